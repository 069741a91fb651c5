//! EXR files: which of their channels are an image, whether they can be decoded within bounds, and
//! the light in them.
//!
//! The size that counts for memory is not that of the picture (the display window) alone but that
//! of the stored layer and of its blocks, which a damaged header can make anything. The decoder
//! takes this memory unasked.

use std::io::Cursor;

use exr::image::read::read;
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{IntegerBounds, ReadChannels as _, ReadLayers as _, ReadSpecificChannel as _};

use super::linear_image::{LinearImage, MAX_MEMORY, MAX_PIXELS, Texels};
use super::source::LoadProblem;

/// Largest block, in bytes: as many blocks as there are threads are decoded at once.
const MAX_BLOCK: u64 = 512 << 20;

/// The flag of deep data in the sixth byte of a file (OpenEXR file layout, version field, bit 11).
const DEEP: u8 = 0x08;

/// What the layer is called in Blender's files that has the whole picture.
const COMBINED: &str = "Combined.";

/// An image in an EXR file, by its header.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ExrImage {
    /// The names of its red, green and blue channel, or of its gray one.
    channels: Vec<String>,
    /// What is seen of it.
    window: IntegerBounds,
    /// Where its pixels begin.
    position: Vec2<i32>,
}

impl ExrImage {
    /// Finds the image in a file.
    ///
    /// # Errors
    ///
    /// If the header is damaged or asks for more memory than is allowed, or the file holds no
    /// image of colors or gray, or several.
    pub fn find(bytes: &[u8]) -> Result<Self, LoadProblem> {
        if bytes.get(5).is_some_and(|flags| flags & DEEP != 0) {
            return Err(LoadProblem::Unsupported("deep pixels; flatten them".to_owned()));
        }
        let file = MetaData::read_from_buffered(Cursor::new(bytes), false)
            .map_err(|error| LoadProblem::Damaged(error.to_string()))?;
        if !file.headers.iter().all(header_keeps_limits) {
            return Err(LoadProblem::TooLarge);
        }
        let image = |header: &Header, channels: Vec<String>| Self {
            channels,
            window: header.shared_attributes.display_window,
            position: header.own_attributes.layer_position,
        };
        let found: Vec<(String, Self)> = file
            .headers
            .iter()
            .flat_map(|header| layers(header).map(move |layer| (header, layer)))
            .map(|(header, (name, channels))| (name, image(header, channels)))
            .collect();
        let whole = |(name, _): &&(String, Self)| name.ends_with(COMBINED);
        match &found[..] {
            [(_, image)] => return Ok(image.clone()),
            [_, _, ..] => {
                let combined: Vec<_> = found.iter().filter(whole).collect();
                return match &combined[..] {
                    [(_, image)] => Ok(image.clone()),
                    _ => Err(LoadProblem::Layers(listed(found.iter().map(|(name, _)| name)))),
                };
            }
            [] => {}
        }
        let has = |header: &Header, name: &str| channel_names(header).any(|known| known == name);
        let gray = file.headers.iter().find(|header| has(header, "Y"));
        match gray {
            Some(header) if !has(header, "RY") => Ok(image(header, vec!["Y".to_owned()])),
            Some(_) => {
                Err(LoadProblem::Unsupported("luminance and chroma; convert them".to_owned()))
            }
            None => {
                let names: Vec<String> = file.headers.iter().flat_map(channel_names).collect();
                Err(LoadProblem::Channels(listed(names.iter())))
            }
        }
    }

    /// Width and height of what is seen of it, in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.window.size.width() as u32, self.window.size.height() as u32]
    }

    /// The light in it; where the file has no pixels it is dark.
    ///
    /// # Errors
    ///
    /// If the file is damaged, or cannot be decoded.
    pub fn read(&self, bytes: &[u8]) -> Result<LinearImage, LoadProblem> {
        let [width, height] = self.size().map(|side| side as usize);
        let offset = self.position - self.window.position;
        let dark = move || vec![0.0_f32; 3 * width * height];
        let put = move |texels: &mut Vec<f32>, at: Vec2<usize>, color: [f32; 3]| {
            let at = at.to_i32() + offset;
            let within = |at: i32, side: usize| usize::try_from(at).ok().filter(|at| *at < side);
            if let (Some(x), Some(y)) = (within(at.x(), width), within(at.y(), height)) {
                texels[3 * (y * width + x)..][..3].copy_from_slice(&color);
            }
        };
        let source = Cursor::new(bytes);
        let layers = read().no_deep_data().largest_resolution_level();
        let texels = match &self.channels[..] {
            [red, green, blue] => layers
                .specific_channels()
                .required(&**red)
                .required(&**green)
                .required(&**blue)
                .collect_pixels(
                    move |_, _| dark(),
                    move |texels, at, (r, g, b): (f32, f32, f32)| {
                        put(texels, at, [r, g, b]);
                    },
                )
                .first_valid_layer()
                .all_attributes()
                .from_buffered(source)
                .map(|image| image.layer_data.channel_data.pixels),
            channels => layers
                .specific_channels()
                .required(&*channels[0])
                .collect_pixels(
                    move |_, _| dark(),
                    move |texels, at, (gray,): (f32,)| put(texels, at, [gray; 3]),
                )
                .first_valid_layer()
                .all_attributes()
                .from_buffered(source)
                .map(|image| image.layer_data.channel_data.pixels),
        };
        let texels = texels.map_err(|error| LoadProblem::Damaged(error.to_string()))?;
        Ok(LinearImage { width, height, texels: Texels::Linear(texels) })
    }
}

