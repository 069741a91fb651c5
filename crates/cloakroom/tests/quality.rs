//! Tables of cloaking quality, against scenes whose figures are known.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::long;
use cloakroom::measure::{Constraint, QualityError, QualityTable, Sweep, SweepPlan, quality};
use cloakroom::render::{RenderError, Supervision};
use cloakroom::scene_file::{self, Override};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

fn plan(scene: &str, sweeps: &[&str]) -> Result<SweepPlan, QualityError> {
    let sweeps = sweeps.iter().map(|text| Sweep::parse(text).unwrap()).collect();
    SweepPlan::new(sweeps, Vec::new(), |more| scene_file::parse(scene, "test", Path::new(""), more))
}

fn measured(scene: &str, sweeps: &[&str]) -> QualityTable {
    measured_of(plan(scene, sweeps).unwrap())
}

fn measured_of(plan: SweepPlan) -> QualityTable {
    let (done, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let count = |rows| {
        done.fetch_add(rows, Ordering::Relaxed);
    };
    let table = quality(&plan, &Supervision { rows_done: &count, stop: &stop }).unwrap();
    assert_eq!(done.into_inner(), plan.steps(), "the progress runs to its end");
    let rows: usize = table.sweeps.iter().map(|sweep| sweep.values.len()).product();
    assert_eq!(table.rows.len(), rows);
    table
}

/// A number of a table, by its row and its column's name.
trait Figure {
    fn figure(&self, row: usize, name: &str) -> f64;
}

impl Figure for QualityTable {
    fn figure(&self, row: usize, name: &str) -> f64 {
        self.rows[row].numbers[self.column(name).unwrap()]
    }
}

#[test]
fn devices_are_held_against_a_reference() {
    let scene =
        "[camera]\nresolution = [40, 30]\nsamples = 1\n[[device]]\nkind = \"square-cloak\"\n";
    let sweeps = ["device.0.show=cloak,bare"];
    let against = |show: &str| {
        let reference = format!("{scene}show = \"{show}\"\n");
        let reference = scene_file::parse(&reference, "reference", Path::new(""), &[]).unwrap();
        measured_of(plan(scene, &sweeps).unwrap().with_reference(reference.scene))
    };
    // Against itself all is in its place; the cloak's own mirror, edge-on, is nothing to be seen.
    let bare = against("bare");
    assert!((bare.figure(1, "ideal_picture_correlation") - 1.0).abs() < 1e-9);
    assert_eq!(bare.figure(1, "in_place_share"), 1.0);
    assert!(bare.figure(0, "ideal_picture_correlation") < 0.95);
    let (mirror, ideal) = (against("mirror"), measured(scene, &sweeps));
    let numbers = |table: &QualityTable| {
        let numbers = table.rows.iter().flat_map(|row| &row.numbers);
        numbers.map(|number| number.to_bits()).collect::<Vec<u64>>()
    };
    assert_eq!(numbers(&mirror), numbers(&ideal));
    assert_eq!(ideal.columns[0].name, "in_place_share");
}

#[test]
fn design_iii_is_perfect_and_bare_metal_is_not() {
    let scene =
        "[camera]\nresolution = [80, 60]\nsamples = 1\n[[device]]\nkind = \"square-cloak\"\n";
    let table = measured(scene, &["device.0.show=cloak,bare", "device.0.rotation=0,10"]);
    for row in [0, 1] {
        for name in ["ideal_picture_correlation", "ideal_silhouette_correlation_maximum_red"] {
            assert!((table.figure(row, name) - 1.0).abs() < 1e-9, "{name}");
        }
        assert!((table.figure(row, "ideal_silhouette_structural_similarity") - 1.0).abs() < 1e-6);
        assert!(table.figure(row, "ideal_silhouette_flip") < 1e-3);
        assert!(table.figure(row, "displacement_rms_cm") < 1e-9);
        assert!(table.figure(row, "direction_error_rms_deg") < 1e-6);
        assert_eq!(table.figure(row, "uncloaked_area_cm2"), 0.0);
    }
    assert!((table.figure(0, "delivered") - 1.0).abs() < 1e-6);
    assert!(table.figure(0, "time_of_flight_difference_maximum_ns").abs() < 1e-13);
    // Turned, it is a mirror, which is not the empty view.
    assert!(table.figure(0, "empty_silhouette_correlation") > 1.0 - 1e-9);
    assert!(table.figure(1, "empty_silhouette_correlation") < 0.9);
    // The rhombus, 11.51 cm high and 100 cm away, covers the middles of 12 rows of pixels.
    assert!(table.figure(2, "uncloaked_share") > 0.99);
    let pixel = 2.0 * 150.0 * 20f64.to_radians().tan() / 80.0;
    let share = table.figure(2, "silhouette_share");
    assert!((share - 12.0 / 60.0).abs() < 1e-12, "{share}");
    let area = table.figure(2, "uncloaked_area_cm2") / table.figure(2, "uncloaked_share");
    assert!((area / (12.0 * 80.0 * pixel * pixel) - 1.0).abs() < 1e-9, "{area}");
    // It is black from edge to edge, which correlates with nothing; turned, it shows something
    // else.
    assert!(table.figure(2, "ideal_silhouette_correlation").is_nan());
    assert!(table.figure(3, "ideal_silhouette_correlation") < 0.5);
}

#[test]
fn a_glass_plate_moves_the_view_as_snell_says() {
    // All rays slant by atan(0.3); the plate moves each by t (tan a - tan b), sin a = n sin b,
    // turns none, and sends what is reflected twice, 0.2 % at this angle, into branches too weak to
    // follow.
    let scene = "[camera]\nposition = [-100, -30, 0]\ntarget = [0, 0, 0]\nprojection = \"orthographic\"\n\
                 width = 8\nresolution = [40, 30]\nsamples = 1\n[trace]\nmin_power = 0.01\n\
                 [[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = 1\npermittivity = 2.25\n";
    let table = measured(scene, &["device.0.thickness=1..15:2"]);
    let sine = 0.3 / 1.09f64.sqrt();
    let inside = (sine / 1.5).asin().tan();
    for (row, thickness) in [1.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0, 15.0].into_iter().enumerate() {
        let expected = thickness * (0.3 - inside);
        let off = table.figure(row, "displacement_rms_cm");
        assert!((off - expected).abs() < 1e-9, "{thickness} cm: {off} {expected}");
        assert!(table.figure(row, "direction_error_rms_deg") < 1e-7);
        // Later by the path in glass less that in air between the same two planes.
        let late = thickness * (1.5 * inside.hypot(1.0) - 1.09f64.sqrt());
        let mean = table.figure(row, "time_of_flight_difference_mean_ns") * 29.979_245_8;
        assert!((mean - late).abs() < 1e-9, "{mean} {late}");
        assert!(table.figure(row, "time_of_flight_difference_rms_about_mean_ns") < 1e-12);
        // Moved by more than 1 cm, nothing is where it should be.
        let uncloaked = table.figure(row, "uncloaked_share");
        assert_eq!(uncloaked, if expected > 1.0 { 1.0 } else { 0.0 }, "{thickness} cm");
    }
}

#[test]
fn what_is_turned_is_not_in_place_even_where_it_lands_right() {
    // A wedge of glass before the photograph turns light by asin(n sin a) - a, so little before it
    // that it lands within 1 cm of where it should: 0.50 degrees for 1 degree of wedge, 1.50 for 3.
    let scene = "[camera]\nposition = [-100, 0, 0]\nprojection = \"orthographic\"\nwidth = 4\n\
                 resolution = [8, 6]\nsamples = 1\n[trace]\nmin_power = 0.01\n\
                 [[device]]\nkind = \"prisms\"\nposition = [44, 0, 0]\n\
                 [[device.prism]]\npermittivity = 2.25\n";
    for (degrees, in_place) in [(1.0f64, true), (3.0, false)] {
        let angle = degrees.to_radians();
        let [low, high] = [-4.0, 4.0].map(|y: f64| 2.0 + y * angle.tan());
        let corners = format!("corners = [[0, -4], [{low}, -4], [{high}, 4], [0, 4]]\n");
        let table = measured(&format!("{scene}{corners}"), &["camera.samples=1"]);
        let turned = ((1.5 * angle.sin()).asin() - angle).to_degrees();
        assert!((table.figure(0, "direction_error_rms_deg") - turned).abs() < 1e-9, "{turned}");
        assert_eq!(table.figure(0, "uncloaked_share"), 0.0);
        // Two faces reflect 4 % each.
        let share = if in_place { 0.96 * 0.96 } else { 0.0 };
        assert!((table.figure(0, "in_place_share") - share).abs() < 1e-3);
    }
}

#[test]
fn polarizations_add_up() {
    let scene = "[camera]\nresolution = [48, 36]\nsamples = 1\n\
                 [[device]]\nkind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\n";
    let table = measured(scene, &["camera.polarizer=horizontal,vertical,none"]);
    for name in ["delivered", "escaped", "absorbed", "pruned"] {
        let [h, v, both] = [0, 1, 2].map(|row| table.figure(row, name));
        assert!((0.5 * (h + v) - both).abs() < 1e-6, "{name}: {h} {v} {both}");
    }
    let off = |row| table.figure(row, "displacement_rms_cm");
    assert!(off(0) < off(2) && off(2) < off(1));
    let sum: f64 = ["delivered", "escaped", "absorbed", "pruned"]
        .iter()
        .map(|name| table.figure(2, name))
        .sum();
    assert!((sum - 1.0).abs() < 1e-6);
}

#[test]
fn a_view_without_the_device_has_no_figures_of_it() {
    let scene = "[camera]\nresolution = [16, 12]\nsamples = 1\n\
                 [[device]]\nkind = \"luneburg-lens\"\nposition = [0, 200, 0]\n";
    let table = measured(scene, &["device.0.radius=5,10"]);
    assert_eq!(table.figure(0, "silhouette_share"), 0.0);
    assert!((table.figure(0, "ideal_picture_correlation") - 1.0).abs() < 1e-12);
    for name in ["ideal_silhouette_correlation", "displacement_rms_cm", "delivered"] {
        assert!(table.figure(0, name).is_nan(), "{name}");
    }
}

#[test]
fn what_cannot_be_is_told_before_the_work() {
    let scene = "[[device]]\nkind = \"square-cloak\"\n";
    let message = |sweeps: &[&str]| plan(scene, sweeps).unwrap_err().to_string();
    assert!(message(&["device.0.rotaton=0,5"]).contains("did you mean `rotation`"));
    assert!(message(&["device.0.kappa=0.5,2"]).contains("kappa"));
    assert!(message(&["device.0.side=1,2", "device.0.side=3,4"]).contains("twice"));
    let plan = plan(scene, &["device.0.rotation=0"]).unwrap();
    let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(true) };
    let stopped = quality(&plan, &supervision);
    assert!(matches!(stopped, Err(QualityError::Render(RenderError::Stopped(_)))));
}

