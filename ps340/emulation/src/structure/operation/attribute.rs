//! Rows of the attributes of what is below.

use glam::DVec2;

/// Half the size of the pick box when SET PICKING LOCATION does not give it: what a client sends. Ours.
pub(super) const DEFAULT_PICK_SIZE: DVec2 = DVec2::splat(0.01);

macro_rules! attribute_rows {
    ({ $next:ident $($rest:ident)* } $($before:tt)*) => { $next! { { $($rest)* } $($before)*

    /// SET COLOR.
    Color {
        /// Degrees; 0 is blue.
        hue: f64,
        /// 0 white, 1 pure.
        saturation: f64,
    } = {
        named "SET COLOR";
        from Operate::SetColor { hue, saturation } =>
            Operation::Color { hue, saturation: saturation.clamp(0.0, 1.0) };
        odd Operate::SetColor { hue, saturation } => both(wrapped("hue", hue), clamped("saturation", saturation));
        at FIRST takes KindSet::VECTOR2.or(KindSet::NUMBER), given => match given.value {
            // A colour as F:COLOR makes it is both.
            Value::Vector2(color) => (*hue, *saturation) = (color.x, color.y.clamp(0.0, 1.0)),
            _ => *hue = given.number()?,
        };
        at SECOND takes KindSet::NUMBER, given => *saturation = given.unit()?;
        below state => {
            state.hue_saturation = [*hue, *saturation];
            state.color = rgb(*hue as f32, *saturation as f32);
        };
        shows rows(&[&[*hue, *saturation]]);
    }

    /// SET COLOR BLENDING: saturation of blended lists.
    ColorBlending(saturation: f64) = {
        named "SET COLOR BLENDING";
        from Operate::SetColorBlending(saturation) => Operation::ColorBlending(saturation.clamp(0.0, 1.0));
        odd Operate::SetColorBlending(saturation) => clamped("saturation", saturation);
        at FIRST takes KindSet::NUMBER, given => *saturation = given.unit()?;
        below state => state.blending = Some(*saturation);
        shows saturation.to_string();
    }

    /// SET INTENSITY.
    Intensity {
        /// OFF leaves the viewport's range in force.
        on: bool,
        /// At the back and at the front.
        range: [f64; 2],
    } = {
        named "SET INTENSITY";
        from Operate::SetIntensity { on, range } => Operation::Intensity { on, range };
        at FIRST takes KindSet::BOOLEAN.or(KindSet::VECTOR2), given => match given.value {
            Value::Vector2(new) => *range = new.to_array(),
            _ => *on = given.boolean()?,
        };
        below state => state.intensity = on.then_some(*range);
        shows format!("{} {}", switch(*on), rows(&[range]));
    }

    /// SET CONTRAST, 0..=1.
    Contrast(contrast: f64) = {
        named "SET CONTRAST";
        from Operate::SetContrast(contrast) => Operation::Contrast(contrast.clamp(0.0, 1.0));
        odd Operate::SetContrast(contrast) => clamped("contrast", contrast);
        at FIRST takes KindSet::NUMBER, given => *contrast = given.unit()?;
        below state => state.contrast = contrast.clamp(0.0, 1.0);
        shows contrast.to_string();
    }

    /// SET CSM. The drive of the tube changes nothing that is seen here.
    Csm(on: bool) = {
        named "SET CSM";
        from Operate::SetCsm(on) => Operation::Csm(on);
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        shows switch(*on).into();
    }

    /// SET DEPTH_CLIPPING.
    DepthClipping(on: bool) = {
        named "SET DEPTH_CLIPPING";
        from Operate::SetDepthClipping(on) => Operation::DepthClipping(on);
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        below state => state.depth_clipping = *on;
        shows switch(*on).into();
    }

    /// SET DISPLAYS.
    Displays {
        /// Bit n for screen n, 0..=3.
        scopes: u8,
        /// ON or OFF.
        on: bool,
    } = {
        named "SET DISPLAY";
        from Operate::SetDisplays { scopes: Scopes::All, on } => Operation::Displays { scopes: ALL_SCOPES, on };
        from Operate::SetDisplays { scopes: Scopes::Some(scopes), on } => Operation::Displays { scopes, on };
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        below state => state.scopes = if *on { state.scopes | scopes & ALL_SCOPES } else { state.scopes & !scopes };
        shows format!("{} {}", screens(*scopes), switch(*on));
    }

    /// SET CHARACTERS.
    Orientation(orientation: CharacterOrientation) = {
        named "SET CHARACTERS";
        from Operate::SetCharacters(orientation) => Operation::Orientation(orientation);
        below state => state.orientation = *orientation;
        shows oriented(*orientation).into();
    }

    /// SET PICKING.
    Picking(on: bool) = {
        named "SET PICKING";
        from Operate::SetPicking(on) => Operation::Picking(on);
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        below state => state.picking = *on;
        shows switch(*on).into();
    }

    /// SET PICKING IDENTIFIER.
    PickIdentifier(id: Name) = {
        named "SET PICKING IDENTIFIER";
        from Operate::SetPickingIdentifier(ref id) => Operation::PickIdentifier(id.clone());
        asks Asked::Identifier(id);
        shows id.to_string();
    }

    /// SET PICKING LOCATION.
    PickLocation {
        /// Centre of the pick box, -1..=1.
        center: DVec2,
        /// Half its size.
        size: DVec2,
    } = {
        named "SET PICKING LOCATION";
        from Operate::SetPickingLocation { center, size } =>
            Operation::PickLocation { center, size: size.unwrap_or(DEFAULT_PICK_SIZE) };
        at FIRST takes POSITION, given => *center = given.position()?.truncate();
        at SECOND takes POSITION, given => *size = given.position()?.truncate().abs();
        below state => state.pick_box = Some([*center, *size]);
        shows rows(&[&center.to_array(), &size.to_array()]);
    }

    /// SET LEVEL_OF_DETAIL.
    LevelOfDetail(level: u16) = {
        named "SET LEVEL_OF_DETAIL";
        from Operate::SetLevelOfDetail(level) => Operation::LevelOfDetail(checked_level(level)?);
        at FIRST takes KindSet::INTEGER, given => *level = given.level()?;
        below state => state.level = i32::from(*level);
        shows level.to_string();
    }

    /// INCREMENT and DECREMENT LEVEL_OF_DETAIL.
    ChangeLevelOfDetail(by: i32) = {
        named if *by > 0 { "INCREMENT LEVEL_OF_DETAIL" } else { "DECREMENT LEVEL_OF_DETAIL" };
        from Operate::IncrementLevelOfDetail => Operation::ChangeLevelOfDetail(1);
        from Operate::DecrementLevelOfDetail => Operation::ChangeLevelOfDetail(-1);
        below state => state.level = state.level.saturating_add(*by).clamp(0, MAX_LEVEL.into());
    }

    /// SET CONDITIONAL_BIT.
    ConditionalBit {
        /// 0..=14.
        bit: u8,
        /// ON or OFF.
        on: bool,
    } = {
        named "SET CONDITIONAL_BIT";
        from Operate::SetConditionalBit { bit, on } => Operation::ConditionalBit { bit: checked_bit(bit)?, on };
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        below state => {
            let mask = 1_u16.checked_shl(u32::from(*bit)).unwrap_or(0);
            state.bits = if *on { state.bits | mask } else { state.bits & !mask };
        };
        shows format!("{bit} {}", switch(*on));
    }

    /// SET RATE; the frame of the display when it was set. `<1>` and `<2>` change the phases and let them go on; `<3>`,
    /// the state at the beginning, and `<4>`, the frames before it, begin anew. Ours.
    Rate {
        /// The phases.
        rate: Rate,
        /// The frame from which they are counted.
        since: u64,
    } = {
        named "SET RATE";
        from Operate::SetRate(rate), in context => Operation::Rate { rate, since: context.since };
        odd Operate::SetRate(rate) => endless(&rate);
        at FIRST takes KindSet::INTEGER, given => rate.on = given.frames()?;
        at SECOND takes KindSet::INTEGER, given => rate.off = given.frames()?;
        at THIRD takes KindSet::BOOLEAN, given => (rate.initial, *since) = (given.boolean()?, given.frame);
        at FOURTH takes KindSet::INTEGER, given => (rate.delay, *since) = (given.frames()?, given.frame);
        asks Asked::Phase { rate, since: *since };
        shows format!("{} {} {} {}", rate.on, rate.off, switch(rate.initial), rate.delay);
    }

    /// SET RATE EXTERNAL: the phase, as functions set it.
    ExternalRate(on: bool) = {
        named "SET RATE EXTERNAL";
        from Operate::SetRateExternal => Operation::ExternalRate(true);
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        below state => state.phase = *on;
        shows switch(*on).into();
    }

    /// SET BLINKING.
    Blinking(on: bool) = {
        named "SET BLINKING";
        from Operate::SetBlinking(on) => Operation::Blinking(on);
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        below state => state.blinking = *on;
        shows switch(*on).into();
    }

    /// SET BLINK RATE, frames of a phase.
    BlinkRate(frames: u32) = {
        named "SET BLINK RATE";
        from Operate::SetBlinkRate(frames) => Operation::BlinkRate(frames);
        odd Operate::SetBlinkRate(0) => Some("a phase of 0 frames counts as 1".into());
        at FIRST takes KindSet::INTEGER, given => *frames = given.frames()?.max(1);
        below state => state.blink_rate = (*frames).max(1);
        shows frames.to_string();
    }

    /// SET PLOTTER.
    Plotter(on: bool) = {
        named "SET PLOTTER";
        from Operate::SetPlotter(on) => Operation::Plotter(on);
        at FIRST takes KindSet::BOOLEAN, given => *on = given.boolean()?;
        below state => state.plotter = *on;
        shows switch(*on).into();
    }

    /// SET PRIORITY, which changes nothing that is seen here.
    Priority(priority: i32) = {
        named "SET PRIORITY";
        from Operate::SetPriority(priority) => Operation::Priority(priority);
        at FIRST takes KindSet::INTEGER, given => *priority = given.integer()?;
        shows priority.to_string();
    }

    /// SET LINE_TEXTURE, which changes nothing that is seen here.
    LineTexture {
        /// Whether it goes on around corners.
        around_corners: bool,
        /// The texture.
        texture: u32,
    } = {
        named "SET LINE_TEXTURE";
        from Operate::SetLineTexture { around_corners, texture } => Operation::LineTexture { around_corners, texture };
        at FIRST takes KindSet::INTEGER, given => *texture = given.count()?;
        shows texture.to_string();
    }
    } };
}

pub(super) use attribute_rows;
