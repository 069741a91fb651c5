//! A worker that does what the leading one orders, one after the other.

use crate::order::{About, Outcome, Work, broken, encode, pack};
use cloakroom::photograph::ImageSource;
use cloakroom::render::{Images, PreparedScene, Supervision};
use cloakroom_viewer::end::{self, Problem};
use cloakroom_viewer::{Opened, Watched, rays, read_photograph};
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::atomic::AtomicBool;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// Sends what has come of an order.
    #[wasm_bindgen(js_name = handOver)]
    fn hand_over(ticket: u32, outcome: Vec<u8>);
}

/// What a hand is told.
enum Told {
    /// To do something.
    Order { ticket: u32, about: String, work: String },
    /// A photograph that the page has brought.
    Photograph { name: String, bytes: Vec<u8> },
}

/// What a hand is told and has not done yet, in its order.
type Queue = Watched<VecDeque<Told>>;

async fn next(queue: &Queue) -> Told {
    queue.until(VecDeque::pop_front).await
}

/// A hand.
#[wasm_bindgen]
pub struct Hand(Rc<Queue>);

#[wasm_bindgen]
impl Hand {
    /// One that begins to work.
    ///
    /// # Errors
    ///
    /// If the first scene cannot be read.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Result<Self, String> {
        let (opened, photograph) = crate::first()?;
        let queue = Rc::new(Queue::default());
        wasm_bindgen_futures::spawn_local(work(opened, photograph, queue.clone()));
        Ok(Self(queue))
    }

    /// Orders something.
    pub fn order(&self, ticket: u32, about: String, work: String) {
        self.0.change(|told| told.push_back(Told::Order { ticket, about, work }));
    }

    /// Hangs a photograph up, in the place of the one before.
    pub fn hang(&self, name: String, bytes: Vec<u8>) {
        self.0.change(|told| told.push_back(Told::Photograph { name, bytes }));
    }
}

async fn work(opened: Opened, photograph: ImageSource, queue: Rc<Queue>) {
    let mut images = Images::default();
    // While the page is set up: most scenes show it.
    let _ = images.photograph(&photograph);
    let mut own: Option<(ImageSource, Images)> = None;
    let mut told = next(&queue).await;
    loop {
        told = match told {
            Told::Photograph { name, bytes } => {
                // It has been read before, by the one who leads.
                let source = opened.source_of(&name);
                own = None;
                if let Ok((image, _)) = read_photograph(&source, &name, &bytes) {
                    let mut images = Images::default();
                    images.hang(source.clone(), image);
                    own = Some((source, images));
                }
                next(&queue).await
            }
            Told::Order { .. } => with_scene(&opened, (&mut images, &mut own), told, &queue).await,
        };
    }
}

/// Does all orders in a row that are about the same scene; what comes then.
async fn with_scene(
    opened: &Opened,
    (images, own): (&mut Images, &mut Option<(ImageSource, Images)>),
    first: Told,
    queue: &Queue,
) -> Told {
    let Told::Order { about: same, .. } = &first else { return first };
    let same = same.clone();
    let source = own.as_ref().map(|(source, _)| source.clone());
    let scene = serde_json::from_str(&same).map_err(|_| broken()).and_then(|about: About| {
        let read = opened.read(&about.look.scene, source.as_ref()).map_err(Problem::of)?;
        Ok((about.recipe, about.recipe.scene(&read.scene)))
    });
    let images = match (&scene, own) {
        (Ok((_, scene)), Some((source, own))) if *source == scene.photograph.image => own,
        _ => images,
    };
    let prepared = match &scene {
        Ok((recipe, scene)) => recipe.prepared(scene, images).map_err(Problem::from),
        Err(problem) => Err(problem.clone()),
    };
    let mut told = first;
    while let Told::Order { ticket, about, work } = &told
        && *about == same
    {
        let done = match &prepared {
            Ok(prepared) => done(prepared, images, work),
            Err(problem) => Err(problem.clone()),
        };
        let (outcome, numbers) =
            done.unwrap_or_else(|problem| (Outcome::Problem(problem), Vec::new()));
        hand_over(*ticket, encode(&outcome, &numbers));
        told = next(queue).await;
    }
    told
}

fn done(
    prepared: &PreparedScene<'_>,
    images: &mut Images,
    work: &str,
) -> Result<(Outcome, Vec<u8>), Problem> {
    // Who orders cancels between two orders, for nothing is heard during one.
    let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) };
    let outcome = match serde_json::from_str(work).map_err(|_| broken())? {
        Work::Rows(rows, wanted) => {
            return end::rows(prepared, rows, wanted, &supervision).map(|picture| pack(&picture));
        }
        Work::Times => Outcome::Times(end::times(prepared)),
        Work::Section => Outcome::Section(end::section(prepared)),
        Work::Survey => Outcome::Survey(end::survey(prepared, images, &supervision)?),
        Work::Ray(ray) => Outcome::Ray(rays(prepared, &ray)),
    };
    Ok((outcome, Vec::new()))
}
