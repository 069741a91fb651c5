//! One suite that every device of the catalogue must pass, whatever it is: the account of the
//! power, the way back, no numbers that are none, and its bare and mirror views.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::long::count;
use crate::rays::{launches_around, strongest, try_bench};
use cloakroom::assembly::{Assembly, MOST_DEVICES};
use cloakroom::device::{CATALOGUE, FactValue, Request, entry};
use cloakroom::keys::{KeyKind, Value};
use cloakroom::render::{PreparedSceneError, assembly};
use cloakroom::scene::{DeviceSettings, Scene};
use cloakroom::trace::{Launch, Limits, Tracer};
use glam::DVec3;

/// What a kind needs to be something: its tables or media, of indices so low that boxes cannot trap
/// light.
const MORE: &[(&str, &str)] = &[
    (
        "prisms",
        "[[device.prism]]
corners = [[-8, -6], [4, -6], [4, 0], [-2, 0], [-2, 7], [-8, 7]]
permittivity = 1.44
[[device.prism]]
corners = [[4, -4], [9, -4], [9, -2], [4, -2]]
permittivity = [[1.3, 0.05, 0], [0.05, 1.4, 0], [0, 0, [1.2, 4e-7]]]
permeability = [1.03, 1e-7]
[[device.prism]]
corners = [[-2, 0], [1, 0], [1, 5], [-2, 5]]
metal = true",
    ),
    ("body", "permittivity = [1.4, 2e-7]\npermeability = 1.03\n"),
    ("graded", GRADED),
];

/// A hilly index, around a core.
const GRADED: &str = "width = 24
height = 20
inner = 3
index = [
  [1.02, 1.05, 0.98, 1.04, 1.01],
  [1.10, 1.15, 1.12, 1.03, 0.97],
  [1.08, 1.12, 1.10, 1.11, 1.06],
  [0.95, 1.07, 1.14, 1.18, 1.02],
  [1.00, 1.02, 1.05, 1.09, 1.10],
]
";

/// The devices that have a core to open, with more of their keys.
const OPEN_CORES: &[(&str, &str)] = &[
    ("square-cloak", ""),
    ("double-gaussian-cloak", ""),
    ("cylinder-cloak", ""),
    ("cylinder-cloak", "material = \"radial-uniaxial\"\n"),
    ("sphere-cloak", ""),
    ("graded", ""),
];

/// Words that go with other tables than these.
const OTHERS: [(&str, &str); 1] = [("graded", "shape = \"ball\"\n")];

/// Every device in every view, endless and short, at a few rotations and places, in each of the
/// words that its keys take, with a description.
fn benches() -> Vec<(String, Assembly)> {
    let mut benches = Vec::new();
    for entry in CATALOGUE {
        let mut variants = vec![String::new()];
        for key in entry.keys {
            match key.kind {
                KeyKind::Choice { options } => variants
                    .extend(options[1..].iter().map(|word| format!("{} = \"{word}\"\n", key.name))),
                KeyKind::Flag => {
                    let default = (key.default)() == Some(Value::Flag(true));
                    variants.push(format!("{} = {}\n", key.name, !default));
                }
                _ => {}
            }
        }
        let cores = OPEN_CORES.iter().filter(|(kind, _)| *kind == entry.kind);
        variants.extend(cores.map(|(_, keys)| format!("core = \"open\"\n{keys}")));
        let is_another = |variant: &String| OTHERS.contains(&(entry.kind, variant.as_str()));
        for variant in variants.into_iter().filter(|variant| !is_another(variant)) {
            for show in ["cloak", "bare", "mirror"] {
                for (rotation, length) in [(0.0, None), (13.0, Some(18.0)), (90.0, None)] {
                    let mut text = format!(
                        "[[device]]\nkind = \"{}\"\nshow = \"{show}\"\nrotation = {rotation:?}\n\
                         position = [1.5, -2.0, 0.5]\n{variant}",
                        entry.kind
                    );
                    if let Some(length) = length {
                        text += &format!("length = {length:?}\n");
                    }
                    let tables = MORE.iter().filter(|(kind, _)| *kind == entry.kind);
                    text.extend(tables.map(|(_, tables)| *tables));
                    let assembly = match try_bench(&text) {
                        Ok(assembly) => assembly,
                        // What is no cloak has no other views.
                        Err(PreparedSceneError::Device { error, .. })
                            if matches!(error.key, Some("show" | "core")) && show != "cloak" =>
                        {
                            break;
                        }
                        // A box or a ball has no length of its own.
                        Err(PreparedSceneError::Device { error, .. })
                            if error.key == Some("length") && length.is_some() =>
                        {
                            continue;
                        }
                        Err(error) => panic!("{text}{error}"),
                    };
                    benches.push((text, assembly));
                    if show != "cloak" {
                        // Metal and mirrors know nothing of the cloak's material.
                        break;
                    }
                }
            }
        }
    }
    benches
}

/// Rays from all around, towards the device.
fn launches(count: u32) -> impl Iterator<Item = Launch<2>> {
    launches_around(count, [80.0, 60.0], DVec3::new(30.0, 24.0, 30.0))
}

