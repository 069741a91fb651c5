//! The named channels of a picture.

use crate::scene::PictureSettings;

/// What a picture is asked to hold, from little to much.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChannelSet {
    /// The image through the camera's polarizer alone: `R`, `G`, `B`.
    Image,
    /// That and the images through a horizontal and a vertical polarizer, `horizontal.R` to `vertical.B`, as pictures
    /// through them alone would be. Where every channel is wanted, these too show all branches that are followed.
    Polarizers,
    /// Every channel of [`Channel::ALWAYS`], and those of [`Channel::OPTIONAL`] that the scene asks for.
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
pub enum Channel {
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
    /// Of the power that enters a uniaxial medium through the first surface met, the share in the
    /// extraordinary wave; NaN where none does.
    ExtraordinaryShare,
    /// Share of the power reflected at the first surface met, 1 for metal; NaN where none is met.
    FirstFaceReflectance,
}

impl Channel {
    /// The channels that every file of data holds, in its order.
    pub const ALWAYS: [Self; 16] = [
        Self::Image(0),
        Self::Image(1),
        Self::Image(2),
        Self::Horizontal(0),
        Self::Horizontal(1),
        Self::Horizontal(2),
        Self::Vertical(0),
        Self::Vertical(1),
        Self::Vertical(2),
        Self::TimeOfFlight,
        Self::TimeOfFlightSpread,
        Self::TimeOfFlightDifference,
        Self::Delivered,
        Self::Escaped,
        Self::Absorbed,
        Self::Pruned,
    ];

    /// The channels that a scene must ask for, in the order of files.
    pub const OPTIONAL: [Self; 6] = [
        Self::Stokes(0),
        Self::Stokes(1),
        Self::Stokes(2),
        Self::Stokes(3),
        Self::ExtraordinaryShare,
        Self::FirstFaceReflectance,
    ];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        let nth = |names: &[&'static str], i: usize| names[i.min(names.len() - 1)];
        match self {
            Self::Image(i) => nth(&["R", "G", "B"], i),
            Self::Horizontal(i) => nth(&["horizontal.R", "horizontal.G", "horizontal.B"], i),
            Self::Vertical(i) => nth(&["vertical.R", "vertical.G", "vertical.B"], i),
            Self::TimeOfFlight => "time_of_flight",
            Self::TimeOfFlightSpread => "time_of_flight_spread",
            Self::TimeOfFlightDifference => "time_of_flight_difference",
            Self::Delivered => "delivered",
            Self::Escaped => "escaped",
            Self::Absorbed => "absorbed",
            Self::Pruned => "pruned",
            Self::Stokes(i) => nth(&["stokes.S0", "stokes.S1", "stokes.S2", "stokes.S3"], i),
            Self::ExtraordinaryShare => "extraordinary_share",
            Self::FirstFaceReflectance => "first_face_reflectance",
        }
    }

    /// What its samples are.
    #[must_use]
    pub fn form(self) -> Form {
        match self {
            // Differences of times go down to yoctoseconds.
            Self::TimeOfFlight | Self::TimeOfFlightSpread | Self::TimeOfFlightDifference => {
                Form::Double
            }
            Self::Stokes(_) => Form::Rgb,
            _ => Form::Single,
        }
    }

    /// The channels of a picture that is to hold `wanted`.
    #[must_use]
    pub fn of(wanted: ChannelSet, picture: &PictureSettings) -> Vec<Self> {
        match wanted {
            ChannelSet::Image => Self::ALWAYS[..3].to_vec(),
            ChannelSet::Polarizers => Self::ALWAYS[..9].to_vec(),
            ChannelSet::Everything => {
                let asked = Self::OPTIONAL.iter().filter(|c| picture.asks_for(c.keyword()));
                Self::ALWAYS.iter().chain(asked).copied().collect()
            }
        }
    }

    /// The word with which a scene asks for it.
    fn keyword(self) -> &'static str {
        match self {
            Self::Stokes(_) => "stokes",
            _ => self.name(),
        }
    }
}

/// What the samples of a channel are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Numbers in single precision.
    Single,
    /// Numbers in double precision.
    Double,
    /// Red, green and blue in single precision.
    Rgb,
}

impl Form {
    /// How many bytes a pixel takes.
    #[must_use]
    pub fn bytes(self) -> u64 {
        match self {
            Self::Single => 4,
            Self::Double => 8,
            Self::Rgb => 12,
        }
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
            Channel::of(wanted, &settings).into_iter().map(Channel::name).collect::<Vec<_>>()
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
        assert_eq!(all.len(), Channel::ALWAYS.len() + Channel::OPTIONAL.len());
    }
}
