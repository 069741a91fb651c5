//! A place for the newest of many wishes: older ones that nobody has taken are gone.

use crate::watched::Watched;

/// A place that holds one thing at most, from which one at a time takes.
#[derive(Debug)]
pub struct Slot<T>(Watched<Content<T>>);

#[derive(Debug)]
struct Content<T> {
    waiting: Option<T>,
    closed: bool,
}

impl<T> Default for Content<T> {
    fn default() -> Self {
        Self { waiting: None, closed: false }
    }
}

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self(Watched::default())
    }
}

impl<T> Slot<T> {
    /// Puts something in, in the place of what was there.
    pub fn put(&self, wish: T) {
        self.0.change(|content| content.waiting = Some(wish));
    }

    /// Waits for something and takes it; `None` once the slot is closed.
    pub async fn take(&self) -> Option<T> {
        let taken = |content: &mut Content<T>| match content.closed {
            true => Some(None),
            false => content.waiting.take().map(Some),
        };
        self.0.until(taken).await
    }

    /// Ends the waiting for good.
    pub fn close(&self) {
        self.0.change(|content| content.closed = true);
    }
}
