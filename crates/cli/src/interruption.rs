//! Ctrl-C: a flag that long work looks at.

use crate::report::{Failure, Result};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Set when work is to stop.
pub static STOP: AtomicBool = AtomicBool::new(false);
static BUSY: AtomicBool = AtomicBool::new(false);
static FIRST: OnceLock<Instant> = OnceLock::new();

/// Another one within this time is the same: programs like `timeout` ask a process, and then the
/// group that it is in.
const AT_ONCE: Duration = Duration::from_millis(500);

/// Watches for Ctrl-C and for being asked to end. During work that looks at the flag, the first one
/// stops it cleanly, and another one, for the impatient, ends the process at once; at any other
/// time, as while input is awaited, the first one does.
pub fn watch() -> Result<()> {
    ctrlc::set_handler(|| {
        STOP.store(true, Ordering::SeqCst);
        let is_impatient = FIRST.get_or_init(Instant::now).elapsed() > AT_ONCE;
        if is_impatient || !BUSY.load(Ordering::SeqCst) {
            std::process::exit(Failure::Interrupted.tell().into());
        }
    })
    .map_err(|error| Failure::Failed(format!("cannot watch for Ctrl-C: {error}")))
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
