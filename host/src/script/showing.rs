//! Functions of the scene language that say how pictures are shown, one row each.

use super::function::{Function, function};
use super::kinds::{NumberKind, ScalarKind, TextKind, Word};
use super::lighting::spectrum_named;
use super::parameter::{required, with_default};
use crate::picture::display::{Tone, neutral};
use rhai::Dynamic;

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    function! {
        exposure(
            stops: required(
                ScalarKind,
                "each doubles the light; 0 shows radiance as it is, \"auto\" is the meter's, \"auto+0.5\" half a stop more",
            ),
        )
        "Sets how much brighter pictures are shown; without it a meter finds what suits the scene. EXR files keep the radiance."
        "exposure(-1.5);"
        |builder| {
            builder.scene.display.exposure = stops.to_string().parse()?;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        tone(
            curve: required(
                Word(&Tone::NAMED),
                "\"filmic\" goes softly into white and black; \"reinhard\" keeps chromaticities; \"linear\" clips beyond 1",
            ),
        )
        "Sets the curve from exposed radiance to the light of the display."
        "tone(\"linear\");"
        |builder| {
            builder.scene.display.tone = curve;
            Ok(Dynamic::UNIT)
        }
    },
    function! {
        white_balance(
            light: required(TextKind, "\"A\", \"D50\" and others, \"blackbody 3000\" or \"daylight 5000\" (kelvin)"),
        )
        "Shows the white of a light as white, as an eye that is adapted to it sees it."
        "white_balance(\"A\");"
        |builder| {
            let white = neutral(&spectrum_named(builder, &light)?);
            builder.scene.display.white = Some(white.ok_or_else(|| format!("the light {light} cannot be seen"))?);
            builder.scene.display.check().map(|()| Dynamic::UNIT)
        }
    },
    function! {
        bloom(amount: with_default(NumberKind(0.0, 100.0), 1.0, "times what a healthy eye spreads"))
        "Spreads light about bright points as the lens and the cornea of an eye do."
        "bloom(0.5);"
        |builder| {
            builder.scene.display.bloom = amount;
            Ok(Dynamic::UNIT)
        }
    },
];
