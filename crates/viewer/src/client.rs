//! One open page: what it says is read here, and handed to its two threads.

use crate::end::Gone;
use crate::idle::ASK;
use crate::painter::Wish;
use crate::protocol::{Ray, error};
use crate::seen::Seen;
use crate::server::Server;
use crate::session::{Heard, Session, nothing_shown, read_photograph};
use crate::slot::Slot;
use crate::studio::{self, Shown};
use crate::watched::lock;
use axum::body::Bytes;
use axum::extract::ws;
use cloakroom::photograph::ImageSource;
use cloakroom::render::Images;
use futures_util::{SinkExt, StreamExt};
use serde_json::Value;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use tokio::runtime::Handle;
use tokio::sync::mpsc;

/// Messages on the way to a page; who has more to say waits.
const QUEUE: usize = 4;

/// Most pixels of the photographs of all pages together.
const MOST_PIXELS_OF_ALL: u64 = 160_000_000;

/// Where messages to a page go.
#[derive(Clone, Debug)]
pub(crate) struct Outbox(mpsc::Sender<ws::Message>);

impl Outbox {
    /// Says something.
    pub async fn say(&self, message: &Value) -> Result<(), Gone> {
        self.0.send(ws::Message::text(message.to_string())).await.map_err(|_| Gone)
    }

    /// Says something unless the page is busy.
    pub fn say_if_room(&self, message: &Value) {
        // What is lost is said again with newer numbers.
        let _ = self.0.try_send(ws::Message::text(message.to_string()));
    }

    /// Sends bytes.
    pub async fn send_bytes(&self, bytes: Vec<u8>) -> Result<(), Gone> {
        self.0.send(ws::Message::binary(bytes)).await.map_err(|_| Gone)
    }
}

/// A photograph that a page has brought.
#[derive(Clone, Debug)]
pub(crate) struct Uploaded {
    /// Its name as a file of the scene's folder, where nobody looks for it.
    pub source: ImageSource,
    /// It, hung up under that name.
    pub images: Images,
    /// Which of the page's uploads it is.
    pub number: u64,
    /// What it takes.
    pub space: Arc<Space>,
}

/// Some of the pixels that all pages may have; given back when dropped, which is when nothing shows
/// the photograph any more.
#[derive(Debug)]
pub(crate) struct Space {
    server: Arc<Server>,
    pixels: u64,
}

impl Space {
    fn take(server: &Arc<Server>, pixels: u64) -> Option<Self> {
        let fits = |taken: u64| Some(taken + pixels).filter(|sum| *sum <= MOST_PIXELS_OF_ALL);
        let order = Ordering::Relaxed;
        server.uploaded_pixels.fetch_update(order, order, fits).ok()?;
        Some(Self { server: server.clone(), pixels })
    }
}

impl Drop for Space {
    fn drop(&mut self) {
        self.server.uploaded_pixels.fetch_sub(self.pixels, Ordering::Relaxed);
    }
}

/// The state of a page.
#[derive(Debug)]
pub(crate) struct Client {
    pub server: Arc<Server>,
    pub looks: Slot<Wish>,
    pub seen: Seen,
    pub rays: Slot<(Ray, Arc<Shown>)>,
    /// What rays go through.
    pub shown: Mutex<Option<Arc<Shown>>>,
    uploaded: Mutex<Option<Uploaded>>,
    uploads: AtomicU64,
}

impl Client {
    /// The photograph that the page has brought last.
    pub fn uploaded(&self) -> Option<Uploaded> {
        lock(&self.uploaded).clone()
    }

    /// Reads a photograph, one at a time of all pages: memory for more is not taken.
    fn hang(&self, name: &str, bytes: &[u8]) -> Result<Value, String> {
        let source = self.server.opened.source_of(name);
        let _one = lock(&self.server.reading);
        let (image, said) = read_photograph(&source, name, bytes)?;
        // The old one makes room, as soon as no picture of it is under way.
        *lock(&self.uploaded) = None;
        *lock(&self.shown) = None;
        let pixels = (image.width * image.height) as u64;
        let space = Space::take(&self.server, pixels).ok_or(
            "other pages have brought so many photographs that there is no room; close some",
        )?;
        let mut images = lock(&self.server.images).clone();
        images.hang(source.clone(), image);
        let number = self.uploads.fetch_add(1, Ordering::Relaxed);
        *lock(&self.uploaded) = Some(Uploaded { source, images, number, space: Arc::new(space) });
        Ok(said)
    }
}

