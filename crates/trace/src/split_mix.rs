//! `SplitMix64` (Steele, Lea & Flood, OOPSLA 2014): numbers without a pattern that depend on their
//! seed alone.

/// By how much the state grows from one number to the next.
pub const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// The first number after `state`; [`STEP`] added to it gives the second, and so on.
#[inline]
#[must_use]
pub fn mix(state: u64) -> u64 {
    let z = state.wrapping_add(STEP);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gives_the_numbers_of_the_reference_for_seed_zero() {
        let numbers = [0, 1, 2].map(|n| mix(STEP.wrapping_mul(n)));
        assert_eq!(numbers, [0xE220_A839_7B1D_CDAF, 0x6E78_9E6A_A1B9_65F4, 0x06C4_5D18_8009_454F]);
    }
}
