//! What has been found out about a statement, and how it is written down.

use super::fixture::{HALF_VIEW, WIDE_HALF_VIEW};
use cloakroom::measure::IN_PLACE_WITHIN;
use serde::Serialize;
use std::fmt::Write;

/// Whether a statement holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It does: a number to the digits that are printed, a limit kept, a comparison that comes out
    /// so.
    Agrees,
    /// A number is off by no more than a tenth of the one that is printed; by how much is said
    /// beside it.
    AgreesClosely,
    /// A number is not off by more than a factor of 3.
    AgreesInOrderOfMagnitude,
    /// A judgement without a number holds by one of the two tolerances of light in place, and not
    /// by the other.
    DependsOnTolerance,
    /// It does not.
    Differs,
}

/// One statement of the paper and what was computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    pub remark: String,
    /// By how much a number is off the one that is printed, or beyond the limit that is stated, as
    /// a share of that; 0 where it agrees, `None` where the statement has no number.
    pub relative_deviation: Option<f64>,
}

/// The largest deviation of numbers that agree closely.
const CLOSE: f64 = 0.1;

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
        if (ratio - 1.0).abs() <= CLOSE {
            Self::AgreesClosely
        } else if (1.0 / MAGNITUDE..=MAGNITUDE).contains(&ratio) {
            Self::AgreesInOrderOfMagnitude
        } else {
            Self::Differs
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::AgreesClosely => "agrees closely",
            Self::AgreesInOrderOfMagnitude => "agrees in order of magnitude",
            Self::DependsOnTolerance => "depends on the tolerance",
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
        let (remark, relative_deviation) = (String::new(), None);
        self.0.push(Finding { place, statement, computed, verdict, remark, relative_deviation });
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
        let words = format!("{computed:.decimals$}{unit}");
        self.computed(words).verdict_on_number(computed, printed, decimals)
    }

    /// The verdict on a number, against the one that is printed with so many decimals.
    pub(super) fn verdict_on_number(
        &mut self,
        computed: f64,
        printed: f64,
        decimals: usize,
    ) -> &mut Self {
        let verdict = Verdict::number(computed, printed, decimals as i32);
        self.deviation(verdict, computed / printed - 1.0).verdict(verdict)
    }

    /// The verdict on a number that is said to be at most another.
    pub(super) fn verdict_on_limit(&mut self, computed: f64, limit: f64) -> &mut Self {
        let verdict = Verdict::limit(computed, limit);
        self.deviation(verdict, computed / limit - 1.0).verdict(verdict)
    }

    fn deviation(&mut self, verdict: Verdict, deviation: f64) -> &mut Self {
        let off = if verdict == Verdict::Agrees { 0.0 } else { deviation };
        self.relative_deviation = Some(off);
        self
    }

    /// The verdict in words.
    fn verdict_in_words(&self) -> String {
        match (self.verdict, self.relative_deviation) {
            (Verdict::Agrees, _) => Verdict::Agrees.words().to_owned(),
            (Verdict::AgreesClosely, Some(off)) => {
                format!("**agrees to {} %**", rounded_up(100.0 * off.abs()))
            }
            (verdict, _) => format!("**{}**", verdict.words()),
        }
    }

    /// The verdict on what is judged by light in place, strictly and widely; if they are two, a
    /// word says which holds.
    pub(super) fn verdict_in_place(&mut self, [strictly, widely]: [bool; 2]) -> &mut Self {
        if strictly == widely {
            return self.verdict(strictly);
        }
        let [place, angle] = IN_PLACE_WITHIN[usize::from(widely)];
        let degrees = if angle == 1.0 { "degree" } else { "degrees" };
        self.because(format!("It holds within {place} cm and {angle} {degrees} alone."));
        self.verdict(Verdict::DependsOnTolerance)
    }

    /// The finding with a word why, or one more.
    pub(super) fn because(&mut self, remark: impl AsRef<str>) {
        if !self.remark.is_empty() {
            self.remark.push(' ');
        }
        self.remark.push_str(remark.as_ref());
    }
}

/// A positive number to two digits, rounded up.
fn rounded_up(number: f64) -> String {
    let decimals = (1.0 - number.log10().floor()).clamp(0.0, 9.0);
    let scale = 10f64.powf(decimals);
    format!("{:.*}", decimals as usize, (number * scale).ceil() / scale)
}

/// Where waves are: this program computes rays alone.
const WAVES: &str = "\n## Waves\n\n\
    Rays are the limit of short waves. [full-wave.md](full-wave.md) solves Maxwell's equations on the same devices and says where rays\n\
    hold, and where they do not: it is computed by `benches/full_wave/run.py`, not by `cloakroom verify`.\n";

