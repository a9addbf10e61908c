//! Functions of the scene language for the wind, one row each.

use super::builder::Builder;
use super::function::{Function, function};
use super::kinds::{Integer, NumberKind, Vector};
use super::parameter::{optional, required, with_default};
use crate::procedural::Wind;
use crate::scene::Sway;
use glam::DVec3;
use rhai::Dynamic;

/// A length of the wind's.
const SIZE: NumberKind = NumberKind(1e-9, 1e12);
/// A part of the mean speed.
const PART: NumberKind = NumberKind(0.0, 100.0);

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        wind(
            speed: required(NumberKind(0.0, 1e9), "in the mean, units a second"),
            from: with_default(
                NumberKind(-360.0, 360.0),
                270.0,
                "where it comes from, degrees clockwise from north, which is -z: 270 blows towards +x",
            ),
            gusts: with_default(PART, 0.3, "how much the speed varies along the ground, in parts of the mean"),
            gust_size: with_default(SIZE, 20.0, "size of gusts"),
            turbulence: with_default(PART, 0.15, "how much the velocity varies in all directions, in parts of the mean"),
            eddy_size: with_default(SIZE, 3.0, "size of the largest eddies of that"),
            octaves: with_default(Integer(1, 8), 2, "how many sizes of eddies there are, each half of the one before"),
            period: optional(SIZE, "none", "after so many seconds it begins anew, without a jump: for a loop"),
            seed: with_default(Integer(0, i64::MAX as u64), 1, "of gusts and eddies"),
        )
        "Sets the wind, a function of place and time, for what is scattered behind it with sway, and for wind_at()."
        "wind(6, #{ from: 240, gusts: 0.4, period: 8 });"
        |builder| {
            let towards = DVec3::new(-from.to_radians().sin(), 0.0, from.to_radians().cos());
            let (octaves, mean) = (octaves as u32, towards * speed);
            let wind = Wind { mean, gusts, gust_size, turbulence, eddy_size, octaves, period, seed };
            wind.check().map_err(|error| error.to_string())?;
            builder.wind = Some(wind);
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        wind_at(place: required(Vector, "where"))
        "Gives the velocity of the wind at a place and at the time of the picture, [x, y, z] in units a second."
        "wind(6); let v = wind_at(0, 10, 0); cone(0.4, 3).rotate(\"z\", -90 - 5 * v[1]);"
        |builder| {
            let velocity = blowing(builder)?.at(place, builder.ask_time());
            Ok(Dynamic::from_array(velocity.to_array().map(Dynamic::from).to_vec()))
        }
    },
];

/// How the wind at this time bends what leans so far at a speed of 10.
///
/// - `lean`: degrees.
pub(super) fn sway(builder: &mut Builder, lean: f64) -> Result<Sway, String> {
    Ok(Sway { wind: blowing(builder)?, time: builder.ask_time(), lean })
}

/// The wind that was set.
fn blowing(builder: &Builder) -> Result<Wind, String> {
    if builder.makes_model() {
        return Err("within a model there is no wind; let what is scattered sway, or moves".into());
    }
    builder.wind.clone().ok_or_else(|| "there is no wind; call wind() before".into())
}
