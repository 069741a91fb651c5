//! `cloakroom pulses`: the pulses of one pixel.

use crate::arguments::PulsesArguments;
use crate::report::{self, Failure, Result, decimals};
use crate::scene;
use cloakroom::render::{self, Images, PulseList};
use std::fmt::Write;

/// Lists the pulses of a pixel.
pub fn run(arguments: &PulsesArguments) -> Result<()> {
    let loaded = scene::load(&arguments.scene, &[])?;
    let prepared = scene::prepared(&loaded, &mut Images::default())?;
    let list = render::pulses(&prepared, arguments.pixel)
        .map_err(|error| Failure::Usage(format!("--pixel: {error}")))?;
    if arguments.json {
        return report::print_json(&list);
    }
    report::print(&described(&list)?)
}

fn described(list: &PulseList) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let [column, row] = list.pixel;
    let time = |time: Option<f64>| time.map_or("-".to_owned(), |time| decimals(time, 9));
    writeln!(text, "pixel {column},{row}")?;
    writeln!(
        text,
        "{:>18} {:>14} {:>14} {:>10}  from (y, z) in cm",
        "time of flight ns", "delay ns", "group delay ns", "power"
    )?;
    for pulse in &list.pulses {
        let landings: Vec<String> = (pulse.landings.iter())
            .map(|landing| {
                let [_, y, z] = landing.position_cm.map(|part| decimals(part, 3));
                format!("({y}, {z})")
            })
            .collect();
        writeln!(
            text,
            "{:>18.9} {:>14} {:>14} {:>10.6}  {}",
            pulse.time_of_flight_ns,
            time(pulse.delay_ns),
            time(pulse.group_delay_ns),
            pulse.power,
            landings.join(" ")
        )?;
    }
    for (name, share) in [
        ("delivered", list.delivered),
        ("escaped", list.escaped),
        ("absorbed", list.absorbed),
        ("pruned", list.pruned),
    ] {
        writeln!(text, "{name:<33} {share:>10.6}")?;
    }
    let mean = time(list.mean_time_of_flight_ns);
    let spread = time(list.time_of_flight_spread_ns);
    writeln!(
        text,
        "mean {mean} ns, spread {spread} ns, pulses within {:.1e} ns are one",
        list.resolution_ns
    )?;
    Ok(text)
}
