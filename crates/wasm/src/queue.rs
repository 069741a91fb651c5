//! What has come and is not done yet, in its order.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::task::{Poll, Waker};

/// A queue from which one at a time takes.
#[derive(Debug)]
pub(crate) struct Queue<T>(RefCell<(VecDeque<T>, Option<Waker>)>);

impl<T> Default for Queue<T> {
    fn default() -> Self {
        Self(RefCell::new((VecDeque::new(), None)))
    }
}

impl<T> Queue<T> {
    /// Puts something at the end.
    pub fn put(&self, one: T) {
        let taker = {
            let (waiting, taker) = &mut *self.0.borrow_mut();
            waiting.push_back(one);
            taker.take()
        };
        if let Some(taker) = taker {
            taker.wake();
        }
    }

    /// Waits for the first and takes it.
    pub async fn take(&self) -> T {
        poll_fn(|context| {
            let (waiting, taker) = &mut *self.0.borrow_mut();
            waiting.pop_front().map_or_else(
                || {
                    *taker = Some(context.waker().clone());
                    Poll::Pending
                },
                Poll::Ready,
            )
        })
        .await
    }
}
