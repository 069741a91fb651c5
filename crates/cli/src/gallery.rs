//! `cloakroom gallery`: a picture of every device, how long light takes, and the table of them all.

use crate::arguments::GalleryArguments;
use crate::panels;
use crate::report::{Failure, Result};
use cloakroom::render::ChannelSet;
use cloakroom_figures::gallery::{self, EXHIBITS, Exhibit};
use cloakroom_figures::panels::{PanelMaker, merge_metadata};
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
    let names = chosen.iter().map(|exhibit| exhibit.name.to_owned());
    let maps = chosen.iter().map(|exhibit| format!("{}{OF_MAP}", exhibit.name));
    let names = names.chain(maps).chain([OF_TABLE.to_owned()]);
    panels::made(&arguments.panels, &arguments.out, names, |maker| {
        let (mut rows, mut metadata) = (Vec::new(), Vec::new());
        for exhibit in &chosen {
            rows.push(make(exhibit, maker, &mut metadata)?);
        }
        if chosen.len() == EXHIBITS.len() {
            let drawing = table(gallery::TITLE, &rows);
            let pixels = drawing.pixels();
            maker.write_drawing(&drawing, gallery::TITLE, &metadata, pixels, OF_TABLE)?;
        }
        Ok(())
    })
}

/// Makes picture and map of one exhibit, writes them, and gives its row of the table.
fn make(
    exhibit: &Exhibit,
    maker: &mut PanelMaker<'_, Failure>,
    metadata: &mut Vec<(String, String)>,
) -> Result<TableRow> {
    let loaded = maker.load(exhibit.scene, exhibit.name, &[])?;
    let picture = maker.picture(&loaded, ChannelSet::Everything, exhibit.name)?;
    let image = maker.write_shown(&loaded, &picture, exhibit.name)?;
    let map = ScalarMap::new(&picture, MAP, &loaded.scene.picture)?;
    let drawing = map.draw(true);
    let title = format!("{}: {}", exhibit.title, map.bar.quantity.title);
    let name = format!("{}{OF_MAP}", exhibit.name);
    maker.write_drawing(&drawing, &title, &picture.metadata, drawing.pixels(), &name)?;
    merge_metadata(metadata, &picture.metadata);
    Ok(TableRow {
        title: exhibit.title.to_owned(),
        words: exhibit.words().map(|(name, words)| (name, words.to_owned())).to_vec(),
        pictures: vec![
            TablePicture::new(&image),
            TablePicture::of_map(&map, "no light from the photograph arrives"),
        ],
    })
}
