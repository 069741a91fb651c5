//! Whether a JPEG file is all there.
//!
//! Decoders paint what is missing of a cut-off JPEG gray and call it a success, so the end is
//! looked for before decoding.

/// True if the marker segments of a JPEG file run to an end-of-image marker.
///
/// Thumbnails inside metadata have end markers of their own; segments are therefore skipped as a
/// whole by their length.
pub(super) fn is_complete(bytes: &[u8]) -> bool {
    // Behind the start-of-image marker.
    let mut at = 2;
    loop {
        let Some(marker) = next_marker(bytes, &mut at) else { return false };
        match marker {
            END_OF_IMAGE => return true,
            // Restart markers and other markers without a length.
            0x01 | 0xD0..=0xD8 => {}
            _ => {
                let Some(&[high, low]) = bytes.get(at..at + 2) else { return false };
                // The data after a scan header holds no marker but stuffed zeros and restarts,
                // which `next_marker` steps over.
                at += usize::from(u16::from_be_bytes([high, low])).max(2);
            }
        }
    }
}

const END_OF_IMAGE: u8 = 0xD9;

/// Steps behind the next marker and returns its code.
fn next_marker(bytes: &[u8], at: &mut usize) -> Option<u8> {
    loop {
        let rest = bytes.get(*at..)?;
        *at += rest.iter().position(|&byte| byte == 0xFF)? + 1;
        match *bytes.get(*at)? {
            // A stuffed zero: data. 0xFF: padding, the code follows.
            0x00 => *at += 1,
            0xFF => {}
            code => {
                *at += 1;
                return Some(code);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_end_behind_segments_and_data() {
        let mut bytes = vec![0xFF, 0xD8];
        // A metadata segment that contains an end marker.
        bytes.extend([0xFF, 0xE1, 0x00, 0x06, 0xFF, 0xD9, 0x01, 0x02]);
        // A scan header, stuffed data, a restart marker.
        bytes.extend([0xFF, 0xDA, 0x00, 0x03, 0x00, 0x12, 0xFF, 0x00, 0x34, 0xFF, 0xD0, 0x56]);
        assert!(!is_complete(&bytes));
        bytes.extend([0xFF, 0xFF, 0xD9]);
        assert!(is_complete(&bytes));
        bytes.extend(b"trailing bytes");
        assert!(is_complete(&bytes));
    }

    #[test]
    fn every_cut_is_noticed() {
        let bytes = [0xFF, 0xD8, 0xFF, 0xDA, 0x00, 0x03, 0x00, 0x12, 0xFF, 0x00, 0xFF, 0xD9];
        for length in 0..bytes.len() {
            assert!(!is_complete(&bytes[..length]), "cut to {length} bytes");
        }
    }
}