/// The names of a header's channels.
fn channel_names(header: &Header) -> impl Iterator<Item = String> {
    header.channels.list.iter().map(|channel| channel.name.to_string())
}

/// The layers of a header that have red, green and blue: what they are called, and these channels.
/// One without a name of its own is the image, whatever else there is.
fn layers(header: &Header) -> impl Iterator<Item = (String, Vec<String>)> {
    let part = header.own_attributes.layer_name.as_ref().map(ToString::to_string);
    let prefixes = channel_names(header).filter_map(|name| {
        // A part of a file is called by its name, one of its layers by the names of its channels.
        name.strip_suffix('R').map(str::to_owned).filter(|p| p.is_empty() || p.ends_with('.'))
    });
    let own = header.channels.list.iter().any(|channel| channel.name.eq("R"));
    prefixes.filter(move |prefix| !own || prefix.is_empty()).filter_map(move |prefix| {
        let channels: Vec<String> = ["R", "G", "B"].map(|color| format!("{prefix}{color}")).into();
        let all = channels.iter().all(|name| channel_names(header).any(|known| known == *name));
        let name = if prefix.is_empty() { part.clone().unwrap_or_default() } else { prefix };
        all.then_some((name, channels))
    })
}

/// Names, one after the other; a layer's end in a point.
fn listed<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let names: Vec<&str> = names.map(|name| name.trim_end_matches('.')).collect();
    names.join(", ")
}

