//! What a window needs of the system, looked for before it is opened, so that what is missing has a name.

use super::ConsoleError;

/// Libraries that the window system loads by name, with the packages of Debian that hold them.
///
/// # Source
/// A window was opened in a bare system to which one package after the other was added.
#[cfg(target_os = "linux")]
const X11: &[(&str, &str)] = &[
    ("libX11.so.6", "libx11-6"),
    ("libX11-xcb.so.1", "libx11-xcb1"),
    ("libXcursor.so.1", "libxcursor1"),
    ("libXi.so.6", "libxi6"),
    ("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
];

/// Whether a window can be opened, as far as can be seen.
///
/// # Errors
/// What is missing.
#[cfg(target_os = "linux")]
pub fn check() -> Result<(), ConsoleError> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if is_set("WAYLAND_DISPLAY") {
        return Ok(());
    }
    if !is_set("DISPLAY") {
        return Err(ConsoleError::NoDisplay);
    }
    for (library, package) in X11 {
        // SAFETY: loading these libraries runs only their own start, which has no conditions.
        if unsafe { libloading::Library::new(library) }.is_err() {
            return Err(ConsoleError::NoLibrary { library, package });
        }
    }
    Ok(())
}

/// Whether a window can be opened: elsewhere the system has what it needs.
#[cfg(not(target_os = "linux"))]
pub fn check() -> Result<(), ConsoleError> {
    Ok(())
}

/// The display on which a window is opened, as the environment names it.
pub fn display() -> String {
    let named =
        ["WAYLAND_DISPLAY", "DISPLAY"].into_iter().find_map(|name| std::env::var(name).ok().filter(|n| !n.is_empty()));
    named.unwrap_or_default()
}
