//! EXR: every channel in single precision.

use super::{Channel, OutputError, Picture, Samples, write_whole};
use crate::color::BIN_EDGES_NM;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, ImageAttributes, Layer,
    LayerAttributes, Text, Vec2, WritableImage,
};
use std::io;
use std::path::Path;

/// Writes every channel as 32-bit floats under its name, colors as `.R`, `.G` and `.B` of it, bins of
/// a spectrum by their edges as `.430-450nm`, and the metadata as text attributes.
///
/// # Errors
///
/// If the file cannot be written.
pub(super) fn write_exr(picture: &Picture, path: &Path) -> Result<(), OutputError> {
    let plane =
        |name: &str, values: Vec<f32>| AnyChannel::new(text(name), FlatSamples::F32(values));
    let planes = |Channel { name, samples }: &Channel| match samples {
        Samples::F32(values) => vec![plane(name, values.clone())],
        Samples::F64(values) => {
            vec![plane(name, values.iter().map(|value| *value as f32).collect())]
        }
        Samples::Rgb(values) => {
            let color = |i: usize| values.iter().map(|rgb| rgb[i]).collect();
            let colors = ["R", "G", "B"].into_iter().enumerate();
            colors.map(|(i, word)| plane(&format!("{name}.{word}"), color(i))).collect()
        }
        Samples::Bins(values) => {
            let bin = |i: usize| values.iter().map(|bins| bins[i]).collect();
            let edges = BIN_EDGES_NM.windows(2).enumerate();
            edges
                .map(|(i, edges)| plane(&format!("{name}.{}-{}nm", edges[0], edges[1]), bin(i)))
                .collect()
        }
    };
    let channels = picture.channels.iter().flat_map(planes).collect();
    let size = Vec2(picture.width, picture.height);
    let mut attributes = LayerAttributes::default();
    for (key, value) in &picture.metadata {
        // EXR has names of its own for some.
        if key == "software" {
            attributes.software_name = Some(text(value));
            continue;
        }
        let key = if key == "version" { "cloakroom_version" } else { key };
        attributes.other.insert(text(key), AttributeValue::Text(text(value)));
    }
    let layer = Layer::new(size, attributes, Encoding::FAST_LOSSLESS, AnyChannels::sort(channels));
    let image = Image {
        attributes: ImageAttributes::new(exr::prelude::IntegerBounds::from_dimensions(size)),
        layer_data: layer,
    };
    write_whole(path, |out| {
        // One thread: the bytes must not depend on how many there are.
        let writer = image.write().non_parallel();
        let headers = writer.infer_meta_data();
        writer.to_buffered(&mut *out).map_err(io::Error::other)?;
        // The encoder writes attributes in an order that changes from run to run; they are
        // written again, sorted, over the same place.
        let mut sorted = Vec::new();
        for header in &headers {
            let mut attributes: Vec<_> = header.all_named_attributes().collect();
            attributes.sort_by_key(|(name, _)| *name);
            for (name, value) in attributes {
                exr::meta::attribute::write(name, &value, &mut sorted).map_err(io::Error::other)?;
            }
        }
        out.seek(io::SeekFrom::Start(HEADER))?;
        out.write_all(&sorted)
    })
}

/// Where attributes begin: behind the magic number and the version.
const HEADER: u64 = 8;

/// UTF-8 as it is: the encoder's own conversion refuses most characters.
fn text(words: &str) -> Text {
    Text::from_bytes_unchecked(words.as_bytes().iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::super::Channel;
    use super::*;
    use exr::prelude::read_first_flat_layer_from_file;

    #[test]
    fn channels_can_be_read_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.exr");
        let picture = Picture {
            width: 3,
            height: 2,
            channels: vec![
                Channel {
                    name: "R".into(),
                    samples: Samples::F32(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]),
                },
                Channel { name: "time_of_flight".into(), samples: Samples::F64(vec![1e-15; 6]) },
                Channel {
                    name: "stokes.S1".into(),
                    samples: Samples::Rgb(vec![[0.25, -0.5, 4.0]; 6]),
                },
            ],
            metadata: vec![
                ("scene".into(), "side = 3 # ≤ 4 µm".into()),
                ("version".into(), "0.1.0".into()),
            ],
        };
        super::super::write(&picture, &path).expect("written");
        let image = read_first_flat_layer_from_file(&path).expect("an EXR");
        let channels = &image.layer_data.channel_data.list;
        let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(names, ["R", "stokes.S1.B", "stokes.S1.G", "stokes.S1.R", "time_of_flight"]);
        assert_eq!(channels[0].sample_data.value_by_flat_index(4).to_f32(), 4.0);
        assert_eq!(channels[2].sample_data.value_by_flat_index(5).to_f32(), -0.5);
        assert_eq!(channels[4].sample_data.value_by_flat_index(0).to_f32(), 1e-15);
        let scene = &image.layer_data.attributes.other[&Text::from("scene")];
        assert!(matches!(scene, AttributeValue::Text(t) if t.to_string().contains("side = 3")));
        let version = &image.layer_data.attributes.other[&Text::from("cloakroom_version")];
        assert!(matches!(version, AttributeValue::Text(t) if t.eq("0.1.0")));
    }
}
