//! Files of materials that a scene names: those of the refractiveindex.info database.
//!
//! M. N. Polyanskiy, Sci. Data 11, 94 (2024). Each is a YAML document with a list `DATA` of one or two
//! entries: a dispersion formula with its coefficients, or a table of n, of k or of both, by the
//! wavelength in µm.

use crate::device::{MaterialWord, MediumWords};
use crate::input::{Digest, read_file, reason};
use crate::keys::{Field, KeyKind, Value};
use optics::material::{Dispersion, IndexLaw, Material, Table};
use std::borrow::Cow;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use yaml_rust2::{Yaml, YamlLoader};

/// Longer files are no material.
const LONGEST: u64 = 16 << 20;

/// A file that has been read.
#[derive(Debug, PartialEq)]
pub struct MaterialFile {
    path: PathBuf,
    /// What it holds.
    pub(crate) material: Arc<Material>,
    /// Of its bytes.
    pub(crate) digest: Digest,
}

impl MaterialFile {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// A message that names the file and says why it cannot be used.
    pub fn read(path: &Path) -> Result<Self, String> {
        let failed = |reason: String| format!("cannot read {}: {reason}", path.display());
        let bytes = read_file(LONGEST, path).map_err(|error| failed(reason(&error)))?;
        let digest = Digest::of(&bytes);
        let text =
            String::from_utf8(bytes).map_err(|_| failed("it is not UTF-8 text".to_owned()))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let material = material(&text, name).map_err(failed)?;
        Ok(Self { path: path.to_owned(), material: Arc::new(material), digest })
    }

    /// What it holds.
    #[must_use]
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// Whether that is its path, from the current folder or in full.
    pub(crate) fn is_at(&self, path: &Path) -> bool {
        let full = |path: &Path| std::path::absolute(path).ok();
        self.path == path || full(&self.path).is_some_and(|own| Some(own) == full(path))
    }
}

/// Files that have been read, each once.
#[derive(Debug, Default)]
pub(crate) struct MaterialFiles {
    known: RefCell<Vec<Arc<MaterialFile>>>,
    /// Whether these are all, and no other is opened.
    are_all: bool,
}

impl MaterialFiles {
    /// Files that have been read before, and no others.
    pub(crate) fn only(known: &[Arc<MaterialFile>]) -> Self {
        Self { known: RefCell::new(known.to_vec()), are_all: true }
    }

    /// All that have been read.
    pub(crate) fn read(&self) -> Vec<Arc<MaterialFile>> {
        self.known.borrow().clone()
    }

    /// The file at a path.
    pub(crate) fn at(&self, path: &Path) -> Result<Arc<MaterialFile>, String> {
        let mut files = self.known.borrow_mut();
        if let Some(known) = files.iter().find(|file| file.is_at(path)) {
            return Ok(Arc::clone(known));
        }
        if self.are_all {
            return Err(format!("{} did not come with the scene", path.display()));
        }
        let file = Arc::new(MaterialFile::read(path)?);
        files.push(Arc::clone(&file));
        Ok(file)
    }
}

/// The material that a value of the key `material` says: a name, the path of a file, or the table of a law.
///
/// # Errors
///
/// A message that says what is wrong with the value, or why its file cannot be used.
pub fn material_of(value: &Value) -> Result<Arc<Material>, String> {
    let key =
        MediumWords::KEYS.iter().find(|key| matches!(key.kind, KeyKind::MaterialOrTable { .. }));
    let value = key.map_or_else(|| Ok(value.clone()), |key| key.check(value))?;
    let mut word = MaterialWord::from_value(&value)
        .ok_or_else(|| format!("{value} is no material: it is a name, a file or a law"))?;
    let (files, mut failed) = (MaterialFiles::default(), None);
    word.show_files("", &mut |_, file| match (files.at(file.path), file.material) {
        (Ok(read), Some(material)) => *material = Some(Arc::clone(&read.material)),
        (Err(message), _) => failed = failed.take().or(Some(message)),
        (Ok(_), None) => {}
    });
    failed.map_or_else(|| word.material().map_err(|error| error.message), Err)
}

