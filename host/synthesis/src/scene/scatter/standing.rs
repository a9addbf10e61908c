//! How an instance stands that is somewhere by chance.

use super::super::object::{Scatter, Sway};
use super::air::AirLattice;
use crate::numeric::sampling::{RandomStream, disk_across, part_of};
use crate::octree::{Instance, Prototype};
use crate::procedural::Wind;
use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::TAU;

/// At this speed what the wind bends leans as far as is told, units of length a second.
const SWAY_SPEED: f64 = 10.0;
/// Gusts that are faster than the mean speed by more than so many standard deviations bend no more.
const STRONGEST: f64 = 2.0;

/// What is drawn for each instance, and within which ranges.
#[derive(Clone, Debug)]
pub(super) struct Standing {
    scale: [f64; 2],
    /// Radians.
    turn: f64,
    /// Radians.
    lean: f64,
    upright: f64,
    sink: f64,
    sway: Option<Sway>,
    /// The wind where places are told in coordinates of a level ground.
    air: Option<AirLattice>,
    /// From coordinates in which places are told to those of the instances; a rotation and a translation.
    to_instances: DAffine3,
    /// Of the shares of the prototypes, the part up to each.
    below: Vec<f64>,
    pub(super) shares: Vec<f64>,
    pub(super) seed: u64,
}

impl Standing {
    pub(super) fn new(scatter: &Scatter) -> Standing {
        let Scatter { scale, turn, lean, upright, sink, ref shares, ref sway, seed, .. } = *scatter;
        let below = parts_below(shares.iter().copied());
        let (turn, lean) = (turn.to_radians(), lean.to_radians());
        let (shares, sway, to_instances) = (shares.clone(), sway.clone(), DAffine3::IDENTITY);
        Standing { scale, turn, lean, upright, sink, sway, air: None, to_instances, below, shares, seed }
    }

    /// These, with places that are told in coordinates of a level ground.
    pub(super) fn on_ground(self, to_instances: DAffine3) -> Standing {
        let air = self.sway.as_ref().map(|sway| AirLattice::new(sway, to_instances));
        Standing { air, to_instances, ..self }
    }

    /// Whether there is nothing to place.
    pub(super) fn places_nothing(&self) -> bool {
        self.below.is_empty()
    }

    /// The instance at a place.
    ///
    /// - `normal`, `vertical`: of the surface there, and up; of unit length.
    pub(super) fn instance(&self, at: DVec3, normal: DVec3, vertical: DVec3, mut random: RandomStream) -> Instance {
        let up = self.up(normal, vertical);
        let offset = disk_across(up, random.point());
        let up = (up + offset * self.lean.tan()).try_normalize().unwrap_or(up);
        let up = self.bent(at, up);
        let turned = (self.turn * (random.uniform() - 0.5)).rem_euclid(TAU);
        // Where nothing is turned, x stays as much along x as it can.
        let across = [DVec3::X, DVec3::Z].map(|axis| axis - up * up.dot(axis));
        let across =
            if across[0].length() > 1e-3 { across[0] } else { across[1] }.normalize_or(up.any_orthonormal_vector());
        let x = across * turned.cos() - up.cross(across) * turned.sin();
        let [least, most] = self.scale;
        let scale = least + (most - least) * random.uniform();
        let matrix3 = DMat3::from_cols(x, up, x.cross(up)) * scale;
        let (prototype, _) = part_of(&self.below, random.uniform());
        let variation = (random.uniform() * 65_536.0) as u16;
        let placement = DAffine3 { matrix3, translation: at - up * (self.sink * scale) };
        Instance { prototype: prototype as u16, variation, placement }
    }

    /// The size of an instance as a part of the largest.
    ///
    /// - `random`: what more is drawn for it.
    pub(super) fn part_of_largest(&self, mut random: RandomStream) -> f64 {
        let [least, most] = self.scale;
        if least == most {
            return 1.0;
        }
        // How it leans, and how it is turned.
        random.point();
        random.uniform();
        (least + (most - least) * random.uniform()) / most
    }

