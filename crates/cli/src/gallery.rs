//! `cloakroom gallery`: a picture of every device, how long light takes, and the table of them all.

use crate::arguments::GalleryArguments;
use crate::interruption;
use crate::panels::{self, merge, write_drawing, write_png};
use crate::render::{picture, rgb};
use crate::report::{Failure, Result};
use crate::scene;
use cloakroom::render::{ChannelSet, Images};
use cloakroom_figures::gallery::{self, EXHIBITS, Exhibit};
use cloakroom_figures::{ScalarMap, TablePicture, TableRow, table};

/// The channel whose map stands beside the picture.
const MAP: &str = "time_of_flight_difference";

/// What the names of maps end with.
const OF_MAP: &str = "-time-of-flight";

/// The name of the table.
const OF_TABLE: &str = "gallery";

/// Makes the chosen pictures and maps, and the table if all are chosen.
pub fn run(arguments: &GalleryArguments) -> Result<()> {
    let chosen = gallery::select(&arguments.only).map_err(Failure::Usage)?;
    scene::use_threads(&arguments.panels.threads)?;
    let names = chosen.iter().map(|exhibit| arguments.out.join(exhibit.name));
    let maps = chosen.iter().map(|exhibit| arguments.out.join(format!("{}{OF_MAP}", exhibit.name)));
    let names = names.chain(maps).chain([arguments.out.join(OF_TABLE)]);
    let mut images = panels::prepare(&arguments.panels, &arguments.out, names)?;
    let _busy = interruption::busy();
    let mut rows = Vec::new();
    let mut metadata = Vec::new();
    for exhibit in &chosen {
        rows.push(make(exhibit, arguments, &mut images, &mut metadata)?);
    }
    if chosen.len() == EXHIBITS.len() {
        let drawing = table(gallery::TITLE, &rows);
        let name = arguments.out.join(OF_TABLE);
        write_drawing(&drawing, gallery::TITLE, &metadata, drawing.pixels(), &name)?;
    }
    Ok(())
}

/// Makes picture and map of one exhibit, writes them, and gives its row of the table.
fn make(
    exhibit: &Exhibit,
    arguments: &GalleryArguments,
    images: &mut Images,
    metadata: &mut Vec<(String, String)>,
) -> Result<TableRow> {
    let loaded = panels::load(exhibit.scene, exhibit.name, &arguments.panels, &[])?;
    let prepared = scene::prepared(&loaded, images)?;
    let picture = picture(&prepared, ChannelSet::Everything, exhibit.name)?;
    let image = rgb(&loaded.scene, &picture)?;
    let map = ScalarMap::new(&picture, MAP, &loaded.scene.picture)?;
    let file = |ending: &str| arguments.out.join(format!("{}{ending}", exhibit.name));
    write_png(&image, &picture.metadata, &file(".png"))?;
    let drawing = map.draw(true);
    let title = format!("{}: {}", exhibit.title, map.bar.quantity.title);
    write_drawing(&drawing, &title, &picture.metadata, drawing.pixels(), &file(OF_MAP))?;
    merge(metadata, &picture.metadata);
    Ok(TableRow {
        title: exhibit.title.to_owned(),
        words: exhibit.words().map(|(name, words)| (name, words.to_owned())).to_vec(),
        pictures: vec![
            TablePicture::new(&image),
            TablePicture::of_map(&map, "no light from the photograph arrives"),
        ],
    })
}
