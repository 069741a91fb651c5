//! The spectrum of the light.

use crate::color::Lamp;
use crate::keys::{Field, KeyError, KeyKind, Sampled, Value, ValueRange, VisitFile};
use cloakroom_trace::{choice, table};

// Where an error is, in the table of the light.
/// Its key in `[light]`.
pub(crate) const SPECTRUM: &str = "spectrum";
const LINES: &str = "spectrum.lines";
const TABLE: &str = "spectrum.table";

choice! {
    /// How a picture has its colors, in a word.
    pub enum SpectrumWord {
        /// Daylight where a medium is of a law, else `rgb`.
        Auto = "auto",
        /// Red, green and blue go all as light of `wavelength_nm` does.
        Rgb = "rgb",
        /// Daylight of 6504 K, the white of sRGB.
        D65 = "D65",
        /// The same power at all wavelengths.
        E = "E",
    }
}

table! {
    /// What a lamp sends out: one of a black body, lines or a table.
    pub struct LampSpectrum {
        /// The temperature of a black body.
        black_body_k: Option<f64>, "K", in ValueRange::Within(500.0, 1e6),
        /// Lines { wavelength_nm = 546.1, power = 1 }, each of one wavelength.
        lines: Vec<SpectralLine>,
        /// Rows [wavelength, power] of rising wavelengths (nm), with straight lines between them and
        /// nothing beyond: the power is that in equal ranges of wavelengths. They stand in the scene itself.
        table: Option<Sampled>, in ValueRange::Within(0.0, 1e30),
    }
}

table! {
    /// A line of a lamp.
    pub struct SpectralLine {
        /// Its wavelength in vacuum.
        wavelength_nm: Option<f64>, "nm", in ValueRange::Within(380.0, 780.0),
        /// Its power beside that of other lines.
        power: f64 = 1.0, in ValueRange::Within(0.0, 1e30),
    }
}

/// The spectrum of the light: a word, one wavelength or a lamp.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// A word.
    Word(SpectrumWord),
    /// Light of one wavelength in vacuum, nm.
    Wavelength(f64),
    /// A lamp.
    Lamp(LampSpectrum),
}

impl Default for Spectrum {
    fn default() -> Self {
        Self::Word(SpectrumWord::default())
    }
}

impl Field for Spectrum {
    const KIND: KeyKind =
        KeyKind::ChoiceNumberOrTable { options: SpectrumWord::WORDS, keys: LampSpectrum::KEYS };

    fn from_value(value: &Value) -> Option<Self> {
        if value.as_text().is_some() {
            return SpectrumWord::from_value(value).map(Self::Word);
        }
        match value.as_number() {
            Some(wavelength_nm) => Some(Self::Wavelength(wavelength_nm)),
            None => LampSpectrum::from_value(value).map(Self::Lamp),
        }
    }

    fn value(&self) -> Option<Value> {
        match self {
            Self::Word(word) => word.value(),
            Self::Wavelength(wavelength_nm) => wavelength_nm.value(),
            Self::Lamp(lamp) => lamp.value(),
        }
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        if let Self::Lamp(lamp) = self {
            lamp.show_files(path, visit);
        }
    }
}

impl Spectrum {
    /// The lamp whose light has colors of wavelengths; `None` where red, green and blue go as light
    /// of one wavelength does. `dispersive` is whether a medium of the scene is of a law.
    ///
    /// # Errors
    ///
    /// If it is that of no lamp.
    pub fn lamp(&self, dispersive: bool) -> Result<Option<Lamp>, KeyError> {
        match self {
            Self::Word(SpectrumWord::Auto) => Ok(dispersive.then_some(Lamp::D65)),
            Self::Word(SpectrumWord::Rgb) => Ok(None),
            Self::Word(SpectrumWord::D65) => Ok(Some(Lamp::D65)),
            Self::Word(SpectrumWord::E) => Ok(Some(Lamp::EqualPower)),
            Self::Wavelength(wavelength_nm) => Ok(Some(Lamp::Lines(vec![[*wavelength_nm, 1.0]]))),
            Self::Lamp(lamp) => lamp.lamp().map(Some),
        }
    }
}

