//! What a ray goes through: transparent bodies, one within another.

use super::world::{Found, Met, World};
use crate::color::Channels;
use crate::illumination::optics::Side;
use crate::numeric::ray::Ray;
use crate::render::eye::{Cone, Sight};
use glam::DVec3;

/// Most bodies within one another that a ray keeps in mind.
const MOST: usize = 6;

/// The bodies that a ray is in, each by its object and material, the innermost last.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Media {
    bodies: [(u32, u32); MOST],
    count: usize,
}

impl Media {
    /// The bodies around a point in the middle of the time in which the shutter is open.
    ///
    /// What two rays from there that go opposite ways leave without having come into it: one would also leave an open surface.
    pub(super) fn around(world: &World<'_>, point: DVec3) -> Media {
        // Not along anything that a scene is likely to have.
        let direction = DVec3::new(0.3517, 0.8731, 0.3379);
        let [one, other] =
            [direction, -direction].map(|direction| Media::left(world, Ray { origin: point, direction }));
        let mut around = Media::default();
        for body in one.bodies[..one.count].iter().filter(|(object, _)| other.holds(*object)) {
            around.bodies[around.count] = *body;
            around.count += 1;
        }
        around
    }

    /// The bodies that a ray leaves without having come into them.
    fn left(world: &World<'_>, ray: Ray) -> Media {
        let mut sight = Sight { ray, t_min: 0.0, t_max: f64::INFINITY, cone: Cone::default() };
        let (mut left, mut entered) = (Media::default(), Media::default());
        loop {
            let met = world.meet(&sight, 0, 0.0);
            let (t, found) = match met {
                Met::Nothing => return left,
                Met::Glow(_, glow) => (glow.t, None),
                Met::Element(found) => (found.t, Some(found)),
            };
            sight.t_min = t.next_up();
            if let Some(found) = found {
                if found.element.outside || entered.holds(found.object) {
                    entered.cross(&found);
                } else {
                    left.notice(&found);
                }
            }
        }
    }

    fn holds(&self, object: u32) -> bool {
        self.bodies[..self.count].iter().any(|(other, _)| *other == object)
    }

    fn innermost(&self) -> Option<(u32, u32)> {
        self.count.checked_sub(1).map(|last| self.bodies[last])
    }

    /// The part of light that comes through a length of what is here.
    pub(super) fn absorbed(&self, world: &World<'_>, length: f64, comb: usize) -> Channels {
        let interior =
            self.innermost().and_then(|(object, material)| world.appearance.optics(object, material).interior.as_ref());
        match interior {
            Some(interior) if interior.absorption.max() > 0.0 => {
                interior.absorption.of(comb).map(|absorption| (-absorption * length).exp())
            }
            _ => Channels::ONE,
        }
    }

    /// The refractive indices before and behind an element; 1 where there is no body.
    pub(super) fn side(&self, world: &World<'_>, found: &Found<'_>, comb: usize) -> Side {
        let index = |body: Option<(u32, u32)>| {
            let interior =
                body.and_then(|(object, material)| world.appearance.optics(object, material).interior.as_ref());
            interior.map_or(Channels::ONE, |interior| interior.index.of(comb))
        };
        let own = Some((found.object, found.material));
        if found.optics.interior.is_none() {
            let before = index(self.innermost());
            return Side { before, behind: before };
        }
        if found.element.outside {
            return Side { before: index(self.innermost()), behind: index(own) };
        }
        // From inside, also where the eye was in the body from the beginning.
        let mut beyond = *self;
        beyond.leave(found.object);
        Side { before: index(own), behind: index(beyond.innermost()) }
    }

    /// Goes through an element, into its body or out of it.
    pub(super) fn cross(&mut self, found: &Found<'_>) {
        if found.optics.interior.is_none() {
            return;
        }
        if !found.element.outside {
            self.leave(found.object);
        } else if self.count < MOST {
            self.bodies[self.count] = (found.object, found.material);
            self.count += 1;
        }
    }

    /// Takes note of the body of an element that is met from inside, if light began there.
    pub(super) fn notice(&mut self, found: &Found<'_>) {
        let is_inner = found.optics.interior.is_some() && !found.element.outside;
        if is_inner && self.count < MOST && !self.holds(found.object) {
            // Around those that it is in.
            self.bodies.copy_within(0..self.count, 1);
            self.bodies[0] = (found.object, found.material);
            self.count += 1;
        }
    }

    fn leave(&mut self, object: u32) {
        if let Some(place) = self.bodies[..self.count].iter().rposition(|(other, _)| *other == object) {
            self.bodies.copy_within(place + 1..self.count, place);
            self.count -= 1;
        }
    }
}
