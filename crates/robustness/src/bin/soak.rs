//! Traces random rays through random devices of every kind, for as long as one likes, and counts
//! what must not be.
//!
//! The work is done in parcels: one random device each, and up to 20 000 rays; or as many through
//! devices that touch, glass cut at random, or stacks of plates. Every finished
//! parcel is a line of the record; begun again with the same record, the program goes on where it
//! was. A ray that does not end within a minute of computing is recorded, too, and ends the
//! program.
//!
//! ```sh
//! cargo run --release -p cloakroom-robustness --bin soak -- --rays 100000000 --record soak.jsonl
//! ```
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program for people")]

use clap::Parser;
use cloakroom::assembly::Assembly;
use cloakroom::device::{CATALOGUE, Entry};
use cloakroom::trace::{Limits, Tracer};
use robustness::{Draws, Fault, SoundScene};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Most rays of a parcel.
const RAYS: u64 = 20_000;

/// A parcel whose rays take longer than this ends early: its device is one of deep trees.
const LONGEST: Duration = Duration::from_secs(3);

/// A ray, or the making of a device, that takes longer than this does not end.
const STUCK: Duration = Duration::from_secs(60);

/// Branches weaker than this are not followed, as in pictures.
const LEAST_POWER: f64 = 1e-4;

/// What is counted of each parcel, by its name in the record.
const COUNTS: [&str; 11] = [
    "devices",
    "refused",
    "rays",
    "leaves",
    "unbalanced",
    "not_finite",
    "unsound",
    "early",
    "panics",
    "lost",
    "endless",
];

#[derive(Debug, Parser)]
struct Arguments {
    /// How many rays the record shall have.
    #[arg(long, default_value_t = 100_000_000)]
    rays: u64,
    /// The record: a line of JSON for each parcel.
    #[arg(long, default_value = "soak.jsonl")]
    record: PathBuf,
    /// The parcel to begin with: two programs with records of their own can share the work, and the
    /// lines of both be put into one record.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Ends after so many seconds, whatever has been done.
    #[arg(long)]
    seconds: Option<u64>,
    /// Only prints the table of what has been done.
    #[arg(long)]
    table: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match soak(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {}: {error}", arguments.record.display());
            ExitCode::FAILURE
        }
    }
}

/// Whether nothing was counted that must not be.
fn soak(arguments: &Arguments) -> io::Result<bool> {
    let mut lines = recorded(&arguments.record)?;
    if !arguments.table {
        let start = Instant::now();
        let done: HashSet<u64> = lines.iter().filter_map(|line| line["parcel"].as_u64()).collect();
        let mut rays: u64 = lines.iter().filter_map(|line| line["rays"].as_u64()).sum();
        let record = OpenOptions::new().create(true).append(true).open(&arguments.record)?;
        watch(start, record.try_clone()?);
        let in_time = || arguments.seconds.is_none_or(|most| start.elapsed().as_secs() < most);
        for number in (arguments.first..).filter(|number| !done.contains(number)) {
            if rays >= arguments.rays || !in_time() {
                break;
            }
            let line = parcel(number);
            rays += line["rays"].as_u64().unwrap_or(0);
            write_line(&record, &line)?;
            lines.push(line);
        }
    }
    Ok(print_table(&lines))
}

/// The lines of a record; one that was cut short when the program was killed is left out.
fn recorded(path: &Path) -> io::Result<Vec<Value>> {
    let file = match File::open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        file => file?,
    };
    let lines = BufReader::new(file).lines();
    lines.filter_map(|line| line.map(|line| serde_json::from_str(&line).ok()).transpose()).collect()
}

fn write_line(mut record: &File, line: &Value) -> io::Result<()> {
    // Begins with the end of a line: what was cut short before spoils nothing.
    record.write_all(format!("\n{line}").as_bytes())
}

