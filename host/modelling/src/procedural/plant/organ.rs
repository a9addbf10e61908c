//! Organs of plants: leaves, needles, blossoms, fruit. What they look like, where they stand, when they are there.

use super::instant::eased;
use super::outline::BladeOutline;
use crate::procedural::Varied;
use glam::DVec3;

/// An organ of a plant, of which there are many.
#[derive(Clone, Debug, PartialEq)]
pub struct Organ {
    /// What it is called.
    pub name: String,
    /// How its blades are arranged.
    pub arrangement: BladeArrangement,
    /// The outline of a blade.
    pub outline: BladeOutline,
    /// Width of a blade, in parts of its length.
    pub width: f64,
    /// Angle by which each half of a blade is folded up from the plane, degrees.
    pub fold: Varied,
    /// Angle by which a blade bends down from its base to its tip, degrees.
    pub curl: Varied,
    /// Length of the stalk, in parts of that of the organ.
    pub stalk: f64,
    /// Length of the organ, units of length.
    pub size: Varied,
    /// How many there are on each stem of the last level.
    pub count: Varied,
    /// Where on the stem they stand.
    pub place: OrganPlace,
    /// Angle between organ and stem, degrees.
    pub down_angle: Varied,
    /// Turn from one to the next about the stem, degrees; below 0 they stand on both sides in turn.
    pub rotate: Varied,
    /// How far they turn up and outwards to the light, 0 to 1.
    pub bend: f64,
    /// When they are there.
    pub season: OrganSeason,
    /// Their colours over the year.
    pub colours: ColourTrack,
    /// Light that goes through them, in parts of what they reflect.
    pub transmission: f64,
    /// Roughness of their surface where it shines, 0 to 1; none where it does not.
    pub gloss: Option<f64>,
}

/// How the blades of an organ are arranged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BladeArrangement {
    /// One blade.
    Simple,
    /// Blades in pairs on both sides of a midrib, and one at its tip.
    Pinnate {
        /// How many, an odd number.
        blades: u32,
        /// Angle between blade and midrib, degrees.
        angle: f64,
    },
    /// Blades that spread from one point as fingers do.
    Palmate {
        /// How many.
        blades: u32,
        /// Angle between the outermost two, degrees.
        angle: f64,
    },
    /// Blades around an axis, as petals are.
    Rosette {
        /// How many.
        blades: u32,
        /// Angle between blade and axis, degrees: 90 lies flat.
        angle: f64,
    },
    /// Needles around a twig, from its base to its tip.
    Brush {
        /// How many.
        blades: u32,
        /// Angle between needle and twig, degrees.
        angle: f64,
        /// Length of a needle in parts of the twig.
        length: f64,
    },
    /// A ball or an egg: `width` is its width in parts of its length.
    Ball,
}

/// Where organs stand on their stem.
#[derive(Clone, Debug, PartialEq)]
pub enum OrganPlace {
    /// All along it.
    Along {
        /// From which part of its length on, 0 to 1.
        from: f64,
    },
    /// At its tip, spread as a fan.
    Fan {
        /// Angle between the outermost two, degrees.
        angle: f64,
    },
    /// At its tip, pointing ahead.
    Tip,
    /// Where another organ stands, by its number.
    With(usize),
}

/// When an organ is there, in parts of the year from midwinter on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrganSeason {
    /// When it comes out of its bud and when it falls; none for what is always there.
    pub lasts: Option<[Varied; 2]>,
    /// How long it takes to become as large as it will be.
    pub unfolding: f64,
}

/// How long an organ takes to wither, in parts of the year.
const WITHERING: f64 = 0.015;

impl OrganSeason {
    /// How large an organ is at a time of the year, in parts of its full size.
    ///
    /// - `draws`: of this organ, uniform in 0..1.
    pub fn size(&self, part_of_year: f64, draws: [f64; 2]) -> f64 {
        let Some([emerges, falls]) = self.lasts else { return 1.0 };
        let [emerges, falls] = [(emerges, draws[0]), (falls, draws[1])].map(|(varied, draw)| varied.at(draw));
        // What comes in autumn and falls in spring is there at the turn of the year.
        let since = (part_of_year - emerges).rem_euclid(1.0);
        let lasts = (falls - emerges).rem_euclid(1.0);
        let unfolded = if self.unfolding > 0.0 { eased(since / self.unfolding) } else { 1.0 };
        unfolded * (1.0 - eased((since - lasts) / WITHERING))
    }
}

/// Colours over the year: between those that are told they change evenly, and from the last to the first of the next year.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourTrack {
    /// Times of the year in rising order with reflectances, linear sRGB; one at least.
    pub keys: Vec<(f64, DVec3)>,
    /// By how much organs are ahead of or behind the mean, in parts of the year.
    pub spread: f64,
    /// How much lighter and darker they are, in parts of their colour.
    pub variation: f64,
}

impl ColourTrack {
    /// The colour in the mean at a time of the year.
    pub fn at(&self, season: f64) -> DVec3 {
        let season = season.rem_euclid(1.0);
        let after = self.keys.iter().position(|(time, _)| *time > season);
        let count = self.keys.len();
        let to = after.unwrap_or(0);
        let [(from_time, from), (to_time, to)] = [self.keys[(to + count - 1) % count], self.keys[to]];
        let lasts = (to_time - from_time).rem_euclid(1.0);
        let part = if lasts == 0.0 { 0.0 } else { (season - from_time).rem_euclid(1.0) / lasts };
        from.lerp(to, part)
    }

    /// The two colours between which organs are at a time of the year.
    pub fn range(&self, season: f64) -> [DVec3; 2] {
        [-1.0, 1.0].map(|side: f64| {
            (self.at(season + side * self.spread) * (1.0 + side * self.variation))
                .clamp(DVec3::ZERO, DVec3::splat(0.98))
        })
    }
}
