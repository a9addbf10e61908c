//! Trees as drawings.

use super::error::PlantError;
use super::frame::StemFrame;
use super::grower::Grower;
use super::instant::{PlantInstant, grown};
use super::parameters::{StemNumber, TreeNumber};
use super::stem::{Stem, StemRun};
use super::tree_model::TreeModel;
use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::{RandomStream, mix};
use crate::procedural::drawing::PlantDrawing;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Turn from trunk to trunk of those side by side: no two are in line with the middle.
const TRUNK_TURN: f64 = 0.381_966_011;
/// How far trunks side by side face another way than outwards, from side to side, radians.
const FACING: f64 = 2.0;

impl TreeModel {
    /// Draws a tree.
    ///
    /// Its strokes have the colour 0; organs are placed surfaces, each of the colour of its number among the organs, from
    /// 1 on.
    ///
    /// - `seed`: which tree.
    /// - `detail`: what is smaller may be left out or stand for several, units of length, above 0.
    ///
    /// # Errors
    /// More stems than there may be, and less memory than the drawing takes.
    pub fn grow(&self, seed: u32, instant: PlantInstant, detail: f64) -> Result<PlantDrawing, PlantError> {
        let mut grower = Grower::new(self, seed, instant, detail);
        grower.plant(seed)?;
        let surfaces = self.surfaces(grower.detail).into();
        Ok(PlantDrawing { surfaces, ..grower.drawing })
    }

    /// A box that holds trees of some seeds, however coarse they are drawn.
    ///
    /// - `first`: the first seed. `count`: how many follow each other.
    ///
    /// # Errors
    /// Those of [`TreeModel::grow`].
    pub fn bounds(&self, first: u32, count: u32, instant: PlantInstant) -> Result<Bounds, PlantError> {
        let of = |seed: u32| -> Result<Bounds, PlantError> {
            let mut grower = Grower::new(self, seed, instant, f64::MIN_POSITIVE);
            grower.plant(seed)?;
            let coarsest = grower.coarsest();
            let drawing = grower.drawing;
            let around = |centre: DVec3, radius: f64| [centre - radius, centre + radius];
            let nodes = drawing.nodes.iter().flat_map(|node| around(node.position, node.radius.max(coarsest)));
            let organs = drawing.placed.iter().flat_map(|placed| {
                let length = placed.placement.matrix3.x_axis.length();
                // Blades may be wider than long, and bend.
                around(placed.placement.translation, (1.5 * length).max(1.5 * coarsest))
            });
            Ok(Bounds::of(nodes.chain(organs)))
        };
        let all: Vec<Bounds> =
            (0..count).into_par_iter().map(|kind| of(first.wrapping_add(kind))).collect::<Result<_, _>>()?;
        Ok(Bounds::of(all.iter().filter(|one| !one.is_empty()).flat_map(|one| [one.min, one.max])))
    }
}

impl Grower<'_> {
    /// Lets all trunks grow.
    fn plant(&mut self, seed: u32) -> Result<(), PlantError> {
        if let Some(colonisation) = &self.model.colonisation {
            return self.colonised(colonisation, seed);
        }
        let trunks = self.number(TreeNumber::Trunks).round() as u32;
        let height = self.number(TreeNumber::Height);
        let (spread, lean) = (self.number(TreeNumber::Spread), self.number(TreeNumber::Lean));
        for trunk in 0..trunks {
            let key = mix(mix(u64::from(seed)) ^ u64::from(trunk));
            let mut random = RandomStream::new(key, 1);
            let length = height * self.draw(0, StemNumber::Length, &mut random).max(0.0);
            let growth = grown(self.instant.age, 0.0);
            let from_middle = if trunks > 1 { ((f64::from(trunk) + 0.5) / f64::from(trunks)).sqrt() } else { 0.0 };
            let turn = TAU * (TRUNK_TURN * f64::from(trunk) + random.uniform());
            let outwards = DVec3::new(turn.cos(), 0.0, turn.sin());
            // Those side by side bend outwards, more or less.
            let facing = FRAC_PI_2 - turn + FACING * (random.uniform() - 0.5);
            let axes = DMat3::from_rotation_y(facing);
            let frame = StemFrame { at: outwards * (from_middle * spread * height * growth), axes };
            let frame = frame.pitched(lean * from_middle);
            let stem = Stem {
                level: 0,
                key,
                length,
                growth,
                birth: 0.0,
                radius: length * growth * self.number(TreeNumber::Ratio),
                abundance: 1.0,
                foliage: 1.0,
            };
            self.stem(&stem, StemRun::whole(frame))?;
        }
        Ok(())
    }
}