fn header_keeps_limits(header: &Header) -> bool {
    let (layer, block) = (header.layer_size, header.max_block_pixel_size());
    let per_pixel = header.channels.bytes_per_pixel as u64;
    let area = |width: usize, height: usize| (width as u64).checked_mul(height as u64);
    let within = |pixels: Option<u64>, limit: u64| {
        pixels.and_then(|pixels| pixels.checked_mul(per_pixel)).is_some_and(|bytes| bytes <= limit)
    };
    let pixels = area(layer.width(), layer.height());
    // Blocks end where the layer does.
    let block = area(block.width().min(layer.width()), block.height().min(layer.height()));
    pixels.is_some_and(|pixels| pixels <= MAX_PIXELS)
        && within(pixels, MAX_MEMORY)
        && within(block, MAX_BLOCK)
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::*;

    /// A file of layers with those channels; each pixel has the number of its channel.
    fn file(size: (usize, usize), layers: &[(Option<&str>, &[&str])]) -> Vec<u8> {
        let layer = |(name, channels): &(Option<&str>, &[&str])| {
            let channel = |(number, name): (usize, &&str)| {
                AnyChannel::new(*name, FlatSamples::F32(vec![number as f32; size.0 * size.1]))
            };
            let channels = channels.iter().enumerate().map(channel).collect();
            let layer_name = name.map(Text::from);
            let attributes = LayerAttributes { layer_name, ..LayerAttributes::default() };
            Layer::new(size, attributes, Encoding::default(), AnyChannels::sort(channels))
        };
        let layers: Layers<_> = layers.iter().map(layer).collect();
        let window = ImageAttributes::new(IntegerBounds::from_dimensions(size));
        let mut bytes = Cursor::new(Vec::new());
        let image = Image::from_layers(window, layers);
        image.write().to_buffered(&mut bytes).expect("a file");
        bytes.into_inner()
    }

    /// A file of three colors.
    fn colors(width: usize, height: usize) -> Vec<u8> {
        file((width, height), &[(None, &["R", "G", "B"])])
    }

    /// The first pixel of a file, or why there is none.
    fn first(layers: &[(Option<&str>, &[&str])]) -> std::result::Result<Vec<f32>, String> {
        let bytes = file((3, 2), layers);
        let image = ExrImage::find(&bytes).and_then(|image| image.read(&bytes));
        let texels = image.map_err(|problem| problem.to_string())?.texels;
        let Texels::Linear(values) = texels else { panic!("floats") };
        assert_eq!(values.len(), 18);
        Ok(values[..3].to_vec())
    }

    #[test]
    fn colors_and_gray_are_read_wherever_they_are() {
        assert_eq!(first(&[(None, &["R", "G", "B"])]), Ok(vec![0.0, 1.0, 2.0]));
        assert_eq!(first(&[(None, &["A", "R", "G", "B", "Z"])]), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(first(&[(None, &["Y"])]), Ok(vec![0.0; 3]));
        assert_eq!(first(&[(None, &["A", "Y"])]), Ok(vec![1.0; 3]));
        let rendered = ["View.Combined.A", "View.Combined.R", "View.Combined.G", "View.Combined.B"];
        let with_passes = [&rendered[..], &["View.Diffuse.R", "View.Diffuse.G", "View.Diffuse.B"]];
        assert_eq!(first(&[(None, &with_passes.concat())]), Ok(vec![1.0, 2.0, 3.0]));
        assert_eq!(
            first(&[(None, &["Z", "beauty.R", "beauty.G", "beauty.B"])]),
            Ok(vec![1.0, 2.0, 3.0])
        );
        let polarized = ["R", "G", "B", "horizontal.R", "horizontal.G", "horizontal.B"];
        assert_eq!(first(&[(None, &polarized)]).map(|color| color.len()), Ok(3));
        let depth: (_, &[&str]) = (Some("depth"), &["Z"]);
        assert_eq!(first(&[depth, (Some("color"), &["R", "G", "B"])]), Ok(vec![0.0, 1.0, 2.0]));
    }

    #[test]
    fn what_is_no_image_is_called_what_it_is() {
        let colors: &[&str] = &["R", "G", "B"];
        assert_eq!(
            first(&[(Some("left"), colors), (Some("right"), colors)]),
            Err("has several layers (left, right); write one of them into a file of its own"
                .to_owned())
        );
        assert_eq!(
            first(&[(None, &["a.R", "a.G", "a.B", "b.R", "b.G", "b.B"])]),
            Err("has several layers (a, b); write one of them into a file of its own".to_owned())
        );
        let luminance = first(&[(None, &["BY", "RY", "Y"])]).expect_err("chroma");
        assert!(luminance.contains("luminance and chroma"), "{luminance}");
        assert_eq!(
            first(&[(None, &["X", "Z"])]),
            Err("has the channels X, Z; an image has R, G and B, or Y alone".to_owned())
        );
    }

    #[test]
    fn deep_pixels_are_told() {
        let mut bytes = colors(3, 2);
        bytes[5] |= DEEP;
        let problem = ExrImage::find(&bytes).expect_err("deep").to_string();
        assert!(problem.contains("deep pixels"), "{problem}");
    }

    /// Changes the right and bottom edge in the header.
    fn stretch(bytes: &mut [u8], attribute: &[u8], right: i32, bottom: i32) {
        let name = bytes.windows(attribute.len()).position(|window| window == attribute);
        // Behind the name, the type `box2i`, the size, left and top.
        let at = name.expect("the attribute") + attribute.len() + 1 + 6 + 4 + 8;
        bytes[at..at + 4].copy_from_slice(&right.to_le_bytes());
        bytes[at + 4..at + 8].copy_from_slice(&bottom.to_le_bytes());
    }

    #[test]
    fn honest_files_pass() {
        assert!(ExrImage::find(&colors(30, 20)).is_ok());
        assert!(matches!(ExrImage::find(&colors(30, 20)[..40]), Err(LoadProblem::Damaged(_))));
    }

    #[test]
    fn a_huge_layer_behind_a_small_picture_does_not() {
        let mut bytes = colors(30, 20);
        stretch(&mut bytes, b"dataWindow", 30_000, 30_000);
        assert!(matches!(ExrImage::find(&bytes), Err(LoadProblem::TooLarge)));
        stretch(&mut bytes, b"dataWindow", 1 << 24, 1 << 8);
        assert!(matches!(ExrImage::find(&bytes), Err(LoadProblem::TooLarge)));
        stretch(&mut bytes, b"dataWindow", 60, 40);
        assert!(ExrImage::find(&bytes).is_ok());
    }
}
