//! The sRGB curve, from the numbers in a file to linear light and back (IEC 61966-2-1).

use std::sync::LazyLock;

/// Linear light (0 to 1) of a sRGB value (0 to 1).
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB value (0 to 1) of linear light (0 to 1).
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Linear light of each 8-bit sRGB value.
pub fn decode_table() -> &'static [f32; 256] {
    static TABLE: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|code| decode(code as f64 / 255.0) as f32));
    &TABLE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_of_the_curve() {
        assert_eq!(decode(0.0), 0.0);
        assert!((decode(1.0) - 1.0).abs() < 1e-15);
        // Middle gray: 118 of 255 is the well-known 18 % card, within half a code.
        assert!((decode(118.0 / 255.0) - 0.18).abs() < 0.002);
        for linear in [0.0, 0.002, 0.003_130_8, 0.2, 1.0] {
            assert!((decode(encode(linear)) - linear).abs() < 1e-8);
        }
        // Both branches meet, to the precision of the standard's constants.
        assert!((decode(0.04045) - decode(0.040_450_001)).abs() < 1e-7);
    }

    #[test]
    fn table_follows_the_curve() {
        let table = decode_table();
        assert_eq!(table[0], 0.0);
        assert_eq!(table[255], 1.0);
        assert!(table.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
