//! What a measurement of flux has found.

use super::Direction;
use crate::trace::TraceStats;

/// What stands in the way of the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stand {
    /// No device.
    Nothing,
    /// The metal without its cloak.
    Bare,
    /// The scene as it is.
    Cloaked,
}

/// All three, in the order of files.
pub const STANDS: [Stand; 3] = [Stand::Nothing, Stand::Bare, Stand::Cloaked];

impl Stand {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["nothing", "bare", "cloaked"][self as usize]
    }
}

/// One sample of one direction: the power on each cell, horizontal and vertical.
#[derive(Clone, Debug)]
pub(super) struct Tally {
    cells: Vec<[f64; 2]>,
    pub stats: TraceStats,
}

impl Tally {
    pub fn new([wide, long]: [usize; 2]) -> Self {
        Self { cells: vec![[0.0; 2]; wide * long], stats: TraceStats::default() }
    }

    pub fn add(&mut self, cell: usize, power: [f64; 2]) {
        for (sum, power) in self.cells[cell].iter_mut().zip(power) {
            *sum += power;
        }
    }

    /// The power on all cells: horizontal, vertical and unpolarized.
    fn total(&self) -> [f64; 3] {
        let sum = |i: usize| self.cells.iter().map(|cell| cell[i]).sum::<f64>();
        let [horizontal, vertical] = [sum(0), sum(1)];
        [horizontal, vertical, 0.5 * (horizontal + vertical)]
    }
}

/// The mean irradiance of the receiver, that across the light being 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Total {
    /// The mean over the samples.
    pub mean: f64,
    /// Its standard error.
    pub error: f64,
}

/// The share of the shadow of bare metal that the cloak gives back, in percent; 100 is perfect,
/// less than 0 is worse than the metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain {
    /// (cloaked - bare)/(nothing - bare).
    pub percent: f64,
    /// Its standard error, by the jackknife.
    pub error: f64,
}

/// What becomes of a number as rays are added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// How many rays.
    pub rays: u64,
    /// The irradiance behind the cloak, unpolarized.
    pub cloaked: Total,
    /// The shadow given back, unpolarized; `None` without a shadow.
    pub gain: Option<Gain>,
}

/// What light from one direction does.
#[derive(Clone, Debug, PartialEq)]
pub struct Incidence {
    /// The direction.
    pub direction: Direction,
    /// The angle to the receiver's normal, degrees.
    pub degrees: f64,
    /// For each of [`STANDS`]: in horizontal, in vertical and in unpolarized light.
    pub totals: [[Total; 3]; 3],
    /// In horizontal, in vertical and in unpolarized light; `None` where bare metal makes no
    /// shadow, or in one sample alone.
    pub gains: [Option<Gain>; 3],
    /// For each of [`STANDS`]: the irradiance of each cell, across first, in unpolarized light.
    pub maps: [Vec<f64>; 3],
    /// With more and more samples.
    pub convergence: Vec<Convergence>,
    /// Rare events in all samples.
    pub stats: TraceStats,
}

/// What a measurement of flux has found.
#[derive(Clone, Debug, PartialEq)]
pub struct FluxReport {
    /// Cells across and along the receiver.
    pub cells: [usize; 2],
    /// The size of the receiver across and along, cm.
    pub size: [f64; 2],
    /// For each direction.
    pub incidences: Vec<Incidence>,
    /// Scene, version and seed, for files.
    pub metadata: Vec<(String, String)>,
}

impl Incidence {
    /// From the samples of each of [`STANDS`], in that order, of so many rays each, of which one
    /// stands for the irradiance `share`.
    pub(super) fn new(
        direction: Direction,
        degrees: f64,
        tallies: &[Vec<Tally>],
        (rays, share): (u32, f64),
    ) -> Self {
        let sums: Vec<Vec<[f64; 3]>> =
            tallies.iter().map(|samples| samples.iter().map(Tally::total).collect()).collect();
        let of = |stand: Stand, light: usize| -> Vec<f64> {
            sums[stand as usize].iter().map(|sum| sum[light]).collect()
        };
        let gain = |light: usize, most: usize| {
            let [n, b, c] = STANDS.map(|stand| of(stand, light)[..most].to_vec());
            given_back(&n, &b, &c)
        };
        let mut stats = TraceStats::default();
        tallies.iter().flatten().for_each(|tally| stats += tally.stats);
        let samples = sums.first().map_or(0, Vec::len);
        let steps = std::iter::successors(Some(2), |step| Some(step * 2));
        let steps = steps.take_while(|step| *step < samples).chain([samples]);
        Self {
            direction,
            degrees,
            totals: STANDS.map(|stand| [0, 1, 2].map(|light| Total::of(&of(stand, light), share))),
            gains: [0, 1, 2].map(|light| gain(light, samples)),
            maps: STANDS.map(|stand| map(&tallies[stand as usize])),
            convergence: steps
                .map(|most| Convergence {
                    rays: u64::from(rays) * most as u64,
                    cloaked: Total::of(&of(Stand::Cloaked, 2)[..most], share),
                    gain: gain(2, most),
                })
                .collect(),
            stats,
        }
    }
}

impl Total {
    /// From samples of a grid of rays, of which one stands for `share`.
    fn of(samples: &[f64], share: f64) -> Self {
        let count = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / count;
        let square: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
        // The edges of the receiver cut two strata of a row: whether their rays come down on it is
        // chance, p(1 - p) of a ray, which is 1/6 on average. A few samples may all fall alike.
        let edges = 2.0 / 6.0 * share * share;
        let variance = (square / (count - 1.0)).max(edges);
        Self { mean, error: (variance / count).sqrt() }
    }
}

/// A shadow less than this share of the light is none.
const NO_SHADOW: f64 = 1e-9;

/// The share of the shadow that is given back, with its jackknife error; none if there is no
/// shadow, or but for one sample none.
pub(super) fn given_back(nothing: &[f64], bare: &[f64], cloaked: &[f64]) -> Option<Gain> {
    let count = nothing.len() as f64;
    let [n, b, c] = [nothing, bare, cloaked].map(|samples| samples.iter().sum::<f64>());
    let ratio = |n: f64, b: f64, c: f64| {
        let shadow = n - b;
        (shadow.abs() > NO_SHADOW * n.abs()).then(|| 100.0 * (c - b) / shadow)
    };
    let without = |i: usize| ratio(n - nothing[i], b - bare[i], c - cloaked[i]);
    let parts: Vec<f64> = (0..nothing.len()).map(without).collect::<Option<_>>()?;
    let mean = parts.iter().sum::<f64>() / count;
    let square: f64 = parts.iter().map(|part| (part - mean).powi(2)).sum();
    Some(Gain { percent: ratio(n, b, c)?, error: (square * (count - 1.0) / count).sqrt() })
}

/// The irradiance of each cell: a cell's share of the receiver is one over their number.
fn map(samples: &[Tally]) -> Vec<f64> {
    let cells = samples.first().map_or(0, |tally| tally.cells.len());
    let scale = cells as f64 / samples.len() as f64;
    (0..cells)
        .map(|i| scale * samples.iter().map(|s| 0.5 * (s.cells[i][0] + s.cells[i][1])).sum::<f64>())
        .collect()
}
