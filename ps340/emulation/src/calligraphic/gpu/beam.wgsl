// The light of a stroke at a pixel: the closed forms of spot.rs and track.rs, for one instance a stroke.
//
// Lengths along and across a stroke are in standard deviations of the spot, places in pixels. Differences of places are
// taken between whole numbers, and what is far away was taken off in double precision before (instance.rs), so that
// 32 bits suffice.

struct Screen {
    // Width and height in pixels.
    size: vec2f,
    // Standard deviation of the spot in pixels.
    spot: f32,
    unused: f32,
}

@group(0) @binding(0) var<uniform> screen: Screen;

// Fields as in instance.rs.
struct Stroke {
    @location(0) place: vec4f, // anchor, step
    @location(1) course: vec4f, // u, rest and v at the anchor; kind
    @location(2) terms: vec4f,
    @location(3) reach: vec4f, // from, to, fifth term, -
    @location(4) color: vec4f,
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) place: vec4f,
    @location(1) @interpolate(flat) course: vec4f,
    @location(2) @interpolate(flat) terms: vec4f,
    @location(3) @interpolate(flat) reach: vec4f,
    @location(4) @interpolate(flat) color: vec4f,
}

// Where the spot ends; with the density of a whole Gaussian there, and one over its integral up to there.
const REACH: f32 = 4.5;
const EDGE: f32 = 1.598374e-5;
const WHOLE: f32 = 1.0000068;
// 1 / sqrt(2 pi).
const DENSITY: f32 = 0.3989423;
// How far the rectangle goes beyond the reach, so that rounding of its corners loses no pixel.
const MARGIN: f32 = 0.1;

@vertex
fn corner(@builtin(vertex_index) index: u32, stroke: Stroke) -> Corner {
    let along = select(stroke.reach.x - MARGIN, stroke.reach.y + MARGIN, (index & 1u) != 0u);
    let across = select(-REACH - MARGIN, REACH + MARGIN, (index & 2u) != 0u) - stroke.course.z;
    let step = stroke.place.zw;
    // A step is a unit over the spot.
    let way = (along * step + across * vec2f(-step.y, step.x)) * (screen.spot * screen.spot);
    let at = (stroke.place.xy + 0.5 + way) / screen.size;
    let position = vec4f(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.0, 1.0);
    return Corner(position, stroke.place, stroke.course, stroke.terms, stroke.reach, stroke.color);
}

@fragment
fn light(stroke: Corner) -> @location(0) vec4f {
    let from_anchor = stroke.position.xy - 0.5 - stroke.place.xy;
    let step = stroke.place.zw;
    let gone = from_anchor.x * step.x + from_anchor.y * step.y;
    let u = stroke.course.x + gone;
    let rest = stroke.course.y - gone;
    let v = stroke.course.z + (from_anchor.y * step.x - from_anchor.x * step.y);
    var light: f32;
    if stroke.course.w == 0.0 {
        light = of_point(stroke.terms, stroke.reach.z, (u - rest) * 0.5, v);
    } else if stroke.course.w == 1.0 {
        light = of_both(stroke.terms.x, stroke.terms.y, u, rest) * across(v);
    } else {
        light = of_nearer(stroke.terms.x, stroke.terms.y, u, rest) * across(v);
    }
    return vec4f(stroke.color.rgb * light, 0.0);
}

fn of_point(terms: vec4f, last: f32, middle: f32, v: f32) -> f32 {
    let square = middle * middle;
    if max(abs(middle), abs(v)) > REACH {
        return 0.0;
    }
    let even = (last * square + terms.z) * square + terms.x;
    let odd = terms.w * square + terms.y;
    return max(bell(square + v * v) * (DENSITY * WHOLE * WHOLE) * (odd * middle + even), 0.0);
}

fn of_both(current: f32, gain: f32, u: f32, rest: f32) -> f32 {
    let passed = written(u) + written(rest) - 1.0;
    return max(gain * (rise(u) - rise(rest)) + (gain * u + current) * passed, 0.0);
}

fn of_nearer(current: f32, gain: f32, u: f32, rest: f32) -> f32 {
    let nearer = min(u, rest);
    let change = select(-rise(nearer), rise(nearer), u < rest);
    return max(gain * change + (gain * u + current) * written(nearer), 0.0);
}

fn across(v: f32) -> f32 {
    return select(0.0, bell(v * v) * WHOLE, abs(v) <= REACH);
}

fn bell(square: f32) -> f32 {
    return exp(-0.5 * square);
}

fn rise(x: f32) -> f32 {
    let inside = clamp(x, -REACH, REACH);
    return max(bell(inside * inside) * DENSITY - EDGE, 0.0) * WHOLE;
}

fn written(beyond: f32) -> f32 {
    let x = clamp(beyond, -REACH, REACH);
    let t = x * x * (2.0 / (REACH * REACH)) - 1.0;
    let square = t * t;
    let fourth = square * square;
    let low = (5.470156e-2 - 4.019157e-2 * t) * square + (1.56906e-1 - 7.719028e-2 * t);
    let middle = (1.1439304e-2 - 6.302321e-3 * t) * square + (2.8284123e-2 - 1.8561372e-2 * t);
    let high = (9.806993e-4 - 3.8208627e-4 * t) * square + (2.716296e-3 - 1.2892946e-3 * t);
    return x * ((high * fourth + middle) * fourth + low) + 0.5;
}
