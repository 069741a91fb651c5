//! The command line.

mod groups;
mod measuring;
mod values;

use clap::builder::PossibleValuesParser;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use cloakroom::render::{Delay, Flash, Gate, Tile};
use cloakroom::scene::OPTIONAL_CHANNELS;
use cloakroom::scene_file::Override;
pub use groups::{listed, wrapped};
pub use measuring::*;
use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;
pub use values::PulseTimes;
use values::{exposure, frames_only, map_range, pixel, pulse, size};

/// What stands below the help of a command: how it is used first.
macro_rules! example {
    ($words:literal) => {
        concat!("Example:\n  cloakroom ", $words)
    };
}

/// Photorealistic, physically exact pictures of invisibility cloaks.
#[derive(Debug, Parser)]
#[command(name = "cloakroom", version = env!("CLOAKROOM_VERSION"), about, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to pictures and data.
    #[command(after_help = example!("render gallery/luneburg-lens --size 640x480 -o lens.png"))]
    Render(RenderArguments),
    /// Put tiles that `render --tile` has written together: the picture as if it had been rendered
    /// whole.
    #[command(after_help = example!("merge top.npz bottom.npz -o whole.exr"))]
    Merge(MergeArguments),
    /// Make a film of a scene while keys of it change: GIF, animated PNG or WebP, MP4, WebM, or a
    /// folder of frames.
    #[command(after_help = example!("animate scene.toml --sweep device.0.rotation=0..360 --frames 120 -o turn.gif"))]
    Animate(AnimateArguments),
    /// Film light in flight: what a camera with a time gate sees when the photograph flashes.
    #[command(after_help = example!("flight paper/fig2c --size 320x240 -o pulses.gif"))]
    Flight(FlightArguments),
    /// Validate a scene and print facts and an estimate of the time, without rendering.
    #[command(after_help = example!("check scene.toml --set camera.samples=16"))]
    Check(CheckArguments),
    /// Trace given rays through a scene; JSON in, JSON out.
    #[command(after_help = example!("trace scene.toml --rays rays.json"))]
    Trace(TraceArguments),
    /// List the pulses in which a short flash of the photograph arrives at one pixel.
    #[command(after_help = example!("pulses scene.toml --pixel 512,384"))]
    Pulses(PulsesArguments),
    /// Solve interfaces between media, or of a medium and metal; JSON in, JSON out.
    #[command(after_help = example!("interface interfaces.json"))]
    Interface {
        /// The interfaces: a JSON file, or - for standard input.
        interfaces: PathBuf,
    },
    /// Make the figures of Halimeh & Wegener, Opt. Express 21, 9457 (2013): the setting (1) and the
    /// pictures (2-9); what is drawn as PNG, SVG and PDF.
    #[command(after_help = example!("figures --only 6,8c --size 640x480"))]
    Figures(FiguresArguments),
    /// Make a picture and a map of times of flight of every device, and the table of them all.
    #[command(after_help = example!("gallery --only eaton-lens,prisms"))]
    Gallery(GalleryArguments),
    /// Measure how much light comes through to a plane behind the devices, for nothing, bare metal
    /// and the cloak.
    #[command(after_help = example!("flux flux/solar-cell -o angles.svg"))]
    Flux(FluxArguments),
    /// Draw a ray diagram of a scene, or its setting, as SVG, PDF or PNG, or a film of a pulse on its way through it.
    #[command(after_help = example!("diagram scene.toml -o rays.svg"))]
    Diagram(DiagramArguments),
    /// Write what a device is made of, for fabrication and full-wave solvers: its index and tensors
    /// on a grid, or its segments as a table; or the outlines of devices as meshes, STL or glTF.
    #[command(after_help = example!("export scene.toml --grid 200x200x1 -o device.vti"))]
    Export(ExportArguments),
    /// Compare two pictures: correlation, structural similarity, FLIP, times of flight, power.
    #[command(after_help = example!("compare empty.npz cloaked.npz"))]
    Compare(CompareArguments),
    /// Measure how well a scene's devices work over a range of settings: a table, data and a plot.
    #[command(after_help = example!("quality scene.toml --sweep device.0.rotation=0..90:5 -o turned.csv"))]
    Quality(QualityArguments),
    /// Go through the statements of the paper, one by one: what comes out here, and a verdict
    /// (Markdown).
    #[command(after_help = example!("verify > verdicts.md"))]
    Verify(VerifyArguments),
    /// Open a page in the browser, served on this machine alone, on which devices can be turned and
    /// changed.
    #[command(after_help = example!("view scene.toml"))]
    View(ViewArguments),
    /// List the devices with their keys, limits, defaults and computed facts, or one of them.
    #[command(after_help = example!("devices square-cloak"))]
    Devices {
        /// The kind of a device: all its keys, those of tables in it included.
        kind: Option<String>,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// List the materials that come with the program, or the indices of one: n, k and the group
    /// index.
    #[command(after_help = example!("materials bk7 --at 400..700:50"))]
    Materials(MaterialsArguments),
    /// List the example scenes, or copy them.
    #[command(after_help = example!("scenes --out scenes"))]
    Scenes(ScenesArguments),
    /// Print the JSON Schema of scene files, for editors, or the same as a page to read.
    #[command(after_help = example!("schema > scene.schema.json"))]
    Schema {
        /// Print a page in Markdown.
        #[arg(long)]
        markdown: bool,
    },
    /// Print completions of the command line for a shell.
    #[command(after_help = example!("completions bash > cloakroom.bash"))]
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print a manual page, as in `cloakroom manual render | man -l -`, or write them all.
    #[command(after_help = example!("manual render"))]
    Manual(ManualArguments),
}

