//! Something that changes, and that one who waits is woken for.

use std::future::poll_fn;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::task::{Poll, Waker};

/// A value of which one at a time awaits a change.
#[derive(Debug, Default)]
pub struct Watched<T>(Mutex<(T, Option<Waker>)>);

impl<T> Watched<T> {
    /// Changes it, and wakes who waits.
    pub fn change(&self, change: impl FnOnce(&mut T)) {
        let mut held = lock(&self.0);
        change(&mut held.0);
        let waits = held.1.take();
        drop(held);
        if let Some(waits) = waits {
            waits.wake();
        }
    }

    /// Waits until `ready` finds something in it.
    pub async fn until<R>(&self, mut ready: impl FnMut(&mut T) -> Option<R>) -> R {
        poll_fn(|context| {
            let mut held = lock(&self.0);
            match ready(&mut held.0) {
                Some(found) => Poll::Ready(found),
                None => {
                    held.1 = Some(context.waker().clone());
                    Poll::Pending
                }
            }
        })
        .await
    }
}

/// Holds what a mutex guards, whatever has become of who held it before.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
