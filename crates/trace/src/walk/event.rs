//! What happens to a branch on its way, and the fingerprint that it leaves.

use crate::split_mix::STEP as ODD;
use std::hash::{Hash, Hasher};

/// Where a branch comes to a border.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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

/// Marks where an event begins, so that the numbers of one are never read as the next one's; with
/// no pattern in it.
const BEGIN: u64 = 0x2545_F491_4F6C_DD1D;

/// Adds what happens to a branch to the fingerprint of its path.
#[inline]
pub(super) fn fingerprint(path: u64, event: impl Hash) -> u64 {
    let mut state = Fingerprint(path ^ BEGIN);
    event.hash(&mut state);
    state.finish()
}

/// Turns, adds and multiplies by an odd number: few instructions, and no two ways in practice have
/// one number.
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

#[cfg(test)]
mod tests {
    use super::*;
    use optics::interface::Side;
    use optics::medium::ModeKind;
    use std::collections::HashSet;

    /// Ways of up to two events of any kind, with small numbers as scenes have them.
    #[test]
    fn ways_that_differ_have_fingerprints_that_differ() {
        let mut events = HashSet::new();
        for (device, region, face) in (0..27).map(|i| (i / 9, i / 3 % 3, i % 3)) {
            for event in
                [Event::Surface { device, surface: face }, Event::Face { device, region, face }]
            {
                events.extend([event, event.shared()]);
            }
        }
        let waves: Vec<(Side, ModeKind)> = [Side::Reflected, Side::Transmitted]
            .into_iter()
            .flat_map(|side| {
                [ModeKind::Shared, ModeKind::S, ModeKind::Ordinary].map(|mode| (side, mode))
            })
            .collect();
        let after = |way: u64| {
            let alone = events.iter().map(move |event| fingerprint(way, event));
            let split =
                events.iter().flat_map(|event| waves.iter().map(move |wave| (event, *wave)));
            alone.chain(
                split.map(move |(event, (side, mode))| fingerprint(way, (event, side, mode))),
            )
        };
        let once: Vec<u64> = after(0).collect();
        let twice = once.iter().flat_map(|way| after(*way));
        let ways: Vec<u64> = [0].into_iter().chain(once.iter().copied()).chain(twice).collect();
        assert_eq!(ways.len(), 1 + once.len() + once.len().pow(2));
        assert_eq!(ways.iter().collect::<HashSet<_>>().len(), ways.len());
    }
}
