//! What a person has chosen to see and to do at the window.

/// Where the raster screen is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RasterPlacement {
    /// Nowhere.
    #[default]
    Hidden,
    /// Beside the vector screen.
    Beside,
    /// In a window of its own.
    Apart,
}

impl RasterPlacement {
    /// It in a word.
    pub fn word(self) -> &'static str {
        match self {
            RasterPlacement::Hidden => "off",
            RasterPlacement::Beside => "beside",
            RasterPlacement::Apart => "window",
        }
    }

    /// It in a phrase.
    pub fn summary(self) -> &'static str {
        match self {
            RasterPlacement::Hidden => "off",
            RasterPlacement::Beside => "beside the vector screen",
            RasterPlacement::Apart => "in a window of its own",
        }
    }
}

/// What the mouse is over the vector screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MouseRole {
    /// It turns dials.
    Dials,
    /// It is the puck of the tablet.
    Puck,
}

impl MouseRole {
    /// It in a word.
    pub fn word(self) -> &'static str {
        match self {
            MouseRole::Dials => "dials",
            MouseRole::Puck => "puck",
        }
    }
}

/// What a person has chosen to see and to do.
#[derive(Debug)]
pub struct Choices {
    /// Where the raster screen is.
    pub raster: RasterPlacement,
    /// Whether dials, keys and buttons are there.
    pub devices: bool,
    /// The view beside the screens, by its index in the list.
    pub view: Option<usize>,
    /// What the mouse is; none for what the program that runs needs.
    pub role: Option<MouseRole>,
}
