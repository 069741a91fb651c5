//! A place for the newest of many wishes: older ones that nobody has taken are gone.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// A place that holds one thing at most.
#[derive(Debug)]
pub(crate) struct Slot<T> {
    content: Mutex<Content<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct Content<T> {
    waiting: Option<T>,
    closed: bool,
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        let content = Mutex::new(Content { waiting: None, closed: false });
        Self { content, changed: Condvar::new() }
    }
}

impl<T> Slot<T> {
    /// Puts something in, in the place of what was there.
    pub fn put(&self, wish: T) {
        self.lock().waiting = Some(wish);
        self.changed.notify_one();
    }

    /// Waits for something and takes it; `None` once the slot is closed.
    pub fn take(&self) -> Option<T> {
        let mut content = self.lock();
        loop {
            if content.closed {
                return None;
            }
            if let Some(wish) = content.waiting.take() {
                return Some(wish);
            }
            content = self.changed.wait(content).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Ends the waiting for good.
    pub fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, Content<T>> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
