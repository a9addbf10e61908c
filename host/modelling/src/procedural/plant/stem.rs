//! One stem: its axis, its forks, the stems and organs that it bears.

use super::axis::StemAxis;
use super::crown::CrownShape;
use super::error::PlantError;
use super::frame::StemFrame;
use super::grower::{Grower, drawn};
use super::instant::{eased, grown};
use super::organ::OrganPlace;
use super::organ_mesh::ORGAN_VARIANTS;
use super::parameters::{StemNumber, TreeNumber};
use super::taper::{flared, stem_radius};
use crate::numeric::sampling::{RandomStream, mix};
use crate::procedural::drawing::{CrossSection, PlacedPredefined, append};
use glam::{DAffine3, DVec3};

/// Turns of a stem that winds as a screw, from its base to its tip.
const HELIX_TURNS: f64 = 2.0;
/// Most parts into which a segment is divided to be smooth.
const MOST_PARTS: f64 = 8.0;
/// The last stem is born when this part of the growth of the one that bears it is over: so that young plants have boughs.
const LAST_BIRTH: f64 = 0.15;
/// Steps of the bisection that finds how long a stem is that the envelope cuts.
const PRUNING_STEPS: u32 = 12;
/// How far, in parts of the distance to the next, stems and organs stray along what bears them.
const STRAY: f64 = 0.35;
/// An organ is small if its length is below this part of the detail.
const SMALL: f64 = 0.8;

/// A stem before its axis is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stem {
    pub level: usize,
    /// From which all random numbers of the stem come.
    pub key: u64,
    /// Its length when it is grown up, and the part of that which it has.
    pub length: f64,
    pub growth: f64,
    /// The age at which it was born.
    pub birth: f64,
    /// Its radius at its base, as it has grown.
    pub radius: f64,
    /// How many stems and organs it bears, in parts of the most.
    pub abundance: f64,
    pub foliage: f64,
}

/// The rest of a stem, from one of its segments on: all of it, or what goes on behind a fork.
#[derive(Clone, Copy, Debug)]
pub(super) struct StemRun {
    frame: StemFrame,
    /// Its direction before, so that it is smooth there.
    before: DVec3,
    first: usize,
    /// How far it bends back at each segment, degrees.
    correction: f64,
    /// Forks that were owed when the last was made.
    owed: f64,
}

impl StemRun {
    /// A stem from its base on.
    pub fn whole(frame: StemFrame) -> StemRun {
        StemRun { frame, before: frame.ahead(), first: 0, correction: 0.0, owed: 0.0 }
    }
}