/// The findings as a page in Markdown.
#[must_use]
pub fn markdown(findings: &[Finding]) -> String {
    let count = |verdict| findings.iter().filter(|finding| finding.verdict == verdict).count();
    let [[place, angle], [wide_place, wide_angle]] = IN_PLACE_WITHIN;
    let mut text = format!(
        "# Validation\n\n\
         What of Halimeh & Wegener, Opt. Express 21, 9457 (2013) comes out here. `cloakroom verify` computes this page\n\
         from the scenes of the paper, and a test holds each verdict and its numbers. No number is adjusted to agree.\n\n\
         A number *agrees* if it does to the digits that are printed, or keeps the limit that is stated, of which the largest\n\
         number found is held against it and no mean; it agrees *to x %* if it is off by no more than {}, and *in\n\
         order of magnitude* within a factor of 3.\n\n\
         A judgement without a number is judged by rays, for pictures flatter or blame with the photograph, by one rule for all\n\
         designs. Light is *in place* if it goes within {angle} degree of the direction that it should have and lands within\n\
         {place} cm of where it should, which is what `cloakroom quality` calls cloaked; *widely*, within {wide_angle} degrees and\n\
         {wide_place} cm. It should be where the same ray lands in the empty view or, where the paper speaks of a flat mirror, in\n\
         the view of this mirror. Perfect means all of the power to rounding; very good, formidable, great, amazing or remarkable {}\n\
         of it, good {}, both more than with the bare metal; no cloaking, less than {}. A comparison agrees if it comes\n\
         out so. No word of the paper says how far off light may be: where the two tolerances give two answers, the verdict *depends\n\
         on the tolerance*. The mean is over one region for all designs and rotations: the part of the view where the metal of each of\n\
         them, bare and along the axis, leaves nothing in place, even widely. FLIP, 0 for equal pictures, stands beside it. A\n\
         reflection is seen, or significant, from {} of the light on. Which rule stands for which word is our choice; the numbers\n\
         let everyone choose another.\n\n\
         The paper gives neither the camera's distance nor its field of view. Ours, 100 cm and a half view of {HALF_VIEW} degrees, are an\n\
         assumption. Where a bound over the view hangs on it, the number for a half view of {WIDE_HALF_VIEW} degrees stands in brackets beside\n\
         it; the verdict is that of {HALF_VIEW} degrees. Light in place, means and reflections of pictures are those of our view.\n\n\
         Pictures are of 160 x 120 pixels with one ray each, `min_power` 1e-4; main paths are of every second row and\n\
         column. H and V are horizontal and vertical polarization.\n\n",
        percent(CLOSE, 0),
        percent(VERY_GOOD, 0),
        percent(GOOD, 0),
        percent(NO_CLOAKING, 0),
        percent(SEEN, 0),
    );
    // Writing into a text does not fail.
    let _ = writeln!(
        text,
        "{} statements: {} agree, {} agree to {}, {} agree in order of magnitude, {} depend on \
         the tolerance, {} differ.\n",
        findings.len(),
        count(Verdict::Agrees),
        count(Verdict::AgreesClosely),
        percent(CLOSE, 0),
        count(Verdict::AgreesInOrderOfMagnitude),
        count(Verdict::DependsOnTolerance),
        count(Verdict::Differs)
    );
    text.push_str("| place | the paper says | computed here | verdict | why |\n");
    text.push_str("| --- | --- | --- | --- | --- |\n");
    for finding in findings {
        let Finding { place, statement, computed, remark, .. } = finding;
        let verdict = finding.verdict_in_words();
        let _ = writeln!(text, "| {place} | {statement} | {computed} | {verdict} | {remark} |");
    }
    text.push_str(WAVES);
    text
}

/// The share of the power that is in place where a design is called good, and very good.
pub(super) const GOOD: f64 = 0.5;
pub(super) const VERY_GOOD: f64 = 0.9;

/// The share below which nothing is called cloaked.
pub(super) const NO_CLOAKING: f64 = 0.1;

/// The share of the light that a reflection must have to be seen, or to be significant.
pub(super) const SEEN: f64 = 0.01;

/// What double precision leaves of equal numbers near 1, and what single precision leaves of equal
/// light.
pub(super) const DOUBLE: f64 = 2e-13;
pub(super) const SINGLE: f64 = 2e-6;

/// A number in percent, to a number of decimals.
pub(super) fn percent(share: f64, decimals: usize) -> String {
    format!("{:.decimals$} %", 100.0 * share)
}

/// Numbers in words, one after the other.
pub(super) fn list<T>(values: &[T], word: impl Fn(&T) -> String) -> String {
    values.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// The power of ten that a number, of which what is below `least` is rounding, stays below: that is
/// worth no more digits, and would change from machine to machine.
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
        assert_eq!(Verdict::number(11.516, 11.51, 2), Verdict::AgreesClosely);
        assert_eq!(Verdict::number(12.8, 11.51, 2), Verdict::AgreesInOrderOfMagnitude);
        assert_eq!(Verdict::number(40.0, 11.51, 2), Verdict::Differs);
        assert_eq!(Verdict::limit(0.02, 0.03), Verdict::Agrees);
        assert_eq!(Verdict::limit(0.032, 0.03), Verdict::AgreesClosely);
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
        page.says("there", "it is 114.83").number(114.7802, (114.83, 2, " cm²"));
        page.says("there", "it is less than 3 %").verdict_on_limit(0.0319, 0.03);
        assert_eq!(page.0[2].relative_deviation, Some(114.7802 / 114.83 - 1.0));
        page.says("there", "it is good")
            .computed("40 %".to_owned())
            .verdict_in_place([false, true]);
        let page = markdown(&page.0);
        assert!(page.contains(
            "5 statements: 1 agree, 2 agree to 10 %, 0 agree in order of magnitude, 1 depend on the \
             tolerance, 1 differ.",
        ));
        assert!(page.contains(
            "| 40 % | **depends on the tolerance** | It holds within 5 cm and 5 degrees alone. |",
        ));
        assert!(page.contains("| 114.78 cm² | **agrees to 0.044 %** |"));
        assert!(page.contains("| **agrees to 6.4 %** |"));
        assert!(page.contains("| there | it is 3 | 9 | **differs** | It is 9. |\n"));
        assert!(page.contains(" |\n\n## Waves\n"));
        assert_eq!(below(3e-5, 1e-12, "cm"), "below 1e-4 cm");
        assert_eq!(below(0.0, 2e-13, ""), "below 1e-12");
        assert_eq!(below(4.0, 20.0, "ys"), "below 100 ys");
    }
}