/// Which material, and where.
#[derive(Args, Debug)]
pub struct MaterialsArguments {
    /// A material, or a file of the refractiveindex.info database (.yml).
    pub name: Option<String>,
    /// Wavelengths in nm, as in 400..700:50 or 488,590.
    #[arg(long = "at", value_name = "NM", requires = "name")]
    pub wavelengths: Option<String>,
    /// Plot the indices into a file: SVG, PDF or PNG by its ending; may be repeated.
    #[arg(long = "plot", value_name = "FILE", requires = "name")]
    pub plots: Vec<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// A scene and what is changed in it.
#[derive(Args, Debug)]
#[command(next_help_heading = "Scene")]
pub struct SceneArguments {
    /// The scene: a file (TOML), - for standard input, or an example (`cloakroom scenes`), as in
    /// gallery/prisms.
    #[arg(help_heading = None::<&'static str>)]
    pub scene: PathBuf,
    /// Override a key of the scene, as in camera.samples=16, device.0.rotation=5 or, of every
    /// device, device.*.rotation=5.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<Override>,
}

/// The picture of a scene, with its devices or without.
#[derive(Args, Debug)]
#[command(next_help_heading = "Picture")]
pub struct PictureArguments {
    /// How it is made.
    #[command(flatten)]
    pub format: FormatArguments,
    /// Take every device away: the empty view.
    #[arg(long)]
    pub empty: bool,
}

/// The format of a picture, in short; `--set` of the same key goes before.
#[derive(Args, Debug)]
#[command(next_help_heading = "Picture")]
pub struct FormatArguments {
    /// Size of the picture in pixels (camera.resolution).
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// Samples per pixel (camera.samples).
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub samples: Option<u32>,
    /// Another photograph, PNG, JPEG or EXR (photograph.image).
    #[arg(long, value_name = "FILE")]
    pub photo: Option<PathBuf>,
}

/// Arguments of `check`.
#[derive(Args, Debug)]
pub struct CheckArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Its picture.
    #[command(flatten)]
    pub picture: PictureArguments,
}

/// How many threads work.
#[derive(Args, Debug)]
#[command(next_help_heading = "Work")]
pub struct ThreadsArguments {
    /// Number of threads; all cores if absent.
    #[arg(long = "threads", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub count: Option<u16>,
}

/// Arguments of `render`.
#[derive(Args, Debug)]
pub struct RenderArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Its picture.
    #[command(flatten)]
    pub picture: PictureArguments,
    /// A file to write; its ending decides: .png, .exr or .npz, for a map (picture.map) also .svg
    /// or .pdf. May be given several times [default: the name of the scene with .png, beside it].
    #[arg(short, long = "output", value_name = "FILE", help_heading = "Files")]
    pub outputs: Vec<PathBuf>,
    /// More channels for .exr and .npz files, as in stokes,first_face_reflectance
    /// (`picture.channels`).
    #[arg(long, help_heading = "Files", value_name = "LIST", value_delimiter = ',', value_parser = PossibleValuesParser::new(OPTIONAL_CHANNELS))]
    pub channels: Vec<String>,
    /// Render this part of the picture alone, in pixels from the top left: other machines may
    /// render the others, and `merge` puts them together. Tiles are .npz or .png; even edges save
    /// work.
    #[arg(long, help_heading = "Work", value_name = "LEFT,TOP,WIDTH,HEIGHT", requires = "outputs")]
    pub tile: Option<Tile>,
    /// Keep what is finished beside the first file, in a folder of its name and .strips, until all of
    /// them are written, and go on with what a stopped run has kept there.
    #[arg(long, help_heading = "Work", conflicts_with = "tile")]
    pub resume: bool,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `merge`.
