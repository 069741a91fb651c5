//! A place for the newest of many wishes: older ones that nobody has taken are gone.

use std::future::poll_fn;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::task::{Poll, Waker};

/// A place that holds one thing at most, from which one at a time takes.
#[derive(Debug)]
pub struct Slot<T>(Mutex<Content<T>>);

#[derive(Debug)]
struct Content<T> {
    waiting: Option<T>,
    closed: bool,
    taker: Option<Waker>,
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self(Mutex::new(Content { waiting: None, closed: false, taker: None }))
    }
}

impl<T> Slot<T> {
    /// Puts something in, in the place of what was there.
    pub fn put(&self, wish: T) {
        self.change(|content| content.waiting = Some(wish));
    }

    /// Waits for something and takes it; `None` once the slot is closed.
    pub async fn take(&self) -> Option<T> {
        poll_fn(|context| {
            let mut content = lock(&self.0);
            if content.closed {
                return Poll::Ready(None);
            }
            match content.waiting.take() {
                Some(wish) => Poll::Ready(Some(wish)),
                None => {
                    content.taker = Some(context.waker().clone());
                    Poll::Pending
                }
            }
        })
        .await
    }

    /// Ends the waiting for good.
    pub fn close(&self) {
        self.change(|content| content.closed = true);
    }

    fn change(&self, change: impl FnOnce(&mut Content<T>)) {
        let mut content = lock(&self.0);
        change(&mut content);
        let taker = content.taker.take();
        drop(content);
        if let Some(taker) = taker {
            taker.wake();
        }
    }
}

/// Holds what a mutex guards, whatever has become of who held it before.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
