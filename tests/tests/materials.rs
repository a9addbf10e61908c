//! Materials as somebody writes them in a script: names, numbers that patterns give, and the errors for mistakes.

use host::color::shipped;
use host::illumination::material::{Finish, MaterialKind, RefractiveIndex, Transparent};
use host::illumination::texture::NumberTexture;
use host::script::{self, Inputs};
use std::fs;
use std::path::Path;
use std::time::Duration;
use tests::run;

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");

fn bodies(text: &str) -> Vec<MaterialKind> {
    let evaluated = script::evaluate(text, "a.rhai", Path::new(""), &Inputs::default());
    let evaluated = evaluated.unwrap_or_else(|error| panic!("{error}"));
    evaluated.scene.objects.into_iter().filter_map(|object| Some(object.material?.body)).collect()
}

fn problem(text: &str) -> String {
    let evaluated = script::evaluate(text, "a.rhai", Path::new(""), &Inputs::default());
    evaluated.err().map_or_else(|| panic!("{text} is right"), |error| error.to_string())
}

#[test]
fn every_metal_glass_and_liquid_that_ships_can_be_named() {
    let calls = |names: Vec<&str>, function: &str| -> String {
        names.iter().map(|name| format!("sphere(1).{function}(\"{name}\");\n")).collect()
    };
    let metals = bodies(&calls(shipped::metals(), "metal"));
    assert_eq!(metals.len(), 26);
    assert!(metals.iter().all(|body| matches!(body, MaterialKind::Metal(_))));
    let clear = [calls(shipped::glasses(), "glass"), calls(shipped::liquids(), "liquid")].concat();
    let clear = bodies(&clear);
    assert_eq!(clear.len(), 20);
    let priorities: Vec<i32> = clear
        .iter()
        .map(|body| match body {
            MaterialKind::Transparent(Transparent { index: RefractiveIndex::Dispersive(_), priority, .. }) => *priority,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(priorities, [[0; 15].as_slice(), &[-1; 5]].concat());
}

#[test]
fn glass_is_named_as_one_expects() {
    let same = bodies(
        "sphere(1).glass(\"BK7\"); sphere(1).glass(#{ name: \"BK7\" }); sphere(1).glass(#{ index: \"BK7\" });
         sphere(1).water(); sphere(1).liquid(\"water\"); sphere(1).glass(); sphere(1).glass(1.5);",
    );
    assert!(same[0] == same[1] && same[1] == same[2] && same[3] == same[4] && same[5] == same[6]);
}

#[test]
fn numbers_may_be_patterns() {
    let [metal, brushed, glass, classic, principled] = &bodies(
        "let clouds = noise(0.05, 0.4, 0.2);
         sphere(1).metal(\"brass\", clouds);
         sphere(1).metal(#{ name: \"iron\", roughness: 0.1, along: [1, 0, 0], across: clouds });
         sphere(1).glass(#{ roughness: clouds });
         sphere(1).material(#{ specular: 0.5, exponent: between(10, 500, checker(0, 1)) });
         sphere(1).principled(#{ metallic: checker(0, 1), roughness: between(0.5, 0.1, clouds, \"green\") });",
    )[..] else {
        panic!("five objects")
    };
    // Brightness is a mean of three bands, which rounds.
    let is_from_to = |number: &NumberTexture, from: f64, to: f64| {
        let [least, most] = number.range();
        (least - from).abs() < 1e-12 * to && (most - to).abs() < 1e-12 * to
    };
    let MaterialKind::Metal(metal) = metal else { panic!("{metal:?}") };
    assert!(matches!(&metal.finish, Finish::Rough { roughness, .. } if is_from_to(roughness, 0.05, 0.4)));
    let MaterialKind::Metal(brushed) = brushed else { panic!("{brushed:?}") };
    assert!(matches!(&brushed.finish, Finish::Brushed { roughness: [a, b], .. }
        if !a.is_varying() && is_from_to(b, 0.05, 0.4)));
    assert!(matches!(glass, MaterialKind::Transparent(glass) if glass.roughness.is_varying()));
    assert!(matches!(classic, MaterialKind::Classic(classic) if is_from_to(&classic.exponent, 10.0, 500.0)));
    let MaterialKind::Principled(principled) = principled else { panic!("{principled:?}") };
    assert!(is_from_to(&principled.metallic, 0.0, 1.0));
    assert!(is_from_to(&principled.roughness, 0.34, 0.48), "{:?}", principled.roughness.range());
}

#[test]
fn mistakes_are_told_with_their_place_and_what_was_meant() {
    for (text, words) in [
        ("sphere(1).metal(\"brss\");", "no metal is called \"brss\"; did you mean brass?"),
        ("sphere(1).metal(\"steel\");", "did you mean stainless_steel or ferritic_steel?"),
        ("sphere(1).glass(\"bk-7\");", "no glass is called \"bk-7\"; did you mean BK7?"),
        ("sphere(1).liquid(\"wine\");", "no liquid is called \"wine\"; there are water, ethanol,"),
        ("sphere(1).material(\"oak\");", "did you mean oak_leaf?"),
        ("sphere(1).glass(#{ index: 1.5, name: \"BK7\" });", "either an index or the name"),
        ("sphere(1).glass(#{ roughness: checker(0, -1) });", "two must be a number from 0 to 1"),
        ("sphere(1).coated(0.5, between(0, -1, checker(0, 1)));", "roughness must be a number from 0 to 1000"),
        ("sphere(1).principled(#{ metallic: 1.2 });", "metallic must be a number from 0 to 1 or a pattern"),
        ("sphere(1).principled(#{ roughness: \"red\" });", "roughness must be a number from 0 to 1"),
        ("sphere(1).principled(#{ priority: 5000 });", "priority must be a whole number"),
        ("sphere(1).metal(\"gold\", between(0, 1, 0.5));", "between needs a pattern"),
        ("sphere(1).metal(\"gold\", between(0, 1, checker(\"red\", 0)));", "not of spectra"),
    ] {
        let found = problem(&format!("\n{text}"));
        assert!(found.contains(words), "{text}: {found}");
        assert!(found.contains("a.rhai:2:"), "{text}: {found}");
    }
}

#[test]
fn a_map_of_numbers_is_not_decoded_and_a_name_that_is_none_is_answered() {
    let folder = tempfile::tempdir().expect("a folder");
    // A grey of 128 is 0.502 as a number, and 0.216 as a color.
    let map = image::RgbImage::from_pixel(4, 4, image::Rgb([128, 128, 128]));
    map.save(folder.path().join("map.png")).expect("written");
    let text = |numbers: bool| {
        format!(
            "image(8, 8); samples(4); sphere(1).metal(\"gold\", picture(#{{ file: \"map.png\", numbers: {numbers} }}));
             directional_light(#{{ direction: [0, 0, -1], irradiance: 3 }}); camera(#{{ from: [0, 0, 9], at: [0, 0, 0] }});"
        )
    };
    let mut pictures = Vec::new();
    for numbers in [true, false] {
        fs::write(folder.path().join("a.rhai"), text(numbers)).expect("written");
        let ended = run(PERIS, &["render", "a.rhai", "-o", "a.exr"], &[], folder.path(), Duration::from_secs(100));
        assert_eq!(ended.code, Some(0), "{ended:?}");
        pictures.push(fs::read(folder.path().join("a.exr")).expect("a picture"));
    }
    assert_ne!(pictures[0], pictures[1]);
    for (arguments, words) in [
        (&["render", "ringg"][..], "there is no file ringg, and no scene of that name; did you mean ring?"),
        (&["render", "map.png"], "map.png is a picture"),
        (&["functions", "shpere"], "there is no function shpere; did you mean sphere?"),
        (&["db", "show", "shipped", "coper"], "did you mean copper?"),
    ] {
        let ended = run(PERIS, arguments, &[], folder.path(), Duration::from_secs(100));
        assert!(ended.code.is_some_and(|code| code > 0) && ended.errors.contains(words), "{arguments:?}: {ended:?}");
    }
}