#[derive(Args, Debug)]
pub struct MergeArguments {
    /// The tiles, all .npz or all .png; they must cover the picture and not overlap.
    #[arg(required = true)]
    pub tiles: Vec<PathBuf>,
    /// A file to write; its ending decides: .png, .exr or .npz, for a map also .svg or .pdf; .png
    /// alone where the tiles are .png. May be given several times.
    #[arg(short, long = "output", value_name = "FILE", required = true)]
    pub outputs: Vec<PathBuf>,
}

/// The heading of what changes in a film.
const CHANGES: &str = "Changes";

/// Arguments of `animate`.
#[derive(Args, Debug)]
#[command(group(ArgGroup::new("changes").required(true).multiple(true)))]
pub struct AnimateArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Its pictures.
    #[command(flatten)]
    pub picture: PictureArguments,
    /// A key and its way, spread evenly over the frames, as in device.0.rotation=0..360, there and
    /// back, 0..25..0, or camera.position=[-100,0,0]..[-50,20,0]; or a value a frame, as in 0..90:5
    /// or 1,2,4. May be given several times: the keys change together.
    #[arg(long = "sweep", value_name = "KEY=START..END", help_heading = CHANGES, group = "changes")]
    pub sweeps: Vec<String>,
    /// The camera goes round its target, degrees about camera.up, counterclockwise from above: 0..360,
    /// or there and back, -20..20..-20; 0 is where it stands.
    #[arg(long, value_name = "START..END", help_heading = CHANGES, group = "changes", allow_hyphen_values = true)]
    pub orbit: Option<String>,
    /// Keys of the scene at some frames, and smooth ways between them: a file of tables [[keyframe]],
    /// each with its `frame`, as in frame = 50 and camera.position = [-80, 20, 0].
    #[arg(long, value_name = "FILE", help_heading = CHANGES, group = "changes")]
    pub keyframes: Option<PathBuf>,
    /// How many frames [default: as many as there are values or keyframes say].
    #[arg(long, value_name = "N", help_heading = CHANGES)]
    pub frames: Option<usize>,
    /// The file to write; its ending decides: .gif, .apng, .png, .webp, .mp4 or .webm (with
    /// ffmpeg), or none for a folder of frames.
    #[arg(short, long, value_name = "FILE", help_heading = "Files")]
    pub output: PathBuf,
    /// Frames a second.
    #[arg(long, help_heading = "Files", value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub fps: u32,
    /// Render only these frames, the first being 0, into the folder of frames, and make no film: a
    /// part of a job that is shared.
    #[arg(long, help_heading = "Work", value_name = "FIRST..LAST", value_parser = frames_only)]
    pub frames_only: Option<[usize; 2]>,
    /// Keep the folder of frames beside the film.
    #[arg(long, help_heading = "Files")]
    pub keep_frames: bool,
    /// The range of a map's colors (`picture.map`), in ns for times and as shares for powers.
    #[arg(long, help_heading = "Picture", value_name = "LOW,HIGH", allow_hyphen_values = true, value_parser = map_range)]
    pub map_range: Option<[f64; 2]>,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// The heading of when light arrives.
const TIME: &str = "Time";

/// Which time of light counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FlightDelay {
    /// What a pulse takes.
    Group,
    /// What the phase takes, as in the paper.
    Phase,
}

impl From<FlightDelay> for Delay {
    fn from(delay: FlightDelay) -> Self {
        match delay {
            FlightDelay::Group => Self::Group,
            FlightDelay::Phase => Self::Phase,
        }
    }
}

/// Arguments of `flight`.
#[derive(Args, Debug)]
pub struct FlightArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Its picture.
    #[command(flatten)]
    pub picture: PictureArguments,
    /// When the gate is open: the middles of the first and the last bin of time, ns after the flash,
    /// and how long each is, as in 5.0..5.4:0.005 [default: about 120 bins that hold what arrives].
    #[arg(long, value_name = "START..END:STEP", help_heading = TIME, allow_hyphen_values = true)]
    pub gate: Option<Gate>,
    /// How long the flash is at half its height, ns, of the shape cos².
    #[arg(long, value_name = "NS", help_heading = TIME, default_value_t = 0.0, value_parser = pulse)]
    pub pulse: f64,
    /// Which time counts.
    #[arg(long, value_name = "TIME", help_heading = TIME, default_value = "group")]
    pub delay: FlightDelay,
    /// What flashes: the whole photograph at once; where a plane wave along a direction comes to it,
    /// plane:DX,DY,DZ; where light from a point does, point:X,Y,Z; or a spot of a laser on it alone,
    /// spot:X,Y,Z,RADIUS in cm.
    #[arg(long, value_name = "WHAT", help_heading = TIME, default_value = "photograph")]
    pub flash: Flash,
    /// Show all light up to the time of a frame, and not what arrives in it alone.
    #[arg(long, help_heading = "Film")]
    pub accumulate: bool,
    /// How bright the flash is: 1 as the picture.
    #[arg(long, value_name = "X", help_heading = "Film", default_value_t = 1.0, value_parser = exposure)]
    pub exposure: f64,
    /// Frames a second.
    #[arg(long, help_heading = "Film", value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub fps: u32,
    /// Keep the folder of frames beside the film.
    #[arg(long, help_heading = "Files")]
    pub keep_frames: bool,
    /// A file to write; its ending decides: .npz for arrays, .gif, .apng, .png, .webp, .mp4 or .webm (with
    /// ffmpeg) for a film, none for a folder of frames. May be given several times.
    #[arg(short, long = "output", value_name = "FILE", help_heading = "Files", required = true)]
    pub outputs: Vec<PathBuf>,
    /// Order the arrays of .npz as mitransient does: (height, width, time, color).
    #[arg(long, help_heading = "Files")]
    pub time_last: bool,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `trace`.
