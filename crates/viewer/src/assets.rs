//! The files of the page, carried in the program: nothing is read from the disk.

/// Files of the folder `page` by their media types.
macro_rules! assets {
    ($($kind:literal: $($path:literal $file:literal)+;)+) => {
        &[$($((
            $path,
            concat!($kind, "; charset=utf-8"),
            include_bytes!(concat!("../page/", $file)),
        )),+),+]
    };
}

/// All of them: their paths in the address, media types, and what they hold.
pub(crate) static ASSETS: &[(&str, &str, &[u8])] = assets! {
    "text/html": "/" "index.html";
    "text/css": "/style.css" "style.css";
    "image/svg+xml": "/icon.svg" "icon.svg";
    "text/javascript": "/gestures.js" "gestures.js" "/main.js" "main.js" "/choices.js" "choices.js" "/state.js" "state.js"
        "/orbit.js" "orbit.js" "/connection.js" "connection.js" "/line.js" "line.js" "/picture.js" "picture.js" "/section.js" "section.js"
        "/controls.js" "controls.js" "/numbers.js" "numbers.js";
};
