//! The worker that hears the page, and shares its work out among the hands.

use crate::order::{About, Band, Outcome, Work, broken, decode, join};
use cloakroom::output::Picture;
use cloakroom::photograph::ImageSource;
use cloakroom::render::{BAND_ROWS, Supervision};
use cloakroom_viewer::end::{End, Gone, Problem, Subject, Survey, Wanted};
use cloakroom_viewer::{
    Heard, Opened, Ray, Seen, Session, Slot, Wish, error, greeting, lock, nothing_shown, paint,
    read_photograph,
};
use futures_util::future::{join_all, select};
use serde_json::Value;
use std::future::Future;
use std::pin::pin;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use wasm_bindgen::prelude::{JsCast, wasm_bindgen};
use wasm_bindgen_futures::{JsFuture, spawn_local};

#[wasm_bindgen]
extern "C" {
    /// Says something to the page.
    fn tell(text: &str);
    /// Sends a picture to the page.
    #[wasm_bindgen(js_name = show)]
    fn show_picture(bytes: Vec<u8>);
    /// Orders something of a hand; promises the bytes that come of it, or that the hand has ended.
    fn order(hand: u32, about: &str, work: &str) -> js_sys::Promise;
    /// Gives a photograph to all hands.
    #[wasm_bindgen(js_name = giveToHands)]
    fn give_to_hands(name: &str, bytes: &[u8]);
    /// Milliseconds since some moment.
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
    /// Promises to have waited.
    fn pause(milliseconds: u32) -> js_sys::Promise;
}

/// The one who leads.
#[wasm_bindgen]
pub struct Lead {
    desk: Arc<Desk>,
    session: Session,
}

/// What is heard and what is under way.
struct Desk {
    opened: Opened,
    hands: u32,
    looks: Slot<Wish>,
    seen: Seen,
    /// The photograph that the page has brought last.
    uploaded: Mutex<Option<ImageSource>>,
    /// What orders to follow rays are about.
    shown: Mutex<Option<String>>,
    /// Who does next what one hand does alone.
    turn: AtomicU32,
}

#[wasm_bindgen]
impl Lead {
    /// One with so many hands, which greets the page.
    ///
    /// # Errors
    ///
    /// If the first scene cannot be read.
    #[wasm_bindgen(constructor)]
    pub fn new(hands: u32) -> Result<Self, String> {
        let (opened, _) = crate::first()?;
        let desk = Arc::new(Desk {
            opened,
            hands,
            looks: Slot::default(),
            seen: Seen::default(),
            uploaded: Mutex::default(),
            shown: Mutex::default(),
            turn: AtomicU32::new(0),
        });
        tell(&greeting(&desk.opened).to_string());
        let painter = desk.clone();
        spawn_local(async move {
            paint(&*painter, &painter.opened, &painter.looks, &painter.seen).await;
        });
        Ok(Self { desk, session: Session::default() })
    }

    /// Hears a message of the page.
    pub fn hear(&mut self, text: &str) {
        let desk = &self.desk;
        let uploaded = lock(&desk.uploaded).clone();
        let about = (&desk.looks, &desk.seen);
        match self.session.hear(text, about, &desk.opened, uploaded.as_ref()) {
            Ok(Heard::All) => {}
            Ok(Heard::Answer(answer)) => tell(&answer.to_string()),
            Ok(Heard::Follow(ray)) => follow(desk, ray),
            Err(problem) => tell(&error(None, &problem).to_string()),
        }
    }

    /// Takes a photograph of the page.
    #[wasm_bindgen(js_name = takePhotograph)]
    pub fn take_photograph(&mut self, bytes: &[u8]) {
        let hung = self.session.name_of_photograph(bytes.len()).and_then(|name| {
            let source = self.desk.opened.source_of(&name);
            let (_, said) = read_photograph(&source, &name, bytes)?;
            give_to_hands(&name, bytes);
            *lock(&self.desk.uploaded) = Some(source);
            Ok(said)
        });
        tell(&hung.unwrap_or_else(|problem| error(None, &problem)).to_string());
    }
}

/// Lets a hand follow a ray.
fn follow(desk: &Arc<Desk>, ray: Ray) {
    let Some(about) = lock(&desk.shown).clone() else {
        return tell(&nothing_shown(&ray).to_string());
    };
    let desk = desk.clone();
    spawn_local(async move {
        if let Ok((Outcome::Ray(said), _)) = desk.by_one(&about, &Work::Ray(ray)).await {
            tell(&said.to_string());
        }
    });
}

