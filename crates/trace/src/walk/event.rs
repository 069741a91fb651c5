//! What happens to a branch on its way, and the fingerprint that it leaves.

use crate::split_mix::STEP as ODD;
use std::hash::{Hash, Hasher};

/// Where a branch comes to a border.
#[derive(Clone, Copy, Debug, Hash)]
pub(super) enum Event {
    /// To a surface of a device, from outside.
    Surface { device: u16, surface: u16 },
    /// To a face of a region of a device, from inside.
    Face { device: u16, region: u16, face: u16 },
    /// To either where another device is beyond it.
    Shared { device: u16, face: u16 },
}

impl Event {
    /// The same border, where another device is beyond it.
    pub fn shared(self) -> Self {
        match self {
            Self::Surface { device, surface: face } | Self::Face { device, face, .. } => {
                Self::Shared { device, face }
            }
            Self::Shared { .. } => self,
        }
    }
}

/// Adds what happens to a branch to the fingerprint of its path.
#[inline]
pub(super) fn fingerprint(path: u64, event: impl Hash) -> u64 {
    let mut state = Fingerprint(path);
    event.hash(&mut state);
    state.finish()
}

/// A polynomial in an odd number: few instructions, and every way gets a number of its own.
struct Fingerprint(u64);

impl Hasher for Fingerprint {
    #[inline]
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u16((*byte).into()));
    }

    #[inline]
    fn write_u16(&mut self, number: u16) {
        self.0 = (self.0.rotate_left(5) ^ u64::from(number)).wrapping_mul(ODD);
    }

    /// The variants of enums.
    #[inline]
    fn write_isize(&mut self, number: isize) {
        self.write_u16(number as u16);
    }
}
