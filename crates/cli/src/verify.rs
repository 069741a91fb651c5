//! `cloakroom verify`: the statements of the paper, and what comes out here.

use crate::arguments::VerifyArguments;
use crate::interruption::{self, STOP};
use crate::progress::supervised;
use crate::report::{self, Result};
use crate::scene;
use cloakroom_figures::verification::{self, markdown, verify};

/// Goes through the paper and prints what has been found.
pub fn run(arguments: &VerifyArguments) -> Result<()> {
    scene::use_threads(&arguments.threads)?;
    let busy = interruption::busy();
    let findings =
        supervised(verification::steps(), "verifying", |bar, _| verify(&|| bar.inc(1), &STOP))?;
    drop(busy);
    if arguments.json {
        return report::print_json(&serde_json::json!({ "findings": findings }));
    }
    report::print(&markdown(&findings))
}
