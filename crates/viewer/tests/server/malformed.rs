//! Thousands of messages that make no sense: each is answered with an error and nothing else.

use crate::long;
use crate::page::{Heard, Page, Server, look};
use serde_json::{Value, json};
use tokio_tungstenite::tungstenite::Message;

/// Pseudorandom numbers (xorshift64*), the same every time.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % limit
    }

    fn pick<'a, T>(&mut self, among: &'a [T]) -> &'a T {
        &among[self.below(among.len())]
    }
}

/// A value that makes little sense.
fn nonsense(random: &mut Random, depth: usize) -> Value {
    match random.below(if depth > 3 { 8 } else { 10 }) {
        0 => Value::Null,
        1 => json!(random.below(2) == 1),
        2 => json!(random.below(1 << 30) as i64 - (1 << 29)),
        3 => json!(random.pick(&[1e308, -1e308, 1e-308, 0.0, -0.0, 0.5, 1e30])),
        4 => json!(random.pick(&[
            "",
            "../../etc/passwd",
            "/etc/passwd",
            "builtin:",
            "square-cloak",
            "\u{0}",
            "NaN",
            "cloak"
        ])),
        5 => json!("x".repeat(random.below(3000))),
        6 => json!(u64::MAX),
        7 => json!(random.below(100) as f64 / 7.0),
        8 => (0..random.below(5)).map(|_| nonsense(random, depth + 1)).collect(),
        _ => {
            let keys = [
                "camera", "device", "kind", "image", "position", "size", "id", "look", "scene",
                "at", "rotation",
            ];
            let entries = random.below(5);
            (0..entries)
                .map(|_| ((*random.pick(&keys)).to_owned(), nonsense(random, depth + 1)))
                .collect()
        }
    }
}

/// A message spoiled somewhere: a value of it replaced, or its text cut or changed.
fn spoiled(random: &mut Random) -> String {
    let scene = json!({
        "camera": { "position": [-100, 0, 0], "field_of_view": 40 },
        "photograph": { "image": "builtin:bookshelf" },
        "device": [{ "kind": "square-cloak", "rotation": 3 }],
    });
    let messages = [
        json!({ "look": { "id": 7, "scene": scene, "size": [8, 6], "samples": 1, "beside": "bare", "moment": 0.5 } }),
        json!({ "ray": { "id": 7, "at": [0.2, 0.3] } }),
        json!({ "save": { "scene": scene } }),
        json!({ "seen": { "id": 7 } }),
        json!({ "photograph": { "name": "a.png" } }),
        json!({ "unknown": {} }),
    ];
    let mut message = random.pick(&messages).clone();
    match random.below(4) {
        0 => {
            let mut bytes = message.to_string().into_bytes();
            let at = random.below(bytes.len());
            bytes.truncate(at);
            String::from_utf8(bytes).unwrap()
        }
        1 => {
            let mut bytes = message.to_string().into_bytes();
            for _ in 0..=random.below(4) {
                let at = random.below(bytes.len());
                bytes[at] = 32 + random.below(95) as u8;
            }
            String::from_utf8(bytes).unwrap()
        }
        2 => nonsense(random, 0).to_string(),
        _ => {
            let pointers = [
                "/look",
                "/look/id",
                "/look/size",
                "/look/size/0",
                "/look/samples",
                "/look/beside",
                "/look/moment",
                "/look/scene",
                "/look/scene/camera",
                "/look/scene/camera/position",
                "/look/scene/camera/field_of_view",
                "/look/scene/photograph/image",
                "/look/scene/device",
                "/look/scene/device/0",
                "/look/scene/device/0/kind",
                "/look/scene/device/0/rotation",
                "/ray",
                "/ray/at",
                "/ray/at/0",
                "/save",
                "/save/scene",
                "/save/scene/device",
                "/photograph",
                "/photograph/name",
                "",
            ];
            let here: Vec<_> =
                pointers.into_iter().filter(|pointer| message.pointer(pointer).is_some()).collect();
            let pointer = *random.pick(&here);
            *message.pointer_mut(pointer).unwrap() = nonsense(random, 0);
            message.to_string()
        }
    }
}

#[test]
fn malformed_messages_are_answered_with_an_error_and_nothing_else() {
    let server = Server::start(0);
    let mut random = Random(20_131_105);
    let mut errors = 0;
    let pages = long::count(6, 50);
    for _ in 0..pages {
        let mut page = server.page();
        for _ in 0..100 {
            page.socket.send(Message::text(spoiled(&mut random))).unwrap();
        }
        // After all of them the page still works.
        page.say(&json!({ "save": { "scene": { "surroundings": { "image": "builtin:bookshelf" },
            "device": [{ "kind": "body", "shape": "box", "size": [1, 2, 3], "position": [0, 0, 0] }],
            "photograph": { "image": "mine.png" } } } }));
        page.say(&json!({ "save": { "scene": { "the last one": 1 } } }));
        errors += hear_last(&mut page);
        page.say(&look(9, 5.0, 1));
        page.finished(9);
    }
    assert!(errors > 60 * pages, "{errors}");
}

/// Reads on until the answer to the message that only an error can answer.
fn hear_last(page: &mut Page) -> usize {
    let mut errors = 0;
    loop {
        match page.listen() {
            Heard::Text(message) => {
                let words = message["error"]["message"].as_str().unwrap_or("");
                assert!(
                    !words.contains("root:") && !words.contains("mistake in the program"),
                    "{words}"
                );
                assert!(words.len() < 4000, "{words}");
                if words.contains("the last one") {
                    return errors;
                }
                errors += usize::from(!words.is_empty());
            }
            Heard::Picture(caption, _) => assert!(caption["id"].is_u64()),
            Heard::End => panic!("the server has closed the page"),
        }
    }
}

#[test]
fn long_messages_and_odd_bytes_are_errors() {
    let server = Server::start(0);
    let mut page = server.page();
    page.socket.send(Message::text(" ".repeat(65 << 10))).unwrap();
    assert!(page.hear()["error"]["message"].as_str().unwrap().contains("may have 65536 bytes"));
    let deep = "[".repeat(30_000);
    page.socket.send(Message::text(deep)).unwrap();
    assert!(page.hear()["error"]["message"].is_string());
    let mut nested = json!(1);
    for _ in 0..100 {
        nested = json!({ "a": nested });
    }
    page.say(&json!({ "save": { "scene": nested } }));
    assert!(page.hear()["error"]["message"].is_string());
    for size in [[0, 5], [5, 0], [4096, 1], [1 << 30, 1 << 30]] {
        let mut look = look(1, 0.0, 1);
        look["look"]["size"] = json!(size);
        page.say(&look);
        assert!(page.hear()["error"]["message"].as_str().unwrap().contains("size must be"));
    }
    let mut look = look(1, 0.0, 1_000_000);
    page.say(&look);
    assert!(page.hear()["error"]["message"].as_str().unwrap().contains("samples must be"));
    look["look"]["samples"] = json!(1);
    look["look"]["scene"]["photograph"] = json!({ "image": "/etc/passwd" });
    page.say(&look);
    assert!(page.hear()["error"]["message"].as_str().unwrap().contains("it can open no file"));
}
