//! What has been found out about a statement, and how it is written down.

use serde::Serialize;
use std::fmt::Write;

/// Whether a statement holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It does: a number to the digits that are printed, a limit kept, a comparison that comes out so.
    Agrees,
    /// A number is not off by more than a factor of 3.
    AgreesInOrderOfMagnitude,
    /// It does not.
    Differs,
}

/// One statement of the paper and what was computed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// Where it stands.
    pub place: &'static str,
    /// Its gist.
    pub statement: &'static str,
    /// What was computed, in words and numbers.
    pub computed: String,
    /// Whether it holds.
    pub verdict: Verdict,
    /// A word why, where it does not quite; else empty.
    pub remark: &'static str,
}

/// The largest factor between numbers of one order of magnitude.
const MAGNITUDE: f64 = 3.0;

impl From<bool> for Verdict {
    /// Of a statement that comes out or does not.
    fn from(holds: bool) -> Self {
        if holds { Self::Agrees } else { Self::Differs }
    }
}

impl Verdict {
    /// Of a number, against the one that is printed with so many decimals.
    pub(super) fn number(computed: f64, printed: f64, decimals: i32) -> Self {
        // A hair more than half a digit: the border belongs to both.
        let half = 0.5 * 10f64.powi(-decimals) * (1.0 + 1e-9);
        let agrees = (computed - printed).abs() <= half;
        if agrees { Self::Agrees } else { Self::magnitude(computed, printed) }
    }

    /// Of a number that is said to be at most another.
    pub(super) fn limit(computed: f64, limit: f64) -> Self {
        if computed <= limit { Self::Agrees } else { Self::magnitude(computed, limit) }
    }

    fn magnitude(computed: f64, printed: f64) -> Self {
        let ratio = computed / printed;
        if (1.0 / MAGNITUDE..=MAGNITUDE).contains(&ratio) {
            Self::AgreesInOrderOfMagnitude
        } else {
            Self::Differs
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::AgreesInOrderOfMagnitude => "agrees in order of magnitude",
            Self::Differs => "differs",
        }
    }
}

/// All that has been found.
#[derive(Default)]
pub(super) struct Page(pub Vec<Finding>);

impl Page {
    /// Adds what the paper says at a place, its gist; what was found about it is called on it.
    pub fn says(&mut self, place: &'static str, statement: &'static str) -> &mut Finding {
        let (index, computed, verdict) = (self.0.len(), String::new(), Verdict::Differs);
        self.0.push(Finding { place, statement, computed, verdict, remark: "" });
        &mut self.0[index]
    }
}

impl Finding {
    /// What was computed, in words and numbers.
    pub(super) fn computed(&mut self, computed: String) -> &mut Self {
        self.computed = computed;
        self
    }

    /// Whether the statement holds.
    pub(super) fn verdict(&mut self, verdict: impl Into<Verdict>) -> &mut Self {
        self.verdict = verdict.into();
        self
    }

    /// A number was computed, against the one that is printed with so many decimals.
    pub(super) fn number(&mut self, computed: f64, printed: (f64, usize, &str)) -> &mut Self {
        let (printed, decimals, unit) = printed;
        let verdict = Verdict::number(computed, printed, decimals as i32);
        self.computed(format!("{computed:.decimals$}{unit}")).verdict(verdict)
    }

    /// The finding with a word why.
    pub(super) fn because(&mut self, remark: &'static str) {
        self.remark = remark;
    }
}

/// Where waves are: this program computes rays alone.
const WAVES: &str = "\n## Waves\n\n\
    Rays are the limit of short waves. [full-wave.md](full-wave.md) solves Maxwell's equations on the same devices and says where rays\n\
    hold, and where they do not: it is computed by `benches/full_wave/run.py`, not by `cloakroom verify`.\n";

