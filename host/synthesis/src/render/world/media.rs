//! Media along a ray: transparent bodies, some of them in one place.

use super::camera_rays::{BoundedRay, RayCone};
use super::geometry::World;
use super::interaction::{RayHit, SurfaceInteraction};
use crate::color::Channels;
use crate::illumination::optics::{InterfaceIndices, InteriorMedium};
use crate::numeric::ray::Ray;
use glam::DVec3;

/// Most bodies in one place that a ray keeps track of.
const MOST: usize = 8;

/// A transparent body: its object, and which of its materials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::render) struct MediumId {
    object: u32,
    material: u32,
}

impl MediumId {
    fn of(interaction: &SurfaceInteraction<'_>) -> MediumId {
        MediumId { object: interaction.object, material: interaction.material }
    }

    fn interior<'a>(self, world: &'a World<'_>) -> Option<&'a InteriorMedium> {
        world.appearance.interior(self.object, self.material)
    }
}

/// The transparent bodies that a ray is in.
///
/// Where there are several, that of the greatest priority is there, and of several with the same the smallest: a bubble
/// in water, and water in a glass into which it reaches a little.
///
/// # Source
/// Schmidt and Budge 2002, simple nested dielectrics in ray traced images.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::render) struct Media {
    bodies: [MediumId; MOST],
    count: usize,
}

/// The medium interface at an element: what a ray is in before and behind it.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct MediumInterface {
    /// The body before it.
    before: Option<MediumId>,
    /// The body behind it.
    behind: Option<MediumId>,
    /// The media of a ray that goes through.
    pub(in crate::render) media: Media,
    /// The last of the surfaces that lie in the same place, in lengths of the ray's direction.
    pub(in crate::render) last: f64,
    /// Whether the ray comes from inside the body of the element.
    inside: bool,
    /// Whether there is anything: not where a body of a greater priority is on both sides.
    pub(in crate::render) is_interface: bool,
}

impl Media {
    /// The bodies around a point in the middle of the time in which the shutter is open.
    ///
    /// What two rays from there that go opposite ways leave without having come into it: one would also leave an open
    /// surface.
    pub(in crate::render) fn around(world: &World<'_>, point: DVec3) -> Media {
        // Not along anything that a scene is likely to have.
        let direction = DVec3::new(0.3517, 0.8731, 0.3379);
        let [one, other] =
            [direction, -direction].map(|direction| Media::left(world, Ray { origin: point, direction }));
        let mut around = Media::default();
        for body in one.bodies().iter().filter(|body| other.holds(body.object)) {
            around.enter(*body);
        }
        around
    }

    /// The bodies that a ray leaves without having come into them.
    fn left(world: &World<'_>, ray: Ray) -> Media {
        let mut bounded = BoundedRay { ray, t_min: 0.0, t_max: f64::INFINITY, cone: RayCone::default() };
        let (mut left, mut entered) = (Media::default(), Media::default());
        loop {
            let hit = world.intersect(&bounded, 0, 0.0);
            let (t, interaction) = match hit {
                RayHit::Nothing => return left,
                RayHit::Light(_, light_hit) => (light_hit.t, None),
                RayHit::Surface(interaction) => (interaction.t, Some(interaction)),
            };
            bounded.t_min = t.next_up();
            if let Some(interaction) = interaction {
                if interaction.element.outside || entered.holds(interaction.object) {
                    entered.pass(&interaction);
                } else {
                    left.notice(&interaction);
                }
            }
        }
    }

    fn bodies(&self) -> &[MediumId] {
        &self.bodies[..self.count]
    }

    fn holds(&self, object: u32) -> bool {
        self.bodies().iter().any(|body| body.object == object)
    }

    /// The body that is there.
    fn present(&self, world: &World<'_>) -> Option<MediumId> {
        let rank = |body: &&MediumId| world.appearance.rank(body.object, body.material);
        self.bodies().iter().max_by_key(rank).copied()
    }

    /// Transmittance of a length of what is here (Bouguer's law).
    pub(in crate::render) fn transmittance(&self, world: &World<'_>, length: f64, wavelength_set: usize) -> Channels {
        match self.present(world).and_then(|body| body.interior(world)) {
            Some(interior) if interior.absorption.max() > 0.0 => {
                interior.absorption.of(wavelength_set).map(|absorption| (-absorption * length).exp())
            }
            _ => Channels::ONE,
        }
    }

    /// The medium interface at an element, with the other surfaces of bodies that lie in the same place.
    ///
    /// - `ray`: that hit the element.
    pub(in crate::render) fn crossing(
        &self,
        world: &World<'_>,
        interaction: &SurfaceInteraction<'_>,
        ray: &Ray,
    ) -> MediumInterface {
        let mut inside = *self;
        if interaction.bsdf.interior.is_none() {
            let present = inside.present(world);
            return MediumInterface {
                before: present,
                behind: present,
                media: inside,
                last: interaction.t,
                inside: false,
                is_interface: true,
            };
        }
        // The camera or a lamp may have been in the body from the beginning.
        inside.notice(interaction);
        let mut behind = inside;
        behind.pass(interaction);
        let mut last = interaction.t;
        world.coincident(ray, interaction, |t, object, material, outside| {
            let body = MediumId { object, material };
            last = last.max(t);
            if outside { behind.enter(body) } else { behind.leave(object) }
        });
        let [from, to] = [inside, behind].map(|media| media.present(world));
        let is_inside = !interaction.element.outside;
        MediumInterface { before: from, behind: to, media: behind, last, inside: is_inside, is_interface: from != to }
    }

    /// Goes through an element, into its body or out of it.
    fn pass(&mut self, interaction: &SurfaceInteraction<'_>) {
        if interaction.bsdf.interior.is_none() {
            return;
        }
        if interaction.element.outside { self.enter(MediumId::of(interaction)) } else { self.leave(interaction.object) }
    }

    /// Takes note of the body of an element that is hit from inside, if light began there.
    pub(in crate::render) fn notice(&mut self, interaction: &SurfaceInteraction<'_>) {
        let is_inner = interaction.bsdf.interior.is_some() && !interaction.element.outside;
        if is_inner && !self.holds(interaction.object) {
            self.enter(MediumId::of(interaction));
        }
    }

    fn enter(&mut self, body: MediumId) {
        if self.count < MOST {
            self.bodies[self.count] = body;
            self.count += 1;
        }
    }

    fn leave(&mut self, object: u32) {
        if let Some(place) = self.bodies().iter().rposition(|body| body.object == object) {
            self.bodies.copy_within(place + 1..self.count, place);
            self.count -= 1;
        }
    }
}

impl MediumInterface {
    /// The refractive indices before and behind the element; 1 where there is no body.
    pub(in crate::render) fn indices(&self, world: &World<'_>, wavelength_set: usize) -> InterfaceIndices {
        let [before, behind] = [self.before, self.behind].map(|body| {
            let interior = body.and_then(|body| body.interior(world));
            interior.map_or(Channels::ONE, |interior| interior.index.of(wavelength_set))
        });
        InterfaceIndices { before, behind, inside: self.inside }
    }
}
