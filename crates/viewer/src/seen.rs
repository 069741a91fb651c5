//! What a page has put on its screen. Finer pictures wait for that: they take all processors, and a
//! browser on the same machine would show the coarse one a second late.

use crate::slot::lock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex};
use std::time::Duration;

/// The newest look of which something has been seen.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    look: Mutex<u64>,
    changed: Condvar,
}

impl Seen {
    /// The page has shown a picture of this look.
    pub fn tell(&self, look: u64) {
        let mut seen = lock(&self.look);
        *seen = look.max(*seen);
        self.changed.notify_all();
    }

    /// Sets a flag that somebody who waits looks at.
    pub fn stop(&self, flag: &AtomicBool) {
        let _seen = lock(&self.look);
        flag.store(true, Ordering::Relaxed);
        self.changed.notify_all();
    }

    /// Waits until a look has been seen, but no longer than `patience`, and not if `stop` is set.
    pub fn wait(&self, look: u64, patience: Duration, stop: &AtomicBool) {
        let unseen = |seen: &mut u64| *seen < look && !stop.load(Ordering::Relaxed);
        // Whether it was seen or not, the work goes on.
        let _ = self.changed.wait_timeout_while(lock(&self.look), patience, unseen);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    const LONG: Duration = Duration::from_secs(100);

    #[test]
    fn waiting_ends_when_seen_stopped_or_out_of_patience() {
        let (seen, stop) = (Seen::default(), AtomicBool::new(false));
        let start = Instant::now();
        seen.wait(7, Duration::from_millis(1), &stop);
        std::thread::scope(|scope| {
            scope.spawn(|| seen.wait(7, LONG, &stop));
            seen.tell(8);
        });
        // Older looks count as seen, too.
        seen.tell(3);
        seen.wait(8, LONG, &stop);
        std::thread::scope(|scope| {
            scope.spawn(|| seen.wait(9, LONG, &stop));
            seen.stop(&stop);
        });
        assert!(start.elapsed() < LONG);
    }
}
