//! The files of the page, carried in the program: nothing is read from the disk.

/// One file of the page.
pub(crate) struct Asset {
    /// Its path in the address.
    pub path: &'static str,
    /// Its media type.
    pub kind: &'static str,
    /// What it holds.
    pub bytes: &'static [u8],
}

/// An asset of the folder `page`.
macro_rules! asset {
    ($path:literal, $file:literal, $kind:literal) => {
        Asset { path: $path, kind: $kind, bytes: include_bytes!(concat!("../page/", $file)) }
    };
}

/// All of them.
pub(crate) static ASSETS: &[Asset] = &[
    asset!("/", "index.html", "text/html; charset=utf-8"),
    asset!("/style.css", "style.css", "text/css; charset=utf-8"),
    asset!("/icon.svg", "icon.svg", "image/svg+xml"),
    asset!("/gestures.js", "gestures.js", "text/javascript; charset=utf-8"),
    asset!("/main.js", "main.js", "text/javascript; charset=utf-8"),
    asset!("/choices.js", "choices.js", "text/javascript; charset=utf-8"),
    asset!("/state.js", "state.js", "text/javascript; charset=utf-8"),
    asset!("/orbit.js", "orbit.js", "text/javascript; charset=utf-8"),
    asset!("/connection.js", "connection.js", "text/javascript; charset=utf-8"),
    asset!("/picture.js", "picture.js", "text/javascript; charset=utf-8"),
    asset!("/section.js", "section.js", "text/javascript; charset=utf-8"),
    asset!("/controls.js", "controls.js", "text/javascript; charset=utf-8"),
    asset!("/numbers.js", "numbers.js", "text/javascript; charset=utf-8"),
];
