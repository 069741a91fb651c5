//! The page of `cloakroom view`: invisibility cloaks to turn with one's own hands, served to
//! browsers on this machine and to nobody else.
//!
//! A browser loads the page (`assets`), opens one WebSocket, and says what it wants to look at
//! (`protocol`). Each page has a thread that renders (`painter`), coarsely at once and then better
//! (`pace`), and one that follows single rays (`ray_tree`). New wishes cancel stale work. A page
//! is opened by an address that holds a secret (`address`), and can name no file of this machine: the
//! images it may show are those of the program, of the scene
//! that was opened on the command line, and its own upload (`scenes`).

mod address;
mod assets;
mod catalogue;
mod client;
mod cross_section;
mod figures;
mod idle;
mod pace;
mod painter;
mod protocol;
mod ray_tree;
mod scenes;
mod seen;
mod server;
mod slot;
mod way_in;

pub use server::{Settings, ViewerError, serve};
pub use way_in::WayIn;
