//! Which values of which keys are gone through.

use super::waypoint::Waypoint;
use crate::keys::{Value, quoted};
use crate::scene_file::{Override, text};

/// Most pictures that one set of sweeps may ask for.
const MOST: usize = 100_000;

/// Numbers of a range are written with no more decimals: enough for any.
const MOST_DECIMALS: usize = 400;

/// One key of a scene and the values it takes, one after the other.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Sweep {
    /// The key, as in `device.0.rotation`.
    pub key: String,
    /// Its values as a scene or an override writes them, one at least.
    pub values: Vec<String>,
    /// What they are, where they were not given as text.
    #[serde(skip)]
    given: Vec<Value>,
}

/// Why there is nothing to sweep.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SweepError {
    /// The sweep is not written as one.
    #[error(
        "--sweep {text}: {problem}; write KEY=START..END:STEP or KEY=VALUE,VALUE,... as in \
         device.0.rotation=0..90:5"
    )]
    Unreadable {
        /// The sweep as it was written.
        text: String,
        /// What is wrong with it.
        problem: String,
    },
    /// This key is swept twice.
    #[error("{0} is swept twice")]
    Twice(String),
    /// There are too many combinations.
    #[error("these sweeps have more than {MOST} combinations")]
    TooMany,
}

impl Sweep {
    /// Reads `KEY=START..END:STEP`, the end included, or `KEY=VALUE,VALUE,...`; commas in brackets
    /// and quotes belong to a value. Start and end may be vectors, `[0,0,0]..[10,0,0]:5`: the step is
    /// a length along the straight way between them.
    ///
    /// # Errors
    ///
    /// If it is written otherwise, has no values, or a number in it is not finite.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let refuse = |problem: String| SweepError::Unreadable { text: text.to_owned(), problem };
        let (key, values) =
            text.split_once('=').ok_or_else(|| refuse("there is no = in it".to_owned()))?;
        let (key, values) = (key.trim(), values.trim());
        if key.is_empty() {
            return Err(refuse("there is no key before the =".to_owned()));
        }
        let range = values.split_once("..").filter(|_| !values.contains(['"', '\'']));
        let values = match range {
            Some((start, rest)) => {
                let (end, step) = rest
                    .split_once(':')
                    .ok_or_else(|| refuse("a range needs a step".to_owned()))?;
                let [start, end, step] = [start, end, step].map(str::trim);
                let is_vector = start.starts_with('[') || end.starts_with('[');
                let steps = if is_vector { vector_steps } else { steps };
                steps(start, end, step).map_err(refuse)?
            }
            None => split(values),
        };
        if values.iter().any(String::is_empty) {
            return Err(refuse("a value is missing".to_owned()));
        }
        let infinite = |value: &&String| value.parse().is_ok_and(|n: f64| !n.is_finite());
        if let Some(value) = values.iter().find(infinite) {
            return Err(refuse(format!("{} is not a finite number", quoted(value, '`'))));
        }
        Ok(Self { key: key.to_owned(), values, given: Vec::new() })
    }

    /// The sweep of a key through values.
    #[must_use]
    pub fn through(key: String, given: Vec<Value>) -> Self {
        Self { key, values: given.iter().map(text).collect(), given }
    }

    /// The sweep of a key through values that are written.
    #[must_use]
    pub fn written(key: String, values: Vec<String>) -> Self {
        Self { key, values, given: Vec::new() }
    }

    /// What sets the key to the value of that number.
    pub(crate) fn set(&self, number: usize) -> Override {
        let key = self.key.clone();
        let set = match self.given.get(number) {
            Some(value) => Override::value(key, value.clone()),
            None => format!("{key}={}", self.values[number]).into(),
        };
        let words = format!("--sweep {set}");
        set.by(words)
    }

    /// The values as numbers, if all are.
    #[must_use]
    pub fn numbers(&self) -> Option<Vec<f64>> {
        self.values.iter().map(|value| value.parse().ok()).collect()
    }
}