/// The material that a document describes.
fn material(text: &str, title: String) -> Result<Material, String> {
    let documents =
        YamlLoader::load_from_str(text).map_err(|error| format!("it is no YAML: {error}"))?;
    let document = documents.first().unwrap_or(&Yaml::BadValue);
    let Some(data) = document["DATA"].as_vec() else {
        return Err("it is no file of a material: it has no list `DATA`".to_owned());
    };
    let mut law: Option<(Dispersion, [f64; 2])> = None;
    let mut extinction: Option<Table> = None;
    for entry in data {
        let kind = entry["type"].as_str().unwrap_or_default();
        let index = match kind.split_once(' ') {
            Some(("formula", number)) => Some(formula(entry, number)?),
            Some(("tabulated", columns @ ("n" | "k" | "nk"))) => {
                let [wavelengths_um, first, second] = columns_of(entry, columns.len())?;
                let table = |values| Table { wavelengths_um: wavelengths_um.clone(), values };
                let range = [wavelengths_um[0], wavelengths_um[wavelengths_um.len() - 1]];
                let (n, k) = match columns {
                    "n" => (Some(first), None),
                    "k" => (None, Some(first)),
                    _ => (Some(first), Some(second)),
                };
                if let Some(k) = k
                    && extinction.replace(table(k)).is_some()
                {
                    return Err("it has more than one extinction coefficient k".to_owned());
                }
                n.map(|n| (Dispersion::Table(table(n)), range))
            }
            _ => {
                return Err(format!(
                    "its data are of the type `{kind}`; known are formula 1 to 9 and tabulated n, k and nk"
                ));
            }
        };
        if let Some(index) = index
            && law.replace(index).is_some()
        {
            return Err("it has more than one index of refraction".to_owned());
        }
    }
    let (dispersion, [mut least, mut most]) =
        law.ok_or("it has no index of refraction, as a formula or as a table of n")?;
    if let Some(table) = &extinction {
        let ends = &table.wavelengths_um;
        (least, most) = (least.max(ends[0]), most.min(ends[ends.len() - 1]));
    }
    if least > most {
        return Err("its n and its k have no wavelength in common".to_owned());
    }
    let source = document["REFERENCES"].as_str().map(plain).unwrap_or_default();
    let ordinary = IndexLaw { dispersion, extinction, range_um: [least, most] };
    Ok(Material { title, source, ordinary, extraordinary: None })
}

/// A formula, and where it holds.
fn formula(entry: &Yaml, number: &str) -> Result<(Dispersion, [f64; 2]), String> {
    let number = number.parse().ok().filter(|number| (1..=9).contains(number));
    let number = number.ok_or("its formula is none of 1 to 9")?;
    let coefficients =
        numbers(&entry["coefficients"]).ok_or("the coefficients of its formula are no numbers")?;
    // c1, and pairs; where one of a pair is missing, which is it?
    if matches!(number, 1 | 2 | 3 | 5 | 6) && coefficients.len() % 2 == 0 {
        return Err(format!(
            "formula {number} has the coefficients c1 and pairs of others, and there are {}",
            coefficients.len()
        ));
    }
    let range = [&entry["wavelength_range"], &entry["range"]].into_iter().find_map(numbers);
    let range_um = range.and_then(|range| <[f64; 2]>::try_from(range).ok());
    let range_um = range_um.filter(|[least, most]| *least > 0.0 && least <= most);
    let range_um = range_um.ok_or("its formula has no range of wavelengths")?;
    Ok((Dispersion::Formula { number, coefficients: Cow::Owned(coefficients) }, range_um))
}

/// The numbers of a text; one alone may be a number.
fn numbers(value: &Yaml) -> Option<Vec<f64>> {
    let finite = |number: f64| number.is_finite().then_some(number);
    match value {
        Yaml::String(text) => {
            text.split_whitespace().map(|word| word.parse().ok().and_then(finite)).collect()
        }
        Yaml::Real(text) => Some(vec![text.parse().ok().and_then(finite)?]),
        Yaml::Integer(number) => Some(vec![*number as f64]),
        _ => None,
    }
}

/// The wavelengths of a table, rising, and one or two columns beside them. The database has tables with a row out of
/// place, or two measured at one wavelength: these count as their mean.
fn columns_of(entry: &Yaml, count: usize) -> Result<[Cow<'static, [f64]>; 3], String> {
    let text = entry["data"].as_str().unwrap_or_default();
    let row = |line: &str| {
        let row = numbers(&Yaml::String(line.to_owned())).filter(|row| row.len() > count);
        row.ok_or_else(|| format!("its table has the row `{}`", line.trim()))
    };
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let mut rows: Vec<Vec<f64>> = lines.map(row).collect::<Result<_, _>>()?;
    rows.sort_by(|one, next| one[0].total_cmp(&next[0]));
    if rows.first().is_none_or(|first| first[0] <= 0.0) {
        return Err("its table has no wavelengths".to_owned());
    }
    let of_one = |column: usize| {
        let of_one = rows.chunk_by(|one, next| one[0] == next[0]);
        let mean = move |rows: &[Vec<f64>]| {
            let numbers = rows.iter().map(|row| row[column]);
            numbers.sum::<f64>() / rows.len() as f64
        };
        of_one.map(mean).collect()
    };
    Ok([0, 1, 2].map(|column| if column > count { Vec::new() } else { of_one(column) }.into()))
}

