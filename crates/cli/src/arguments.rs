//! The command line.

mod values;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use cloakroom::material::Resolution;
use cloakroom::measure::STANDARD_PLOT;
use cloakroom::render::Tile;
use cloakroom::scene::OPTIONAL_CHANNELS;
use std::path::PathBuf;
use values::{angles, frames_only, grid, map_range, pixel, point, range, rectangle, size};

/// Photorealistic, physically exact pictures of invisibility cloaks.
#[derive(Debug, Parser)]
#[command(version, about, arg_required_else_help = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to pictures and data.
    Render(RenderArguments),
    /// Put tiles that `render --tile` has written together: the picture as if it had been rendered whole.
    Merge(MergeArguments),
    /// Make a film of a scene while keys of it change: GIF, animated PNG or WebP, MP4, WebM, or a folder of frames.
    Animate(AnimateArguments),
    /// Validate a scene and print facts and an estimate of the time, without rendering.
    Check(SceneArguments),
    /// Trace given rays through a scene; JSON in, JSON out.
    Trace(TraceArguments),
    /// List the pulses in which a short flash of the photograph arrives at one pixel.
    Pulses(PulsesArguments),
    /// Solve interfaces between media, or of a medium and metal; JSON in, JSON out.
    Interface(InterfaceArguments),
    /// Make the figures of Halimeh & Wegener, Opt. Express 21, 9457 (2013): the setting (1), drawn as
    /// PNG and SVG, and the pictures (2-9).
    Figures(FiguresArguments),
    /// Make a picture and a map of times of flight of every device, and the table of them all.
    Gallery(GalleryArguments),
    /// Measure how much light comes through to a plane behind the devices, for nothing, bare metal and the cloak.
    Flux(FluxArguments),
    /// Draw a ray diagram of a scene, or its setting, as SVG or PNG.
    Diagram(DiagramArguments),
    /// Write what a device is made of, for fabrication and full-wave solvers: its index and tensors on a grid,
    /// or its segments as a table.
    Export(ExportArguments),
    /// Compare two pictures: correlation, structural similarity, FLIP, times of flight, power.
    Compare(CompareArguments),
    /// Measure how well a scene's devices work over a range of settings: a table, data and a plot.
    Quality(QualityArguments),
    /// Go through the statements of the paper, one by one: what comes out here, and a verdict (Markdown).
    Verify(VerifyArguments),
    /// Open a page in the browser, served on this machine alone, on which devices can be turned and changed.
    View(ViewArguments),
    /// List the devices with their keys and computed facts.
    Devices(DevicesArguments),
    /// Print the JSON Schema of scene files, for editors.
    Schema,
}

/// A scene and what is changed in it.
#[derive(Args, Debug)]
pub struct SceneArguments {
    /// The scene file (TOML).
    pub scene: PathBuf,
    /// Override a key of the scene, as in camera.samples=16 or device.0.rotation=5.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
}

/// Arguments of `render`.
#[derive(Args, Debug)]
pub struct RenderArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A file to write; its ending decides: .png, .exr or .npz. May be given several times.
    #[arg(short, long = "output", value_name = "FILE", required = true)]
    pub outputs: Vec<PathBuf>,
    /// More channels for .exr and .npz files, as in stokes,first_face_reflectance (`picture.channels`).
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = PossibleValuesParser::new(OPTIONAL_CHANNELS))]
    pub channels: Vec<String>,
    /// Render this part of the picture alone, in pixels from the top left: other machines may render the others, and
    /// `merge` puts them together. Tiles are .npz or .png; even edges save work.
    #[arg(long, value_name = "LEFT,TOP,WIDTH,HEIGHT")]
    pub tile: Option<Tile>,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// Arguments of `merge`.
#[derive(Args, Debug)]
pub struct MergeArguments {
    /// The tiles, all .npz or all .png; they must cover the picture and not overlap.
    #[arg(required = true)]
    pub tiles: Vec<PathBuf>,
    /// A file to write; its ending decides: .png, .exr or .npz; .png alone where the tiles are .png. May be given several
    /// times.
    #[arg(short, long = "output", value_name = "FILE", required = true)]
    pub outputs: Vec<PathBuf>,
}

