//! `cloakroom verify`: the statements of the paper, and what comes out here.

use crate::arguments::VerifyArguments;
use crate::interruption;
use crate::progress;
use crate::report::{self, Failure};
use crate::scene;
use cloakroom::render::RenderError;
use cloakroom_figures::verification::{self, VerificationError, markdown, verify};
use std::sync::atomic::AtomicBool;

/// Goes through the paper and prints what has been found.
pub fn run(arguments: &VerifyArguments, stop: &AtomicBool) -> Result<(), Failure> {
    scene::use_threads(&arguments.threads)?;
    let busy = interruption::busy();
    let bar = progress::bar(verification::steps(), "verifying");
    let findings = verify(&|| bar.inc(1), stop);
    bar.finish_and_clear();
    drop(busy);
    let findings = findings.map_err(|error| match error {
        VerificationError::Render(RenderError::Stopped) => Failure::Interrupted,
        error => Failure::from_error(error),
    })?;
    if arguments.json {
        return report::print_json(&serde_json::json!({ "findings": findings }));
    }
    report::print(&markdown(&findings))
}