    /// Where an axis points when the wind bends it.
    fn bent(&self, at: DVec3, up: DVec3) -> DVec3 {
        let Some(Sway { wind, time, lean }) = &self.sway else { return up };
        let velocity = match &self.air {
            Some(air) => air.velocity(at),
            None => wind.at(at, *time),
        };
        let speed = velocity.length().min(strongest(wind));
        let towards = self.to_instances.matrix3.transpose() * velocity.normalize_or_zero();
        let across = towards - up * towards.dot(up);
        (up + across * slant(*lean, speed)).try_normalize().unwrap_or(up)
    }

    /// How far an axis leans at the most, by chance and by the wind, radians.
    fn most_lean(&self) -> f64 {
        let bent = |Sway { wind, lean, .. }: &Sway| slant(*lean, strongest(wind)).atan();
        self.lean + self.sway.as_ref().map_or(0.0, bent)
    }

    /// Where the axis of one points that does not lean.
    fn up(&self, normal: DVec3, vertical: DVec3) -> DVec3 {
        normal.lerp(vertical, self.upright).try_normalize().unwrap_or(normal)
    }

    /// The diagonal of the box about the largest thing that is placed.
    pub(super) fn largest(&self, prototypes: &[Prototype]) -> f64 {
        let boxes = prototypes.iter().map(Prototype::bounds).filter(|bounds| !bounds.is_empty());
        boxes.map(|bounds| bounds.diagonal()).fold(0.0, f64::max) * self.scale[1]
    }

    /// How far what is placed can be from its place.
    pub(super) fn reach(&self, prototypes: &[Prototype]) -> f64 {
        let corners = prototypes.iter().filter(|of| !of.bounds().is_empty()).flat_map(|of| of.bounds().corners());
        corners.map(|corner| (corner - DVec3::Y * self.sink).length()).fold(0.0, f64::max) * self.scale[1]
    }

    /// How far what is placed on a level surface can be from its place, along the surface; then how far below it and above.
    ///
    /// - `vertical`: up, where the normal of the surface is y.
    pub(super) fn level_reach(&self, prototypes: &[Prototype], vertical: DVec3) -> (f64, [f64; 2]) {
        let tilt = self.up(DVec3::Y, vertical).y.clamp(-1.0, 1.0).acos() + self.most_lean();
        let (sine, cosine) = if tilt < TAU / 4.0 { tilt.sin_cos() } else { (1.0, 0.0) };
        let corners = prototypes.iter().filter(|of| !of.bounds().is_empty()).flat_map(|of| of.bounds().corners());
        let (mut along, mut heights) = (0.0_f64, [0.0_f64; 2]);
        for corner in corners {
            let (across, y) = (corner.x.hypot(corner.z), corner.y - self.sink);
            along = along.max((across + y.abs() * sine).min(across.hypot(y)));
            // An axis that leans lowers what is along it, and raises what is across; beyond a right angle it turns over.
            let under = if cosine > 0.0 { y.min(0.0) } else { -y.abs() };
            let over = if cosine > 0.0 { y.max(0.0) } else { y.abs() };
            heights = [heights[0].min(under - across * sine), heights[1].max(over + across * sine)];
        }
        (along * self.scale[1], heights.map(|height| height * self.scale[1]))
    }
}

/// The speed beyond which nothing is bent more.
fn strongest(wind: &Wind) -> f64 {
    wind.mean.length() * (1.0 + STRONGEST * wind.gusts.hypot(wind.turbulence))
}

/// The tangent of the angle by which the wind bends an axis across it.
///
/// - `lean`: the angle at [`SWAY_SPEED`], degrees. `speed`: of the wind.
fn slant(lean: f64, speed: f64) -> f64 {
    lean.to_radians().tan() * (speed / SWAY_SPEED).powi(2)
}

/// For each of some amounts, what part of their sum those up to it are; nothing if the sum is 0.
pub(super) fn parts_below(amounts: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut below: Vec<f64> = amounts
        .scan(0.0, |sum, amount| {
            *sum += amount;
            Some(*sum)
        })
        .collect();
    match below.last().copied() {
        Some(sum) if sum > 0.0 => below.iter_mut().for_each(|part| *part /= sum),
        _ => below.clear(),
    }
    below
}
