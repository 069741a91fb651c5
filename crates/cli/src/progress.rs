//! Long work: a bar with the remaining time on a terminal, silence when piped, and an end at
//! Ctrl-C.

use crate::interruption::STOP;
use cloakroom::render::Supervision;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;

/// Does work that comes in `steps` steps; it gets their bar, on standard error, and what it is
/// supervised by.
pub fn supervised<T>(
    steps: u64,
    what: &str,
    work: impl FnOnce(&ProgressBar, &Supervision<'_>) -> T,
) -> T {
    let target = if std::io::stderr().is_terminal() {
        ProgressDrawTarget::stderr_with_hz(10)
    } else {
        ProgressDrawTarget::hidden()
    };
    let bar = ProgressBar::with_draw_target(Some(steps), target);
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  ETA {eta}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.set_style(style);
    bar.set_message(what.to_owned());
    let done = work(&bar, &Supervision { rows_done: &|steps| bar.inc(steps), stop: &STOP });
    bar.finish_and_clear();
    done
}
