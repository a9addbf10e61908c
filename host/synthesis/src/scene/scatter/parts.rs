//! Places of which each part of the surface has as many as its area tells, so that a part is known without the others.

use super::super::ShapeError;
use super::super::object::Scatter;
use super::standing::Standing;
use super::surface::{ScatterSurface, SurfacePlace};
use crate::memory;
use crate::numeric::bounds::Bounds;
use crate::numeric::sampling::RandomStream;
use crate::octree::{Instance, InstanceParts, LocationalCode, MAX_DEPTH, Prototype};
use glam::DVec3;
use std::ops::Range;

/// A part has about so many instances.
const PART: usize = 1 << 12;
/// There are at most about so many parts.
const MOST: usize = 1 << 15;
/// Bytes of a triangle.
const TRIANGLE_BYTES: u64 = 208;
/// Digits of the codes by which triangles are sorted.
const DIGITS: u32 = 16;

/// Instances by the parts of a surface.
///
/// Instance n of N is where the area up to it is between n / N and (n + 1) / N of the whole: stratified sampling.
#[derive(Clone, Debug)]
pub(in crate::scene) struct ScatterParts {
    standing: Standing,
    /// Neighbours follow each other, and no triangle has more than a part.
    surface: ScatterSurface,
    /// Around the triangles of each part.
    boxes: Vec<Bounds>,
    /// The first triangle of each part, and the first behind all.
    triangles: Vec<usize>,
    /// Likewise the first instance.
    instances: Vec<usize>,
    /// How far what is placed can be from its place.
    reach: f64,
}

impl ScatterParts {
    /// Divides the surface. Cost: as its triangles and the number of parts.
    ///
    /// # Errors
    /// [`ShapeError`], if the surface cannot be tessellated, or for too little memory.
    pub(in crate::scene) fn new(
        scatter: &Scatter,
        scene_tolerance: Option<f64>,
        angle: f64,
    ) -> Result<ScatterParts, ShapeError> {
        let standing = Standing::new(scatter);
        let whole = ScatterSurface::new(&scatter.on, &scatter.density, scene_tolerance, angle)?;
        let count = if whole.areas.is_empty() || standing.places_nothing() { 0 } else { scatter.count };
        let part = (count / MOST).max(PART);
        let most = whole.corners.len() as u64 + 4 * (count / part) as u64;
        memory::reserve(most * TRIANGLE_BYTES, || format!("scattering {count} instances"))?;
        let surface = divided(whole, count as f64 / part as f64);
        let up_to = |triangle: usize| if triangle == 0 { 0.0 } else { surface.areas[triangle - 1] };
        let (mut triangles, mut instances) = (vec![0], vec![0]);
        for triangle in 1..=surface.areas.len() {
            let number = (up_to(triangle) * count as f64).round() as usize;
            let is_last = triangle == surface.areas.len();
            // The next triangle may have as many as a part has.
            let next = if is_last { count } else { (up_to(triangle + 1) * count as f64).round() as usize };
            if is_last || next - instances.last().copied().unwrap_or(0) > part {
                triangles.push(triangle);
                instances.push(if is_last { count } else { number });
            }
        }
        let around = |pair: &[usize]| Bounds::of(surface.corners[pair[0]..pair[1]].iter().flatten().copied());
        let boxes = triangles.windows(2).map(around).collect();
        Ok(ScatterParts { standing, surface, boxes, triangles, instances, reach: 0.0 })
    }

    /// These, with what they place.
    pub(in crate::scene) fn placing(self, prototypes: &[Prototype]) -> ScatterParts {
        ScatterParts { reach: self.standing.reach(prototypes), ..self }
    }

    pub(in crate::scene) fn count_of_all(&self) -> usize {
        self.instances.last().copied().unwrap_or(0)
    }

    /// The numbers of about so many instances about a point.
    pub(in crate::scene) fn near(&self, at: DVec3, most: usize) -> Vec<Range<usize>> {
        let distance = |part: &usize| at.distance_squared(at.clamp(self.boxes[*part].min, self.boxes[*part].max));
        let mut parts: Vec<(f64, usize)> = (0..self.boxes.len()).map(|part| (distance(&part), part)).collect();
        parts.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        let mut room = most;
        let nearest = parts.into_iter().map_while(|(_, part)| {
            let all = self.instances[part]..self.instances[part + 1];
            let fits = room > 0;
            room = room.saturating_sub(all.len());
            fits.then_some(all)
        });
        nearest.collect()
    }

