//! The files of the page, carried in the program: nothing is read from the disk.

/// An asset of the folder `page`.
macro_rules! asset {
    ($path:literal, $file:literal, $kind:literal) => {
        ($path, $kind, include_bytes!(concat!("../page/", $file)))
    };
}

/// All of them: their paths in the address, media types, and what they hold.
pub(crate) static ASSETS: &[(&str, &str, &[u8])] = &[
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
