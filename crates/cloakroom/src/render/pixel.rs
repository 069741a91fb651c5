//! What one pixel gathers from its samples.

use super::ChannelKind;
use super::detection::Detection;
use glam::{DMat3, DVec3};

/// Running sums over the samples of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pixel {
    pub image: [f64; 3],
    pub horizontal: [f64; 3],
    pub vertical: [f64; 3],
    pub stokes: [[f64; 3]; 4],
    pub delivered: f64,
    pub escaped: f64,
    pub absorbed: f64,
    pub pruned: f64,
    /// How many of its rays met a surface, and what became of their power at the first one.
    pub surfaces_met: f64,
    pub reflected: f64,
    pub ordinary: f64,
    pub extraordinary: f64,
    /// Times of flight, and what pulses take.
    pub times: Times,
    pub group_delays: Times,
    /// What a LIDAR would tell.
    pub depths: Depths,
}

/// How far away (cm) a LIDAR finds what sends its pulse back.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Depths {
    first: Option<f64>,
    /// The depth, and the share of the power that comes back from there.
    strongest: Option<(f64, f64)>,
}

/// Running sums over times (ns), each weighted by power.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Times {
    time: f64,
    variance: f64,
    difference: f64,
    time_weight: f64,
    difference_weight: f64,
}

/// The pulses of one camera ray: time of flight (ns) and power of each leaf on the photograph.
pub(super) type Pulses = Vec<(f64, f64)>;

/// Puts what arrives in order, the earliest first; what is no number stands last.
#[inline(never)]
pub(super) fn sort_by_arrival(arrivals: &mut [(f64, f64)]) {
    arrivals.sort_by(|one, other| one.0.total_cmp(&other.0));
}

impl Depths {
    /// Adds what comes back of one camera ray: paths (cm) and shares of power, of which those are one
    /// pulse that differ by less than `tolerance`.
    pub fn add(&mut self, returns: &mut [(f64, f64)], tolerance: f64) {
        /// Weaker returns are lost in the noise.
        const LEAST_POWER: f64 = 0.01;
        sort_by_arrival(returns);
        let mut rest = &returns[..];
        while let Some((path, _)) = rest.first() {
            let together = rest.iter().take_while(|other| other.0 - path <= tolerance).count();
            // What is no number is no pulse, and stands last.
            let (pulse, later) = rest.split_at(together.max(1));
            let power: f64 = pulse.iter().map(|(_, power)| power).sum();
            if path.is_finite() && power >= LEAST_POWER {
                self.first = Some(self.first.map_or(*path, |first| first.min(*path)));
                if self.strongest.is_none_or(|(_, strongest)| power > strongest) {
                    self.strongest = Some((*path, power));
                }
            }
            rest = later;
        }
    }
}

impl Times {
    /// Adds the pulses of one camera ray; `empty` is its time of flight in the empty scene, ns.
    pub fn add(&mut self, pulses: &[(f64, f64)], empty: Option<f64>) {
        let power: f64 = pulses.iter().map(|(_, power)| power).sum();
        if power <= 0.0 {
            return;
        }
        // Relative to the first pulse: differences of yoctoseconds survive.
        let first = pulses[0].0;
        let mean = pulses.iter().map(|(time, power)| (time - first) * power).sum::<f64>() / power;
        let variance =
            pulses.iter().map(|(time, power)| (time - first - mean).powi(2) * power).sum::<f64>();
        self.time += (first + mean) * power;
        self.variance += variance;
        self.time_weight += power;
        if let Some(empty) = empty {
            self.difference += (first - empty + mean) * power;
            self.difference_weight += power;
        }
    }

    // 0/0 is the NaN that says: no leaf has reached the photograph.
    fn mean(&self) -> f64 {
        self.time / self.time_weight
    }

    fn spread(&self) -> f64 {
        (self.variance / self.time_weight).sqrt()
    }

    fn difference(&self) -> f64 {
        self.difference / self.difference_weight
    }
}

impl Pixel {
    /// Adds those images of another that are wanted, of things whose red, green and blue light have these colors.
    pub fn add_colors<const N: usize>(
        &mut self,
        other: &Self,
        color: DMat3,
        detection: &Detection<N>,
    ) {
        let add = |sum: &mut [f64; 3], image: [f64; 3]| {
            let added = (color * DVec3::from_array(image)).to_array();
            sum.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
        };
        add(&mut self.image, other.image);
        if detection.separate {
            add(&mut self.horizontal, other.horizontal);
            add(&mut self.vertical, other.vertical);
        }
        if detection.stokes {
            self.stokes.iter_mut().zip(other.stokes).for_each(|(of, added)| add(of, added));
        }
    }

    /// The value of a channel, the pixel having had `samples` samples; `color` says which of red 0,
    /// green 1 and blue 2 where the channel holds all three.
    pub fn value(&self, channel: ChannelKind, color: usize, samples: f64) -> f64 {
        match channel {
            ChannelKind::Image(i) => self.image[i] / samples,
            ChannelKind::Horizontal(i) => self.horizontal[i] / samples,
            ChannelKind::Vertical(i) => self.vertical[i] / samples,
            ChannelKind::TimeOfFlight => self.times.mean(),
            ChannelKind::TimeOfFlightSpread => self.times.spread(),
            ChannelKind::TimeOfFlightDifference => self.times.difference(),
            ChannelKind::GroupDelay => self.group_delays.mean(),
            ChannelKind::GroupDelaySpread => self.group_delays.spread(),
            ChannelKind::GroupDelayDifference => self.group_delays.difference(),
            ChannelKind::FirstPulseDepth => self.depths.first.unwrap_or(f64::NAN),
            ChannelKind::StrongestPulseDepth => {
                self.depths.strongest.map_or(f64::NAN, |(depth, _)| depth)
            }
            ChannelKind::Delivered => self.delivered / samples,
            ChannelKind::Escaped => self.escaped / samples,
            ChannelKind::Absorbed => self.absorbed / samples,
            ChannelKind::Pruned => self.pruned / samples,
            // 0/0 where no surface was met.
            ChannelKind::FirstFaceReflectance => self.reflected / self.surfaces_met,
            ChannelKind::ExtraordinaryShare => {
                self.extraordinary / (self.ordinary + self.extraordinary)
            }
            // It is kept elsewhere, and in pictures without a lamp nothing is known of it.
            ChannelKind::Spectrum => f64::NAN,
            ChannelKind::Stokes(k) => self.stokes[k][color] / samples,
        }
    }
}