impl Grower<'_> {
    /// Lets a stem or the rest of one grow, with all that it bears.
    pub fn stem(&mut self, stem: &Stem, run: StemRun) -> Result<(), PlantError> {
        self.count()?;
        if !(stem.length * stem.growth > 0.0 && stem.radius > 0.0) {
            return Ok(());
        }
        let mut forks = Vec::new();
        let axis = self.axis(stem, &run, &mut forks);
        self.draw_stem(stem, &axis)?;
        if stem.level + 1 < self.levels() {
            self.stems_on(stem, &axis)?;
        } else {
            self.organs_on(stem, &axis)?;
        }
        forks.iter().try_for_each(|(stem, run)| self.stem(stem, *run))
    }

    /// The axis of a run, and what forks off it.
    fn axis(&self, stem: &Stem, run: &StemRun, forks: &mut Vec<(Stem, StemRun)>) -> StemAxis {
        let number = |number: StemNumber| self.model.numbers.stem(stem.level, number);
        let mut shape = RandomStream::new(stem.key, 2);
        let segments = drawn(number(StemNumber::Segments), &mut shape).round().max(1.0) as usize;
        let helix = drawn(number(StemNumber::Helix), &mut shape);
        let mut random = RandomStream::new(mix(stem.key ^ run.first as u64), 3);
        let step = stem.length * stem.growth / segments as f64;
        let axis_of_helix = run.frame.ahead();
        let (mut frame, mut correction, mut owed) = (run.frame, run.correction, run.owed);
        if helix != 0.0 && run.first == 0 {
            frame = frame.pitched(helix);
        }
        let mut frames = Vec::with_capacity(segments + 1 - run.first);
        for segment in run.first..segments {
            frames.push(frame);
            frame.at += frame.ahead() * step;
            let rest = segments - segment - 1;
            if rest == 0 {
                frames.push(frame);
                break;
            }
            frame = frame.pitched(self.bend(stem.level, segment, segments, &mut random) + correction);
            if helix != 0.0 {
                frame = frame.turned(axis_of_helix, 360.0 * HELIX_TURNS / segments as f64);
            }
            if stem.level >= 2 {
                frame = attracted(frame, self.number(TreeNumber::Attraction) / segments as f64);
            }
            let is_base = stem.level == 0 && segment == 0 && self.number(TreeNumber::BaseSplits) > 0.0;
            let wanted = if is_base {
                self.number(TreeNumber::BaseSplits)
            } else {
                drawn(number(StemNumber::Splits), &mut random) + owed
            };
            let count = wanted.round().max(0.0);
            owed = if is_base { 0.0 } else { wanted - count };
            if count == 0.0 {
                continue;
            }
            let before = (frame.at - frames[frames.len() - 1].at).normalize_or(frame.ahead());
            let declination = frame.declination();
            let angle = (drawn(number(StemNumber::SplitAngle), &mut random) - declination).max(0.0);
            let back = correction - angle / rest as f64;
            let own_turn = random.uniform();
            for fork in 1..=count as u64 {
                let turn = if is_base {
                    360.0 * fork as f64 / (count + 1.0)
                } else {
                    spread(declination, random.uniform()) * if fork % 2 == 1 { -1.0 } else { 1.0 }
                };
                let forked = frame.pitched(angle).turned(DVec3::Y, turn);
                let key = mix(stem.key ^ mix((segment as u64) << 32 | fork));
                let run = StemRun { frame: forked, before, first: segment + 1, correction: back, owed };
                forks.push((Stem { key, ..*stem }, run));
            }
            frame = frame.pitched(angle).turned(DVec3::Y, if is_base { 0.0 } else { spread(declination, own_turn) });
            correction = back;
        }
        StemAxis::new(run.before, frames, run.first, segments)
    }

    /// How far a stem bends at the end of a segment, degrees.
    fn bend(&self, level: usize, segment: usize, segments: usize, random: &mut RandomStream) -> f64 {
        let curve = self.model.numbers.stem(level, StemNumber::Curve);
        let back = drawn(self.model.numbers.stem(level, StemNumber::CurveBack), random);
        let stray = curve.deviation * (2.0 * random.uniform() - 1.0) / segments as f64;
        let half = 0.5 * segments as f64;
        match back {
            0.0 => curve.mean / segments as f64 + stray,
            _ if (segment as f64) < half => curve.mean / half + stray,
            back => back / half + stray,
        }
    }

    /// The radius of a stem at a part of its length.
    fn radius_at(&self, stem: &Stem, part: f64) -> f64 {
        let taper = self.model.numbers.stem(stem.level, StemNumber::Taper).mean;
        let radius = stem_radius(stem.radius, stem.length * stem.growth, taper, part);
        if stem.level == 0 { radius * flared(self.number(TreeNumber::Flare), part) } else { radius }
    }

    /// Draws the run of a stem: as it is, or, of thin ones, fewer and wider.
    fn draw_stem(&mut self, stem: &Stem, axis: &StemAxis) -> Result<(), PlantError> {
        let widest = 2.0 * self.radius_at(stem, axis.begin());
        let is_last = stem.level > 0 && stem.level + 1 >= self.levels();
        let wider = match self.thinned(widest, stem.key) {
            _ if !is_last => 1.0,
            Some(wider) => wider,
            None => return Ok(()),
        };
        let step = stem.length * stem.growth / axis.segments as f64;
        let mut nodes = Vec::new();
        for segment in 0..axis.frames.len() - 1 {
            let turn = axis.tangents[segment].angle_between(axis.tangents[segment + 1]);
            let mut parts = (step * turn / (8.0 * 0.5 * self.detail)).sqrt().ceil();
            if stem.level == 0 && axis.first + segment <= axis.segments / 8 && widest > self.detail {
                parts = MOST_PARTS;
            }
            let parts = parts.clamp(1.0, MOST_PARTS) as usize;
            for part in 0..parts {
                let t = part as f64 / parts as f64;
                let of_stem = ((axis.first + segment) as f64 + t) / axis.segments as f64;
                nodes.push((axis.within(segment, t).at, wider * self.radius_at(stem, of_stem)));
            }
        }
        nodes.push((axis.frames[axis.frames.len() - 1].at, wider * self.radius_at(stem, 1.0)));
        let lobes = self.number(TreeNumber::Lobes).round();
        let section = match stem.level {
            _ if self.number(TreeNumber::Flat) >= 0.5 => CrossSection::Flat { across: axis.frames[0].axes.x_axis },
            0 if lobes > 0.0 => CrossSection::Lobed { count: lobes, depth: self.number(TreeNumber::LobeDepth) },
            _ => CrossSection::Round,
        };
        self.stroke(&nodes, section)
    }

    /// Lets the stems of the next level grow.
    fn stems_on(&mut self, stem: &Stem, axis: &StemAxis) -> Result<(), PlantError> {
        let level = stem.level + 1;
        let numbers = &self.model.numbers;
        let mut random = RandomStream::new(stem.key, 5);
        let count =
            (drawn(numbers.stem(level, StemNumber::Branches), &mut random) * stem.abundance + random.uniform()).floor();
        let base = if stem.level == 0 { self.number(TreeNumber::Base) } else { 0.0 };
        let longest = numbers.stem(1, StemNumber::Length).mean.max(1e-12);
        for number in 0..count as u64 {
            let key = mix(stem.key ^ mix(number + 1));
            let mut random = RandomStream::new(key, 6);
            let stray = STRAY * (2.0 * random.uniform() - 1.0);
            let in_crown = (number as f64 + 0.5 + stray) / count;
            let part = base + (1.0 - base) * in_crown;
            if part < axis.begin() {
                continue;
            }
            let rest = 1.0 - in_crown;
            let offset = part * stem.length;
            let drawn_length = drawn(numbers.stem(level, StemNumber::Length), &mut random);
            let (length, abundance) = if level == 1 {
                let length = stem.length * drawn_length * self.model.shape.ratio(rest);
                (length, 0.2 + 0.8 * length / (stem.length * longest))
            } else {
                (drawn_length * (stem.length - 0.6 * offset), 1.0 - 0.5 * part)
            };
            let birth = stem.birth + (1.0 - stem.birth) * LAST_BIRTH * part;
            let growth = grown(self.instant.age, birth);
            let lengths = length * growth / (stem.length * stem.growth);
            let power = self.number(TreeNumber::RatioPower);
            let child = Stem {
                level,
                key,
                length,
                growth,
                birth,
                radius: (stem.radius * lengths.powf(power)).min(self.radius_at(stem, part)),
                abundance,
                foliage: CrownShape::TaperedCylindrical.ratio(part),
            };
            let frame = self.on_stem(axis.at(part), level, number, rest, &mut random);
            let child = self.pruned(child, frame);
            self.stem(&child, StemRun::whole(frame))?;
        }
        Ok(())
    }

    /// The frame of a stem where it leaves the one that bears it.
    ///
    /// - `rest`: of the part of the bearing stem that has stems, what is ahead.
    fn on_stem(&self, frame: StemFrame, level: usize, number: u64, rest: f64, random: &mut RandomStream) -> StemFrame {
        let stem = |number: StemNumber| self.model.numbers.stem(level, number);
        let rotate = stem(StemNumber::Rotate);
        let stray = rotate.deviation * (2.0 * random.uniform() - 1.0);
        let slope = drawn(stem(StemNumber::DownSlope), random) * (0.5 - rest);
        let down = drawn(stem(StemNumber::DownAngle), random) + slope;
        frame.rolled(turn_of(rotate.mean, number) + stray).pitched(down)
    }

    /// A stem, cut back where it would grow out of the envelope.
    fn pruned(&self, stem: Stem, frame: StemFrame) -> Stem {
        let Some(envelope) = &self.envelope else { return stem };
        // The envelope grows as the trunk does.
        let size = grown(self.instant.age, 0.0).max(1e-12);
        let is_inside = |part: f64| {
            let run = StemRun::whole(frame);
            let axis = self.axis(&Stem { length: part * stem.length, ..stem }, &run, &mut Vec::new());
            let inside = |at: DVec3| envelope.contains(at.x.hypot(at.z) / size, at.y / size);
            axis.frames.iter().skip(1).all(|node| inside(node.at))
        };
        let [mut part, mut outside] = if is_inside(1.0) { [1.0, 1.0] } else { [0.0, 1.0] };
        for _ in 0..PRUNING_STEPS {
            let middle = 0.5 * (part + outside);
            if part < outside {
                if is_inside(middle) { part = middle } else { outside = middle }
            }
        }
        let ratio = self.number(TreeNumber::PruneRatio);
        Stem {
            length: stem.length * (1.0 + (part - 1.0) * ratio),
            radius: stem.radius * (1.0 + (part - 1.0) * ratio),
            ..stem
        }
    }

    /// Places the organs of a stem.
    pub fn organs_on(&mut self, stem: &Stem, axis: &StemAxis) -> Result<(), PlantError> {
        let model = self.model;
        for (number, organ) in model.organs.iter().enumerate() {
            let source = if let OrganPlace::With(other) = organ.place { other } else { number };
            let Some(standing) = model.organs.get(source) else { continue };
            let mut random = RandomStream::new(mix(stem.key ^ (source as u64 + 1)), 7);
            let count = (drawn(standing.count, &mut random) * stem.foliage + random.uniform()).floor();
            for one in 0..count as u64 {
                let key = mix(stem.key ^ mix(((source as u64 + 1) << 40) | one));
                let mut random = RandomStream::new(key, 8);
                let stray = STRAY * (2.0 * random.uniform() - 1.0);
                let along = (one as f64 + 0.5 + stray) / count;
                let part = match standing.place {
                    OrganPlace::Along { from } => from + (1.0 - from) * along,
                    _ => 1.0,
                };
                if part < axis.begin() {
                    continue;
                }
                let down = drawn(standing.down_angle, &mut random);
                let roll_stray = standing.rotate.deviation * (2.0 * random.uniform() - 1.0);
                let draws = [random.uniform(), random.uniform()];
                let variant = random.below(ORGAN_VARIANTS);
                let keep = random.uniform();
                let mut own = RandomStream::new(mix(key ^ number as u64), 9);
                let full = drawn(organ.size, &mut own).max(0.0);
                let born = (stem.birth + (1.0 - stem.birth) * 0.3 * part).min(0.999);
                let size = full
                    * organ.season.size(self.instant.part_of_year(), draws)
                    * eased(4.0 * (self.instant.age - born) / (1.0 - born));
                let kept = (full / (SMALL * self.detail)).powi(2).min(1.0);
                if size <= 0.0 || keep >= kept {
                    continue;
                }
                let frame = axis.at(part);
                let frame = match standing.place {
                    OrganPlace::Fan { angle } if count > 1.0 => {
                        let turn = angle * (one as f64 / (count - 1.0) - 0.5);
                        frame.turned(frame.axes.z_axis, turn).pitched(down)
                    }
                    OrganPlace::Tip | OrganPlace::Fan { .. } => frame.rolled(360.0 * draws[0]).pitched(down),
                    // The upper side looks to the tip of the stem.
                    _ => frame.rolled(turn_of(standing.rotate.mean, one) + roll_stray).pitched(down).rolled(180.0),
                };
                let StemFrame { at, axes } = to_light(frame, standing.bend);
                let placement = DAffine3::from_mat3_translation(axes * (size / kept.sqrt()), at);
                let surface = number * ORGAN_VARIANTS + variant;
                let placed = PlacedPredefined { surface, placement, colour: number as u32 + 1 };
                append(&mut self.drawing.placed, placed, "organs")?;
            }
        }
        Ok(())
    }
}

