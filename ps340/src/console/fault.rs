//! What keeps a window from being there.

use std::io;

/// The reason why there is no window, or no machine.
#[derive(Debug, thiserror::Error)]
pub enum ConsoleError {
    /// The machine cannot run.
    #[error(transparent)]
    Machine(#[from] io::Error),
    /// No display is there.
    #[error("no window: neither DISPLAY nor WAYLAND_DISPLAY is set; without '--window' the machine needs no display")]
    NoDisplay,
    /// The display that is named cannot be reached.
    #[error(
        "no window: the display {display} cannot be reached: nothing serves it, or not this user ({reason}); without '--window' the machine needs no display"
    )]
    NoServer {
        /// As the environment names it.
        display: String,
        /// In the window system's words.
        reason: String,
    },
    /// A library of the window system is missing.
    #[error("no window: the library {library} is missing; on Debian and Ubuntu: apt install {package}")]
    NoLibrary {
        /// Its file.
        library: &'static str,
        /// The package that has it.
        package: &'static str,
    },
    /// Nothing can draw a window here.
    #[error(
        "no window: {0}; it needs Vulkan or OpenGL, on Debian and Ubuntu: apt install mesa-vulkan-drivers libvulkan1"
    )]
    Graphics(String),
}