/// Design (iii) with errors, before a small photograph and seen by a small camera.
const ERRONEOUS: &str = "[camera]\nresolution = [16, 12]\nsamples = 1\n[trace]\nmin_power = 1e-3\n\
                         [photograph]\nimage = \"stripes.png\"\n\
                         [[device]]\nkind = \"square-cloak\"\nimperfection = { error = 0.02, seed = 5 }\n";

#[test]
fn draws_give_means_with_errors_that_shrink_as_one_over_root_n() {
    let folder = tempfile::tempdir().unwrap();
    let stripes =
        image::RgbImage::from_fn(16, 12, |x, y| image::Rgb([(x * 15) as u8, (y * 20) as u8, 90]));
    stripes.save(folder.path().join("stripes.png")).unwrap();
    let table = |draws: u32, sweep: &str| {
        let sweeps = vec![Sweep::parse(sweep).unwrap()];
        let load = |more: &[Override]| scene_file::parse(ERRONEOUS, "test", folder.path(), more);
        let plan = SweepPlan::new(sweeps, Vec::new(), load).unwrap().with_draws(draws).unwrap();
        let (done, stop) = (AtomicU64::new(0), AtomicBool::new(false));
        let count = |rows| {
            done.fetch_add(rows, Ordering::Relaxed);
        };
        let table = quality(&plan, &Supervision { rows_done: &count, stop: &stop }).unwrap();
        assert_eq!(done.into_inner(), plan.steps());
        table
    };
    let error = |table: &QualityTable, row: usize, name: &str| {
        table.rows[row].standard_errors[table.column(name).unwrap()]
    };
    let few = table(8, "device.0.imperfection.error=0,0.01,0.02");
    // Without errors it is perfect, and there is one draw.
    assert!(few.figure(0, "displacement_rms_cm") < 1e-9);
    assert_eq!(error(&few, 0, "displacement_rms_cm"), 0.0);
    // Small errors displace in proportion.
    let ratio = few.figure(2, "displacement_rms_cm") / few.figure(1, "displacement_rms_cm");
    assert!(ratio > 1.6 && ratio < 2.4, "{ratio}");
    let draws = long::count(32, 128);
    let many = table(draws, "device.0.imperfection.error=0.02");
    let shrink = (f64::from(draws) / 8.0).sqrt();
    for name in
        ["displacement_rms_cm", "direction_error_rms_deg", "time_of_flight_difference_mean_ns"]
    {
        let (rough, fine) = (error(&few, 2, name), error(&many, 0, name));
        // 8 draws know their error to 27 % (one standard deviation).
        let ratio = rough / fine;
        assert!(ratio > shrink * 0.4 && ratio < shrink * 1.7, "{name}: {ratio}");
        // The means agree within their errors.
        let off = few.figure(2, name) - many.figure(0, name);
        assert!(off.abs() < 4.0 * rough.hypot(fine), "{name}: {off} {rough} {fine}");
    }
    // The same seed, the same numbers.
    assert_eq!(table(8, "device.0.imperfection.error=0,0.01,0.02").to_json(), few.to_json());
    // Another seed, others.
    let other = table(8, "device.0.imperfection.seed=6");
    assert!(other.figure(0, "displacement_rms_cm") != few.figure(2, "displacement_rms_cm"));
    // All power is accounted for.
    let powers = ["delivered", "escaped", "absorbed", "pruned"];
    let sum: f64 = powers.iter().map(|name| many.figure(0, name)).sum();
    assert!((sum - 1.0).abs() < 1e-6, "{sum}");
}

