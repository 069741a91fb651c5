//! The named channels of a picture.

use crate::color::BINS;
use crate::output::Samples;
use crate::scene::PictureSettings;

/// What a picture is asked to hold, from little to much.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChannelSet {
    /// The image through the camera's polarizer alone: `R`, `G`, `B`.
    Image,
    /// That and the images through a horizontal and a vertical polarizer, `horizontal.R` to
    /// `vertical.B`, as pictures through them alone would be. Where every channel is wanted, these
    /// too show all branches that are followed.
    Polarizers,
    /// What views are measured by: the image through the camera's polarizer, times of flight,
    /// interpolated where the image is (to 1e-6 cm/c), and powers.
    Measures,
    /// Every channel that every file of data holds, and the others that the scene asks for.
    Everything,
}

impl ChannelSet {
    /// What the scene's image is made from: a map needs every channel.
    #[must_use]
    pub fn for_image(picture: &PictureSettings) -> Self {
        if picture.map.name().is_some() { Self::Everything } else { Self::Image }
    }
}

/// One channel of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelKind {
    /// The image through the camera's polarizer, linear light: red 0, green 1, blue 2.
    Image(usize),
    /// The image through a horizontal polarizer.
    Horizontal(usize),
    /// The image through a vertical polarizer.
    Vertical(usize),
    /// Time of flight from the camera to the photograph, ns: the mean over the leaves that reach
    /// it, weighted by their power; NaN where none does.
    TimeOfFlight,
    /// Standard deviation of the time of flight over the leaves of one camera ray, ns: above zero
    /// where a short pulse comes back as several; NaN as above.
    TimeOfFlightSpread,
    /// Time of flight less that of the same camera ray in the empty scene, ns; NaN also where
    /// that ray misses the photograph.
    TimeOfFlightDifference,
    /// What a pulse takes from the photograph to the camera, ns: as [`Self::TimeOfFlight`]; NaN
    /// also behind media that absorb.
    GroupDelay,
    /// Its standard deviation over the leaves of one camera ray, ns.
    GroupDelaySpread,
    /// It less the time of flight of the same camera ray in the empty scene, ns.
    GroupDelayDifference,
    /// How far away a LIDAR at the camera finds the photograph or an opaque body, by the first pulse that
    /// comes back: the speed of light times what a pulse takes one way, cm; NaN where none comes back of
    /// which it is known when.
    FirstPulseDepth,
    /// The same by the strongest pulse.
    StrongestPulseDepth,
    /// Share of the power that reaches the photograph.
    Delivered,
    /// Share of the power that goes to the surroundings.
    Escaped,
    /// Share of the power absorbed by media.
    Absorbed,
    /// Share of the power in branches too weak to follow.
    Pruned,
    /// Stokes parameter S0 to S3 of the light that arrives at the camera's polarizer, in color
    /// ([`optics::wave::arriving_stokes`] says with which signs).
    Stokes(usize),
    /// The light of each of [`color::BINS`](crate::color::BINS) bins of wavelengths, as a share of the
    /// power of the lamp that is seen.
    Spectrum,
    /// Of the power that enters a uniaxial medium through the first surface met, the share in the
    /// extraordinary wave; NaN where none does.
    ExtraordinaryShare,
    /// Share of the power reflected at the first surface met, 1 for metal; NaN where none is met.
    FirstFaceReflectance,
}

