//! The named channels of a picture.

/// What a picture is asked to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// The image through the camera's polarizer alone: `R`, `G`, `B`.
    Image,
    /// Every channel of [`Channel::ALL`].
    Everything,
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
}

impl Channel {
    /// Every channel, in the order of files.
    pub const ALL: [Self; 16] = [
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

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        let colour = |names: [&'static str; 3], i: usize| names[i.min(2)];
        match self {
            Self::Image(i) => colour(["R", "G", "B"], i),
            Self::Horizontal(i) => colour(["horizontal.R", "horizontal.G", "horizontal.B"], i),
            Self::Vertical(i) => colour(["vertical.R", "vertical.G", "vertical.B"], i),
            Self::TimeOfFlight => "time_of_flight",
            Self::TimeOfFlightSpread => "time_of_flight_spread",
            Self::TimeOfFlightDifference => "time_of_flight_difference",
            Self::Delivered => "delivered",
            Self::Escaped => "escaped",
            Self::Absorbed => "absorbed",
            Self::Pruned => "pruned",
        }
    }

    /// Whether the channel is a time: kept in double precision, for differences go down to
    /// yoctoseconds.
    #[must_use]
    pub fn is_time(self) -> bool {
        matches!(self, Self::TimeOfFlight | Self::TimeOfFlightSpread | Self::TimeOfFlightDifference)
    }

    /// The channels of a picture that is to hold `wanted`.
    #[must_use]
    pub fn of(wanted: Wanted) -> &'static [Self] {
        match wanted {
            Wanted::Image => &Self::ALL[..3],
            Wanted::Everything => &Self::ALL,
        }
    }
}