#[test]
fn draws_of_nothing_random_are_refused() {
    let scene = "[[device]]\nkind = \"square-cloak\"\n";
    let message = plan(scene, &["device.0.rotation=0"]).unwrap().with_draws(4).unwrap_err();
    assert!(message.to_string().contains("nothing in the scene is random"), "{message}");
    let bad = plan(scene, &["device.0.imperfection.levels=2,1"]).unwrap_err().to_string();
    assert!(bad.contains("levels is 1") && bad.contains("device.0.imperfection.levels=1"), "{bad}");
}

#[test]
fn a_held_fact_stays_while_keys_are_swept() {
    let scene = "[camera]\nresolution = [8, 6]\nsamples = 1\n[[device]]\nkind = \"double-gaussian-cloak\"\n";
    let held = |hold: &str, sweep: &str| {
        let (sweeps, holds) =
            (vec![Sweep::parse(sweep).unwrap()], vec![Constraint::parse(hold).unwrap()]);
        SweepPlan::new(sweeps, holds, |more| scene_file::parse(scene, "test", Path::new(""), more))
    };
    let plan = held("device.0.w=cloaked_area_cm2", "device.0.h=3,4.25").unwrap();
    plan.check_columns(&["device.0.w".to_owned()]).unwrap();
    let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) };
    let table = quality(&plan, &supervision).unwrap();
    // h (sqrt(pi) w - h) is the same.
    let area = |w: f64, h: f64| h * (std::f64::consts::PI.sqrt() * w - h);
    let w = table.figure(0, "device.0.w");
    assert!((area(w, 3.0) - area(10.02, 4.25)).abs() < 1e-10, "{w}");
    assert_eq!(table.figure(1, "device.0.w"), 10.02);
    let message = held("device.0.w=cloaked_area_cm2", "device.0.w=9,10").unwrap_err().to_string();
    assert!(message.contains("both swept and held"), "{message}");
    let message = held("device.0.w=cloaked_area_cm2", "device.0.h=4,30").unwrap_err().to_string();
    assert!(message.contains("h=30"), "{message}");
}