    /// An instance by its number among all.
    pub(in crate::scene) fn instance_of_all(&self, number: usize) -> Instance {
        let part = self.instances.partition_point(|first| *first <= number) - 1;
        self.instance(part, number - self.instances[part])
    }
}

impl InstanceParts for ScatterParts {
    fn parts(&self) -> usize {
        self.boxes.len()
    }

    fn count(&self, part: usize) -> usize {
        self.instances[part + 1] - self.instances[part]
    }

    fn bounds(&self, part: usize) -> Bounds {
        let Bounds { min, max } = self.boxes[part];
        let reach = self.reach + self.surface.ground.as_ref().map_or(0.0, |ground| ground.off);
        Bounds { min: min - reach, max: max + reach }
    }

    fn instance(&self, part: usize, number: usize) -> Instance {
        let mut random = RandomStream::new(self.standing.seed, (self.instances[part] + number) as u64);
        let [first, last] = [self.triangles[part], self.triangles[part + 1]];
        let areas = &self.surface.areas;
        let from = if first == 0 { 0.0 } else { areas[first - 1] };
        let share = (number as f64 + random.uniform()) / self.count(part) as f64;
        let up_to = from + share * (areas[last - 1] - from);
        let triangle = first + areas[first..last - 1].partition_point(|part| *part <= up_to);
        let SurfacePlace { at, normal, .. } = self.surface.of_triangle(triangle, random.point());
        self.standing.instance(at, normal, DVec3::Y, random)
    }

    fn shares(&self) -> &[f64] {
        &self.standing.shares
    }

    fn add_to_checksum(&self, sum: &mut crc32fast::Hasher) {
        sum.update(format!("{:?} {:?}", self.standing, self.instances).as_bytes());
        let points = self.surface.corners.iter().chain(&self.surface.normals).flatten();
        points.flat_map(|point| point.to_array()).for_each(|x| sum.update(&x.to_le_bytes()));
    }
}

/// A surface whose triangles are divided until none has more than the `parts`-th part of the area, neighbours one after
/// another.
fn divided(whole: ScatterSurface, parts: f64) -> ScatterSurface {
    let ScatterSurface { corners, normals, areas: below, .. } = &whole;
    let around = Bounds::of(corners.iter().flatten().copied());
    let unit = f64::from(1_u32 << MAX_DEPTH) / (around.size().max_element() * (1.0 + 1e-9));
    let code = |[a, b, c]: &[DVec3; 3]| {
        let at = ((*a + *b + *c) / 3.0 - around.min) * unit;
        LocationalCode::containing(at.to_array().map(|x| x as u32), DIGITS).bits()
    };
    let mut order: Vec<(u64, usize)> = corners.iter().zip(0..).map(|(of, triangle)| (code(of), triangle)).collect();
    order.sort_unstable();
    let (mut pieces, mut directions) = (Vec::with_capacity(corners.len()), Vec::with_capacity(corners.len()));
    for (_, triangle) in order.into_iter().take(below.len()) {
        let area = below[triangle] - if triangle == 0 { 0.0 } else { below[triangle - 1] };
        let levels = (area * parts).max(1.0).log(4.0).ceil() as u32;
        divide(corners[triangle], normals[triangle], levels, &mut |corners, normals| {
            pieces.push(corners);
            directions.push(normals);
        });
    }
    let mut surface = ScatterSurface::of(pieces, directions);
    surface.ground = whole.ground;
    surface
}

/// Gives the triangles into which one is divided by the middles of its sides, so many times over, with their normals.
fn divide(corners: [DVec3; 3], normals: [DVec3; 3], levels: u32, give: &mut impl FnMut([DVec3; 3], [DVec3; 3])) {
    if levels == 0 {
        give(corners, normals);
        return;
    }
    let pieces = |[a, b, c]: [DVec3; 3]| {
        let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
        [[a, ab, ca], [ab, bc, ca], [ab, b, bc], [ca, bc, c]]
    };
    for (corners, normals) in pieces(corners).into_iter().zip(pieces(normals)) {
        divide(corners, normals, levels - 1, give);
    }
}
