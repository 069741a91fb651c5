//! The server: the page's files, and one WebSocket a page.

use crate::address::{Names, Secret, listen};
use crate::assets::ASSETS;
use crate::catalogue::greeting;
use crate::client;
use crate::idle::{Attentive, Standing};
use crate::protocol::{LARGEST_PHOTOGRAPH, LONGEST_TEXT};
use crate::scenes::Opened;
use crate::watched::lock;
use axum::Router;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{ConnectInfo, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, Uri, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use axum::serve::ListenerExt;
use cloakroom::render::{Images, PreparedScene};
use cloakroom::scene::Scene;
use cloakroom::scene_file::Loaded;
use std::net::IpAddr;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::{Semaphore, watch};

/// Most pages open at once: of those who use this machine, and of a class.
const MOST_PAGES: usize = 10;
const MOST_PAGES_OF_A_CLASS: usize = 40;

/// How often the server looks whether it is to end.
const LOOK: Duration = Duration::from_millis(50);

/// How long the end may take.
const PATIENCE: Duration = Duration::from_secs(2);

/// What a browser may do with the page: load what comes from here, and nothing else.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What is served, and where.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The scene that pages begin with.
    pub scene: Loaded,
    /// What it is called.
    pub name: String,
    /// The folder that names of files in it are relative to.
    pub folder: PathBuf,
    /// The address of this machine to listen on: loopback, or one under which others on its network reach it.
    pub host: IpAddr,
    /// The port; the next free one is taken if it is not free. 0 stands for any.
    pub port: u16,
}

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
pub enum ViewerError {
    /// Not one address, but all of them at once.
    #[error(
        "--host takes one address of this machine, not {0}, which stands for all of them: `ip address`, or `ipconfig`, says which it has"
    )]
    AllAddresses(IpAddr),
    /// No port is free, or the address is none of this machine's.
    #[error("cannot listen on port {port} of {host} or on one of the next: {reason}")]
    Listen {
        /// The address asked for.
        host: IpAddr,
        /// The port asked for.
        port: u16,
        /// Why not.
        reason: std::io::Error,
    },
    /// The server cannot run.
    #[error("cannot start the server: {0}")]
    Run(std::io::Error),
    /// The scene cannot be shown to pages.
    #[error("{0}")]
    Scene(String),
}

/// What all pages share.
#[derive(Debug)]
pub(crate) struct Server {
    pub opened: Opened,
    /// The greeting, as JSON.
    pub greeting: String,
    /// Images that have been read.
    pub images: Mutex<Images>,
    /// Held while a photograph is read.
    pub reading: Mutex<()>,
    /// Pixels of the photographs that pages have brought.
    pub uploaded_pixels: AtomicU64,
    /// Tells pages that the server ends.
    pub closing: watch::Sender<()>,
    pages: Arc<Semaphore>,
    most_pages: usize,
    /// Whether it is reached from this machine alone.
    is_local: bool,
    names: Names,
    secret: Secret,
}