/// A random scene that is looked at for what is said of such scenes alone: it sends rays, and
/// panics if that is not so.
type Trial = fn(&mut Draws<'_>) -> u64;

/// What parcels are of beside one device each.
const TRIALS: [(&str, Trial); 8] = [
    ("devices that touch", robustness::touch_any),
    ("cut glass", robustness::cut_glass),
    ("stacks of plates", robustness::stack),
    ("pictures of shared rays", robustness::interpolate),
    ("pictures straight ahead", robustness::interpolate_straight),
    ("pictures of small parts", robustness::interpolate_small),
    ("light in flight", robustness::fly),
    ("hardly birefringent bodies", robustness::hardly_birefringent),
];

/// What a parcel is of: a device, or a trial.
fn subject(number: u64) -> Result<&'static Entry, (&'static str, Trial)> {
    let subject = (number % (CATALOGUE.len() + TRIALS.len()) as u64) as usize;
    CATALOGUE.get(subject).copied().ok_or_else(|| TRIALS[subject - CATALOGUE.len()])
}

/// The name of what a parcel is of.
fn kind(number: u64) -> &'static str {
    subject(number).map_or_else(|(name, _)| name, |entry| entry.kind)
}

/// One random device and the rays through it, or a trial as long.
fn parcel(number: u64) -> Value {
    let mut draws = Draws::Seed(number.wrapping_mul(0xA076_1D64_78BD_642F));
    PARCEL.store(number, Ordering::Relaxed);
    BEGUN.fetch_add(1, Ordering::Relaxed);
    let ran = catch_unwind(AssertUnwindSafe(|| {
        let entry = match subject(number) {
            Ok(entry) => entry,
            Err((_, trial)) => return try_out(trial, &mut draws),
        };
        let SoundScene { text, scene, assembly, refused } =
            match robustness::sound_scene(&mut draws, entry) {
                Ok(sound) => sound,
                Err(why) => return json!({ "why": why }),
            };
        let tolerance = scene.trace.tolerance;
        let limits = Limits { min_power: LEAST_POWER, tolerance };
        let (mut line, fault) = trace(&assembly, limits, &mut draws);
        line["refused"] = json!(refused);
        if let Some(fault) = fault {
            eprintln!("parcel {number}: {fault}\n{text}");
        }
        line
    }));
    let mut line = ran.unwrap_or_else(|_| json!({ "panics": 1 }));
    line["parcel"] = json!(number);
    line["kind"] = json!(kind(number));
    line
}

/// Repeats a trial.
fn try_out(trial: Trial, draws: &mut Draws<'_>) -> Value {
    let start = Instant::now();
    let (mut scenes, mut rays) = (0, 0);
    while rays < RAYS && start.elapsed() < LONGEST {
        BEGUN.fetch_add(1, Ordering::Relaxed);
        rays += trial(draws);
        scenes += 1;
    }
    json!({ "devices": scenes, "rays": rays, "seconds": start.elapsed().as_secs_f64() })
}

/// Traces rays: what is counted, and the first fault.
fn trace(assembly: &Assembly, limits: Limits, draws: &mut Draws<'_>) -> (Value, Option<String>) {
    let start = Instant::now();
    let tracer = Tracer::new(assembly, limits);
    let timed = draws.below(8) == 0;
    let mut tracer = if timed { robustness::timed(tracer, assembly) } else { tracer };
    let reach = 10f64.powf(draws.between(0.7, 1.7));
    let [mut rays, mut leaves, mut lost, mut endless] = [0u64; 4];
    let [mut unbalanced, mut not_finite, mut unsound, mut early] = [0u64; 4];
    let (mut worst, mut slowest, mut first) = (0.0f64, Duration::ZERO, None);
    let mut last = start;
    // A device may be so large that rays begin in it: others are taken, but not for ever.
    let launches = (0..2 * RAYS).map(|_| robustness::launch(draws, reach));
    for launch in launches.filter(|launch| robustness::starts_in_air(assembly, launch)) {
        if rays == RAYS || last - start > LONGEST {
            break;
        }
        BEGUN.fetch_add(1, Ordering::Relaxed);
        let (found, outcome) = tracer.trace(&launch);
        rays += 1;
        leaves += found.len() as u64;
        lost += outcome.stats.lost;
        endless += u64::from(outcome.stats.endless > 0);
        match robustness::examine(launch.origin, found, outcome) {
            Ok(off) => worst = worst.max(off),
            Err(fault) => {
                match fault {
                    Fault::Unbalanced(_) => unbalanced += 1,
                    Fault::NotFinite => not_finite += 1,
                    Fault::Unsound => unsound += 1,
                    Fault::Early(_) => early += 1,
                    Fault::Lost(_) => {}
                }
                first.get_or_insert_with(|| format!("{fault:?}: {launch:?}"));
            }
        }
        let now = Instant::now();
        slowest = slowest.max(now - last);
        last = now;
    }
    let line = json!({
        "devices": 1, "rays": rays, "leaves": leaves, "unbalanced": unbalanced, "not_finite": not_finite,
        "unsound": unsound, "early": early, "lost": lost, "endless": endless, "worst_balance": worst,
        "slowest_ms": slowest.as_secs_f64() * 1e3, "seconds": start.elapsed().as_secs_f64(),
    });
    (line, first)
}

