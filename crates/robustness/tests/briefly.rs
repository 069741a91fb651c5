//! Every trial for a moment: its seeds, changed at random but the same each time, and what once
//! found a fault.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr, reason = "a test may")]

use crate::long;
use cloakroom::device::CATALOGUE;
use cloakroom::photograph::{ImageSource, load_bytes};
use cloakroom_figures::gallery::EXHIBITS;
use robustness::{Draws, TRIALS, Trial};
use std::fs;
use std::path::{Path, PathBuf};

/// How many changed inputs each trial gets.
fn count(trial: &Trial) -> u64 {
    match trial.name {
        // A connection and a picture each.
        "page_messages" => long::count(10, 60),
        "scene_file" | "physics" => long::count(60, 400),
        "touching" | "cuts" => long::count(10, 400),
        "stacks" => long::count(5, 60),
        _ => long::count(500, 3000),
    }
}

fn trial(name: &str) -> &'static Trial {
    TRIALS.iter().find(|trial| trial.name == name).unwrap()
}

/// Trials that refused all that they begin with would try nothing.
#[test]
fn seeds_are_understood() {
    for trial in TRIALS {
        assert!(!(trial.seeds)().is_empty(), "{}", trial.name);
    }
    // Each scene of the gallery can be traced.
    assert_eq!((trial("trace_json").seeds)().len(), EXHIBITS.len());
    let source = ImageSource::File(PathBuf::from("a"));
    for bytes in (trial("images").seeds)() {
        load_bytes(&source, &bytes, 1 << 20).unwrap();
    }
}

/// An input changed in a few places, as a fuzzer would: bytes, numbers, pieces of another input.
fn changed(input: &[u8], other: &[u8], draws: &mut Draws<'_>) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..=draws.below(4) {
        if bytes.is_empty() {
            return other.to_vec();
        }
        let at = (draws.share() * bytes.len() as f64) as usize;
        match draws.below(6) {
            0 => bytes[at] ^= 1 << draws.below(8),
            1 => bytes[at] = draws.below(256) as u8,
            2 => bytes.truncate(at),
            3 => {
                let end = (at + 1 + draws.below(16)).min(bytes.len());
                bytes.drain(at..end);
            }
            4 => {
                let from = (draws.share() * other.len() as f64) as usize;
                let to = (from + draws.below(40)).min(other.len());
                bytes.splice(at..at, other[from..to].iter().copied());
            }
            _ => {
                let numbers = ["0", "-1", "1e308", "nan", "1e-9", "90", "65536", "0.5", "null"];
                let end = bytes[at..].iter().position(|byte| !byte.is_ascii_digit());
                let end = at + end.unwrap_or(0);
                bytes.splice(at..end, draws.pick(&numbers).bytes());
            }
        }
    }
    bytes
}

fn briefly(name: &str) {
    let trial = trial(name);
    let seeds = (trial.seeds)();
    for seed in &seeds {
        (trial.run)(seed);
    }
    let mut draws = Draws::Seed(20_131_105);
    for number in 0..count(trial) {
        let [one, other] = [0, 1].map(|_| &seeds[(draws.share() * seeds.len() as f64) as usize]);
        let input = changed(one, other, &mut draws);
        let ran = std::panic::catch_unwind(|| (trial.run)(&input));
        if let Err(panic) = ran {
            let path = std::env::temp_dir().join(format!("{name}-{number}"));
            fs::write(&path, &input).unwrap();
            eprintln!("{name}: the input is {}", path.display());
            std::panic::resume_unwind(panic);
        }
    }
}

/// The inputs that once found a fault, by trial.
fn regressions(name: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions").join(name);
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

#[test]
fn every_trial_has_a_target_of_its_own() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz");
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    for Trial { name, .. } in TRIALS {
        assert!(manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")), "{name}");
        let target = fs::read_to_string(folder.join("fuzz_targets").join(format!("{name}.rs")));
        assert!(target.unwrap().contains(&format!("robustness::run(\"{name}\", bytes)")), "{name}");
    }
    assert_eq!(manifest.matches("[[bin]]").count(), TRIALS.len());
    assert_eq!(fs::read_dir(folder.join("fuzz_targets")).unwrap().count(), TRIALS.len());
}

#[test]
fn what_once_found_a_fault_finds_none() {
    for trial in TRIALS {
        for path in regressions(trial.name) {
            println!("{}", path.display());
            (trial.run)(&fs::read(path).unwrap());
        }
    }
}

#[test]
fn scene_files() {
    briefly("scene_file");
}

#[test]
fn rays_as_json() {
    briefly("trace_json");
}

#[test]
fn interfaces_as_json() {
    briefly("interface_json");
}

#[test]
fn random_interfaces() {
    briefly("interfaces");
}

#[test]
fn image_files() {
    briefly("images");
}

#[test]
fn files_of_pictures() {
    briefly("picture_files");
}

#[test]
fn messages_of_pages() {
    briefly("page_messages");
}

#[test]
fn random_rays_through_random_devices() {
    briefly("physics");
}

#[test]
fn devices_that_touch() {
    briefly("touching");
}

#[test]
fn glass_cut_at_random() {
    briefly("cuts");
}

#[test]
fn stacks_of_plates() {
    briefly("stacks");
}

/// Words that contradict each other, drawn each by itself, once had nearly all of some kinds refused:
/// what is refused is not tried.
#[test]
fn some_scenes_of_every_kind_are_sound() {
    for entry in CATALOGUE {
        let mut draws = Draws::Seed(1);
        let refused: u64 = (0..8)
            .map(|_| match robustness::sound_scene(&mut draws, entry) {
                Ok(sound) => sound.refused,
                Err(why) => panic!("{}: {why}", entry.kind),
            })
            .sum();
        assert!(refused <= 400, "{}: {refused} refused", entry.kind);
    }
}
