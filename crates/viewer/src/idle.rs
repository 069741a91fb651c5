//! Connections that nobody uses end: each takes a place among the files that a process may open.

use axum::serve::Listener;
use std::future::Future;
use std::io::{self, ErrorKind};
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Instant, Sleep, sleep};

/// How long the other side may say nothing.
const PATIENCE: Duration = Duration::from_secs(60);

/// How often a page is asked whether it is there, which its browser answers.
pub(crate) const ASK: Duration = Duration::from_secs(20);

/// A listener whose connections end where the other side says nothing for too long.
pub(crate) struct Attentive<L>(pub L);

impl<L: Listener> Listener for Attentive<L> {
    type Io = Timed<L::Io>;
    type Addr = L::Addr;

    async fn accept(&mut self) -> (Self::Io, Self::Addr) {
        let (stream, address) = self.0.accept().await;
        (Timed::new(stream), address)
    }

    fn local_addr(&self) -> io::Result<Self::Addr> {
        self.0.local_addr()
    }
}

/// A connection, and when its patience ends.
pub(crate) struct Timed<S> {
    stream: S,
    end: Pin<Box<Sleep>>,
}

impl<S> Timed<S> {
    fn new(stream: S) -> Self {
        Self { stream, end: Box::pin(sleep(PATIENCE)) }
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Timed<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
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
        let mut ours = Timed::new(ours);
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
}