#[test]
fn files_hold_the_table() {
    let scene =
        "[camera]\nresolution = [16, 12]\nsamples = 1\n[[device]]\nkind = \"square-cloak\"\n";
    let sweeps = ["camera.polarizer=horizontal,vertical", "device.0.rotation=0..10:5"];
    let mut table = measured(scene, &sweeps);
    let column = table.column("delivered").unwrap();
    table.rows[5].numbers[column] = f64::NAN;
    let folder = tempfile::tempdir().unwrap();
    let [csv, npz] = ["a.csv", "a.npz"].map(|name| folder.path().join(name));
    table.write_csv(&csv).unwrap();
    table.write_npz(&npz).unwrap();
    let text = std::fs::read_to_string(csv).unwrap();
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 7);
    assert_eq!(lines[0][..3], ["camera.polarizer", "device.0.rotation", "in_place_share"]);
    assert_eq!((lines[0].len(), lines[0][2 + column]), (2 + table.columns.len(), "delivered"));
    assert_eq!(
        (&lines[3][..2], &lines[6][..2]),
        (&["horizontal", "10"][..], &["vertical", "10"][..])
    );
    assert_eq!(lines[3][2 + column].parse(), Ok(table.figure(2, "delivered")));
    assert_eq!(lines[6][2 + column], "");
    let mut npz = ndarray_npy::NpzReader::new(std::fs::File::open(npz).unwrap()).unwrap();
    let rotation: ndarray::Array1<f64> = npz.by_name("device.0.rotation").unwrap();
    assert_eq!(rotation.to_vec(), [0.0, 5.0, 10.0, 0.0, 5.0, 10.0]);
    let delivered: ndarray::Array1<f64> = npz.by_name("delivered").unwrap();
    assert!(delivered[2] == table.figure(2, "delivered") && delivered[5].is_nan());
    let json = table.to_json();
    assert_eq!(json["rows"][5]["settings"]["device.0.rotation"], "10");
    assert!(json["rows"][5]["figures"]["delivered"].is_null());
    assert_eq!(json["rows"][2]["figures"]["delivered"], table.figure(2, "delivered"));
}