/// Whether a ray starts in air: one that starts in a slab that absorbs and runs along it never
/// comes out.
fn starts_in_air(assembly: &Assembly, launch: &Launch<2>) -> bool {
    assembly.region_around(launch.origin, launch.direction) == Ok(None)
}

fn is_birefringent(device: &str) -> bool {
    device.contains("uniaxial")
}

/// Whether light may be trapped for good: between the ends of a birefringent prism, and in an open
/// core of which one of two polarizations finds no way out.
fn may_trap_light(device: &str) -> bool {
    is_birefringent(device)
        && if device.contains("square-cloak") {
            device.contains("length")
        } else {
            device.contains("core = \"open\"")
        }
}

#[test]
fn power_is_accounted_for() {
    for (what, assembly) in benches() {
        // The deep trees of birefringent devices have thousands of branches.
        let deep =
            if is_birefringent(&what) { (1e-8, count(8, 100)) } else { (1e-9, count(60, 1000)) };
        for (min_power, rays) in [(1e-4, count(120, 2000)), deep] {
            let mut tracer = Tracer::new(&assembly, Limits { min_power, tolerance: 1e-6 });
            for launch in launches(rays) {
                let (leaves, outcome) = tracer.trace(&launch);
                outcome.assert_balanced(leaves, 1e-12, &(&what, launch));
                assert!(outcome.stats.endless == 0 || may_trap_light(&what), "{what}{launch:?}");
            }
        }
    }
}

#[test]
fn leaves_are_sound_waves_in_air() {
    for (what, assembly) in benches() {
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-9, tolerance: 1e-6 });
        for launch in launches(if is_birefringent(&what) { count(8, 100) } else { count(40, 500) })
        {
            if !starts_in_air(&assembly, &launch) {
                continue;
            }
            let (leaves, _) = tracer.trace(&launch);
            assert!(!leaves.is_empty(), "{what}{launch:?}");
            for leaf in leaves {
                assert!(leaf.position.is_finite() && leaf.optical_path.is_finite(), "{what}");
                assert!((leaf.direction.length() - 1.0).abs() < 1e-12, "{what}");
                for i in 0..2 {
                    let size = leaf.electric[i].norm_squared();
                    assert!(
                        (size - leaf.power[i]).abs() < 1e-9,
                        "{what}{launch:?} {size} {leaf:?}"
                    );
                    let along = leaf.electric[i].dot_real(leaf.direction).norm();
                    assert!(along < 1e-9, "{what}{launch:?} {along}");
                }
            }
        }
    }
}

/// The strongest leaf, sent back where it came from, comes out where the ray started.
#[test]
fn the_way_back_leads_home() {
    for (what, assembly) in benches() {
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-9 });
        let (mut off, mut all) = (0, 0);
        for launch in launches(count(120, 600)) {
            // From beyond the widest floor: on its way home a ray must not meet it after the start.
            let launch = Launch { origin: launch.origin - 400.0 * launch.direction, ..launch };
            if !starts_in_air(&assembly, &launch) {
                continue;
            }
            let (leaves, _) = tracer.trace(&launch);
            let leaf = strongest(leaves);
            let there = leaf.power[0] + leaf.power[1];
            let path = leaf.optical_path;
            if !leaf.met_device {
                continue;
            }
            let back = Launch {
                origin: leaf.position + leaf.direction * 10.0,
                direction: -leaf.direction,
                electric: leaf.electric.map(|_| {
                    // Time reversed; both the same, for one of the two may be nearly dark.
                    let field = leaf.electric[usize::from(leaf.power[1] > leaf.power[0])];
                    field.conj() * field.norm_squared().powf(-0.5)
                }),
            };
            let (leaves, _) = tracer.trace(&back);
            let home = leaves.iter().any(|leaf| {
                let to_start = launch.origin - leaf.position;
                let along = to_start.dot(leaf.direction);
                let beside = (to_start - leaf.direction * along).length();
                (leaf.direction + launch.direction).length() < 1e-6
                    && beside < 1e-5
                    && (leaf.optical_path + along - path - 10.0).abs() < 1e-5
            });
            all += 1;
            off += u32::from(!home);
            assert!(there > 0.0);
        }
        // Rays that meet an edge within rounding may go either way.
        assert!(off * 200 <= all, "{what}: {off} of {all} rays do not come home");
    }
}

#[test]
fn more_devices_than_can_be_numbered_are_refused() {
    let mirror = DeviceSettings::new(entry("mirror-detour").unwrap());
    let scene = Scene { devices: vec![mirror; MOST_DEVICES + 1], ..Scene::default() };
    let error = assembly(&scene).unwrap_err();
    assert!(matches!(error, PreparedSceneError::TooManyDevices { count: 65_536 }), "{error}");
    assert_eq!(error.key(), "device.65535");
}

#[test]
fn facts_are_finite_and_named_with_units() {
    for entry in CATALOGUE {
        let facts = (entry.device)().facts(Request::default());
        assert!(!facts.is_empty(), "{}", entry.kind);
        for fact in facts {
            let finite = match &fact.value {
                FactValue::Number(number) => number.is_finite(),
                FactValue::Numbers(numbers) => numbers.iter().all(|number| number.is_finite()),
            };
            assert!(finite, "{} {}", entry.kind, fact.name);
            assert!(
                fact.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
            );
        }
    }
}
