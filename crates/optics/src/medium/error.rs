//! Why a medium cannot be.

/// Why a medium cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MediumError {
    /// A number is NaN, or too large or too small for fields to be computed.
    #[error("{quantity} is {value:?}; its magnitude must be 1e-12 to 1e12")]
    Degenerate {
        /// What the number is.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// The tensor is not symmetric; such media are not reciprocal and are not supported.
    #[error("the {quantity} tensor is not symmetric")]
    NotSymmetric {
        /// Which tensor.
        quantity: &'static str,
    },
    /// A principal value of the tensor is NaN, or too large or too small, or too small beside
    /// another one, for fields to be computed.
    #[error(
        "the {quantity} tensor is singular, or too large or small: the magnitudes of its principal \
         values must be 1e-12 to 1e12, and the largest at most 1e12 times the smallest"
    )]
    Singular {
        /// Which tensor.
        quantity: &'static str,
    },
    /// Waves are so short that directions in air cannot be told from theirs.
    #[error(
        "the largest principal values of permittivity and permeability are {permittivity:?} and {permeability:?}; \
         their product, the square of an index of refraction, must be at most 1e12"
    )]
    TooDense {
        /// The largest magnitude of a principal value of the permittivity, or nearly so.
        permittivity: f64,
        /// The same of the permeability.
        permeability: f64,
    },
    /// The imaginary part of the tensor would amplify light.
    #[error(
        "the imaginary part of the {quantity} has the negative principal value {value}; media with \
         gain are not supported"
    )]
    Gain {
        /// Which tensor.
        quantity: &'static str,
        /// The smallest principal value of its imaginary part.
        value: f64,
    },
    /// The optic axis has no direction.
    #[error("the optic axis must be a finite vector that is not zero")]
    NoAxis,
}

impl MediumError {
    /// What is wrong: the name of a tensor or of a number.
    #[must_use]
    pub fn quantity(&self) -> Option<&'static str> {
        match self {
            Self::Degenerate { quantity, .. }
            | Self::NotSymmetric { quantity }
            | Self::Singular { quantity }
            | Self::Gain { quantity, .. } => Some(quantity),
            Self::TooDense { .. } | Self::NoAxis => None,
        }
    }
}
