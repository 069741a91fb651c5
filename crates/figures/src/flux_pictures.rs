//! Flux as plots: curves over the directions, and maps of the receiver.

use crate::{Curve, CurvePoint, HeatMap, HeatMapPanel, Plot, PlotPanel};
use cloakroom::flux::{FluxReport, Incidence, Stand};

/// The irradiance over the directions for nothing, bare metal and the cloak in each polarization, and the shadow that is
/// given back; `axis` says what the directions are named by.
#[must_use]
pub fn flux_plot(report: &FluxReport, axis: &str) -> Plot {
    let curve = |label: &str, value: &dyn Fn(&Incidence) -> Option<[f64; 2]>| Curve {
        label: label.to_owned(),
        points: (report.incidences.iter())
            .map(|incidence| {
                let [y, error] = value(incidence).unwrap_or([f64::NAN, 0.0]);
                CurvePoint { x: incidence.direction.label, y, error }
            })
            .collect(),
    };
    let total = |stand: Stand, light: usize| {
        move |incidence: &Incidence| {
            let total = incidence.totals[stand as usize][light];
            Some([total.mean, total.error])
        }
    };
    let gain = |light: usize| {
        move |incidence: &Incidence| incidence.gains[light].map(|gain| [gain.percent, gain.error])
    };
    let nowhere = |_: &Incidence| None;
    let labels =
        ["cloaked, horizontal", "cloaked, vertical", "cloaked, unpolarized", "bare", "nothing"];
    // Every panel has the curves of the key.
    let irradiance = vec![
        curve(labels[0], &total(Stand::Cloaked, 0)),
        curve(labels[1], &total(Stand::Cloaked, 1)),
        curve(labels[2], &total(Stand::Cloaked, 2)),
        curve(labels[3], &total(Stand::Bare, 2)),
        curve(labels[4], &total(Stand::Nothing, 2)),
    ];
    let given_back = vec![
        curve(labels[0], &gain(0)),
        curve(labels[1], &gain(1)),
        curve(labels[2], &gain(2)),
        curve(labels[3], &nowhere),
        curve(labels[4], &nowhere),
    ];
    Plot {
        axis: axis.to_owned(),
        categories: Vec::new(),
        panels: vec![
            PlotPanel { title: "Mean irradiance".to_owned(), curves: irradiance },
            PlotPanel { title: "Shadow given back (%)".to_owned(), curves: given_back },
        ],
    }
}

/// Where the light goes: for bare metal and the cloak, the irradiance across the receiver over all directions, or of a
/// receiver with cells along it, too, over the receiver for the first direction.
#[must_use]
pub fn flux_map(report: &FluxReport, axis: &str) -> Option<HeatMap> {
    let [wide, long] = report.cells;
    let all = &report.incidences;
    let (first, last) = (all.first()?, all.last()?);
    let half = [0, 1].map(|i| 0.5 * report.size[i]);
    let over_directions = long == 1 && all.len() > 1;
    let panels = [Stand::Bare, Stand::Cloaked].map(|stand| HeatMapPanel {
        title: stand.name().to_owned(),
        columns: wide,
        numbers: if over_directions {
            all.iter().flat_map(|incidence| incidence.maps[stand as usize].clone()).collect()
        } else {
            first.maps[stand as usize].clone()
        },
    });
    // A row is as high as the step to the next direction.
    let step = (last.direction.label - first.direction.label) / (all.len().max(2) - 1) as f64;
    Some(HeatMap {
        quantity: "Irradiance".to_owned(),
        across: "Place across the receiver (cm)".to_owned(),
        up: if over_directions {
            axis.to_owned()
        } else {
            "Place along the receiver (cm)".to_owned()
        },
        across_range: [-half[0], half[0]],
        up_range: if over_directions {
            [first.direction.label - 0.5 * step, last.direction.label + 0.5 * step]
        } else {
            [-half[1], half[1]]
        },
        panels: panels.to_vec(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::flux::{Sampling, across_range, flux};
    use cloakroom::render::Supervision;
    use cloakroom::scene_file;
    use std::path::Path;
    use std::sync::atomic::AtomicBool;

    #[test]
    fn what_was_measured_is_drawn() {
        let text =
            "[receiver]\nposition = [30, 0, 0]\nwidth = 50\n[[device]]\nkind = \"square-cloak\"\n";
        let scene = scene_file::parse(text, "scene", Path::new(""), &[]).expect("a scene").scene;
        let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) };
        let directions = across_range(&scene.receiver, &[0.0, 30.0], 0.0);
        let sampling = Sampling { rays: 256, samples: 2, cells: 40 };
        let report = flux(&scene, &directions, sampling, &|_| {}, &supervision).expect("a report");
        let plot = flux_plot(&report, "Angle of incidence (°)");
        assert_eq!(plot.panels[0].curves.len(), 5);
        let map = flux_map(&report, "Angle of incidence (°)").expect("a map").draw();
        assert_eq!(map.expect("drawn").of_class("heat-map").count(), 2);
    }
}
