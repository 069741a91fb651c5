//! The nearest known word to a mistyped one.

use super::synonyms::synonym;
use super::value::quoted;

/// Longer words are not compared: nobody meant a key by them, and the comparison is quadratic.
const LONGEST_WORD: usize = 64;

/// The shortest beginning of a word that counts as an abbreviation of it.
const SHORTEST_ABBREVIATION: usize = 3;

/// The candidate that was probably meant by `word`, if any is near enough.
///
/// Case and the difference between `-` and `_` do not count, about one slip in three letters is
/// forgiven, and a beginning of at least three letters stands for the whole word.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > LONGEST_WORD {
        return None;
    }
    let folded = fold(word);
    candidates
        .into_iter()
        .filter_map(|candidate| Some((distance(&folded, &fold(candidate))?, candidate)))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// The end of a message about an unknown word: "; did you mean `position`?", or, if nothing is
/// near, the list of what is known, introduced by `known_as` ("known keys").
pub fn hint(word: &str, known: &[&str], known_as: &str) -> String {
    match nearest(word, known.iter().copied()) {
        Some(candidate) => format!("; did you mean `{candidate}`?"),
        None if known.is_empty() => String::new(),
        None => format!("; {known_as}: {}", known.join(", ")),
    }
}

/// "unknown key `positon`" with the hint of [`hint`], or with the word here for what is called so
/// elsewhere; `place` is empty or such as ` in [camera]`.
pub fn unknown(what: &str, word: &str, place: &str, known: &[&str]) -> String {
    let hint = match synonym(word, known) {
        Some(meant) => format!("; here it is called `{meant}`"),
        None => hint(word, known, &format!("known {what}s")),
    };
    format!("unknown {what} {}{place}{hint}", quoted(word, '`'))
}

/// How far apart two folded words are; `None` if too far for one to stand for the other.
fn distance(word: &str, candidate: &str) -> Option<usize> {
    let distance = strsim::damerau_levenshtein(word, candidate);
    let forgiven = word.chars().count().max(candidate.chars().count()).div_ceil(3);
    if distance <= forgiven && distance < candidate.chars().count() {
        return Some(2 * distance);
    }
    let abbreviation = word.len() >= SHORTEST_ABBREVIATION && candidate.starts_with(word);
    // Worse than one slip, better than several.
    abbreviation.then_some(3)
}

pub(super) fn fold(word: &str) -> String {
    word.chars().map(|c| if c == '-' || c == ' ' { '_' } else { c.to_ascii_lowercase() }).collect()
}

#[cfg(test)]
mod tests;
