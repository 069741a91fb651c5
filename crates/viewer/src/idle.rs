//! Connections that nobody uses end: each takes a place among the files that a process may open.

use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use std::collections::VecDeque;
use std::future::Future;
use std::io::{self, ErrorKind};
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::sync::oneshot;
use tokio::time::{Instant, Sleep, sleep};

/// How long the other side may say nothing.
const PATIENCE: Duration = Duration::from_secs(60);

/// How long the other side may take to show that it knows the secret, however much it says.
const INTRODUCTION: Duration = Duration::from_secs(20);

/// Most connections at once that have not shown it. A newcomer takes the place of the oldest:
/// whoever knows the secret shows it at once.
const MOST_STRANGERS: usize = 64;

/// How often a page is asked whether it is there, which its browser answers.
pub(crate) const ASK: Duration = Duration::from_secs(20);

/// A listener whose connections end where the other side says nothing for too long, or does not
/// know the secret.
pub(crate) struct Attentive<L> {
    listener: L,
    /// The connections that had not shown it when they were last looked at, oldest first.
    strangers: VecDeque<(Standing, oneshot::Sender<()>)>,
}

impl<L> Attentive<L> {
    pub fn new(listener: L) -> Self {
        Self { listener, strangers: VecDeque::new() }
    }
}

impl<L: Listener> Listener for Attentive<L> {
    type Io = Timed<L::Io>;
    type Addr = L::Addr;

    async fn accept(&mut self) -> (Self::Io, Self::Addr) {
        let (stream, address) = self.listener.accept().await;
        self.strangers.retain(|(standing, place)| !standing.is_known() && !place.is_closed());
        if self.strangers.len() >= MOST_STRANGERS {
            self.strangers.pop_front();
        }
        let (place, taken) = oneshot::channel();
        let timed = Timed::new(stream, taken);
        self.strangers.push_back((timed.standing.clone(), place));
        (timed, address)
    }

    fn local_addr(&self) -> io::Result<Self::Addr> {
        self.listener.local_addr()
    }
}

/// Whether the other side of a connection has shown that it knows the secret.
#[derive(Clone, Debug, Default)]
pub(crate) struct Standing(Arc<AtomicBool>);

impl Standing {
    /// It has.
    pub fn introduce(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn is_known(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl<L: Listener> Connected<IncomingStream<'_, Attentive<L>>> for Standing {
    fn connect_info(stream: IncomingStream<'_, Attentive<L>>) -> Self {
        stream.io().standing.clone()
    }
}

/// A connection, and when its patience ends.
pub(crate) struct Timed<S> {
    stream: S,
    end: Pin<Box<Sleep>>,
    standing: Standing,
    /// When a stranger's patience ends, and what tells that its place is taken.
    introduction: Pin<Box<Sleep>>,
    taken: Option<oneshot::Receiver<()>>,
}

impl<S> Timed<S> {
    fn new(stream: S, taken: oneshot::Receiver<()>) -> Self {
        let after = |time| Box::pin(sleep(time));
        let (standing, taken) = (Standing::default(), Some(taken));
        Self { stream, end: after(PATIENCE), standing, introduction: after(INTRODUCTION), taken }
    }

    /// Whether this is a stranger who has taken too long, or whose place is taken.
    fn is_over(&mut self, context: &mut Context<'_>) -> bool {
        if self.standing.is_known() {
            return false;
        }
        if let Some(taken) = &mut self.taken
            && Pin::new(taken).poll(context).is_ready()
        {
            self.taken = None;
        }
        self.taken.is_none() || self.introduction.as_mut().poll(context).is_ready()
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Timed<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        if self.is_over(context) {
            return Poll::Ready(Err(ErrorKind::TimedOut.into()));
        }
        let read = Pin::new(&mut self.stream).poll_read(context, buffer);
        if read.is_ready() {
            self.end.as_mut().reset(Instant::now() + PATIENCE);
            return read;
        }
        self.end.as_mut().poll(context).map(|()| Err(ErrorKind::TimedOut.into()))
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Timed<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        // A stranger who does not listen goes, too.
        if self.is_over(context) {
            return Poll::Ready(Err(ErrorKind::TimedOut.into()));
        }
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::io::{AsyncReadExt, AsyncWriteExt, duplex};

    #[tokio::test(start_paused = true)]
    async fn silence_ends_a_connection_and_words_keep_it() {
        let (ours, mut theirs) = duplex(16);
        let (_place, taken) = oneshot::channel();
        let mut ours = Timed::new(ours, taken);
        ours.standing.introduce();
        let mut byte = [0];
        for _ in 0..5 {
            sleep(PATIENCE - Duration::from_secs(1)).await;
            theirs.write_all(b"a").await.expect("said");
            ours.read_exact(&mut byte).await.expect("heard");
        }
        let start = Instant::now();
        let error = ours.read_exact(&mut byte).await.expect_err("silence");
        assert_eq!(error.kind(), ErrorKind::TimedOut);
        let waited = start.elapsed();
        assert!(waited >= PATIENCE - Duration::from_secs(2) && waited < 2 * PATIENCE, "{waited:?}");
        assert!(ASK < PATIENCE);
    }

    #[tokio::test(start_paused = true)]
    async fn words_do_not_keep_a_stranger() {
        let (ours, mut theirs) = duplex(16);
        let (_place, taken) = oneshot::channel();
        let mut ours = Timed::new(ours, taken);
        let start = Instant::now();
        let mut byte = [0];
        let error = loop {
            sleep(Duration::from_secs(5)).await;
            theirs.write_all(b"a").await.expect("said");
            if let Err(error) = ours.read_exact(&mut byte).await {
                break error;
            }
        };
        assert_eq!(error.kind(), ErrorKind::TimedOut);
        assert!(start.elapsed() <= INTRODUCTION + Duration::from_secs(5), "{:?}", start.elapsed());
    }

    #[tokio::test(start_paused = true)]
    async fn a_stranger_whose_place_is_taken_goes_and_others_stay() {
        for known in [false, true] {
            let (ours, mut theirs) = duplex(16);
            let (place, taken) = oneshot::channel();
            let mut ours = Timed::new(ours, taken);
            if known {
                ours.standing.introduce();
            }
            drop(place);
            theirs.write_all(b"a").await.expect("said");
            assert_eq!(ours.read_exact(&mut [0]).await.is_ok(), known);
        }
    }
}
