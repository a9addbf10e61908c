//! What a person has chosen to see and to do at the window.

/// Where the raster screen is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RasterPlace {
    /// Nowhere.
    #[default]
    Hidden,
    /// Beside the vector screen.
    Beside,
    /// In a window of its own.
    Apart,
}

impl RasterPlace {
    /// It in a word.
    pub fn word(self) -> &'static str {
        match self {
            RasterPlace::Hidden => "off",
            RasterPlace::Beside => "beside",
            RasterPlace::Apart => "window",
        }
    }

    /// It in a phrase.
    pub fn summary(self) -> &'static str {
        match self {
            RasterPlace::Hidden => "off",
            RasterPlace::Beside => "beside the vector screen",
            RasterPlace::Apart => "in a window of its own",
        }
    }
}

/// What the mouse is over the vector screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It turns dials.
    Dials,
    /// It is the puck of the tablet.
    Puck,
}

impl Role {
    /// It in a word.
    pub fn word(self) -> &'static str {
        match self {
            Role::Dials => "dials",
            Role::Puck => "puck",
        }
    }
}

/// What a person has chosen to see and to do.
#[derive(Debug)]
pub struct Choices {
    /// Where the raster screen is.
    pub raster: RasterPlace,
    /// Whether dials, keys and buttons are there.
    pub devices: bool,
    /// The view beside the screens, by its place in the list.
    pub view: Option<usize>,
    /// What the mouse is; none for what the program that runs needs.
    pub role: Option<Role>,
}
