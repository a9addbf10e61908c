//! Functions of the scene language that say how pictures are shown, one row each.

use super::function::Function;
use super::lighting::spectrum;
use super::parameter::Default::{Is, Required};
use super::parameter::{Kind, parameter};
use crate::picture::display::{Tone, neutral};
use rhai::Dynamic;

/// The functions.
pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "exposure",
        summary: "Sets how much brighter pictures are shown; without it a meter finds what suits the scene. EXR files keep the radiance.",
        parameters: &[parameter(
            "stops",
            Kind::Scalar,
            Required,
            "each doubles the light; 0 shows radiance as it is, \"auto\" is the meter's, \"auto+0.5\" half a stop more",
        )],
        example: "exposure(-1.5);",
        action: |builder, bound| {
            let text = bound.scalar("stops").unwrap_or_default().to_string();
            builder.scene.display.exposure = text.parse()?;
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "tone",
        summary: "Sets the curve from exposed radiance to the light of the display.",
        parameters: &[parameter(
            "curve",
            Kind::Word(&Tone::WORDS),
            Required,
            "\"filmic\" goes softly into white and black; \"reinhard\" keeps chromaticities; \"linear\" clips beyond 1",
        )],
        example: "tone(\"linear\");",
        action: |builder, bound| {
            builder.scene.display.tone = bound.text("curve").and_then(Tone::of_word).unwrap_or_default();
            Ok(Dynamic::UNIT)
        },
    },
    Function {
        name: "white_balance",
        summary: "Shows the white of a light as white, as an eye that is adapted to it sees it.",
        parameters: &[parameter(
            "light",
            Kind::Text,
            Required,
            "\"A\", \"D50\" and others, \"blackbody 3000\" or \"daylight 5000\" (kelvin)",
        )],
        example: "white_balance(\"A\");",
        action: |builder, bound| {
            let name = bound.text("light").unwrap_or_default();
            let white = neutral(&spectrum(builder, name)?);
            builder.scene.display.white = Some(white.ok_or_else(|| format!("the light {name} cannot be seen"))?);
            builder.scene.display.check().map(|()| Dynamic::UNIT)
        },
    },
    Function {
        name: "bloom",
        summary: "Spreads light about bright points as the lens and the cornea of an eye do.",
        parameters: &[parameter("amount", Kind::Number(0.0, 100.0), Is("1"), "times what a healthy eye spreads")],
        example: "bloom(0.5);",
        action: |builder, bound| {
            builder.scene.display.bloom = bound.number("amount").unwrap_or(1.0);
            Ok(Dynamic::UNIT)
        },
    },
];
