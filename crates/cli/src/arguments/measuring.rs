//! Arguments of the commands that measure, draw and export.

use super::values::{PulseTimes, angles, grid, point, rectangle, size, sun, tilt, view, window};
use super::{FlightDelay, FormatArguments, SceneArguments, ThreadsArguments};
use clap::Args;
use clap::builder::PossibleValuesParser;
use cloakroom::material::Resolution;
use cloakroom_figures::STANDARD_PLOT;
use std::path::PathBuf;

/// Arguments of `flux`.
#[derive(Args, Debug)]
pub struct FluxArguments {
    /// The scene; its [receiver] is the plane.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A file to write: data as .csv or .npz, a plot over the directions as .svg, .pdf or .png. May
    /// be given several times; the totals are printed.
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,
    /// A file for a map of the receiver, .svg, .pdf or .png.
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Angles of incidence in the plane across z, degrees.
    #[arg(long, value_name = "FROM..TO:STEP", allow_hyphen_values = true, default_value = "-60..60:10", value_parser = angles, conflicts_with = "sun")]
    pub angles: [f64; 3],
    /// Tilt the light towards z, degrees.
    #[arg(
        long,
        value_name = "DEGREES",
        allow_hyphen_values = true,
        default_value_t = 0.0,
        value_parser = tilt,
        conflicts_with = "sun"
    )]
    pub tilt: f64,
    /// The sun over a day instead, from that latitude and with that declination (degrees; 23.44 at
    /// midsummer): the receiver lies flat, z points north.
    #[arg(long, value_name = "LATITUDE,DECLINATION", allow_hyphen_values = true, value_parser = sun)]
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
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
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
    pub region: Option<[usize; 4]>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `quality`.
#[derive(Args, Debug)]
pub struct QualityArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// The pictures that are measured.
    #[command(flatten)]
    pub format: FormatArguments,
    /// A key and its values, as in device.0.rotation=0..90:5 or
    /// camera.polarizer=horizontal,vertical. May be given several times: every combination is
    /// measured.
    #[arg(long = "sweep", value_name = "KEY=VALUES", required = true)]
    pub sweeps: Vec<String>,
    /// A key of a device that follows, so that a computed fact of the device stays what it is
    /// without sweeps, as in device.0.w=cloaked_area_cm2 (`cloakroom devices` lists facts). May be
    /// given several times.
    #[arg(long = "hold", value_name = "KEY=FACT")]
    pub holds: Vec<String>,
    /// How often the random errors of devices (`device.N.imperfection.error`) are drawn for each
    /// combination: the figures are means, with their standard errors.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub draws: u32,
    /// A scene whose devices show what should be seen, as a flat floor for a carpet of one's own;
    /// without it, a cloak's flat mirror, or nothing. Camera, light and photograph stay those of the
    /// scene that is measured, and what is swept changes nothing in it.
    #[arg(long, value_name = "SCENE")]
    pub reference: Option<PathBuf>,
    /// A file to write; its ending decides: .csv, .npz, or .svg, .pdf and .png for a plot. May be
    /// given several times.
    #[arg(short, long = "output", value_name = "FILE")]
    pub outputs: Vec<PathBuf>,
    /// What a plot shows, as in ideal_picture_flip,delivered: names of the table's columns, a panel
    /// each.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_values = STANDARD_PLOT)]
    pub plot: Vec<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `diagram`.
#[derive(Args, Debug)]
pub struct DiagramArguments {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArguments,
    /// A file to write, .svg, .pdf or .png; a film as .gif, .apng, .png, .webp, .mp4 or .webm (with ffmpeg),
    /// or with no ending as a folder of frames. May be given several times.
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
    /// The part of the cross-section that is shown, cm, as in --window=-20,-10,20,10; the devices and
    /// what is around them if absent.
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, value_parser = window, conflicts_with_all = ["space", "setting"])]
    pub window: Option<[f64; 4]>,
    /// The plane z = const that the rays start in, cm; that of the first device if absent.
    #[arg(long, value_name = "CM", allow_hyphen_values = true)]
    pub z: Option<f64>,
    /// The polarization: none (unpolarized), horizontal or vertical.
    #[arg(long, value_name = "WORD", default_value = "none", value_parser = PossibleValuesParser::new(["none", "horizontal", "vertical"]))]
    pub polarization: String,
    /// Mark the points of equal optical path, as often as that (cm): the wavefronts.
    #[arg(long, value_name = "CM")]
    pub wavefronts: Option<f64>,
    /// A film of a pulse on its way along the rays, while it is seen; or with times, a frame for each, as in
    /// -0.5..1.5:0.02, ns; or a drawing for a single one. It leaves a point or the camera at 0; parallel rays
    /// would be in the middle of the devices then, were there nothing in their way.
    #[arg(long, help_heading = "Pulse", value_name = "NS|START..END:STEP", num_args = 0..=1, default_missing_value = "", allow_negative_numbers = true, conflicts_with = "setting")]
    pub pulse: Option<PulseTimes>,
    /// Which time counts.
    #[arg(
        long,
        value_name = "TIME",
        help_heading = "Pulse",
        default_value = "group",
        requires = "pulse"
    )]
    pub delay: FlightDelay,
    /// Frames a second.
    #[arg(long, help_heading = "Pulse", value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=100), requires = "pulse")]
    pub fps: u32,
    /// Keep the folder of frames beside the film.
    #[arg(long, help_heading = "Pulse", requires = "pulse")]
    pub keep_frames: bool,
    /// Leave out branches below this share of a ray's power.
    #[arg(long, value_name = "P", default_value_t = 0.01)]
    pub min_power: f64,
    /// Show space in parallel projection instead of the cross-section, seen from that azimuth and
    /// elevation, in degrees, as in 30,20.
    #[arg(long, value_name = "AZIMUTH,ELEVATION", allow_hyphen_values = true, value_parser = view)]
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
    /// The file to write; its ending decides: .npz, .vti (ParaView) or .csv; with --table .csv or
    /// .json; the outlines of all devices as a mesh, in the world's frame, .stl (cm), .glb or .gltf.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Which device, by its number, counted from 0, or its name; the only one if absent, for meshes
    /// all of them.
    #[arg(long, value_name = "N|NAME")]
    pub device: Option<String>,
    /// The cells of the grid: how many along x, y and z, as in 200x200x1, or the side of a cubic
    /// cell in cm, as in 0.1 [default: cubes, 64 along the longest side].
    #[arg(long, value_name = "NxNxN|CM", value_parser = grid)]
    pub grid: Option<Resolution>,
    /// Along whose axes grid and tensors lie: the device's own, or the world's.
    #[arg(long, value_name = "FRAME", default_value = "device", value_parser = PossibleValuesParser::new(["device", "world"]))]
    pub frame: String,
    /// Write the homogeneous segments as a table instead: corners, optic axes, principal values and
    /// axes of the tensors, in the device's frame.
    #[arg(long, conflicts_with_all = ["grid", "frame"])]
    pub table: bool,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub struct VerifyArguments {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// How many threads work.
    #[command(flatten)]
    pub threads: ThreadsArguments,
}