#[derive(Args, Debug)]
pub struct TraceArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// The rays: a JSON file, or - for standard input.
    #[arg(long, value_name = "FILE")]
    pub rays: PathBuf,
    /// Add leaves of one direction as fields, as light of the scene's wavelength and bandwidth does
    /// in the far field.
    #[arg(long)]
    pub coherent: bool,
    /// Give `group_path` for each leaf, too: the speed of light times what a pulse takes, cm.
    #[arg(long)]
    pub group_delay: bool,
    /// Prune branches below this share of the launched power [default: the scene's, else 1e-9, with
    /// --coherent 1e-24].
    #[arg(long, value_name = "P")]
    pub min_power: Option<f64>,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `pulses`.
#[derive(Args, Debug)]
pub struct PulsesArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// The pixel, counted from 0,0 at the top left; the ray through its middle is followed.
    #[arg(long, value_name = "COLUMN,ROW", value_parser = pixel)]
    pub pixel: [u32; 2],
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `figures`.
#[derive(Args, Debug)]
pub struct FiguresArguments {
    /// Only these figures or panels, as in 6,8c.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub only: Vec<String>,
    /// The folder for the pictures.
    #[arg(long, value_name = "DIR", default_value = "figures")]
    pub out: PathBuf,
    /// How they are made.
    #[command(flatten)]
    pub panels: PanelArguments,
}

/// Arguments of `gallery`.
#[derive(Args, Debug)]
pub struct GalleryArguments {
    /// Only these exhibits, as in eaton-lens,prisms.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub only: Vec<String>,
    /// The folder for the pictures.
    #[arg(long, value_name = "DIR", default_value = "gallery")]
    pub out: PathBuf,
    /// How they are made.
    #[command(flatten)]
    pub panels: PanelArguments,
}

/// What changes in the scenes that the program carries along.
#[derive(Args, Debug)]
#[command(next_help_heading = "Picture")]
pub struct PanelArguments {
    /// Another photograph (PNG, JPEG or EXR).
    #[arg(long, value_name = "FILE")]
    pub photo: Option<PathBuf>,
    /// Size of a panel in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    pub size: [u32; 2],
    /// Samples per pixel.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub samples: u32,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `view`.
#[derive(Args, Debug)]
pub struct ViewArguments {
    /// The scene to begin with: a file (TOML) or an example, as in gallery/prisms [default: cloak
    /// (iii) of the paper].
    pub scene: Option<PathBuf>,
    /// Override a key of the scene, as in device.0.rotation=5.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<Override>,
    /// The port on this machine; the next free one if it is taken, any free one if 0.
    #[arg(long, value_name = "N", default_value_t = 8420)]
    pub port: u16,
    /// Show the page to others on a network, too: the address of this machine there, as in 192.168.1.20. Whoever has
    /// the link that is printed can open it.
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST), hide_default_value = true)]
    pub host: IpAddr,
    /// Do not open the browser; the address is printed.
    #[arg(long)]
    pub no_open: bool,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `scenes`.
#[derive(Args, Debug)]
pub struct ScenesArguments {
    /// Only these files or folders, as in shop-window,gallery.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Copy them into this folder.
    #[arg(long, value_name = "DIR", conflicts_with = "json")]
    pub out: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `manual`.
#[derive(Args, Debug)]
pub struct ManualArguments {
    /// The command [default: all of them in short].
    pub command: Option<String>,
    /// Write a page for each command into this folder.
    #[arg(long, value_name = "DIR", conflicts_with = "command")]
    pub out: Option<PathBuf>,
}