/// The turn of one of many around what bears them, degrees.
fn turn_of(rotate: f64, number: u64) -> f64 {
    if rotate < 0.0 {
        return if number.is_multiple_of(2) { -rotate } else { 180.0 - rotate };
    }
    (rotate * number as f64).rem_euclid(360.0)
}

/// How far a fork turns about the vertical, degrees.
///
/// # Source
/// Weber and Penn 1995, section 4.2.
fn spread(declination: f64, uniform: f64) -> f64 {
    20.0 + 0.75 * (30.0 + (declination - 90.0).abs()) * uniform * uniform
}

/// Bent up by a part of its declination, or down below 0.
///
/// # Source
/// Weber and Penn 1995, section 4.8, as bending towards the vertical.
fn attracted(frame: StemFrame, attraction: f64) -> StemFrame {
    let declination = frame.declination();
    let Some(axis) = frame.ahead().cross(DVec3::Y).try_normalize() else { return frame };
    let angle = attraction * declination * declination.to_radians().sin();
    // No farther than to the vertical itself.
    frame.turned(axis, angle.clamp(declination - 180.0, declination))
}

/// Turned towards the light: out and up.
///
/// # Source
/// Weber and Penn 1995, section 4.9.
fn to_light(frame: StemFrame, bend: f64) -> StemFrame {
    if bend == 0.0 {
        return frame;
    }
    let DVec3 { x, z, .. } = frame.at;
    let normal = frame.axes.z_axis;
    let outwards = f64::atan2(z, x) - f64::atan2(normal.z, normal.x);
    let outwards = (outwards + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    let frame = frame.turned(DVec3::Y, -bend * outwards.to_degrees());
    let normal = frame.axes.z_axis;
    let Some(axis) = normal.cross(DVec3::Y).try_normalize() else { return frame };
    frame.turned(axis, bend * normal.y.clamp(-1.0, 1.0).acos().to_degrees())
}
