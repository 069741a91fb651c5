//! The page of `cloakroom view`: invisibility cloaks to turn with one's own hands, served to
//! browsers on this machine and to nobody else; or computing by itself, from a folder of any web server.
//!
//! A browser loads the page (`assets`) and says what it wants to look at (`protocol`): to the server, by a
//! WebSocket, or to a worker of its own. These are the two ends (`end`) of one protocol. What is asked for is
//! rendered (`painter`), coarsely at once and then better
//! (`pace`), and single rays are followed (`ray_tree`). New wishes cancel stale work.
//!
//! The server, with the feature of that name, has a thread for each of the two (`studio`). Its page
//! is opened by an address that holds a secret (`address`), and can name no file of this machine: the
//! images it may show are those of the program, of the scene
//! that was opened on the command line, and its own upload (`scenes`).

mod catalogue;
mod cross_section;
pub mod end;
mod figures;
mod pace;
mod painter;
mod protocol;
mod ray_tree;
mod scenes;
mod seen;
mod session;
mod slot;
mod watched;

#[cfg(feature = "server")]
mod address;
#[cfg(feature = "server")]
mod assets;
#[cfg(feature = "server")]
mod client;
#[cfg(feature = "server")]
mod idle;
#[cfg(feature = "server")]
mod server;
#[cfg(feature = "server")]
mod studio;
#[cfg(feature = "server")]
mod way_in;

pub use catalogue::greeting;
pub use painter::{Wish, paint};
pub use protocol::{Look, Ray, SceneTables, error};
pub use ray_tree::rays;
pub use scenes::Opened;
pub use seen::Seen;
#[cfg(feature = "server")]
pub use server::{Settings, ViewerError, serve};
pub use session::{Heard, Session, nothing_shown, read_photograph};
pub use slot::Slot;
pub use watched::{Watched, lock};
#[cfg(feature = "server")]
pub use way_in::WayIn;
