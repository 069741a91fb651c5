//! What the page computes in the browser, on any processor: `cloakroom-portable SCENE [KEY=VALUE]...` writes the picture as PNG.
//!
//! Four rays are not traced side by side, and sines, exponentials and the like are those of the crate `libm`, which compiled for browsers
//! has, too. So the bytes are the same: that is what it is for.

mod elementary;

use std::io::Write;

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().ok_or("cloakroom-portable SCENE [KEY=VALUE]... > PICTURE.png")?;
    let text = std::fs::read_to_string(&scene).map_err(|error| format!("{scene}: {error}"))?;
    let picture = cloakroom_wasm::picture(&text, arguments.collect())?;
    std::io::stdout().write_all(&picture).map_err(|error| error.to_string())
}