/// A text without the tags of a page, on one line.
fn plain(text: &str) -> String {
    let mut is_tag = false;
    let kept: String = text
        .chars()
        .filter(|c| {
            let was_tag = is_tag;
            is_tag = (is_tag || *c == '<') && *c != '>';
            !is_tag && !was_tag
        })
        .collect();
    kept.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(data: &str) -> Result<Material, String> {
        material(
            &format!("REFERENCES: |\n    A. <i>Author</i>,\n    A journal\nDATA:\n{data}"),
            "x".to_owned(),
        )
    }

    #[test]
    fn formulas_and_tables_are_read() {
        let glass = read(
            "  - type: formula 2\n    wavelength_range: 0.3 2.5\n    coefficients: 0 1.03961212 \
             0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n  - type: tabulated k\n    \
             data: |\n        0.4 1e-8\n        0.7 3e-8\n",
        )
        .expect("a material");
        assert_eq!(
            (glass.source.as_str(), glass.ordinary.range_um),
            ("A. Author, A journal", [0.4, 0.7])
        );
        let index = glass.ordinary.at(0.55).expect("in range").index;
        let known =
            Material::named("bk7").expect("known").ordinary.at(0.55).expect("in range").index;
        assert_eq!(index.re, known.re);
        assert!((index.im - 2e-8).abs() < 1e-20);
        let metal =
            read("  - type: tabulated nk\n    data: |\n        0.4 0.05 2\n        0.8 0.03 5\n");
        let index = metal.expect("a material").ordinary.at(0.6).expect("in range").index;
        assert!((index.re - 0.04).abs() < 1e-15 && (index.im - 3.5).abs() < 1e-15);
    }

    #[test]
    fn rows_may_be_in_any_order_and_measured_twice() {
        let table = |rows: &str| read(&format!("  - type: tabulated n\n    data: |\n{rows}"));
        let sorted = table("        0.4 1.5\n        0.6 1.4\n        0.8 1.3\n");
        let unsorted =
            table("        0.4 1.5\n        0.8 1.3\n        0.6 1.35\n        0.6 1.45\n");
        let [sorted, unsorted] = [sorted, unsorted].map(|read| read.expect("a material").ordinary);
        assert_eq!(sorted.range_um, unsorted.range_um);
        for um in [0.4, 0.5, 0.6, 0.75, 0.8] {
            let [one, other] = [&sorted, &unsorted].map(|law| law.at(um).expect("in range").index);
            assert!((one - other).norm() < 1e-15, "{um}: {one} {other}");
        }
    }

    #[test]
    fn what_is_no_material_is_refused() {
        for (data, part) in [
            ("  - type: tabulated n2\n    data: |\n        0.4 1e-20\n", "`tabulated n2`"),
            (
                "  - type: formula 10\n    wavelength_range: 1 2\n    coefficients: 1\n",
                "none of 1 to 9",
            ),
            ("  - type: formula 1\n    coefficients: 0 1 0.1\n", "no range"),
            (
                "  - type: formula 1\n    wavelength_range: 1 2\n    coefficients: 0 x\n",
                "no numbers",
            ),
            (
                "  - type: formula 2\n    wavelength_range: 1 2\n    coefficients: 3 2 0.1 1.8\n",
                "pairs of others, and there are 4",
            ),
            ("  - type: tabulated nk\n    data: |\n        0.4 1.5\n", "the row `0.4 1.5`"),
            ("  - type: tabulated k\n    data: |\n        0.4 1e-8\n", "no index"),
            ("  []\n", "no index"),
        ] {
            let message = read(data).expect_err(data);
            assert!(message.contains(part), "{data}: {message}");
        }
        assert!(material("nothing", "x".to_owned()).expect_err("text").contains("`DATA`"));
        assert!(material("{", "x".to_owned()).expect_err("no YAML").contains("no YAML"));
    }
}
