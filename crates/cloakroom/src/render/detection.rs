//! Which polarizations are launched for a picture, and what each counts for.

use super::{Arrivals, ChannelSet, Delay};
use crate::scene::{Camera, CameraRay, PictureSettings};
use crate::trace::Launch;

/// The polarizations launched with each camera ray, and what each counts for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Detection<const N: usize> {
    /// Amplitudes of the launched polarizations along the camera's horizontal and vertical.
    launched: [[f64; 2]; N],
    /// Weights of the launched polarizations in what the camera with its polarizer sees.
    weights: [f64; N],
    /// Whether the first two launched polarizations are horizontal and vertical, with an image of
    /// their own each.
    pub separate: bool,
    /// Whether the images of these two are to be as if each had been launched alone: without the
    /// branches that are too weak in the one and followed because of the other.
    pub alone: bool,
    /// Whether times of flight are wanted.
    pub times: bool,
    /// Whether these are to be traced wherever that can be done without error.
    pub exact_times: bool,
    /// Whether what pulses take is wanted.
    pub group_delays: bool,
    /// Whether depths that a LIDAR would tell are wanted, for which what pulses take is.
    pub depths: bool,
    /// Whether the Stokes parameters are wanted: for those the first two are needed.
    pub stokes: bool,
    /// Whether the first surface is looked at on its own.
    pub first_face: bool,
    /// Whether the light of each bin of wavelengths is wanted.
    pub spectrum: bool,
    /// Whether shares of the power are wanted.
    shares: bool,
    /// When light arrives, where that is looked at.
    pub arrivals: Option<Arrivals>,
    /// What pulses take need be no more exact, cm.
    pub pulse_tolerance: f64,
}

const HORIZONTAL: [f64; 2] = [1.0, 0.0];
const VERTICAL: [f64; 2] = [0.0, 1.0];

impl Detection<1> {
    /// The image through a polarizer that passes these amplitudes along horizontal and vertical.
    pub fn image(amplitudes: [f64; 2]) -> Self {
        Self::of([amplitudes], [1.0])
    }
}

impl Detection<2> {
    /// No polarizer.
    pub const UNPOLARIZED: Self = Self::of([HORIZONTAL, VERTICAL], [0.5, 0.5]);
}

impl Detection<3> {
    /// Horizontal, vertical, and what a polarizer passes that is neither of them alone.
    pub fn through(amplitudes: [f64; 2]) -> Self {
        Self::of([HORIZONTAL, VERTICAL, amplitudes], [0.0, 0.0, 1.0])
    }
}

impl<const N: usize> Detection<N> {
    /// With times of flight; a single polarization is neither horizontal nor vertical.
    const fn of(launched: [[f64; 2]; N], weights: [f64; N]) -> Self {
        Self {
            launched,
            weights,
            separate: N > 1,
            alone: false,
            times: true,
            exact_times: true,
            group_delays: false,
            depths: false,
            stokes: false,
            first_face: false,
            spectrum: false,
            shares: true,
            arrivals: None,
            pulse_tolerance: 0.0,
        }
    }

    /// Adds what the optional channels of a picture ask for; where the image alone is wanted,
    /// leaves out all but that.
    pub fn with_options(self, wanted: ChannelSet, picture: &PictureSettings) -> Self {
        let everything = wanted == ChannelSet::Everything;
        let asked = |channel| everything && picture.asks_for(channel);
        Self {
            separate: self.separate && (everything || wanted == ChannelSet::Polarizers),
            times: everything || wanted == ChannelSet::Measures,
            exact_times: everything,
            group_delays: everything
                && (picture.asks_for_group_delay() || picture.asks_for_pulse_depth()),
            depths: everything && picture.asks_for_pulse_depth(),
            alone: wanted == ChannelSet::Polarizers,
            stokes: self.separate && asked("stokes"),
            spectrum: asked("spectrum"),
            shares: everything || wanted == ChannelSet::Measures,
            first_face: asked("extraordinary_share") || asked("first_face_reflectance"),
            ..self
        }
    }

    /// The image alone, and when its light arrives, as a pulse to within a tolerance (cm).
    pub fn in_flight(&self, arrivals: Arrivals, pulse_tolerance: f64) -> Self {
        let arrivals = Some(arrivals);
        Self { separate: false, arrivals, pulse_tolerance, ..self.of_colors() }
    }

    /// Whether tracers are to work out what pulses take.
    pub fn wants_group_paths(&self) -> bool {
        self.group_delays || self.arrivals.is_some_and(|arrivals| arrivals.delay == Delay::Group)
    }

    /// Whether anything is wanted that is no color.
    pub fn has_numbers(&self) -> bool {
        self.shares || self.times || self.group_delays || self.first_face
    }

    /// The same for colors alone.
    pub fn of_colors(&self) -> Self {
        let (times, exact_times, shares) = (false, false, false);
        let (group_delays, depths, first_face) = (false, false, false);
        Self { times, exact_times, shares, group_delays, depths, first_face, ..*self }
    }

    /// The ray to launch for a camera ray.
    pub fn launch(&self, camera: &Camera, ray: &CameraRay) -> Launch<N> {
        let (horizontal, vertical) = camera.polarization_basis(ray.direction);
        Launch {
            origin: ray.origin,
            direction: ray.direction,
            electric: self.launched.map(|[h, v]| (horizontal * h + vertical * v).into()),
        }
    }

    /// What the camera with its polarizer sees of these powers.
    pub fn detected(&self, power: &[f64; N]) -> f64 {
        self.weights.iter().zip(power).map(|(weight, power)| weight * power).sum()
    }
}
