//! The files of `conformance/`: what Maxwell's and Hamilton's equations, solved by a program that
//! shares no code with the tracer, say must come out does, within the tolerances that stand in the
//! files.

use cloakroom::interface_json::InterfaceRequest;
use cloakroom::ray_json::{LeafReport, RayReport, RayRequest, trace_rays};
use cloakroom::{render, scene_file};
use num_complex::Complex64;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::AtomicBool;

type Real = [f64; 3];
type Field = [[f64; 2]; 3];

fn read<T: DeserializeOwned>(name: &str) -> T {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../conformance");
    serde_json::from_slice(&std::fs::read(folder.join(name)).unwrap()).unwrap()
}

/// A field as complex numbers.
fn complex(field: &Field) -> [Complex64; 3] {
    field.map(|[re, im]| Complex64::new(re, im))
}

/// The largest difference of two vectors.
fn apart<const N: usize>(a: &[Complex64; N], b: &[Complex64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// The same of real ones.
fn apart_real(a: &Real, b: &Real) -> f64 {
    apart(&a.map(Complex64::from), &b.map(Complex64::from))
}

fn size(v: &[Complex64; 3]) -> f64 {
    v.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt()
}

/// Asserts that something is off by no more than a tolerance; what is no number is off.
fn hold(off: f64, tolerance: f64, what: &str, name: &str) {
    assert!(off <= tolerance, "{name}: {what} is off by {off:e}, of {tolerance:e}");
}

#[derive(Deserialize)]
struct Interfaces {
    tolerance: InterfaceTolerance,
    cases: Vec<Interface>,
}

#[derive(Deserialize)]
struct InterfaceTolerance {
    wave_vector: f64,
    poynting: f64,
    power: f64,
    response: f64,
}

#[derive(Deserialize)]
struct Interface {
    name: String,
    input: Value,
    expected: Scattered,
}

#[derive(Deserialize)]
struct Scattered {
    incident: Vec<Wave>,
    reflected: Vec<Wave>,
    transmitted: Vec<Wave>,
    power: Option<Vec<[Option<f64>; 2]>>,
    total_reflected: Option<[Option<f64>; 2]>,
    total_transmitted: Option<[Option<f64>; 2]>,
    reflection: [Field; 3],
    transmission: Option<[Field; 3]>,
}

#[derive(Deserialize)]
struct Wave {
    wave_vector: Field,
    poynting: Option<Real>,
    propagating: bool,
}

#[test]
fn interfaces_are_those_of_maxwells_equations() {
    let Interfaces { tolerance, cases } = read("interfaces.json");
    assert!(cases.len() > 80);
    for Interface { name, input, expected } in cases {
        let found = InterfaceRequest::read(&input, "").unwrap().solve().unwrap();
        let sides = [
            (&found.incident[..], &expected.incident),
            (&found.reflected, &expected.reflected),
            (&found.transmitted, &expected.transmitted),
        ];
        for (found, expected) in sides {
            assert_eq!(found.len(), expected.len(), "{name}");
            for (mode, wave) in found.iter().zip(expected) {
                let exact = complex(&wave.wave_vector);
                let off = apart(&complex(&mode.wave_vector), &exact) / size(&exact);
                hold(off, tolerance.wave_vector, "a wave vector", &name);
                assert_eq!(mode.propagating, wave.propagating, "{name}");
                assert_eq!(mode.poynting.is_some(), wave.poynting.is_some(), "{name}");
                if let Some((found, exact)) = mode.poynting.zip(wave.poynting) {
                    let off = apart_real(&found, &exact) / size(&exact.map(Complex64::from));
                    hold(off, tolerance.poynting, "a Poynting vector", &name);
                }
            }
        }
        let power = |found: &[Option<f64>; 2], exact: &[Option<f64>; 2]| {
            for (found, exact) in found.iter().zip(exact) {
                assert_eq!(found.is_some(), exact.is_some(), "{name}");
                if let Some((found, exact)) = found.zip(*exact) {
                    let off = (found - exact).abs() / exact.abs().max(1.0);
                    hold(off, tolerance.power, "a power", &name);
                }
            }
        };
        if let Some(rows) = &expected.power {
            assert_eq!(found.power.len(), rows.len(), "{name}");
            found.power.iter().zip(rows).for_each(|(found, exact)| power(found, exact));
        }
        for (found, exact) in [
            (&found.total_reflected, &expected.total_reflected),
            (&found.total_transmitted, &expected.total_transmitted),
        ] {
            exact.iter().for_each(|exact| power(found, exact));
        }
        // The fields that each incident mode raises on either side.
        for column in 0..2 {
            let come = complex(&found.incident[column].electric_field);
            let responses = [
                (&found.reflected[..], Some(&expected.reflection), 0),
                (&found.transmitted, expected.transmission.as_ref(), 2),
            ];
            for (modes, response, first) in responses {
                assert_eq!(modes.is_empty(), response.is_none(), "{name}");
                let Some(response) = response else { continue };
                let exact = response.map(|row| {
                    complex(&row).iter().zip(&come).map(|(r, e)| r * e).sum::<Complex64>()
                });
                let mut raised = [Complex64::ZERO; 3];
                for (mode, row) in modes.iter().zip(&found.amplitudes[first..]) {
                    let [re, im] = row[column];
                    let field = complex(&mode.electric_field);
                    for (raised, e) in raised.iter_mut().zip(field) {
                        *raised += Complex64::new(re, im) * e;
                    }
                }
                let off = apart(&raised, &exact) / size(&exact).max(1.0);
                hold(off, tolerance.response, "a field", &name);
            }
        }
    }
}

/// What `cloakroom trace` makes of a scene's rays.
fn traced(scene: &str, rays: &[RayRequest], coherent: bool) -> Vec<RayReport> {
    let loaded = scene_file::parse(scene, "test", Path::new(""), &[]).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let settings = render::ray_settings(&loaded.scene, None, coherent, false);
    trace_rays(&assembly, settings, rays, &AtomicBool::new(false)).unwrap().iter().collect()
}

#[derive(Deserialize)]
struct Plates {
    wavelength_nm: f64,
    cases: Vec<Stack>,
}

#[derive(Deserialize)]
struct Stack {
    name: String,
    coherent: bool,
    scene: String,
    rays: Vec<RayRequest>,
    expected: Vec<Beams>,
    tolerance: StackTolerance,
}

#[derive(Deserialize)]
struct StackTolerance {
    power: f64,
    electric_field: Option<f64>,
}

#[derive(Deserialize)]
struct Beams {
    reflected: Beam,
    transmitted: Beam,
}

#[derive(Deserialize)]
struct Beam {
    direction: Real,
    power: f64,
    point: Option<Real>,
    electric_field: Option<Field>,
    stokes: Option<Real>,
}

fn dot(a: &Real, b: &Real) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn plates_are_those_of_the_transfer_matrix() {
    let Plates { wavelength_nm, cases } = read("plates.json");
    assert!(cases.len() > 30);
    let wave_number = TAU / (wavelength_nm * 1e-7);
    for Stack { name, coherent, scene, rays, expected, tolerance } in cases {
        let reports = traced(&scene, &rays, coherent);
        assert_eq!(reports.len(), expected.len());
        for ((ray, report), beams) in rays.iter().zip(&reports).zip(&expected) {
            for beam in [&beams.reflected, &beams.transmitted] {
                let along =
                    |leaf: &&LeafReport| apart_real(&leaf.direction, &beam.direction) < 1e-9;
                let leaves: Vec<&LeafReport> = report.leaves.iter().filter(along).collect();
                let power: f64 = leaves.iter().map(|leaf| leaf.power).sum();
                hold((power - beam.power).abs(), tolerance.power, "the power", &name);
                let Some((point, exact)) = beam.point.zip(beam.electric_field) else {
                    assert!(!coherent);
                    continue;
                };
                // The field at a point, where light that goes on undisturbed has the phase k0 d.r.
                let mut field = [Complex64::ZERO; 3];
                for leaf in leaves {
                    let place = leaf.position.unwrap();
                    let path = leaf.optical_path + dot(&beam.direction, &point)
                        - dot(&beam.direction, &place)
                        + dot(&ray.direction, &ray.origin);
                    let phase = Complex64::cis(wave_number * path);
                    for (sum, e) in field.iter_mut().zip(complex(&leaf.electric_field)) {
                        *sum += phase * e;
                    }
                }
                let allowed = tolerance.electric_field.unwrap();
                hold(apart(&field, &complex(&exact)), allowed, "the field", &name);
                let Some(stokes) = beam.stokes else { continue };
                let [_, v, h] = field;
                let across = h * v.conj();
                let found = [h.norm_sqr() - v.norm_sqr(), 2.0 * across.re, 2.0 * across.im];
                let found = found.map(|s| s / (h.norm_sqr() + v.norm_sqr()));
                hold(apart_real(&found, &stokes), 4.0 * allowed, "the Stokes vector", &name);
            }
        }
    }
}

#[derive(Deserialize)]
struct Rays {
    cases: Vec<Traced>,
}

#[derive(Deserialize)]
struct Traced {
    name: String,
    scene: String,
    rays: Vec<RayRequest>,
    expected: Vec<Leaves>,
    /// Absent: there may be others.
    all_leaves_above: Option<f64>,
    tolerance: LeafTolerance,
}

#[derive(Deserialize)]
struct LeafTolerance {
    position: f64,
    direction: f64,
    power: f64,
    optical_path: f64,
    electric_field: f64,
}

#[derive(Deserialize)]
struct Leaves {
    leaves: Vec<Leaf>,
}

#[derive(Debug, Deserialize)]
struct Leaf {
    position: Real,
    direction: Real,
    power: f64,
    optical_path: f64,
    electric_field: Option<Field>,
}

#[test]
fn rays_have_the_leaves_of_their_oracles() {
    let Rays { cases } = read("rays.json");
    assert!(cases.len() > 40);
    for Traced { name, scene, rays, expected, all_leaves_above, tolerance } in cases {
        let reports = traced(&scene, &rays, false);
        assert_eq!(reports.len(), expected.len());
        for (report, Leaves { leaves }) in reports.iter().zip(&expected) {
            let is = |found: &LeafReport, exact: &Leaf| {
                let place = found.position.map(|place| apart_real(&place, &exact.position));
                place.is_some_and(|off| off <= tolerance.position)
                    && apart_real(&found.direction, &exact.direction) <= tolerance.direction
                    && (found.optical_path - exact.optical_path).abs() <= tolerance.optical_path
            };
            for exact in leaves {
                // Leaves that coincide stand in the file as one.
                let found: Vec<&LeafReport> =
                    report.leaves.iter().filter(|found| is(found, exact)).collect();
                assert!(!found.is_empty(), "{name}: no {exact:?} in {report:?}");
                let power: f64 = found.iter().map(|leaf| leaf.power).sum();
                hold((power - exact.power).abs(), tolerance.power, "a power", &name);
                if let ([found], Some(field)) = (&found[..], &exact.electric_field) {
                    let off = apart(&complex(&found.electric_field), &complex(field));
                    hold(off, tolerance.electric_field, "a field", &name);
                }
            }
            let least = all_leaves_above.unwrap_or(f64::INFINITY);
            for found in report.leaves.iter().filter(|leaf| leaf.power > least) {
                assert!(leaves.iter().any(|exact| is(found, exact)), "{name}: why {found:?}");
            }
        }
    }
}
