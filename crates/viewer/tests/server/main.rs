//! The server without a browser: who may ask for what, and what comes of it.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../../../optics/tests/long.rs"]
mod long;
mod malformed;
mod page;
mod pictures;

use cloakroom::scene_file;
use cloakroom_viewer::{Settings, ViewerError, serve};
use page::{Heard, Server, look};
use serde_json::json;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use tokio_tungstenite::tungstenite::Message;

fn status(answer: &str) -> &str {
    answer.split(' ').nth(1).unwrap_or("none")
}

#[test]
fn one_address_is_asked_for_not_all_at_once() {
    let scene = scene_file::parse(page::SCENE, "mine", Path::new(""), &[]).unwrap();
    let host = [0, 0, 0, 0].into();
    let settings = Settings { scene, name: String::new(), folder: PathBuf::new(), host, port: 0 };
    static STOP: AtomicBool = AtomicBool::new(true);
    let served = serve(&settings, |address| panic!("{address}"), &STOP);
    let refused = served.expect_err("all addresses");
    assert!(matches!(refused, ViewerError::AllAddresses(_)), "{refused}");
    assert!(refused.to_string().contains("one address of this machine"), "{refused}");
}

#[test]
fn the_page_comes_from_the_program_and_nothing_else_does() {
    let server = Server::start(0);
    let host = server.host();
    for (path, kind) in [
        ("/", "text/html"),
        ("/main.js", "text/javascript"),
        ("/style.css", "text/css"),
        ("/icon.svg", "image/svg"),
    ] {
        let answer = server.get(path, &host);
        assert_eq!(status(&answer), "200", "{path}");
        let head = answer.to_lowercase();
        assert!(head.contains(&format!("content-type: {kind}")), "{path}");
        assert!(head.contains("content-security-policy: default-src 'none'"), "{path}");
        assert!(head.contains("x-content-type-options: nosniff"), "{path}");
    }
    // The scripts name no other place.
    let page = server.get("/", &host);
    assert!(!page.contains("https://") && !page.contains("http://"), "{page}");
    for path in [
        "/../Cargo.toml",
        "/..%2f..%2fetc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "//etc/passwd",
        "/etc/passwd",
        "/page/main.js",
        "/mine.png",
        "/Cargo.toml",
        "/index.html",
        "/main.js/",
        "/session/x",
        "/%00",
        "/main.js%00.png",
        "http://127.0.0.1/etc/passwd",
        "file:///etc/passwd",
        "*",
    ] {
        let answer = server.get(path, &host);
        assert!(["400", "403", "404"].contains(&status(&answer)), "{path}: {answer}");
        assert!(!answer.contains("root:") && !answer.contains("[package]"), "{path}");
    }
}

#[test]
fn foreign_hosts_and_origins_are_refused() {
    let server = Server::start(0);
    let port = server.port;
    for host in
        ["evil.example", "127.0.0.1", &format!("evil.example:{port}"), "localhost:1", "[::1]"]
    {
        assert_eq!(status(&server.get("/", host)), "403", "{host}");
    }
    assert_eq!(status(&server.get("/", &format!("localhost:{port}"))), "200");
    assert_eq!(status(&server.raw(b"GET / HTTP/1.1\r\nConnection: close\r\n\r\n")), "403");
    let ours = format!("http://127.0.0.1:{port}");
    for origin in [
        None,
        Some("null"),
        Some("https://evil.example"),
        Some("http://evil.example"),
        Some(&*format!("https://127.0.0.1:{port}")),
        Some(&*format!("http://127.0.0.1:{port}.evil.example")),
        Some("http://127.0.0.1"),
    ] {
        assert_eq!(server.connect(origin, None).err(), Some(403), "{origin:?}");
    }
    assert_eq!(server.connect(Some(&ours), Some("evil.example")).err(), Some(403));
    server.connect(Some(&ours), None).expect("our own page");
}

