//! Panics: a mistake in the program is one message like any other failure, and the same exit
//! status.

use crate::report::{Failure, Result};
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook};
use std::sync::{Mutex, PoisonError};

/// What the last panic said, and where it was.
static SAID: Mutex<Option<String>> = Mutex::new(None);

/// Runs the work of the command. A panic in it, or in a thread whose end it waits for, becomes a
/// failure; one that the work itself deals with, such as that of an image's decoder, is not heard
/// of.
///
/// With `RUST_BACKTRACE` every panic is told as it happens, too.
pub fn caught(work: impl FnOnce() -> Result<()>) -> Result<()> {
    let aloud = std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0");
    let usual = std::panic::take_hook();
    set_hook(Box::new(move |panic| {
        *SAID.lock().unwrap_or_else(PoisonError::into_inner) = Some(words(panic));
        if aloud {
            usual(panic);
        }
    }));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        let said = SAID.lock().unwrap_or_else(PoisonError::into_inner).take();
        let said = said.unwrap_or_default();
        Err(Failure::Failed(format!("a mistake in cloakroom, please report it: {said}")))
    })
}

/// A panic in one line.
fn words(panic: &PanicHookInfo<'_>) -> String {
    let payload = panic.payload();
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let message = text.unwrap_or("a panic without words");
    let message = message.lines().map(str::trim).collect::<Vec<_>>().join(" ");
    match panic.location() {
        Some(place) => format!("{message} ({}, line {})", place.file(), place.line()),
        None => message,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    fn message(result: Result<()>) -> String {
        match result {
            Err(Failure::Failed(message)) => message,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn panics_of_any_thread_are_one_message() {
        let here = caught(|| panic!("two\n  lines"));
        let here = message(here);
        assert!(here.starts_with("a mistake in cloakroom") && !here.contains('\n'), "{here}");
        assert!(here.contains("two lines") && here.contains("panic_report.rs, line "), "{here}");
        let elsewhere = caught(|| {
            (0..8).into_par_iter().for_each(|number| assert!(number != 5, "five of eight"));
            Ok(())
        });
        assert!(message(elsewhere).contains("five of eight"));
        assert!(caught(|| Ok(())).is_ok());
    }
}
