//! The files of the page, carried in the program: nothing is read from the disk.

/// Files of the folder `page` by their media types.
macro_rules! assets {
    ($($kind:literal: $($file:literal)+;)+) => {
        &[$($((
            concat!("/", $file),
            concat!($kind, "; charset=utf-8"),
            include_bytes!(concat!("../page/", $file)),
        )),+),+]
    };
}

/// All of them: their paths in the address, media types, and what they hold.
pub(crate) static ASSETS: &[(&str, &str, &[u8])] = assets! {
    "text/html": "index.html";
    "text/css": "style.css";
    "image/svg+xml": "icon.svg";
    "text/javascript": "gestures.js" "main.js" "choices.js" "state.js" "orbit.js" "connection.js" "picture.js" "section.js"
        "controls.js" "numbers.js";
};
