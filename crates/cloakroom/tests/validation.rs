//! docs/validation.md is what `cloakroom verify` finds.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::measure::verification::{markdown, steps, verify};
use std::cell::Cell;
use std::path::Path;
use std::sync::atomic::AtomicBool;

#[test]
fn the_page_is_what_is_found() {
    let done = Cell::new(0);
    let findings = verify(&|| done.set(done.get() + 1), &AtomicBool::new(false)).unwrap();
    assert_eq!(done.get(), steps());
    let page = markdown(&findings);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation.md");
    let written = std::fs::read_to_string(path).unwrap();
    for (found, written) in page.lines().zip(written.lines()) {
        assert_eq!(found, written, "make it again: cloakroom verify > docs/validation.md");
    }
    assert_eq!(page, written, "make it again: cloakroom verify > docs/validation.md");
}
