//! What a page has put on its screen. Finer pictures wait for that: they take all processors, and a
//! browser on the same machine would show the coarse one a second late.

use crate::watched::Watched;
use std::sync::atomic::{AtomicBool, Ordering};

/// The newest look of which something has been seen.
#[derive(Debug, Default)]
pub struct Seen(Watched<u64>);

impl Seen {
    /// The page has shown a picture of this look.
    pub(crate) fn tell(&self, look: u64) {
        self.0.change(|seen| *seen = look.max(*seen));
    }

    /// Sets a flag that somebody who waits looks at.
    pub(crate) fn stop(&self, flag: &AtomicBool) {
        self.0.change(|_| flag.store(true, Ordering::Relaxed));
    }

    /// Waits until a look has been seen, and not if `stop` is set; one at a time may wait.
    pub(crate) async fn wait(&self, look: u64, stop: &AtomicBool) {
        let is_over = |seen: &mut u64| *seen >= look || stop.load(Ordering::Relaxed);
        self.0.until(|seen| is_over(seen).then_some(())).await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use futures_util::FutureExt;

    #[test]
    fn waiting_ends_when_seen_or_stopped() {
        let (seen, stop) = (Seen::default(), AtomicBool::new(false));
        let is_over = |look| seen.wait(look, &stop).now_or_never().is_some();
        assert!(!is_over(7));
        seen.tell(8);
        // Older looks count as seen, too.
        seen.tell(3);
        assert!(is_over(7) && is_over(8) && !is_over(9));
        seen.stop(&stop);
        assert!(is_over(9));
    }

    #[test]
    fn who_waits_is_woken() {
        let (seen, stop) = (Seen::default(), AtomicBool::new(false));
        let runtime = tokio::runtime::Builder::new_current_thread().build().expect("a runtime");
        std::thread::scope(|scope| {
            scope.spawn(|| seen.tell(1));
            runtime.block_on(seen.wait(1, &stop));
        });
        std::thread::scope(|scope| {
            scope.spawn(|| seen.stop(&stop));
            runtime.block_on(seen.wait(2, &stop));
        });
    }
}
