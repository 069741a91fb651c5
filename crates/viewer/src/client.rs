//! One open page: what it says is read here, and handed to its two threads.

use crate::idle::ASK;
use crate::painter::{self, Shown, Wish};
use crate::protocol::{LARGEST_PHOTOGRAPH, Message, error};
use crate::ray_tree;
use crate::scenes::is_plain_name;
use crate::seen::Seen;
use crate::server::Server;
use crate::slot::{Slot, lock};
use axum::body::Bytes;
use axum::extract::ws;
use cloakroom::photograph::{ImageSource, LoadProblem, load_bytes};
use cloakroom::render::Images;
use futures_util::{SinkExt, StreamExt};
use serde_json::{Value, json};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use tokio::sync::mpsc;

/// Messages on the way to a page; who has more to say waits.
const QUEUE: usize = 4;

/// Most pixels of a photograph.
const MOST_PIXELS: u64 = 40_000_000;

/// Most pixels of the photographs of all pages together.
const MOST_PIXELS_OF_ALL: u64 = 160_000_000;

/// The page has gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the page has gone")]
pub(crate) struct Gone;

/// Where messages to a page go.
#[derive(Clone, Debug)]
pub(crate) struct Outbox(mpsc::Sender<ws::Message>);

impl Outbox {
    /// Says something, from a thread that may wait.
    pub fn say(&self, message: &Value) -> Result<(), Gone> {
        self.0.blocking_send(ws::Message::text(message.to_string())).map_err(|_| Gone)
    }

    /// Says something unless the page is busy.
    pub fn say_if_room(&self, message: &Value) {
        // What is lost is said again with newer numbers.
        let _ = self.0.try_send(ws::Message::text(message.to_string()));
    }

    /// Sends bytes, from a thread that may wait.
    pub fn send_bytes(&self, bytes: Vec<u8>) -> Result<(), Gone> {
        self.0.blocking_send(ws::Message::binary(bytes)).map_err(|_| Gone)
    }

    async fn answer(&self, message: &Value) -> Result<(), Gone> {
        self.0.send(ws::Message::text(message.to_string())).await.map_err(|_| Gone)
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
    rays: Slot<ray_tree::Wish>,
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
        let millions = MOST_PIXELS / 1_000_000;
        let words = |problem: LoadProblem| match &problem {
            LoadProblem::TooLarge => {
                format!("the photograph is too large: at most {millions} million pixels")
            }
            LoadProblem::Empty => format!("this {}", LoadProblem::NotAnImage),
            LoadProblem::NotAnImage | LoadProblem::OtherFormat(_) => format!("this {problem}"),
            LoadProblem::Unsupported(_) => format!("this image {problem}"),
            _ => "this image is damaged or cut short".to_owned(),
        };
        let image =
            load_bytes(&source, bytes, MOST_PIXELS).map_err(|error| words(error.problem))?;
        let (width, height) = (image.width, image.height);
        // The old one makes room, as soon as no picture of it is under way.
        *lock(&self.uploaded) = None;
        *lock(&self.shown) = None;
        let space = Space::take(&self.server, (width * height) as u64).ok_or(
            "other pages have brought so many photographs that there is no room; close some",
        )?;
        let mut images = lock(&self.server.images).clone();
        images.hang(source.clone(), image);
        let number = self.uploads.fetch_add(1, Ordering::Relaxed);
        *lock(&self.uploaded) = Some(Uploaded { source, images, number, space: Arc::new(space) });
        Ok(json!({ "photograph": { "name": name, "width": width, "height": height } }))
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
        let mut session = Session { client: &client, outbox: &outbox, name: None, stop: None };
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
            if session.hear(message).await.is_err() {
                break;
            }
        }
        if let Some((stop, _)) = session.stop {
            client.seen.stop(&stop);
        }
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
    let (of_painter, to_page) = (client.clone(), outbox.clone());
    thread("painter").spawn(move || painter::paint(&of_painter, &to_page))?;
    let (of_rays, to_page) = (client.clone(), outbox.clone());
    thread("rays").spawn(move || ray_tree::follow(&of_rays.rays, &to_page))?;
    Ok(())
}

/// What is remembered between the messages of a page.
struct Session<'a> {
    client: &'a Arc<Client>,
    outbox: &'a Outbox,
    /// The name of the photograph that comes next.
    name: Option<String>,
    /// What cancels the last look, and whether it was of something that moves: such pictures are
    /// coarse and quick, and are finished, or nothing would be seen to move.
    stop: Option<(Arc<AtomicBool>, bool)>,
}

impl Session<'_> {
    async fn hear(&mut self, message: ws::Message) -> Result<(), Gone> {
        let heard = match message {
            ws::Message::Text(text) => Message::read(&text).and_then(|said| self.heed(said)),
            ws::Message::Binary(bytes) => self.take_photograph(bytes).await.map(Some),
            ws::Message::Close(_) => return Err(Gone),
            ws::Message::Ping(_) | ws::Message::Pong(_) => Ok(None),
        };
        match heard.unwrap_or_else(|problem| Some(error(None, &problem))) {
            Some(answer) => self.outbox.answer(&answer).await,
            None => Ok(()),
        }
    }

    /// Does what a message says, and gives the answer to it, if there is one at once.
    fn heed(&mut self, message: Message) -> Result<Option<Value>, String> {
        match message {
            Message::Look(look) => {
                if let Some((stop, false)) = &self.stop {
                    self.client.seen.stop(stop);
                }
                let stop = Arc::new(AtomicBool::new(false));
                self.stop = Some((stop.clone(), look.moving));
                self.client.looks.put(Wish { look, stop });
            }
            Message::Seen { id } => self.client.seen.tell(id),
            Message::Ray(ray) => {
                let Some(shown) = lock(&self.client.shown).clone() else {
                    let message = "there is no picture yet that a ray could be followed through";
                    return Ok(Some(error(Some(ray.id), message)));
                };
                self.client.rays.put((ray, shown));
            }
            Message::Save { scene } => {
                let uploaded = self.client.uploaded();
                let source = uploaded.as_ref().map(|uploaded| &uploaded.source);
                let loaded = self.client.server.opened.read(&scene, source)?;
                return Ok(Some(json!({ "saved": { "text": loaded.scene.source } })));
            }
            Message::Photograph { name } if is_plain_name(&name) => self.name = Some(name),
            Message::Photograph { .. } => {
                return Err("a photograph's name is that of a file, without folders".to_owned());
            }
        }
        Ok(None)
    }

    async fn take_photograph(&mut self, bytes: Bytes) -> Result<Value, String> {
        let unnamed = "these bytes belong to no photograph; say its name first";
        let name = self.name.take().ok_or(unnamed)?;
        if bytes.len() > LARGEST_PHOTOGRAPH {
            return Err(format!("a photograph may have {} MiB", LARGEST_PHOTOGRAPH >> 20));
        }
        let client = self.client.clone();
        let read = tokio::task::spawn_blocking(move || client.hang(&name, &bytes)).await;
        read.unwrap_or_else(|_| Err("this image is damaged".to_owned()))
    }
}