impl Desk {
    /// Lets one hand do something, each in its turn.
    async fn by_one(&self, about: &str, work: &Work) -> Result<(Outcome, Vec<u8>), Problem> {
        by(self.turn.fetch_add(1, Ordering::Relaxed) % self.hands, about, work).await
    }
}

/// Lets a hand do something.
async fn by(hand: u32, about: &str, work: &Work) -> Result<(Outcome, Vec<u8>), Problem> {
    let work = serde_json::to_string(work).map_err(Problem::of)?;
    let bytes = JsFuture::from(order(hand, about, &work)).await.map_err(|_| broken())?;
    let bytes = bytes.dyn_into::<js_sys::Uint8Array>().map_err(|_| broken())?;
    match decode(bytes.to_vec())? {
        (Outcome::Problem(problem), _) => Err(problem),
        done => Ok(done),
    }
}

/// What orders for a subject are about.
fn about(subject: &Subject<'_>) -> Result<String, Problem> {
    let about = About { look: subject.look.clone(), recipe: subject.recipe };
    serde_json::to_string(&about).map_err(Problem::of)
}

impl End for Desk {
    fn begin(&self) -> Option<ImageSource> {
        lock(&self.uploaded).clone()
    }

    async fn say(&self, message: &Value) -> Result<(), Gone> {
        tell(&message.to_string());
        Ok(())
    }

    fn say_if_room(&self, message: &Value) {
        tell(&message.to_string());
    }

    async fn send(&self, bytes: Vec<u8>) -> Result<(), Gone> {
        show_picture(bytes);
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs_f64(now() / 1e3)
    }

    async fn wait(&self, what: impl Future<Output = ()>, patience: Duration) {
        let patience = JsFuture::from(pause(patience.as_millis() as u32));
        select(pin!(what), patience).await;
    }

    async fn picture(
        &self,
        subject: &Subject<'_>,
        wanted: Wanted,
        supervision: &Supervision<'_>,
    ) -> Result<Picture, Problem> {
        let about = about(subject)?;
        let height = subject.recipe.size[1];
        let tops: Vec<u32> = (0..height).step_by(BAND_ROWS as usize).collect();
        let next = AtomicU32::new(0);
        let done: Mutex<Vec<Option<Band>>> = Mutex::new(tops.iter().map(|_| None).collect());
        // Each hand takes the next band when it has done one; who is quick does more.
        let bands = join_all((0..self.hands).map(async |hand| {
            loop {
                let band = next.fetch_add(1, Ordering::Relaxed) as usize;
                let Some(top) = tops.get(band) else { return Ok(()) };
                if supervision.stop.load(Ordering::Relaxed) {
                    return Err(Problem::Stopped);
                }
                let rows = [*top, BAND_ROWS.min(height - top)];
                let work = Work::Rows(rows, wanted);
                let (Outcome::Picture(shape), numbers) = by(hand, &about, &work).await? else {
                    return Err(broken());
                };
                lock(&done)[band] = Some((shape, numbers));
                (supervision.rows_done)(rows[1].into());
            }
        }));
        bands.await.into_iter().collect::<Result<(), Problem>>()?;
        Ok(join(lock(&done).drain(..).flatten().collect()))
    }

    async fn times(&self, subject: &Subject<'_>) -> Result<Option<[f64; 2]>, Problem> {
        match self.by_one(&about(subject)?, &Work::Times).await? {
            (Outcome::Times(times), _) => Ok(times),
            _ => Err(broken()),
        }
    }

    async fn section(&self, subject: &Subject<'_>) -> Result<Value, Problem> {
        let about = about(subject)?;
        match self.by_one(&about, &Work::Section).await? {
            (Outcome::Section(section), _) => {
                *lock(&self.shown) = Some(about);
                Ok(section)
            }
            _ => Err(broken()),
        }
    }

    async fn survey(
        &self,
        subject: &Subject<'_>,
        supervision: &Supervision<'_>,
    ) -> Result<Survey, Problem> {
        if supervision.stop.load(Ordering::Relaxed) {
            return Err(Problem::Stopped);
        }
        match self.by_one(&about(subject)?, &Work::Survey).await? {
            (Outcome::Survey(survey), _) => Ok(survey),
            _ => Err(broken()),
        }
    }
}