/// Another user of this machine reaches the server, and may say any name.
#[test]
fn only_who_knows_the_whole_address_is_served() {
    let server = Server::start(0);
    let (host, ours) = (server.host(), format!("http://{}", server.host()));
    let other = "0".repeat(32);
    for path in ["/", "/main.js", "/session", &format!("/{other}/"), &format!("/{}", server.secret)]
    {
        let answer = server.raw(
            format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").as_bytes(),
        );
        assert_eq!(status(&answer), "403", "{path}");
        assert!(answer.contains("the whole address") && !answer.contains(&server.secret));
    }
    for wrong in ["", &other, &server.secret[..31], &format!("{}0", server.secret)] {
        let refused = server.connect_by(wrong, Some(&ours), None).err();
        assert_eq!(refused, Some(403), "{wrong}");
    }
    server.connect(Some(&ours), None).expect("our own page");
    // The next server has another one.
    assert_ne!(server.secret, Server::start(0).secret);
}

/// Another user opens connections and says nothing of use on them.
#[test]
fn strangers_take_no_room() {
    let server = Server::start(0);
    let mut page = server.page();
    let mut strangers: Vec<_> = (0..200)
        .map(|_| {
            let mut stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
            stream.write_all(b"GET / HT").unwrap();
            stream.set_read_timeout(Some(std::time::Duration::from_secs(1))).unwrap();
            stream
        })
        .collect();
    assert_eq!(status(&server.get("/", &server.host())), "200");
    // The oldest are gone: the others would keep silent for longer than one waits here.
    for stream in &mut strangers[..100] {
        // Closed, or reset where words were left unread.
        let silent = |error: std::io::Error| error.kind() == std::io::ErrorKind::WouldBlock;
        assert!(!stream.read(&mut [0; 999]).is_err_and(silent), "still there");
    }
    page.say(&look(1, 5.0, 1));
    page.finished(1);
}

/// A page whose light is trapped in a device, with branches followed for long, keeps no
/// other waiting.
#[test]
fn trapped_light_keeps_no_page_waiting() {
    let server = Server::start(0);
    let (mut slow, mut quick) = (server.page(), server.page());
    let scene = json!({
        "trace": { "min_power": 1e-9 },
        "device": [{ "kind": "square-cloak", "material": "negative-uniaxial", "rotation": 7 }],
    });
    slow.say(&json!({ "look": { "id": 1, "scene": scene, "size": [2000, 2000], "samples": 64 } }));
    slow.hear_of("section");
    let start = std::time::Instant::now();
    quick.say(&look(2, 5.0, 1));
    quick.finished(2);
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

/// A page whose pictures take minutes keeps no other waiting.
#[test]
fn pages_share_the_processors() {
    let server = Server::start(0);
    let (mut slow, mut quick) = (server.page(), server.page());
    let scene = json!({ "device": [{ "kind": "square-cloak", "material": "negative-uniaxial" }] });
    slow.say(&json!({ "look": { "id": 1, "scene": scene, "size": [2000, 2000], "samples": 64 } }));
    std::thread::sleep(std::time::Duration::from_millis(500));
    quick.say(&look(2, 5.0, 2));
    quick.finished(2);
}

#[test]
fn requests_that_are_none_are_refused() {
    let server = Server::start(0);
    let host = server.host();
    let request = |line: &str, more: &str| {
        server.raw(format!("{line}\r\nHost: {host}\r\n{more}Connection: close\r\n\r\n").as_bytes())
    };
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "PATCH"] {
        let line = format!("{method} /{}/ HTTP/1.1", server.secret);
        assert_eq!(status(&request(&line, "Content-Length: 0\r\n")), "405", "{method}");
    }
    // A session that is no WebSocket.
    for (method, more) in [("GET", ""), ("POST", "Content-Length: 0\r\n")] {
        let answer = request(&format!("{method} /{}/session HTTP/1.1", server.secret), more);
        assert!(status(&answer).starts_with('4') && status(&answer) != "403", "{answer}");
    }
    for nonsense in [&b"\0\0\0\0\r\n\r\n"[..], b"GET\r\n\r\n", &[b'a'; 100_000]] {
        let answer = server.raw(nonsense);
        assert!(answer.is_empty() || status(&answer).starts_with('4'), "{answer}");
    }
    let long = format!("X: {}\r\n", "y".repeat(1 << 20));
    assert!(!request("GET / HTTP/1.1", &long).contains("<!doctype"));
    assert_eq!(status(&server.get("/", &host)), "200");
}

