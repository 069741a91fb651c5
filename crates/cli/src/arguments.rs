//! The command line.

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};
use cloakroom::measure::STANDARD_PLOT;
use cloakroom::scene::OPTIONAL_CHANNELS;
use std::path::PathBuf;

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
    /// Compare two pictures: correlation, structural similarity, FLIP, times of flight, power.
    Compare(CompareArguments),
    /// Measure how well a scene's devices work over a range of settings: a table, data and a plot.
    Quality(QualityArguments),
    /// Go through the statements of the paper, one by one: what comes out here, and a verdict (Markdown).
    Verify(VerifyArguments),
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

/// Reads a pixel such as 512,384.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let pair = text.split_once(',').map(|(x, y)| (x.trim().parse(), y.trim().parse()));
    match pair {
        Some((Ok(column), Ok(row))) => Ok([column, row]),
        _ => Err("write COLUMN,ROW, counted from 0 at the top left, as in 512,384".to_owned()),
    }
}

/// Reads a rectangle such as 100,50,200,150.
fn rectangle(text: &str) -> Result<Rectangle, String> {
    let numbers: Option<Vec<usize>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    numbers.and_then(|numbers| numbers.try_into().ok()).map(Rectangle).ok_or_else(|| {
        "write X,Y,W,H in pixels: left column, top row, width, height, as in 100,50,200,150"
            .to_owned()
    })
}

/// Reads a size such as 1024x768.
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(w, h)| (w.parse(), h.parse()));
    match sides {
        Some((Ok(w), Ok(h))) if (1..=65536).contains(&w) && (1..=65536).contains(&h) => Ok([w, h]),
        _ => Err("write WIDTHxHEIGHT in pixels, each from 1 to 65536, as in 1024x768".to_owned()),
    }
}
