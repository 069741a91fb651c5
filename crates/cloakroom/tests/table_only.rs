use cloakroom::measure::{Sweep, SweepPlan, quality};
use cloakroom::render::Supervision;
use cloakroom::scene_file::{self, Override};
use std::path::Path;
use std::sync::atomic::AtomicBool;
#[test]
fn table() {
    let file = std::env::var("SCENE").unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    let sets: Vec<Override> = std::env::var("SETS").unwrap().split(';').map(|t| Override::Text(t.to_owned())).collect();
    let sweeps = std::env::var("SWEEPS").unwrap().split(';').map(|t| Sweep::parse(t).unwrap()).collect();
    let plan = SweepPlan::new(sweeps, Vec::new(), |more| scene_file::parse(&text, "test", Path::new(""), &[&sets[..], more].concat())).unwrap();
    let stop = AtomicBool::new(false);
    let table = quality(&plan, &Supervision { rows_done: &|_| {}, stop: &stop }).unwrap();
    let names = ["ideal_silhouette_correlation", "ideal_silhouette_structural_similarity", "ideal_silhouette_flip", "displacement_rms_cm", "direction_error_rms_deg", "in_place_share", "uncloaked_share", "delivered", "silhouette_share", "time_of_flight_difference_mean_ns"];
    eprintln!("{names:?}");
    for row in &table.rows {
        let n: Vec<String> = names.iter().map(|n| format!("{:.5}", row.numbers[table.column(n).unwrap()])).collect();
        eprintln!("{:?} {}", row.settings, n.join(" "));
    }
}