/// The numbers of a range, with the decimals of its start and its step.
fn steps(start: &str, end: &str, step: &str) -> Result<Vec<String>, String> {
    let number = |text: &str| {
        let parsed: Option<f64> = text.parse().ok().filter(|n: &f64| n.is_finite());
        parsed.ok_or_else(|| format!("{} is not a finite number", quoted(text, '`')))
    };
    let (first, last, by) = (number(start)?, number(end)?, number(step)?);
    let count = count((last - first) / by, by)?;
    let decimals = |text: &str| text.split_once('.').map_or(0, |(_, digits)| digits.len());
    let decimals = decimals(start).max(decimals(step)).min(MOST_DECIMALS);
    let plain = ![start, step].iter().any(|text| text.contains(['e', 'E']));
    Ok((0..count)
        .map(|i| {
            let value = first + i as f64 * by;
            if plain { format!("{value:.decimals$}") } else { value.to_string() }
        })
        .collect())
}

/// The vectors on the straight way from the first to the last, a length of `step` apart.
fn vector_steps(start: &str, end: &str, step: &str) -> Result<Vec<String>, String> {
    let (points, by) = (Waypoint::way(&format!("{start}..{end}"))?, Waypoint::parse(step)?);
    let [first, last] = points.as_slice() else {
        return Err("a range has one start and one end".to_owned());
    };
    let by = by.number().ok_or("the step of a range of vectors is a length, a number")?;
    let length = first.distance(last);
    let count = count(length / by, by)?;
    // The end is itself.
    let share = |i: usize| if length > 0.0 { (i as f64 * by / length).min(1.0) } else { 0.0 };
    Ok((0..count).map(|i| first.toward(last, share(i)).to_string()).collect())
}

/// How many values there are in so many steps of that size, both ends included.
fn count(steps: f64, by: f64) -> Result<usize, String> {
    // Rounding takes no end away.
    let steps = steps + 1e-9;
    if by == 0.0 || steps.is_nan() || steps < 0.0 {
        return Err(
            "the range is empty: its step does not lead from its start to its end; one that goes down is \
             negative, as in 10..0:-2.5"
                .to_owned()
        );
    }
    if steps >= MOST as f64 {
        return Err(format!("the range has more than {MOST} values"));
    }
    Ok(steps as usize + 1)
}

