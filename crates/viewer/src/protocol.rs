//! What a page says: small JSON messages; and one kind of bytes, a photograph.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

/// Longest text message, bytes.
pub(crate) const LONGEST_TEXT: usize = 64 << 10;

/// Largest photograph, bytes.
pub(crate) const LARGEST_PHOTOGRAPH: usize = 32 << 20;

/// Most pixels a side of a picture.
const MOST_PIXELS: u32 = 2048;

/// Most samples a pixel.
const MOST_SAMPLES: u32 = 64;

/// A scene as a page sends it: the tables of a scene file as JSON.
pub type SceneTables = Map<String, Value>;

/// A message from a page.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Message {
    /// Show this.
    Look(Look),
    /// The first picture of a look is on the screen.
    Seen {
        /// That of the look.
        id: u64,
    },
    /// Follow the ray of a point of the picture that is shown.
    Ray(Ray),
    /// Say this scene as TOML.
    Save {
        /// The scene.
        scene: SceneTables,
    },
    /// The next binary message is a photograph of that name.
    Photograph {
        /// A file's name, without folders.
        name: String,
    },
}

/// What to look at.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Look {
    /// Comes back with every answer.
    pub id: u64,
    /// The scene; its resolution and samples are replaced by these.
    pub scene: SceneTables,
    /// Width and height of the full picture, pixels.
    pub size: [u32; 2],
    /// Samples a pixel of the finished picture.
    pub samples: u32,
    /// Whether more is to come at once: one coarse picture is enough.
    #[serde(default)]
    pub moving: bool,
    /// What else is shown beside the scene.
    #[serde(default)]
    pub beside: Beside,
    /// Light in flight after the photograph has flashed, instead of the picture: when, as a share, 0 to 1, of the time in
    /// which it arrives.
    #[serde(default)]
    pub moment: Option<f64>,
}

/// What is shown beside a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Beside {
    /// Nothing.
    #[default]
    Nothing,
    /// The metal without its cloak.
    Bare,
    /// The scene without its devices.
    Empty,
    /// What the cloak should look like.
    Mirror,
}

/// A point of the picture.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ray {
    /// Comes back with the answer.
    pub id: u64,
    /// The point, as shares of width and height from the top left.
    pub at: [f64; 2],
}

impl Message {
    /// Reads a message.
    ///
    /// # Errors
    ///
    /// One sentence that says what is wrong with it.
    pub fn read(text: &str) -> Result<Self, String> {
        if text.len() > LONGEST_TEXT {
            return Err(format!("a message may have {LONGEST_TEXT} bytes"));
        }
        let message: Self = serde_json::from_str(text)
            .map_err(|error| format!("this is no message for this server: {error}"))?;
        match &message {
            Self::Look(look) => {
                if look.size.iter().any(|side| !(1..=MOST_PIXELS).contains(side)) {
                    return Err(format!("size must be 1 to {MOST_PIXELS} pixels a side"));
                }
                if !(1..=MOST_SAMPLES).contains(&look.samples) {
                    return Err(format!("samples must be 1 to {MOST_SAMPLES}"));
                }
                if look.moment.is_some_and(|share| !(0.0..=1.0).contains(&share)) {
                    return Err("moment must be a share from 0 to 1".to_owned());
                }
            }
            Self::Ray(ray) if ray.at.iter().any(|share| !(0.0..=1.0).contains(share)) => {
                return Err("at must be two shares from 0 to 1".to_owned());
            }
            _ => {}
        }
        Ok(message)
    }
}

/// An error as a page gets it; `id` is that of the message at fault, where it is known.
pub fn error(id: Option<u64>, message: &str) -> Value {
    json!({ "error": { "id": id, "message": message } })
}