/// The parcel that is computed, and how many rays and parcels have been begun.
static PARCEL: AtomicU64 = AtomicU64::new(0);
static BEGUN: AtomicU64 = AtomicU64::new(0);

/// How long the main thread has computed: on a busy machine it may wait for long. Where the system
/// does not say, how long the program has run.
fn computed(start: Instant) -> Duration {
    let text = std::fs::read_to_string("/proc/self/schedstat").ok();
    let on_cpu = text.and_then(|text| text.split_whitespace().next()?.parse().ok());
    on_cpu.map_or_else(|| start.elapsed(), Duration::from_nanos)
}

/// Ends the program where a ray does not end.
fn watch(start: Instant, record: File) {
    std::thread::spawn(move || {
        let (mut begun, mut since) = (0, computed(start));
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let (last, now) = (BEGUN.load(Ordering::Relaxed), computed(start));
            if last != begun {
                (begun, since) = (last, now);
            } else if now.saturating_sub(since) > STUCK {
                let number = PARCEL.load(Ordering::Relaxed);
                let line = json!({ "parcel": number, "kind": kind(number), "stuck": 1 });
                let _ = write_line(&record, &line);
                eprintln!("error: a ray of parcel {number} does not end");
                std::process::exit(1);
            }
        }
    });
}

/// Prints what was counted, kind by kind, as Markdown; whether nothing was that must not be.
fn print_table(lines: &[Value]) -> bool {
    let count = |lines: &[&Value], name: &str| -> u64 {
        lines.iter().filter_map(|line| line[name].as_u64()).sum()
    };
    let largest = |lines: &[&Value], name: &str| -> f64 {
        lines.iter().filter_map(|line| line[name].as_f64()).fold(0.0, f64::max)
    };
    println!("| device | {} | stuck | largest imbalance | slowest ray, ms |", COUNTS.join(" | "));
    println!("| --- |{}", " ---: |".repeat(COUNTS.len() + 3));
    let row = |name: &str, lines: &[&Value]| {
        let counts = COUNTS.map(|name| count(lines, name).to_string()).join(" | ");
        println!(
            "| {name} | {counts} | {} | {:.1e} | {:.0} |",
            count(lines, "stuck"),
            largest(lines, "worst_balance"),
            largest(lines, "slowest_ms")
        );
    };
    let kinds = CATALOGUE.iter().map(|entry| entry.kind);
    for kind in kinds.chain(TRIALS.map(|(name, _)| name)) {
        let of_kind: Vec<&Value> = lines.iter().filter(|line| line["kind"] == kind).collect();
        row(kind, &of_kind);
    }
    let all: Vec<&Value> = lines.iter().collect();
    row("all", &all);
    let wrong = ["unbalanced", "not_finite", "unsound", "early", "panics", "stuck", "lost"];
    // What is always refused is not tried.
    let of_refused = all.iter().filter(|line| line["why"].is_string());
    let untried = of_refused.inspect(|line| println!("{}: {}", line["kind"], line["why"])).count();
    untried == 0 && wrong.iter().all(|name| count(&all, name) == 0)
}