impl LampSpectrum {
    fn lamp(&self) -> Result<Lamp, KeyError> {
        let refused = |key, message: &str| Err(KeyError::at(key, message));
        match (self.black_body_k, self.lines.as_slice(), &self.table) {
            (Some(kelvin), [], None) => Ok(Lamp::BlackBody(kelvin)),
            (None, lines @ [_, ..], None) => {
                let line = |line: &SpectralLine| Some([line.wavelength_nm?, line.power]);
                match lines.iter().map(line).collect::<Option<Vec<_>>>() {
                    None => refused(LINES, "a line has no wavelength_nm; give it"),
                    Some(lines) if lines.iter().all(|[_, power]| *power == 0.0) => {
                        refused(LINES, "no line has any power")
                    }
                    Some(lines) => Ok(Lamp::Lines(lines)),
                }
            }
            (None, [], Some(Sampled::Here(rows))) => {
                let pairs: Vec<[f64; 2]> = match rows.shape() {
                    [count, 2] if *count >= 2 => {
                        rows.values().chunks_exact(2).map(|row| [row[0], row[1]]).collect()
                    }
                    _ => {
                        let message =
                            "table needs two rows or more, [wavelength in nm, power] each";
                        return refused(TABLE, message);
                    }
                };
                if pairs.windows(2).any(|pair| pair[0][0] >= pair[1][0]) {
                    return refused(TABLE, "the wavelengths of table do not rise");
                }
                let lamp = Lamp::Table(pairs);
                if lamp.is_dark() {
                    let message = "table has no power that is seen, from 380 to 780 nm";
                    return refused(TABLE, message);
                }
                Ok(lamp)
            }
            (None, [], Some(Sampled::InFile(_))) => {
                refused(TABLE, "table is the name of a file; write its rows here")
            }
            (None, [], None) => refused(
                SPECTRUM,
                "this lamp sends out nothing; give it black_body_k, lines or a table, or write \
                 spectrum = \"D65\"",
            ),
            _ => refused(SPECTRUM, "black_body_k, lines and table: a lamp takes one of them"),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::color::Lamp;
    use crate::scene_file;
    use std::path::Path;

    /// What a spectrum comes to, or the message.
    fn lamp(spectrum: &str) -> Result<Option<Lamp>, String> {
        let text = format!("[light]\nspectrum = {spectrum}\n");
        let loaded = scene_file::parse(&text, "test", Path::new(""), &[])
            .map_err(|error| error.to_string())?;
        loaded.scene.light.spectrum.lamp(false).map_err(|error| format!("{error:?}"))
    }

    #[test]
    fn spectra_are_lamps() {
        let lines = "{ lines = [{ wavelength_nm = 546.1 }, { wavelength_nm = 578, power = 2 }] }";
        for (spectrum, wanted) in [
            ("\"auto\"", None),
            ("\"rgb\"", None),
            ("\"D65\"", Some(Lamp::D65)),
            ("\"E\"", Some(Lamp::EqualPower)),
            ("532", Some(Lamp::Lines(vec![[532.0, 1.0]]))),
            ("{ black_body_k = 2856 }", Some(Lamp::BlackBody(2856.0))),
            (lines, Some(Lamp::Lines(vec![[546.1, 1.0], [578.0, 2.0]]))),
            (
                "{ table = [[400, 0.2], [700, 1]] }",
                Some(Lamp::Table(vec![[400.0, 0.2], [700.0, 1.0]])),
            ),
        ] {
            assert_eq!(lamp(spectrum), Ok(wanted), "{spectrum}");
        }
    }

    #[test]
    fn what_is_no_lamp_is_told() {
        for (spectrum, word) in [
            ("\"d65\"", "D65"),
            ("0.55", "380"),
            ("[400, 700]", "spectrum"),
            ("{}", "sends out nothing"),
            ("{ black_body = 2856 }", "black_body_k"),
            ("{ black_body_k = 20 }", "500"),
            ("{ black_body_k = nan }", "finite"),
            ("{ lines = [{ power = 1 }] }", "wavelength_nm"),
            ("{ lines = [{ wavelength_nm = 900 }] }", "780"),
            ("{ lines = [{ wavelength_nm = 500, power = 0 }] }", "no line has any power"),
            ("{ black_body_k = 3000, lines = [{ wavelength_nm = 500 }] }", "takes one of them"),
            ("{ table = [[400, 1]] }", "two rows"),
            ("{ table = [[400, 1, 2], [500, 1, 2]] }", "two rows"),
            ("{ table = [[500, 1], [400, 1]] }", "do not rise"),
            ("{ table = [[800, 1], [900, 1]] }", "no power that is seen"),
            ("{ table = \"lamp.csv\" }", "write its rows here"),
        ] {
            let message = lamp(spectrum).expect_err(spectrum);
            assert!(message.contains(word), "{spectrum}: {message}");
        }
    }
}
