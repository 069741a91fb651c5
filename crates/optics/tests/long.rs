//! How long tests take: a little by default, as long as it takes in `.ci/long`, which sets
//! `CLOAKROOM_LONG`.

use std::env;

/// How much a test draws: `short` usually, `long` if `CLOAKROOM_LONG` is set. What it asserts is
/// the same.
pub fn count<T>(short: T, long: T) -> T {
    if env::var_os("CLOAKROOM_LONG").is_some() { long } else { short }
}