impl ChannelKind {
    /// All channels in the order of files, with their names there: those that every file of data
    /// holds, then those that a scene must ask for.
    const NAMES: [(Self, &str); 28] = [
        (Self::Image(0), "R"),
        (Self::Image(1), "G"),
        (Self::Image(2), "B"),
        (Self::Horizontal(0), "horizontal.R"),
        (Self::Horizontal(1), "horizontal.G"),
        (Self::Horizontal(2), "horizontal.B"),
        (Self::Vertical(0), "vertical.R"),
        (Self::Vertical(1), "vertical.G"),
        (Self::Vertical(2), "vertical.B"),
        (Self::TimeOfFlight, "time_of_flight"),
        (Self::TimeOfFlightSpread, "time_of_flight_spread"),
        (Self::TimeOfFlightDifference, "time_of_flight_difference"),
        (Self::Delivered, "delivered"),
        (Self::Escaped, "escaped"),
        (Self::Absorbed, "absorbed"),
        (Self::Pruned, "pruned"),
        (Self::Stokes(0), "stokes.S0"),
        (Self::Stokes(1), "stokes.S1"),
        (Self::Stokes(2), "stokes.S2"),
        (Self::Stokes(3), "stokes.S3"),
        (Self::ExtraordinaryShare, "extraordinary_share"),
        (Self::FirstFaceReflectance, "first_face_reflectance"),
        (Self::GroupDelay, "group_delay"),
        (Self::GroupDelaySpread, "group_delay_spread"),
        (Self::GroupDelayDifference, "group_delay_difference"),
        (Self::FirstPulseDepth, "first_pulse_depth"),
        (Self::StrongestPulseDepth, "strongest_pulse_depth"),
        (Self::Spectrum, "spectrum"),
    ];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(channel, _)| *channel == self).map_or("", |(_, name)| name)
    }

    /// Whether it is of colors, which may be traced each by itself.
    #[must_use]
    pub fn is_color(self) -> bool {
        matches!(
            self,
            Self::Image(_)
                | Self::Horizontal(_)
                | Self::Vertical(_)
                | Self::Stokes(_)
                | Self::Spectrum
        )
    }

    /// Its samples before anything is seen.
    #[must_use]
    pub fn blank(self, pixels: usize) -> Samples {
        match self {
            // Differences of times go down to yoctoseconds.
            Self::TimeOfFlight
            | Self::TimeOfFlightSpread
            | Self::TimeOfFlightDifference
            | Self::GroupDelay
            | Self::GroupDelaySpread
            | Self::GroupDelayDifference
            | Self::FirstPulseDepth
            | Self::StrongestPulseDepth => Samples::F64(vec![0.0; pixels]),
            Self::Stokes(_) => Samples::Rgb(vec![[0.0; 3]; pixels]),
            Self::Spectrum => Samples::Bins(vec![[0.0; BINS]; pixels]),
            _ => Samples::F32(vec![0.0; pixels]),
        }
    }

    /// The channels of a picture that is to hold `wanted`.
    #[must_use]
    pub fn of(wanted: ChannelSet, picture: &PictureSettings) -> Vec<Self> {
        let first = match wanted {
            ChannelSet::Image => 3,
            ChannelSet::Polarizers => 9,
            ChannelSet::Measures | ChannelSet::Everything => Self::NAMES.len(),
        };
        let is_wanted = |channel: &Self| {
            let is_measure = matches!(
                channel,
                Self::Image(_)
                    | Self::TimeOfFlight
                    | Self::TimeOfFlightDifference
                    | Self::Delivered
                    | Self::Escaped
                    | Self::Absorbed
                    | Self::Pruned
            );
            is_measure || wanted != ChannelSet::Measures
        };
        // The word with which a scene asks for a channel, where it must.
        let asked = |channel: &Self| match channel {
            Self::Stokes(_) => picture.asks_for("stokes"),
            Self::Spectrum => picture.asks_for("spectrum"),
            Self::GroupDelay | Self::GroupDelaySpread | Self::GroupDelayDifference => {
                picture.asks_for_group_delay()
            }
            Self::FirstPulseDepth | Self::StrongestPulseDepth => picture.asks_for_pulse_depth(),
            Self::ExtraordinaryShare | Self::FirstFaceReflectance => {
                picture.asks_for(channel.name())
            }
            _ => true,
        };
        let channels = Self::NAMES[..first].iter().map(|(channel, _)| *channel);
        channels.filter(is_wanted).filter(asked).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::Table;
    use crate::scene::{MapChannel, OPTIONAL_CHANNELS};

    #[test]
    fn optional_channels_come_only_when_asked_for() {
        let names = |wanted, channels: &[&'static str], map| {
            let mut settings = PictureSettings { map, ..PictureSettings::default() };
            let channels = channels.iter().map(|&word| word.into()).collect();
            settings.set("channels", crate::keys::Value::List(channels)).expect("known");
            ChannelKind::of(wanted, &settings)
                .into_iter()
                .map(ChannelKind::name)
                .collect::<Vec<_>>()
        };
        assert_eq!(names(ChannelSet::Everything, &[], MapChannel::None).len(), 16);
        assert_eq!(
            names(ChannelSet::Polarizers, &["stokes"], MapChannel::None)[3..],
            [
                "horizontal.R",
                "horizontal.G",
                "horizontal.B",
                "vertical.R",
                "vertical.G",
                "vertical.B",
            ]
        );
        assert_eq!(names(ChannelSet::Image, OPTIONAL_CHANNELS, MapChannel::None), ["R", "G", "B"]);
        let stokes = ["stokes.S0", "stokes.S1", "stokes.S2", "stokes.S3"];
        assert_eq!(names(ChannelSet::Everything, &["stokes"], MapChannel::None)[16..], stokes);
        let shown = names(ChannelSet::Everything, &[], MapChannel::ExtraordinaryShare);
        assert_eq!(shown[16..], ["extraordinary_share"]);
        // Every word asks for something, and every channel has its word.
        for word in OPTIONAL_CHANNELS {
            assert!(names(ChannelSet::Everything, &[word], MapChannel::None).len() > 16, "{word}");
        }
        let all = names(ChannelSet::Everything, OPTIONAL_CHANNELS, MapChannel::None);
        assert_eq!(all.len(), ChannelKind::NAMES.len());
    }
}