/// The values between commas that lie in no brackets and no quotes.
fn split(text: &str) -> Vec<String> {
    let (mut depth, mut quote) = (0_i32, None);
    let mut values = vec![String::new()];
    for c in text.chars() {
        match (c, quote) {
            ('"' | '\'', None) => quote = Some(c),
            (_, Some(open)) if c == open => quote = None,
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth -= 1,
            (',', None) if depth <= 0 => {
                values.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(value) = values.last_mut() {
            value.push(c);
        }
    }
    values.iter().map(|value| value.trim().to_owned()).collect()
}

/// Every combination of the values of sweeps, as the number of each value in its sweep; the last
/// one runs fastest. Without sweeps, there is one.
///
/// # Errors
///
/// If a key is swept twice, or there are too many.
pub fn combinations(sweeps: &[Sweep]) -> Result<Vec<Vec<usize>>, SweepError> {
    for (i, sweep) in sweeps.iter().enumerate() {
        if sweeps[..i].iter().any(|other| other.key == sweep.key) {
            return Err(SweepError::Twice(sweep.key.clone()));
        }
    }
    let count =
        sweeps.iter().try_fold(1_usize, |count, sweep| count.checked_mul(sweep.values.len()));
    if count.is_none_or(|count| count > MOST) {
        return Err(SweepError::TooMany);
    }
    Ok(sweeps.iter().fold(vec![Vec::new()], |chosen, sweep| {
        let extended = |before: &Vec<usize>| {
            let before = before.clone();
            (0..sweep.values.len()).map(move |i| [before.as_slice(), &[i]].concat())
        };
        chosen.iter().flat_map(extended).collect()
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Sweep::parse(text).unwrap_or_else(|error| panic!("{error}")).values
    }

    #[test]
    fn ranges_have_both_ends_and_plain_numbers() {
        assert_eq!(values("a=0..1:0.1").len(), 11);
        assert_eq!(values("a=0..1:0.1")[3], "0.3");
        assert_eq!(values("a=0..90:45"), ["0", "45", "90"]);
        assert_eq!(values("a = 2 .. -1 : -1.5"), ["2.0", "0.5", "-1.0"]);
        assert_eq!(values("a=3..3:1"), ["3"]);
        assert_eq!(values("a=1e-4..3e-4:1e-4").len(), 3);
        // More digits than a format takes.
        assert_eq!(values(&format!("a=0..1:0.5{}", "0".repeat(70_000))).len(), 3);
    }

    #[test]
    fn vectors_go_straight_by_lengths() {
        let expected = ["[0, 0, 0]", "[5, 0, 0]", "[10, 0, 0]"];
        assert_eq!(values("a=[0,0,0]..[10, 0, 0]:5"), expected);
        assert_eq!(values("a=[1,2]..[4,6]:2.5"), ["[1, 2]", "[2.5, 4]", "[4, 6]"]);
        assert_eq!(values("a=[0,0]..[0.3,0]:0.1").len(), 4);
        assert_eq!(values("a=[7,7]..[7,7]:1"), ["[7, 7]"]);
    }

    #[test]
    fn lists_keep_brackets_and_quotes_whole() {
        assert_eq!(values("a=horizontal, vertical"), ["horizontal", "vertical"]);
        assert_eq!(values("a=[1,2],[3,[4,5]]"), ["[1,2]", "[3,[4,5]]"]);
        assert_eq!(values("a=\"x,y\",'..'"), ["\"x,y\"", "'..'"]);
        assert_eq!(Sweep::parse("a=1,2.5").map(|s| s.numbers()), Ok(Some(vec![1.0, 2.5])));
        assert_eq!(Sweep::parse("a=1,x").map(|s| s.numbers()), Ok(None));
    }

    #[test]
    fn nothing_to_sweep_is_refused() {
        for (text, part) in [
            ("rotation", "no ="),
            ("=1", "no key"),
            ("a=", "missing"),
            ("a=1,,2", "missing"),
            ("a=0..90", "needs a step"),
            ("a=0..90:-5", "empty"),
            ("a=0..90:0", "empty"),
            ("a=0..inf:1", "`inf` is not a finite"),
            ("a=1,nan", "`nan` is not a finite"),
            ("a=0..1:1e-9", "more than"),
            ("a=x..1:1", "`x` is not"),
            ("a=[0,0]..[1,0,0]:1", "not alike"),
            ("a=0..[1,0,0]:1", "not alike"),
            ("a=[0,0]..[1,0]:-1", "empty"),
            ("a=[0,0]..[1,0]:[1,0]", "is a length"),
            ("a=[0,y]..[1,0]:1", "`y` is not"),
            ("a=[0,0]..[1,0]", "needs a step"),
        ] {
            let message = Sweep::parse(text).expect_err(text).to_string();
            assert!(message.contains(part) && message.contains(text), "{message}");
        }
    }

    #[test]
    fn combinations_are_all_there_once() {
        let sweep = |text: &str| Sweep::parse(text).expect("a sweep");
        let all = combinations(&[sweep("a=1,2"), sweep("b=1..3:1")]).expect("few");
        assert_eq!(all, [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]]);
        assert_eq!(combinations(&[]).expect("one"), [[0_usize; 0]]);
        assert!(combinations(&[sweep("a=1"), sweep("a=2")]).is_err());
        let many = ["a", "b", "c"].map(|key| sweep(&format!("{key}=1..99:1")));
        assert_eq!(combinations(&many), Err(SweepError::TooMany));
    }
}