/// Serves the page on this machine, or on the network of the address given, until `stop` is set. `ready` is told the address once it can be
/// opened.
///
/// # Errors
///
/// If no port is free, or the server cannot run.
pub fn serve(
    settings: &Settings,
    ready: impl FnOnce(&str),
    stop: &'static AtomicBool,
) -> Result<(), ViewerError> {
    let opened = Opened::new(&settings.scene, &settings.name, &settings.folder)
        .map_err(ViewerError::Scene)?;
    let (host, port) = (settings.host, settings.port);
    // Under which names it may be asked would not be known.
    if host.is_unspecified() {
        return Err(ViewerError::AllAddresses(host));
    }
    let listener =
        listen(host, port).map_err(|reason| ViewerError::Listen { host, port, reason })?;
    listener.set_nonblocking(true).map_err(ViewerError::Run)?;
    let address = listener.local_addr().map_err(ViewerError::Run)?;
    let most_pages = if host.is_loopback() { MOST_PAGES } else { MOST_PAGES_OF_A_CLASS };
    let server = Arc::new(Server {
        greeting: greeting(&opened).to_string(),
        opened,
        images: Mutex::default(),
        reading: Mutex::default(),
        uploaded_pixels: AtomicU64::new(0),
        closing: watch::Sender::new(()),
        pages: Arc::new(Semaphore::new(most_pages)),
        most_pages,
        is_local: host.is_loopback(),
        names: Names::of(address),
        secret: Secret::new().map_err(ViewerError::Run)?,
    });
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_io()
        .enable_time()
        .build()
        .map_err(ViewerError::Run)?;
    read_images(&settings.scene.scene, &server);
    let served = runtime.block_on(async {
        // A picture that waits for the page to confirm the last bytes of the one before would wait
        // 40 ms.
        let listener = tokio::net::TcpListener::from_std(listener)?;
        let listener = Attentive::new(listener.tap_io(|stream| {
            // If it cannot be had, pages are slower.
            let _ = stream.set_nodelay(true);
        }));
        let app = Router::new()
            .route("/{secret}/session", get(session))
            .fallback(get(asset))
            .layer(from_fn_with_state(server.clone(), guard))
            .with_state(server.clone())
            .into_make_service_with_connect_info::<Standing>();
        ready(&format!("http://{address}/{}/", server.secret.digits()));
        let closing = server.clone();
        let end = async move {
            stopped(stop).await;
            closing.closing.send_replace(());
        };
        let ended = async {
            stopped(stop).await;
            tokio::time::sleep(PATIENCE).await;
        };
        tokio::select! {
            served = axum::serve(listener, app).with_graceful_shutdown(end) => served,
            () = ended => Ok(()),
        }
    });
    runtime.shutdown_timeout(PATIENCE);
    served.map_err(ViewerError::Run)
}

/// Waits until the server is to end.
async fn stopped(stop: &AtomicBool) {
    while !stop.load(Ordering::Relaxed) {
        tokio::time::sleep(LOOK).await;
    }
}

/// Reads the images of the first scene while the browser opens.
fn read_images(scene: &Scene, server: &Arc<Server>) {
    let (scene, server) = (scene.clone(), server.clone());
    std::thread::spawn(move || {
        let mut images = lock(&server.images);
        // The page is told what is wrong with the scene, if anything is.
        let _ = PreparedScene::with_images(&scene, &mut images);
    });
}

/// Refuses who does not come to this server by its name and its secret, and says what browsers may
/// do.
async fn guard(
    State(server): State<Arc<Server>>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    request: Request,
    next: Next,
) -> Response {
    let refuse = |words: &'static str| (StatusCode::FORBIDDEN, words).into_response();
    let mut response = if !server.names.host_is_ours(request.headers()) {
        refuse("this server answers to its own address alone\n")
    } else if server.secret.path_within(request.uri().path()).is_none() {
        refuse("open the whole address, as `cloakroom view` has printed it\n")
    } else {
        standing.introduce();
        next.run(request).await
    };
    // Browsers warn of one of them where the line is not theirs alone.
    let openers = (header::HeaderName::from_static("cross-origin-opener-policy"), "same-origin");
    let openers = server.is_local.then_some(openers);
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
        (header::HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    ]
    .into_iter()
    .chain(openers)
    {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

/// One of the page's files, by its path within the secret folder.
async fn asset(State(server): State<Arc<Server>>, uri: Uri) -> Response {
    let asked = server.secret.path_within(uri.path());
    match ASSETS.iter().find(|(path, ..)| Some(*path) == asked) {
        Some((_, kind, bytes)) => ([(header::CONTENT_TYPE, *kind)], *bytes).into_response(),
        None => (StatusCode::NOT_FOUND, "there is no such page\n").into_response(),
    }
}

/// Opens the WebSocket of a page, if it is ours and there is room.
async fn session(
    State(server): State<Arc<Server>>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    if !server.names.origin_is_ours(&headers) {
        return (StatusCode::FORBIDDEN, "only this server's own page may do that\n")
            .into_response();
    }
    let Ok(place) = server.pages.clone().try_acquire_owned() else {
        let message = format!("{} pages are open already; close one\n", server.most_pages);
        return (StatusCode::SERVICE_UNAVAILABLE, message).into_response();
    };
    let largest = LARGEST_PHOTOGRAPH.max(LONGEST_TEXT);
    upgrade.max_message_size(largest).max_frame_size(largest).on_upgrade(async move |socket| {
        client::serve(socket, server).await;
        drop(place);
    })
}