/// Serves a page until it closes, or the server ends.
pub(crate) async fn serve(socket: ws::WebSocket, server: Arc<Server>) {
    let (mut sink, mut stream) = socket.split();
    let (sender, mut receiver) = mpsc::channel(QUEUE);
    let outbox = Outbox(sender);
    let mut closing = server.closing.subscribe();
    let writer = tokio::spawn(async move {
        while let Some(message) = receiver.recv().await {
            if sink.send(message).await.is_err() {
                break;
            }
        }
        // It may be closed already.
        let _ = sink.close().await;
    });
    let client = Arc::new(Client {
        server,
        looks: Slot::default(),
        seen: Seen::default(),
        rays: Slot::default(),
        shown: Mutex::default(),
        uploaded: Mutex::default(),
        uploads: AtomicU64::new(0),
    });
    if start_threads(&client, &outbox).is_ok() {
        let mut page = Page { client: &client, outbox: &outbox, session: Session::default() };
        let greeting = client.server.greeting.clone();
        let greeted = outbox.0.send(ws::Message::text(greeting)).await;
        let mut ask = tokio::time::interval(ASK);
        while greeted.is_ok() {
            let message = tokio::select! {
                message = stream.next() => message,
                _ = ask.tick() => {
                    // A page that has more to hear than it takes is there.
                    let _ = outbox.0.try_send(ws::Message::Ping(Bytes::new()));
                    continue;
                }
                _ = closing.changed() => None,
            };
            let Some(Ok(message)) = message else { break };
            if page.hear(message).await.is_err() {
                break;
            }
        }
        page.session.end(&client.seen);
    }
    client.looks.close();
    client.rays.close();
    drop(outbox);
    drop(stream);
    // Its threads end first, and with them the last of its outboxes.
    let _ = tokio::time::timeout(std::time::Duration::from_secs(5), writer).await;
}

fn start_threads(client: &Arc<Client>, outbox: &Outbox) -> std::io::Result<()> {
    let thread = |name: &str| std::thread::Builder::new().name(name.to_owned());
    // These threads wait as others of the server do, but none waits for them.
    let (of_painter, to_page, runtime) = (client.clone(), outbox.clone(), Handle::current());
    thread("painter").spawn(move || runtime.block_on(studio::paint(&of_painter, &to_page)))?;
    let (of_rays, to_page, runtime) = (client.clone(), outbox.clone(), Handle::current());
    thread("rays").spawn(move || runtime.block_on(studio::follow(&of_rays.rays, &to_page)))?;
    Ok(())
}

/// What hears a page.
struct Page<'a> {
    client: &'a Arc<Client>,
    outbox: &'a Outbox,
    session: Session,
}

impl Page<'_> {
    async fn hear(&mut self, message: ws::Message) -> Result<(), Gone> {
        let heard = match message {
            ws::Message::Text(text) => self.heed(&text),
            ws::Message::Binary(bytes) => self.take_photograph(bytes).await.map(Some),
            ws::Message::Close(_) => return Err(Gone),
            ws::Message::Ping(_) | ws::Message::Pong(_) => Ok(None),
        };
        match heard.unwrap_or_else(|problem| Some(error(None, &problem))) {
            Some(answer) => self.outbox.say(&answer).await,
            None => Ok(()),
        }
    }

    /// Does what a message says, and gives the answer to it, if there is one at once.
    fn heed(&mut self, text: &str) -> Result<Option<Value>, String> {
        let Client { looks, seen, rays, shown, server, .. } = &**self.client;
        let uploaded = self.client.uploaded().map(|uploaded| uploaded.source);
        Ok(match self.session.hear(text, (looks, seen), &server.opened, uploaded.as_ref())? {
            Heard::All => None,
            Heard::Answer(answer) => Some(answer),
            Heard::Follow(ray) => match lock(shown).clone() {
                None => Some(nothing_shown(&ray)),
                Some(shown) => {
                    rays.put((ray, shown));
                    None
                }
            },
        })
    }

    async fn take_photograph(&mut self, bytes: Bytes) -> Result<Value, String> {
        let name = self.session.name_of_photograph(bytes.len())?;
        let client = self.client.clone();
        let read = tokio::task::spawn_blocking(move || client.hang(&name, &bytes)).await;
        read.unwrap_or_else(|_| Err("this image is damaged".to_owned()))
    }
}