#[test]
fn ten_pages_are_served_and_the_eleventh_is_refused() {
    let server = Server::start(0);
    let mut pages: Vec<_> = (0..10).map(|_| server.page()).collect();
    for (page, id) in pages.iter_mut().zip(1..) {
        page.say(&look(id, id as f64, 2));
    }
    let origin = format!("http://{}", server.host());
    assert_eq!(server.connect(Some(&origin), None).err(), Some(503));
    let mut pictures: Vec<_> =
        pages.iter_mut().zip(1..).map(|(page, id)| page.finished(id).1).collect();
    pictures.sort();
    pictures.dedup();
    assert_eq!(pictures.len(), 10, "each has its own");
    // One that goes makes room.
    pages.pop().unwrap().socket.close(None).unwrap();
    let room = (0..400).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        server.connect(Some(&origin), None).is_ok()
    });
    assert!(room);
}

#[test]
fn a_port_that_is_taken_is_passed_over() {
    let other = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = other.local_addr().unwrap().port();
    let server = Server::start(port);
    assert!(server.port > port && server.port < port + 100);
    assert_eq!(status(&server.get("/", &server.host())), "200");
}

#[test]
fn the_end_is_clean_while_work_goes_on() {
    let mut server = Server::start(0);
    let mut page = server.page();
    let scene = json!({ "device": [{ "kind": "square-cloak", "material": "negative-uniaxial" }] });
    page.say(&json!({ "look": { "id": 1, "scene": scene, "size": [2000, 2000], "samples": 64 } }));
    page.hear_of("section");
    let start = std::time::Instant::now();
    server.end();
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
    while !matches!(page.listen(), Heard::End) {}
}

#[test]
fn photographs_are_read_with_care() {
    let server = Server::start(0);
    let mut page = server.page();
    let mut png = Vec::new();
    let image = image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([6 * x as u8, 8 * y as u8, 60]));
    image.write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png).unwrap();
    let mut bring = |name: &str, bytes: &[u8]| {
        page.say(&json!({ "photograph": { "name": name } }));
        page.socket.send(Message::binary(bytes.to_vec())).unwrap();
        page.hear()
    };
    assert_eq!(
        bring("mine.png", &png)["photograph"],
        json!({ "name": "mine.png", "width": 40, "height": 30 })
    );
    // A header that promises 60000 x 60000 pixels, and no bytes to go with it.
    let mut bomb = png.clone();
    bomb[16..24].copy_from_slice(&[0, 0, 0xEA, 0x60, 0, 0, 0xEA, 0x60]);
    for (bytes, part) in [
        (&png[..png.len() / 2], "damaged"),
        (&b"GIF89a\x01\x00\x01\x00\x00\x00\x00"[..], "only PNG, JPEG and EXR"),
        (&b""[..], "not an image"),
        (&b"hello, world, this is no image"[..], "not an image"),
        (&bomb[..], ""),
    ] {
        let message = bring("other.png", bytes);
        let message = message["error"]["message"].as_str().unwrap();
        assert!(message.contains(part), "{message}");
        assert!(!message.contains('/'), "no path is told: {message}");
    }
    page.say(&json!({ "photograph": { "name": "../mine.png" } }));
    assert!(page.hear()["error"]["message"].as_str().unwrap().contains("without folders"));
    // Bytes without a name.
    page.socket.send(Message::binary(png)).unwrap();
    assert!(page.hear()["error"]["message"].as_str().unwrap().contains("say its name first"));
    // More than may come at once closes the page, and no other.
    let mut other = server.page();
    let _ = page.socket.send(Message::binary(vec![0; (32 << 20) + 1]));
    while !matches!(page.listen(), Heard::End) {}
    other.say(&look(1, 3.0, 1));
    other.finished(1);
}
