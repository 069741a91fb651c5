//! A server of its own for each test, and pages that talk to it without a browser.

use cloakroom::scene_file;
use cloakroom_viewer::{Settings, serve};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread::JoinHandle;
use std::time::Duration;
use tokio_tungstenite::tungstenite::{self, ClientRequestBuilder, Message, WebSocket};

/// A small scene that is quick to render.
pub const SCENE: &str = "[camera]\nresolution = [32, 24]\n[photograph]\nimage = 'mine.png'\n\
                         [[device]]\nkind = 'square-cloak'\nrotation = 10\n";

pub struct Server {
    pub port: u16,
    /// The secret folder of its address.
    pub secret: String,
    stop: &'static AtomicBool,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    pub fn start(port: u16) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let scene = scene_file::parse(SCENE, "mine", folder, &[]).unwrap();
        let folder = folder.to_owned();
        let (name, host) = ("mine".to_owned(), [127, 0, 0, 1].into());
        let settings = Settings { scene, name, folder, host, port };
        let stop: &'static AtomicBool = Box::leak(Box::new(AtomicBool::new(false)));
        let (sender, receiver) = mpsc::channel();
        let thread = std::thread::spawn(move || {
            let ready = |address: &str| sender.send(address.to_owned()).unwrap();
            serve(&settings, ready, stop).unwrap();
        });
        let address = receiver.recv_timeout(Duration::from_secs(60)).unwrap();
        let rest = address.strip_prefix("http://127.0.0.1:").unwrap();
        let (port, secret) = rest.strip_suffix('/').unwrap().split_once('/').unwrap();
        let (port, secret) = (port.parse().unwrap(), secret.to_owned());
        Self { port, secret, stop, thread: Some(thread) }
    }

    /// Ends the server as Ctrl-C does.
    pub fn end(&mut self) {
        self.stop.store(true, Ordering::SeqCst);
        self.thread.take().unwrap().join().unwrap();
    }

    /// Sends a request as it is, and reads what comes back until the server closes or is silent.
    pub fn raw(&self, request: &[u8]) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
        // It may close before it has heard all.
        let _ = stream.write_all(request);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// Asks for a path within the secret folder, or another address.
    pub fn get(&self, path: &str, host: &str) -> String {
        let folder =
            if path.starts_with('/') { format!("/{}", self.secret) } else { String::new() };
        let path = format!("{folder}{path}");
        self.raw(
            format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").as_bytes(),
        )
    }

    pub fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// Opens a page's WebSocket; the status if it is refused.
    pub fn connect(&self, origin: Option<&str>, host: Option<&str>) -> Result<Page, u16> {
        self.connect_by(&self.secret, origin, host)
    }

    /// The same by whoever believes the secret to be this.
    pub fn connect_by(
        &self,
        secret: &str,
        origin: Option<&str>,
        host: Option<&str>,
    ) -> Result<Page, u16> {
        let uri = format!("ws://127.0.0.1:{}/{secret}/session", self.port).parse().unwrap();
        let mut request = ClientRequestBuilder::new(uri);
        if let Some(origin) = origin {
            request = request.with_header("Origin", origin);
        }
        let mut request =
            tungstenite::client::IntoClientRequest::into_client_request(request).unwrap();
        if let Some(host) = host {
            request.headers_mut().insert("Host", host.parse().unwrap());
        }
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(Page { socket }),
            Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(response))) => {
                Err(response.status().as_u16())
            }
            Err(error) => panic!("{error}"),
        }
    }

    /// Opens a page, greeted.
    pub fn page(&self) -> Page {
        let origin = format!("http://{}", self.host());
        let mut page = self.connect(Some(&origin), None).unwrap();
        assert!(page.hear()["hello"]["kinds"].is_object());
        page
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        if self.thread.is_some() {
            self.end();
        }
    }
}

/// What a page gets to hear.
pub enum Heard {
    Text(Value),
    Picture(Value, Vec<u8>),
    End,
}

pub struct Page {
    pub socket: WebSocket<TcpStream>,
}

impl Page {
    pub fn say(&mut self, message: &Value) {
        self.socket.send(Message::text(message.to_string())).unwrap();
    }

    pub fn listen(&mut self) -> Heard {
        loop {
            match self.socket.read() {
                Ok(Message::Text(text)) => {
                    return Heard::Text(serde_json::from_str(&text).unwrap());
                }
                Ok(Message::Binary(bytes)) => {
                    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
                    let caption = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
                    return Heard::Picture(caption, bytes[4 + length..].to_vec());
                }
                Ok(Message::Close(_)) | Err(_) => return Heard::End,
                Ok(_) => {}
            }
        }
    }

    /// The next message that is text.
    pub fn hear(&mut self) -> Value {
        loop {
            match self.listen() {
                Heard::Text(value) => return value,
                Heard::Picture(..) => {}
                Heard::End => panic!("the server has closed the page"),
            }
        }
    }

    /// The next message of a kind.
    pub fn hear_of(&mut self, kind: &str) -> Value {
        loop {
            let message = self.hear();
            if !message[kind].is_null() {
                return message[kind].clone();
            }
        }
    }

    /// The finished picture of a look, with its caption.
    pub fn finished(&mut self, id: u64) -> (Value, Vec<u8>) {
        loop {
            match self.listen() {
                Heard::Picture(caption, pixels) if caption["id"] == id => {
                    assert_eq!(pixels.len() as u64, area(&caption) * 4);
                    if caption["finished"] == true {
                        return (caption, pixels);
                    }
                }
                Heard::Text(message) if message["error"]["id"] == id => panic!("{message}"),
                Heard::End => panic!("the server has closed the page"),
                _ => {}
            }
        }
    }
}

fn area(caption: &Value) -> u64 {
    caption["width"].as_u64().unwrap() * caption["height"].as_u64().unwrap()
}

/// A look at a cloak turned by an angle.
pub fn look(id: u64, rotation: f64, samples: u32) -> Value {
    let scene = json!({ "device": [{ "kind": "square-cloak", "rotation": rotation }] });
    json!({ "look": { "id": id, "scene": scene, "size": [48, 36], "samples": samples } })
}
