//! Tiles are the picture, whatever their edges.

use super::*;
use crate::render::{ChannelSet, PreparedScene, Supervision, render, render_tile};
use crate::scene_file;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const SCENE: &str = "[camera]\nresolution = [37, 23]\nsamples = 2\n[picture]\nchannels = [\"stokes\"]\n\
                     [[device]]\nkind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\nrotation = 10\n";

fn with_prepared<T>(work: impl FnOnce(&PreparedScene<'_>, &Supervision<'_>) -> T) -> T {
    let loaded = scene_file::parse(SCENE, "scene", Path::new(""), &[]).expect("a scene");
    let prepared = PreparedScene::new(&loaded.scene).expect("a sound scene");
    let stop = AtomicBool::new(false);
    work(&prepared, &Supervision { rows_done: &|_| {}, stop: &stop })
}

fn pieces(tiles: &[&str]) -> Vec<Piece<Picture>> {
    with_prepared(|prepared, supervision| {
        let piece = |text: &&str| {
            let tile = text.parse().expect("a tile");
            let rendered = render_tile(prepared, ChannelSet::Everything, tile, supervision);
            let picture = rendered.expect("a picture").picture;
            ((*text).to_owned(), picture.metadata.clone(), picture)
        };
        tiles.iter().map(piece).collect()
    })
}

/// What a picture says, NaN being equal to itself.
fn bits(picture: &Picture) -> Vec<u64> {
    let samples = picture.channels.iter().map(|channel| &channel.samples);
    samples.flat_map(|s| (0..s.len()).map(|i| s.get(i).to_bits())).collect()
}

#[test]
fn tiles_with_even_and_odd_edges_make_the_whole_picture() {
    let whole = with_prepared(|prepared, supervision| {
        render(prepared, ChannelSet::Everything, supervision).expect("a picture").picture
    });
    let merged = merge(&pieces(&["0,0,11,7", "11,0,26,7", "0,7,20,16", "20,7,17,16"]));
    let merged = merged.expect("tiles of one picture");
    assert_eq!(bits(&merged), bits(&whole));
    assert_eq!(merged.metadata, whole.metadata);
    let names = |picture: &Picture| -> Vec<String> {
        picture.channels.iter().map(|channel| channel.name.clone()).collect()
    };
    assert_eq!(names(&merged), names(&whole));
}

#[test]
fn images_are_put_together_the_same_way() {
    let image = |(name, metadata, picture): Piece<Picture>| {
        (name, metadata, crate::output::to_srgb(&picture).expect("an image"))
    };
    let tiles = ["0,0,37,10", "0,10,37,13"];
    let images: Vec<_> = pieces(&tiles).into_iter().map(image).collect();
    let (merged, metadata) = merge_images(&images).expect("tiles of one picture");
    let whole = merge(&pieces(&tiles)).expect("tiles of one picture");
    assert_eq!(merged, crate::output::to_srgb(&whole).expect("an image"));
    assert_eq!(metadata, whole.metadata);
}

#[test]
fn what_is_not_one_picture_is_refused() {
    let refused = |pieces: &[Piece<Picture>]| merge(pieces).expect_err("must fail").to_string();
    let tiles = pieces(&["0,0,37,10", "0,10,37,13", "0,9,37,14"]);
    assert!(refused(&tiles[..1]).contains("370 of the picture's 37 x 23 pixels"));
    assert!(refused(&tiles).contains("0,0,37,10 and 0,9,37,14 overlap"));
    assert!(refused(&[]).contains("some tiles are missing"));
    let mut other = tiles[..2].to_vec();
    other[1].1[3].1 = "7".to_owned();
    assert!(refused(&other).contains("their `seed` metadata differ"), "{}", refused(&other));
    other[1] = tiles[1].clone();
    other[1].2.channels.pop();
    assert!(refused(&other).contains("channels differ"));
    other[1].1.clear();
    assert!(refused(&other).contains("not a tile"));
    other[1] = tiles[2].clone();
    other[1].1.retain(|(key, _)| key != RESOLUTION);
    other[1].1.push((RESOLUTION.to_owned(), "38,23".to_owned()));
    assert!(refused(&other).contains("resolutions differ"));
}

#[test]
fn a_tile_is_as_large_as_it_says_or_none() {
    let metadata = || {
        let all = format!("{0},{0}", u32::MAX);
        [(TILE, format!("0,0,{all}")), (RESOLUTION, all)]
            .map(|(key, text)| (key.to_owned(), text))
            .to_vec()
    };
    let small = Channel { name: "R".to_owned(), samples: Samples::F32(vec![0.0; 4]) };
    let picture = Picture { width: 2, height: 2, channels: vec![small], metadata: metadata() };
    let merged = merge(&[("a".to_owned(), metadata(), picture)]);
    assert_eq!(merged, Err(MergeError::NoTile("a".to_owned())));
    let merged = merge_images(&[("a".to_owned(), metadata(), RgbImage::new(2, 2))]);
    assert_eq!(merged, Err(MergeError::NoTile("a".to_owned())));
}

#[test]
fn tiles_are_read_and_checked() {
    let tile: Tile = "2, 3,4,5".parse().expect("a tile");
    assert_eq!(tile, Tile { left: 2, top: 3, width: 4, height: 5 });
    assert_eq!(tile.to_string().parse(), Ok(tile));
    for text in ["", "1,2,3", "1,2,3,4,5", "1,2,3,-4", "a,b,c,d", "1,2,3,4.5", "1,2,3,4294967296"] {
        assert!(text.parse::<Tile>().is_err(), "{text}");
    }
    assert_eq!(tile.check([6, 8]), Ok(tile));
    for resolution in [[5, 8], [6, 7]] {
        assert!(tile.check(resolution).is_err());
    }
    let endless = Tile { left: u32::MAX, top: 0, width: 2, height: 1 };
    let empty = Tile { left: 0, top: 0, width: 0, height: 1 };
    assert!(endless.check([5, 5]).is_err() && empty.check([5, 5]).is_err());
}
