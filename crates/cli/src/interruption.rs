//! Ctrl-C: a flag that long work looks at.

use crate::report::Failure;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);
static BUSY: AtomicBool = AtomicBool::new(false);

/// Watches for Ctrl-C and for being asked to end. During work that looks at the flag, the first one
/// stops it cleanly, and another one, for the impatient, ends the process at once; at any other time,
/// as while input is awaited, the first one does.
pub fn watch() -> Result<&'static AtomicBool, Failure> {
    ctrlc::set_handler(|| {
        let asked_before = STOP.swap(true, Ordering::SeqCst);
        if asked_before || !BUSY.load(Ordering::SeqCst) {
            std::process::exit(130);
        }
    })
    .map_err(|error| Failure::Failed(format!("cannot watch for Ctrl-C: {error}")))?;
    Ok(&STOP)
}

/// Work that looks at the flag, or leaves unfinished files if ended at once; over when dropped.
#[derive(Debug)]
pub struct Busy(());

/// Begins such work.
pub fn busy() -> Busy {
    BUSY.store(true, Ordering::SeqCst);
    Busy(())
}

impl Drop for Busy {
    fn drop(&mut self) {
        BUSY.store(false, Ordering::SeqCst);
    }
}
