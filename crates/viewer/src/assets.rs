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
    "text/javascript": "/caption.js" "caption.js" "/choices.js" "choices.js" "/connection.js" "connection.js"
        "/controls.js" "controls.js" "/corners.js" "corners.js" "/faults.js" "faults.js" "/film.js" "film.js"
        "/gallery.js" "gallery.js" "/gestures.js" "gestures.js" "/gif.js" "gif.js" "/line.js" "line.js" "/main.js" "main.js"
        "/notes.js" "notes.js" "/numbers.js" "numbers.js" "/orbit.js" "orbit.js" "/picture.js" "picture.js"
        "/section.js" "section.js" "/state.js" "state.js" "/tour.js" "tour.js" "/words.js" "words.js";
};
