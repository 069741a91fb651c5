//! What a page says, message by message, and what is remembered between them.

use crate::painter::Wish;
use crate::protocol::{LARGEST_PHOTOGRAPH, Message, Ray, error};
use crate::scenes::{Opened, is_plain_name};
use crate::seen::Seen;
use crate::slot::Slot;
use cloakroom::photograph::{ImageSource, LinearImage, LoadProblem, load_bytes};
use serde_json::{Value, json};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Most pixels of a photograph.
const MOST_PIXELS: u64 = 40_000_000;

/// What is left to do once a message has been heard.
#[derive(Debug)]
pub enum Heard {
    /// Nothing.
    All,
    /// To send this answer.
    Answer(Value),
    /// To follow this ray.
    Follow(Ray),
}

/// What is remembered between the messages of a page.
#[derive(Debug, Default)]
pub struct Session {
    /// The name of the photograph that comes next.
    name: Option<String>,
    /// What cancels the last look, and whether it was of something that moves: such pictures are
    /// coarse and quick, and are finished, or nothing would be seen to move.
    stop: Option<(Arc<AtomicBool>, bool)>,
}

impl Session {
    /// Does what a message says, as far as it needs no ray; `uploaded` is the photograph that the page has brought.
    ///
    /// # Errors
    ///
    /// One sentence that says what is wrong with it.
    pub fn hear(
        &mut self,
        text: &str,
        (looks, seen): (&Slot<Wish>, &Seen),
        opened: &Opened,
        uploaded: Option<&ImageSource>,
    ) -> Result<Heard, String> {
        match Message::read(text)? {
            Message::Look(look) => {
                if let Some((stop, false)) = &self.stop {
                    seen.stop(stop);
                }
                let stop = Arc::new(AtomicBool::new(false));
                self.stop = Some((stop.clone(), look.moving));
                looks.put(Wish { look, stop });
            }
            Message::Seen { id } => seen.tell(id),
            Message::Ray(ray) => return Ok(Heard::Follow(ray)),
            Message::Save { scene } => {
                let loaded = opened.read(&scene, uploaded)?;
                return Ok(Heard::Answer(json!({ "saved": { "text": loaded.scene.source } })));
            }
            Message::Photograph { name } if is_plain_name(&name) => self.name = Some(name),
            Message::Photograph { .. } => {
                return Err("a photograph's name is that of a file, without folders".to_owned());
            }
        }
        Ok(Heard::All)
    }

    /// The name of a photograph of so many bytes that has come.
    ///
    /// # Errors
    ///
    /// If none was said, or there are too many.
    pub fn name_of_photograph(&mut self, bytes: usize) -> Result<String, String> {
        let unnamed = "these bytes belong to no photograph; say its name first";
        let name = self.name.take().ok_or(unnamed)?;
        if bytes > LARGEST_PHOTOGRAPH {
            return Err(format!("a photograph may have {} MiB", LARGEST_PHOTOGRAPH >> 20));
        }
        Ok(name)
    }

    /// Cancels the last look: the page has gone.
    pub fn end(&self, seen: &Seen) {
        if let Some((stop, _)) = &self.stop {
            seen.stop(stop);
        }
    }
}

/// Reads a photograph that a page has brought, and says what the page is told of it.
///
/// # Errors
///
/// One sentence without its path.
pub fn read_photograph(
    source: &ImageSource,
    name: &str,
    bytes: &[u8],
) -> Result<(LinearImage, Value), String> {
    let millions = MOST_PIXELS / 1_000_000;
    let words = |problem: LoadProblem| match &problem {
        LoadProblem::TooLarge => {
            format!("the photograph is too large: at most {millions} million pixels")
        }
        LoadProblem::Empty => format!("this {}", LoadProblem::NotAnImage),
        LoadProblem::NotAnImage | LoadProblem::OtherFormat(_) | LoadProblem::NotInBrowser => {
            format!("this {problem}")
        }
        LoadProblem::Unsupported(_) => format!("this image {problem}"),
        _ => "this image is damaged or cut short".to_owned(),
    };
    let image = load_bytes(source, bytes, MOST_PIXELS).map_err(|error| words(error.problem))?;
    let (width, height) = (image.width, image.height);
    let said = json!({ "photograph": { "name": name, "width": width, "height": height } });
    Ok((image, said))
}

/// The answer to whoever asks for a ray before there is a picture.
#[must_use]
pub fn nothing_shown(ray: &Ray) -> Value {
    error(Some(ray.id), "there is no picture yet that a ray could be followed through")
}
