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
        lock(&self.content).waiting = Some(wish);
        self.changed.notify_one();
    }

    /// Waits for something and takes it; `None` once the slot is closed.
    pub fn take(&self) -> Option<T> {
        let is_idle = |content: &mut Content<T>| content.waiting.is_none() && !content.closed;
        let content = self.changed.wait_while(lock(&self.content), is_idle);
        let mut content = content.unwrap_or_else(PoisonError::into_inner);
        content.waiting.take().filter(|_| !content.closed)
    }

    /// Ends the waiting for good.
    pub fn close(&self) {
        lock(&self.content).closed = true;
        self.changed.notify_all();
    }
}

/// Holds what a mutex guards, whatever has become of who held it before.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
