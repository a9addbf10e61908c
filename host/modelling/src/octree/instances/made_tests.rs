//! Prototypes that are made on demand, beside the same stored.

use super::super::{Octree, OctreeSettings, Ray};
use super::*;
use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::{RandomStream, sphere};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::cell::RefCell;
use std::sync::Arc;

/// Three tetrahedra in a row, as instances of one.
fn row() -> Arc<InstanceOctree> {
    let vertices = [DVec3::new(0.5, 0.5, 0.5), DVec3::new(0.5, -0.5, -0.5), DVec3::new(-0.5, 0.5, -0.5), DVec3::NEG_X];
    let triangles = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    let octree = Octree::build(&vertices, &triangles, &OctreeSettings::default()).expect("a sound mesh");
    let instance = |n: usize| {
        let turn = DQuat::from_rotation_y(n as f64);
        let placement = DAffine3::from_rotation_translation(turn, DVec3::X * (1.5 * n as f64 - 1.5));
        Instance { prototype: 0, variation: n as u16 * 100, placement }
    };
    let prototype = Prototype::surface(Arc::new(octree), 0);
    Arc::new(InstanceOctree::new(vec![prototype], PlacementForm::Exact, 3, instance).expect("few instances"))
}

/// Gives the row, and notes for which placements.
struct Row {
    row: Arc<InstanceOctree>,
    asked: RefCell<Vec<PlacedSurface>>,
}

impl PrototypeMaker for Row {
    fn give(
        &self,
        model: u32,
        placed: &PlacedSurface,
        _: Option<RayInterval<'_>>,
        to: &mut dyn FnMut(&InstanceOctree),
    ) {
        assert_eq!(model, 7);
        self.asked.borrow_mut().push(*placed);
        to(&self.row);
    }

    fn aggregate_views(&self, _: u32) -> &[AggregateView] {
        &[]
    }
}

/// Instances of it in two levels, the outer ones mirrored and skewed.
fn nested(prototype: Prototype) -> InstanceOctree {
    let map = |n: usize, scale: f64| {
        let turn = DMat3::from_quat(DQuat::from_rotation_z(0.4 * n as f64));
        let skew = DMat3::from_cols(DVec3::X, DVec3::new(0.3, 1.0, 0.0), -DVec3::Z);
        let at = DVec3::new(n as f64, (n * n % 5) as f64, (n * 3 % 7) as f64) * 2.0 * scale;
        DAffine3 { matrix3: turn * skew * scale, translation: at }
    };
    let instance =
        |scale: f64| move |n: usize| Instance { prototype: 0, variation: n as u16 + 1, placement: map(n, scale) };
    let inner = InstanceOctree::new(vec![prototype], PlacementForm::Affine, 9, instance(0.3)).expect("few");
    let inner = Prototype::instances(Arc::new(inner));
    InstanceOctree::new(vec![inner], PlacementForm::Exact, 5, instance(1.0)).expect("few")
}

#[test]
fn what_is_made_is_hit_where_it_would_be_hit_if_it_were_stored() {
    let row = row();
    let bounds = row.bounds();
    let larger = Bounds { min: bounds.min - 0.1, max: bounds.max + 0.1 };
    let (stored, made) = (nested(Prototype::instances(row.clone())), nested(Prototype::made(7, larger)));
    assert_eq!((stored.levels(), made.levels()), (3, 5));
    let maker = Row { row, asked: RefCell::default() };
    let walk = made.made_by(Some(&maker));
    let mut random = RandomStream::new(3, 0);
    let mut hits = 0;
    for _ in 0..8_000 {
        let (origin, target) = (sphere(random.point()) * 20.0, DVec3::splat(3.0) + sphere(random.point()) * 4.0);
        let ray = Ray { origin, direction: target - origin };
        let expected = stored.closest(&ray, 0.0, f64::INFINITY);
        let found = walk.closest(&ray, 0.0, f64::INFINITY);
        match (&expected, &found) {
            (Some(expected), Some(found)) => {
                hits += 1;
                // The sphere about the prototype is another, and with it where the rounded placements are.
                assert!((expected.hit.t - found.hit.t).abs() < 1e-6, "{expected:?} {found:?}");
                assert_eq!(found.path.numbers().len(), 3);
                let [there, here] = [stored.placed(&expected.path), walk.placed(&found.path)];
                assert_eq!(there.variation, here.variation);
                assert!((there.placement.matrix3 - here.placement.matrix3).abs_diff_eq(DMat3::ZERO, 1e-6));
                assert!(there.placement.translation.distance(here.placement.translation) < 1e-6);
            }
            (None, None) => {}
            _ => panic!("{expected:?} {found:?}"),
        }
        assert_eq!(walk.occluded(&ray, 0.0, f64::INFINITY), found.is_some());
    }
    assert!(hits > 300, "{hits}");
    // Each of the 45 is told by its own placement, and by that alone.
    let mut asked: Vec<u16> = maker.asked.borrow().iter().map(|placed| placed.variation).collect();
    asked.sort_unstable();
    asked.dedup();
    assert_eq!(asked, (2..=14).collect::<Vec<u16>>());
}

#[test]
fn what_nobody_makes_is_not_there_and_too_many_levels_are_refused() {
    let bounds = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
    let unmade = nested(Prototype::made(7, bounds));
    let ray = Ray { origin: DVec3::new(0.0, 0.0, 50.0), direction: DVec3::NEG_Z };
    assert!(unmade.closest(&ray, 0.0, f64::INFINITY).is_none());
    let mut prototype = Prototype::made(7, bounds);
    for _ in MOST_MADE_LEVELS..MOST_LEVELS {
        let instance = |_| Instance { prototype: 0, variation: 0, placement: DAffine3::IDENTITY };
        let all = InstanceOctree::new(vec![prototype], PlacementForm::Exact, 1, instance).expect("few levels");
        prototype = Prototype::instances(Arc::new(all));
    }
    let instance = |_| Instance { prototype: 0, variation: 0, placement: DAffine3::IDENTITY };
    let refused = InstanceOctree::new(vec![prototype], PlacementForm::Exact, 1, instance);
    assert!(matches!(refused, Err(InstanceError::TooManyLevels { .. })));
}