/// The findings as a page in Markdown.
#[must_use]
pub fn markdown(findings: &[Finding]) -> String {
    let count = |verdict| findings.iter().filter(|finding| finding.verdict == verdict).count();
    let mut text = String::from(
        "# Validation\n\n\
         What of Halimeh & Wegener, Opt. Express 21, 9457 (2013) comes out here. `cloakroom verify` computes this page\n\
         from the scenes of the paper, and a test holds each verdict and its numbers. No number is adjusted to agree.\n\n\
         A number *agrees* if it does to the digits that are printed, or keeps the limit that is stated; it agrees *in order\n\
         of magnitude* within a factor of 3. A judgement without a number (good, formidable) agrees if the comparison behind\n\
         it comes out: nearer to what should be seen than bare metal is, or than the design that it is held against; a\n\
         reflection is significant from 1 % of the light on, and absent below.\n\
         Which comparison stands for a judgement, and over which part of the picture, is our choice; the numbers let\n\
         everyone choose another.\n\n\
         Pictures are of 160 x 120 pixels with one ray each, `min_power` 1e-4. A correlation is the zero-mean normalized one\n\
         of linear light at zero shift, the mean of red, green and blue, over the silhouette of the device unless it says\n\
         otherwise; RMS displacements are at the photograph, from rays. H and V are horizontal and vertical polarization.\n\n",
    );
    // Writing into a text does not fail.
    let _ = writeln!(
        text,
        "{} statements: {} agree, {} agree in order of magnitude, {} differ.\n",
        findings.len(),
        count(Verdict::Agrees),
        count(Verdict::AgreesInOrderOfMagnitude),
        count(Verdict::Differs)
    );
    text.push_str("| place | the paper says | computed here | verdict | why |\n");
    text.push_str("| --- | --- | --- | --- | --- |\n");
    for Finding { place, statement, computed, verdict, remark } in findings {
        let verdict = match verdict {
            Verdict::Agrees => verdict.words().to_owned(),
            _ => format!("**{}**", verdict.words()),
        };
        let _ = writeln!(text, "| {place} | {statement} | {computed} | {verdict} | {remark} |");
    }
    text.push_str(WAVES);
    text
}

/// What double precision leaves of equal numbers near 1, and what single precision leaves of equal light.
pub(super) const DOUBLE: f64 = 2e-13;
pub(super) const SINGLE: f64 = 2e-6;

/// A number in percent, to a number of decimals.
pub(super) fn percent(share: f64, decimals: usize) -> String {
    format!("{:.decimals$} %", 100.0 * share)
}

/// Numbers for the paper's rotations, one after the other.
pub(super) fn list(values: [f64; 3]) -> String {
    values.map(|value| format!("{value:.2}")).join(", ")
}

/// Whether each number is above that of another list.
pub(super) fn above(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| *a > b)
}

/// The power of ten that a number, of which what is below `least` is rounding, stays below: that is worth no more
/// digits, and would change from machine to machine.
pub(super) fn below(number: f64, least: f64, unit: &str) -> String {
    let exponent = number.abs().max(least).log10().floor() as i32 + 1;
    let power = match exponent {
        0..=3 => 10f64.powi(exponent).to_string(),
        _ => format!("1e{exponent}"),
    };
    format!("below {power} {unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_follow_from_numbers() {
        assert_eq!(Verdict::number(11.5126, 11.51, 2), Verdict::Agrees);
        assert_eq!(Verdict::number(11.516, 11.51, 2), Verdict::AgreesInOrderOfMagnitude);
        assert_eq!(Verdict::number(40.0, 11.51, 2), Verdict::Differs);
        assert_eq!(Verdict::limit(0.02, 0.03), Verdict::Agrees);
        assert_eq!(Verdict::limit(0.05, 0.03), Verdict::AgreesInOrderOfMagnitude);
        assert_eq!(Verdict::limit(0.5, 0.03), Verdict::Differs);
        // Not a number is no agreement.
        assert_eq!(Verdict::limit(f64::NAN, 0.03), Verdict::Differs);
    }

    #[test]
    fn pages_have_a_line_for_each_finding() {
        let mut page = Page::default();
        page.says("here", "it is 3").computed("3".to_owned()).verdict(true);
        page.says("there", "it is 3").computed("9".to_owned()).verdict(false).because("It is 9.");
        let page = markdown(&page.0);
        assert!(page.contains("2 statements: 1 agree, 0 agree in order of magnitude, 1 differ."));
        assert!(page.contains("| there | it is 3 | 9 | **differs** | It is 9. |\n\n## Waves\n"));
        assert_eq!(below(3e-5, 1e-12, "cm"), "below 1e-4 cm");
        assert_eq!(below(0.0, 2e-13, ""), "below 1e-12");
        assert_eq!(below(4.0, 20.0, "ys"), "below 100 ys");
    }
}