/// Arguments of `animate`.
#[derive(Args, Debug)]
pub struct AnimateArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A key and its way, spread evenly over the frames, as in device.0.rotation=0..360 or, there and back, 0..25..0;
    /// or a value a frame, as in 0..90:5 or 1,2,4. May be given several times: the keys change together.
    #[arg(long = "sweep", value_name = "KEY=START..END", required = true)]
    pub sweeps: Vec<String>,
    /// How many frames.
    #[arg(long, value_name = "N")]
    pub frames: Option<usize>,
    /// The file to write; its ending decides: .gif, .apng, .png, .webp, .mp4 or .webm (with ffmpeg), or none for a
    /// folder of frames.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Frames a second.
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub fps: u32,
    /// Render only these frames, the first being 0, into the folder of frames, and make no film: a part of a job
    /// that is shared.
    #[arg(long, value_name = "FIRST..LAST", value_parser = frames_only)]
    pub frames_only: Option<[usize; 2]>,
    /// Keep the folder of frames beside the film.
    #[arg(long)]
    pub keep_frames: bool,
    /// The range of a map's colors (`picture.map`), in ns for times and as shares for powers.
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, value_parser = map_range)]
    pub map_range: Option<[f64; 2]>,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
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
    /// Prune branches below this share of the launched power [default: the scene's, else 1e-9].
    #[arg(long, value_name = "P")]
    pub min_power: Option<f64>,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
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

/// Arguments of `interface`.
#[derive(Args, Debug)]
pub struct InterfaceArguments {
    /// The interfaces: a JSON file, or - for standard input.
    pub interfaces: PathBuf,
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
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// Arguments of `flux`.
#[derive(Args, Debug)]
pub struct FluxArguments {
    /// The scene; its [receiver] is the plane.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A file to write: data as .csv or .npz, a plot over the directions as .svg or .png. May be given several
    /// times; the totals are printed.
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,
    /// A file for a map of the receiver, .svg or .png.
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Angles of incidence in the plane across z, degrees.
    #[arg(long, value_name = "FROM..TO:STEP", allow_hyphen_values = true, default_value = "-60..60:10", value_parser = range, conflicts_with = "sun")]
    pub angles: [f64; 3],
    /// Tilt the light towards z, degrees.
    #[arg(
        long,
        value_name = "DEGREES",
        allow_hyphen_values = true,
        default_value_t = 0.0,
        conflicts_with = "sun"
    )]
    pub tilt: f64,
    /// The sun over a day instead, from that latitude and with that declination (degrees; 23.44 at midsummer): the
    /// receiver lies flat, z points north.
    #[arg(long, value_name = "LATITUDE,DECLINATION", allow_hyphen_values = true, value_parser = angles)]
    pub sun: Option<[f64; 2]>,
    /// Rays in each of the independent samples.
    #[arg(long, value_name = "N", default_value_t = 4096)]
    pub rays: u32,
    /// Independent samples, from which the errors come.
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub samples: u32,
    /// Cells of the map across the receiver.
    #[arg(long, value_name = "N", default_value_t = 60)]
    pub cells: u32,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// Arguments of `compare`.
