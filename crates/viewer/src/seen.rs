//! What a page has put on its screen. Finer pictures wait for that: they take all processors, and a
//! browser on the same machine would show the coarse one a second late.

use crate::slot::lock;
use std::future::poll_fn;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Poll, Waker};

/// The newest look of which something has been seen.
#[derive(Debug, Default)]
pub struct Seen(Mutex<State>);

#[derive(Debug, Default)]
struct State {
    look: u64,
    waits: Option<Waker>,
}

impl Seen {
    /// The page has shown a picture of this look.
    pub(crate) fn tell(&self, look: u64) {
        self.change(|state| state.look = look.max(state.look));
    }

    /// Sets a flag that somebody who waits looks at.
    pub(crate) fn stop(&self, flag: &AtomicBool) {
        self.change(|_| flag.store(true, Ordering::Relaxed));
    }

    /// Waits until a look has been seen, and not if `stop` is set; one at a time may wait.
    pub(crate) async fn wait(&self, look: u64, stop: &AtomicBool) {
        poll_fn(|context| {
            let mut state = lock(&self.0);
            if state.look >= look || stop.load(Ordering::Relaxed) {
                return Poll::Ready(());
            }
            state.waits = Some(context.waker().clone());
            Poll::Pending
        })
        .await;
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        let mut state = lock(&self.0);
        change(&mut state);
        let waits = state.waits.take();
        drop(state);
        if let Some(waits) = waits {
            waits.wake();
        }
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
