//! The end of the protocol that the server is: the two threads of a page, which render and follow rays.

use crate::client::{Client, Outbox, Space, Uploaded};
use crate::end::{self, End, Gone, Problem, Subject, Survey, Wanted};
use crate::painter;
use crate::protocol::Ray;
use crate::ray_tree::rays;
use crate::slot::Slot;
use crate::watched::lock;
use cloakroom::output::Picture;
use cloakroom::photograph::ImageSource;
use cloakroom::render::{Images, PreparedScene, Supervision};
use cloakroom::scene::Scene;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde_json::Value;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What a page shows now, for rays to be sent through.
#[derive(Debug)]
pub(crate) struct Shown {
    /// The scene in the size of the full picture.
    scene: Scene,
    /// Its images.
    images: Images,
    /// What a photograph among them takes.
    _space: Option<Arc<Space>>,
}

/// Paints what a page wishes, until it is gone.
pub(crate) async fn paint(client: &Client, outbox: &Outbox) {
    let images = lock(&client.server.images).clone();
    // Of its own: the system shares the processors out among pages, and light that is trapped in the
    // device of one keeps no other waiting.
    let threads = ThreadPoolBuilder::new().num_threads(rayon::current_num_threads()).build();
    let studio = Studio {
        client,
        outbox,
        start: Instant::now(),
        threads: threads.ok(),
        walls: Mutex::new(Walls { images, own: None, of_look: None }),
    };
    painter::paint(&studio, &client.server.opened, &client.looks, &client.seen).await;
}

struct Studio<'a> {
    client: &'a Client,
    outbox: &'a Outbox,
    start: Instant,
    threads: Option<ThreadPool>,
    walls: Mutex<Walls>,
}

/// What hangs there for scenes to show.
struct Walls {
    images: Images,
    /// The images of the page's own photograph, and its number.
    own: Option<(u64, Images)>,
    /// That photograph, as the page had brought it when this look began: a scene must never look for a file of its name.
    of_look: Option<Uploaded>,
}

impl Studio<'_> {
    /// Does something with a scene, on all threads.
    fn with<T: Send>(
        &self,
        subject: &Subject<'_>,
        work: impl FnOnce(&PreparedScene<'_>, &mut Images, Option<Arc<Space>>) -> Result<T, Problem>
        + Send,
    ) -> Result<T, Problem> {
        let scene = subject.recipe.scene(subject.scene);
        let mut walls = lock(&self.walls);
        let Walls { images, own, of_look } = &mut *walls;
        let shown = of_look.as_ref().filter(|own| own.source == scene.photograph.image);
        let (images, space) = match shown {
            None => (images, None),
            Some(Uploaded { images, number, space, .. }) => {
                let known = own.take().filter(|(known, _)| known == number);
                let own = own.insert(known.unwrap_or_else(|| (*number, images.clone())));
                (&mut own.1, Some(space.clone()))
            }
        };
        let work = || work(&subject.recipe.prepared(&scene, images)?, images, space);
        match &self.threads {
            Some(threads) => threads.install(work),
            None => work(),
        }
    }
}

impl End for Studio<'_> {
    fn begin(&self) -> Option<ImageSource> {
        let uploaded = self.client.uploaded();
        let source = uploaded.as_ref().map(|uploaded| uploaded.source.clone());
        lock(&self.walls).of_look = uploaded;
        source
    }

    async fn say(&self, message: &Value) -> Result<(), Gone> {
        self.outbox.say(message).await
    }

    fn say_if_room(&self, message: &Value) {
        self.outbox.say_if_room(message);
    }

    async fn send(&self, bytes: Vec<u8>) -> Result<(), Gone> {
        self.outbox.send_bytes(bytes).await
    }

    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    async fn wait(&self, what: impl Future<Output = ()>, patience: Duration) {
        // Whether it has come or not, the work goes on.
        let _ = tokio::time::timeout(patience, what).await;
    }

    async fn picture(
        &self,
        subject: &Subject<'_>,
        wanted: Wanted,
        supervision: &Supervision<'_>,
    ) -> Result<Picture, Problem> {
        let all = [0, subject.recipe.size[1]];
        self.with(subject, |prepared, _, _| end::rows(prepared, all, wanted, supervision))
    }

    async fn times(&self, subject: &Subject<'_>) -> Result<Option<[f64; 2]>, Problem> {
        self.with(subject, |prepared, _, _| Ok(end::times(prepared)))
    }

    async fn section(&self, subject: &Subject<'_>) -> Result<Value, Problem> {
        self.with(subject, |prepared, images, space| {
            let (scene, images) = (prepared.scene.clone(), images.clone());
            *lock(&self.client.shown) = Some(Arc::new(Shown { scene, images, _space: space }));
            Ok(end::section(prepared))
        })
    }

    async fn survey(
        &self,
        subject: &Subject<'_>,
        supervision: &Supervision<'_>,
    ) -> Result<Survey, Problem> {
        self.with(subject, |prepared, images, _| end::survey(prepared, images, supervision))
    }
}

/// Follows rays until the slot is closed.
pub(crate) async fn follow(slot: &Slot<(Ray, Arc<Shown>)>, outbox: &Outbox) {
    let mut images = Images::default();
    let mut next = slot.take().await;
    while let Some((_, shown)) = next.clone() {
        images.clone_from(&shown.images);
        // The devices are built once for all points of one picture.
        let prepared = PreparedScene::with_images(&shown.scene, &mut images);
        while let Some((ray, same)) = &next
            && Arc::ptr_eq(same, &shown)
        {
            if let Ok(prepared) = &prepared
                && outbox.say(&rays(prepared, ray)).await.is_err()
            {
                return;
            }
            next = slot.take().await;
        }
    }
}
