//! The finished strips of a picture, kept in a folder, so that a stopped run can go on.

use crate::files::make_folder;
use crate::report::Result;
use cloakroom::output::{self, Picture};
use cloakroom::render::{self, ChannelSet, PreparedScene, Rendered, Supervision, Tile};
use cloakroom::trace::TraceStats;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of the strips of one picture.
#[derive(Debug)]
pub struct Strips<'p> {
    prepared: &'p PreparedScene<'p>,
    wanted: ChannelSet,
    folder: PathBuf,
}

impl<'p> Strips<'p> {
    /// The folder beside a file: its name and `.strips`, made if it is not there.
    pub fn beside(
        path: &Path,
        prepared: &'p PreparedScene<'p>,
        wanted: ChannelSet,
    ) -> Result<Self> {
        let mut name = OsString::from(path);
        name.push(".strips");
        let folder = PathBuf::from(name);
        make_folder(&folder)?;
        Ok(Self { prepared, wanted, folder })
    }

    /// A strip that is there, or rendered now; it is a tile of the picture.
    pub fn strip(&self, part: Tile, supervision: &Supervision<'_>) -> Result<Rendered> {
        let file = self.file(part);
        if let Some(picture) = self.finished(&file, part) {
            (supervision.rows_done)(u64::from(part.height));
            return Ok(Rendered { picture, stats: TraceStats::default(), most_pruned: 0.0 });
        }
        let strip = render::render_tile(self.prepared, self.wanted, part, supervision)?;
        output::write(&strip.picture, &file)?;
        Ok(strip)
    }

    /// What is in a file, if that is this strip of this picture.
    fn finished(&self, file: &Path, part: Tile) -> Option<Picture> {
        let picture = output::read_npz(file).ok()?;
        let [width, height] = [part.width, part.height].map(|side| side as usize);
        // In any order: an NPZ keeps none.
        let metadata = render::tile_metadata(self.prepared, part);
        let is_same = picture.metadata.len() == metadata.len()
            && metadata.iter().all(|pair| picture.metadata.contains(pair))
            && [picture.width, picture.height] == [width, height];
        is_same.then_some(picture)
    }

    /// The strips of pictures with other channels have other names.
    fn file(&self, part: Tile) -> PathBuf {
        self.folder.join(format!("strip-{:05}-{:?}.npz", part.top, self.wanted).to_lowercase())
    }

    /// Removes the strips, and the folder if nothing else is in it.
    pub fn remove(&self) {
        for part in render::small_strips(self.prepared) {
            // What cannot be removed stays: the picture is there.
            let _ = fs::remove_file(self.file(part));
        }
        let _ = fs::remove_dir(&self.folder);
    }
}
