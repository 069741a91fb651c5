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

/// Watches for Ctrl-C and for being asked to end, as by a terminal that is closed; what the parent
/// process has set to be ignored (`nohup`, a shell's job in the background) stays ignored. During
/// work that looks at the flag, the first one stops it cleanly, and another one, for the impatient,
/// ends the process at once; at any other time, as while input is awaited, the first one does.
pub fn watch() -> Result<()> {
    watch_signals().map_err(|error| Failure::Failed(format!("cannot watch for Ctrl-C: {error}")))
}

fn asked_to_end() {
    STOP.store(true, Ordering::SeqCst);
    let is_impatient = FIRST.get_or_init(Instant::now).elapsed() > AT_ONCE;
    if is_impatient || !BUSY.load(Ordering::SeqCst) {
        std::process::exit(Failure::Interrupted.tell().into());
    }
}

#[cfg(unix)]
fn watch_signals() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // A file that grows over the limit of the system is told of as one that cannot be written.
    signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default())?;
    let ignored = ignored();
    let watched = [SIGINT, SIGTERM, SIGHUP].into_iter();
    let watched = watched.filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = signal_hook::iterator::Signals::new(watched)?;
    let watching = move || signals.forever().for_each(|_| asked_to_end());
    std::thread::Builder::new().name("signals".to_owned()).spawn(watching).map(drop)
}

/// The signals that the parent has set to be ignored, one bit each from the first on; none where the
/// system does not say (it is Linux that does).
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(not(unix))]
fn watch_signals() -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(asked_to_end)
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
