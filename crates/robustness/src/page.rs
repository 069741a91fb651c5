//! A page that says anything: messages of `cloakroom view` over a real connection to a server of
//! this process.

use cloakroom::scene_file;
use cloakroom_viewer::{Settings, serve};
use serde_json::{Value, json};
use std::io::ErrorKind;
use std::net::{Ipv4Addr, TcpStream};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{LazyLock, mpsc};
use std::time::Duration;
use tokio_tungstenite::tungstenite::{self, ClientRequestBuilder, Message, WebSocket};

/// The scene that pages begin with.
const SCENE: &str = "[[device]]\nkind = 'square-cloak'\n";

/// Most messages of a trial.
const MOST_MESSAGES: usize = 12;

/// How long pictures are waited for.
const PATIENCE: Duration = Duration::from_millis(300);

/// How long the server may take for an answer that needs no picture.
const ANSWER: Duration = Duration::from_secs(30);

/// Set by nobody: the server ends with the process.
static STOP: AtomicBool = AtomicBool::new(false);

/// Where the server listens, with the secret folder.
static ADDRESS: LazyLock<String> = LazyLock::new(|| {
    let folder = PathBuf::from("/nowhere");
    let scene = scene_file::parse(SCENE, "a", &folder, &[]).expect("a scene");
    let (name, host) = ("a".to_owned(), Ipv4Addr::LOCALHOST.into());
    let settings = Settings { scene, name, folder, host, port: 0 };
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        serve(&settings, |address| sender.send(address.to_owned()).expect("heard"), &STOP)
    });
    let address = receiver.recv_timeout(ANSWER).expect("a server");
    address.trim_start_matches("http://").trim_end_matches('/').to_owned()
});

/// Says the lines of `bytes`, each a message (a photograph where it is no text), and hears what the
/// server says.
pub(crate) fn say(bytes: &[u8]) {
    let mut socket = connect();
    let mut last_look = None;
    for line in bytes.split(|byte| *byte == b'\n').take(MOST_MESSAGES) {
        let message = match std::str::from_utf8(line) {
            Ok(text) => {
                last_look = look_id(text).or(last_look);
                Message::text(text)
            }
            Err(_) => Message::binary(line.to_vec()),
        };
        if socket.send(message).is_err() {
            // Whoever says what no WebSocket may say is gone; the server must not be.
            return drop(connect());
        }
    }
    let last = json!({ "save": { "scene": { "the last": 1 } } }).to_string();
    let said = socket.send(Message::text(last));
    let mut answered = said.is_err();
    let mut painted = last_look.is_none();
    while !(answered && painted) {
        let heard = match socket.read() {
            Ok(Message::Text(text)) => serde_json::from_str(&text).expect("JSON"),
            Ok(Message::Binary(bytes)) => caption(&bytes),
            Ok(_) => continue,
            Err(tungstenite::Error::Io(error)) if error.kind() == ErrorKind::Interrupted => {
                continue;
            }
            Err(tungstenite::Error::Io(_)) if answered => break,
            Err(error) => panic!("the server is silent: {error}"),
        };
        let told = heard["error"]["message"].as_str().unwrap_or_default();
        assert!(!told.contains("a mistake in the program"), "{heard}");
        if told.contains("the last") {
            answered = true;
            let _ = socket.get_ref().set_read_timeout(Some(PATIENCE));
        }
        let id = if heard["finished"] == true { &heard["id"] } else { &heard["error"]["id"] };
        painted = painted || id.as_u64() == last_look;
    }
    let _ = socket.close(None);
}

/// The number of a look, if a message is one.
fn look_id(text: &str) -> Option<u64> {
    serde_json::from_str::<Value>(text).ok()?.get("look")?.get("id")?.as_u64()
}

/// What a picture says of itself.
fn caption(bytes: &[u8]) -> Value {
    let (length, rest) = bytes.split_first_chunk().expect("a length");
    serde_json::from_slice(&rest[..u32::from_le_bytes(*length) as usize]).expect("a caption")
}

/// A page's connection, greeted.
fn connect() -> WebSocket<TcpStream> {
    // Pages that have just gone may still have their places.
    for _ in 0..600 {
        let (host, _) = ADDRESS.split_once('/').expect("a folder");
        let uri = format!("ws://{}/session", *ADDRESS).parse().expect("an address");
        let request =
            ClientRequestBuilder::new(uri).with_header("Origin", format!("http://{host}"));
        let stream = TcpStream::connect(host).expect("the server is there");
        stream.set_read_timeout(Some(ANSWER)).expect("a socket");
        match tungstenite::client(request, stream) {
            Ok((mut socket, _)) => {
                let greeting = socket.read().expect("a greeting").to_string();
                assert!(greeting.contains("hello"), "{greeting}");
                return socket;
            }
            Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(_))) => {
                std::thread::sleep(Duration::from_millis(50));
            }
            Err(error) => panic!("{error}"),
        }
    }
    panic!("pages that have gone keep their places");
}

/// Messages to begin with.
pub(crate) fn messages() -> Vec<Vec<u8>> {
    let looks = cloakroom_figures::gallery::EXHIBITS.iter().map(|exhibit| {
        let table: toml::Table = toml::from_str(exhibit.scene).expect("a scene");
        let scene = serde_json::to_value(table).expect("tables");
        let beside = ["nothing", "bare", "empty", "mirror"][exhibit.name.len() % 4];
        let look = json!({ "look": { "id": 7, "scene": scene, "size": [8, 6], "samples": 1, "beside": beside } });
        let ray = json!({ "ray": { "id": 8, "at": [0.5, 0.4] } });
        let save = json!({ "save": { "scene": scene } });
        let seen = json!({ "seen": { "id": 7 } });
        format!("{look}\n{seen}\n{ray}\n{save}\n{ray}").into_bytes()
    });
    let photograph = json!({ "photograph": { "name": "a.png" } });
    let hung = json!({ "look": { "id": 9, "scene": { "photograph": { "image": "a.png" } },
                                 "size": [8, 6], "samples": 2, "moving": true } });
    let photographs = crate::trials::image_files().into_iter().map(|bytes| {
        [photograph.to_string().as_bytes(), b"\n", &bytes, b"\n", hung.to_string().as_bytes()]
            .concat()
    });
    looks.chain(photographs).collect()
}