#[derive(Args, Debug)]
pub struct CompareArguments {
    /// The picture to compare with, .npz, .exr or .png: what should be seen.
    pub first: PathBuf,
    /// The picture to be judged.
    pub second: PathBuf,
    /// Compare also what is white in this picture (.png, .exr or .npz).
    #[arg(long, value_name = "FILE")]
    pub mask: Option<PathBuf>,
    /// Compare also this rectangle: left column, top row, width and height in pixels.
    #[arg(long, value_name = "X,Y,W,H", conflicts_with = "mask", value_parser = rectangle)]
    pub region: Option<Rectangle>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// Arguments of `quality`.
#[derive(Args, Debug)]
pub struct QualityArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A key and its values, as in device.0.rotation=0..90:5 or camera.polarizer=horizontal,vertical. May be
    /// given several times: every combination is measured.
    #[arg(long = "sweep", value_name = "KEY=VALUES", required = true)]
    pub sweeps: Vec<String>,
    /// A key of a device that follows, so that a computed fact of the device stays what it is without sweeps, as in
    /// device.0.w=cloaked_area_cm2 (`cloakroom devices` lists facts). May be given several times.
    #[arg(long = "hold", value_name = "KEY=FACT")]
    pub holds: Vec<String>,
    /// How often the random errors of devices (`device.N.imperfection.error`) are drawn for each combination: the
    /// figures are means, with their standard errors.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub draws: u32,
    /// A file to write; its ending decides: .csv, .npz, or .svg and .png for a plot. May be given several times.
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,
    /// What a plot shows, as in ideal_picture_flip,delivered: names of the table's columns, a panel each.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_values = STANDARD_PLOT)]
    pub plot: Vec<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// Arguments of `diagram`.
#[derive(Args, Debug)]
pub struct DiagramArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A file to write, .svg or .png. May be given several times.
    #[arg(short, long = "output", value_name = "FILE", required = true)]
    pub outputs: Vec<PathBuf>,
    /// How many rays.
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub rays: u32,
    /// Parallel rays in that direction, degrees from x in the xy-plane: the default, along x.
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, conflicts_with_all = ["point", "camera"])]
    pub parallel: Option<f64>,
    /// A fan of rays from that point, cm.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point, conflicts_with = "camera")]
    pub point: Option<[f64; 3]>,
    /// A fan of rays from the scene's camera.
    #[arg(long)]
    pub camera: bool,
    /// The width of a bundle of parallel rays, cm; that of the devices if absent.
    #[arg(long, value_name = "CM")]
    pub width: Option<f64>,
    /// The plane z = const that the rays start in, cm; that of the first device if absent.
    #[arg(long, value_name = "CM", allow_hyphen_values = true)]
    pub z: Option<f64>,
    /// The polarization: none (unpolarized), horizontal or vertical.
    #[arg(long, value_name = "WORD", default_value = "none", value_parser = PossibleValuesParser::new(["none", "horizontal", "vertical"]))]
    pub polarization: String,
    /// Mark the points of equal optical path, as often as that (cm): the wavefronts.
    #[arg(long, value_name = "CM")]
    pub wavefronts: Option<f64>,
    /// Leave out branches below this share of a ray's power.
    #[arg(long, value_name = "P", default_value_t = 0.01)]
    pub min_power: f64,
    /// Show space in parallel projection instead of the cross-section, seen from that azimuth and elevation, in
    /// degrees, as in 30,20.
    #[arg(long, value_name = "AZIMUTH,ELEVATION", allow_hyphen_values = true, value_parser = angles)]
    pub space: Option<[f64; 2]>,
    /// With --space: layers of rays one behind the other along z.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub layers: u32,
    /// Draw the setting instead: camera, photograph and devices to scale.
    #[arg(long)]
    pub setting: bool,
    /// Size in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    pub size: [u32; 2],
}

/// Arguments of `export`.
#[derive(Args, Debug)]
pub struct ExportArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// The file to write; its ending decides: .npz, .vti (ParaView) or .csv; with --table .csv or .json.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Which device, counted from 0; the only one if absent.
    #[arg(long, value_name = "N")]
    pub device: Option<usize>,
    /// The cells of the grid: how many along x, y and z, as in 200x200x1, or the side of a cubic cell in cm, as
    /// in 0.1 [default: cubes, 64 along the longest side].
    #[arg(long, value_name = "NxNxN|CM", value_parser = grid)]
    pub grid: Option<Resolution>,
    /// Along whose axes grid and tensors lie: the device's own, or the world's.
    #[arg(long, value_name = "FRAME", default_value = "device", value_parser = PossibleValuesParser::new(["device", "world"]))]
    pub frame: String,
    /// Write the homogeneous segments as a table instead: corners, optic axes, principal values and axes of
    /// the tensors, in the device's frame.
    #[arg(long, conflicts_with_all = ["grid", "frame"])]
    pub table: bool,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub struct VerifyArguments {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Number of threads; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// Arguments of `view`.
#[derive(Args, Debug)]
pub struct ViewArguments {
    /// The scene to begin with (TOML) [default: cloak (iii) of the paper].
    pub scene: Option<PathBuf>,
    /// Override a key of the scene, as in device.0.rotation=5.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
    /// The port on this machine; the next free one if it is taken, any free one if 0.
    #[arg(long, value_name = "N", default_value_t = 8420)]
    pub port: u16,
    /// Do not open the browser; the address is printed.
    #[arg(long)]
    pub no_open: bool,
    /// Number of threads that render; all cores if absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// A rectangle of a picture: left column, top row, width and height in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle(pub [usize; 4]);

/// Arguments of `devices`.
#[derive(Args, Debug)]
pub struct DevicesArguments {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}
