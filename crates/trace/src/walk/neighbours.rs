//! An order of rays in which neighbours follow one another: four of them then go alike through the
//! same cells.

use super::Launch;

/// Directions count as places at this distance, cm, beside the places where rays start.
const DISTANCE: f64 = 100.0;

/// A ray's number, where its line comes closest to the world's origin, and where it goes.
type RayLine = (usize, [f64; 6]);

/// The numbers of the rays, neighbours side by side: their lines are divided in halves across the
/// widest spread, down to fours.
pub(super) fn side_by_side<const N: usize>(launches: &[Launch<N>]) -> Vec<usize> {
    let line = |(number, launch): (usize, &Launch<N>)| {
        let Launch { origin, direction, .. } = *launch;
        let place = origin - direction * origin.dot(direction);
        let goes = direction * DISTANCE;
        (number, [place.x, place.y, place.z, goes.x, goes.y, goes.z])
    };
    let mut lines: Vec<RayLine> = launches.iter().enumerate().map(line).collect();
    divide(&mut lines);
    lines.into_iter().map(|(number, _)| number).collect()
}

fn divide(lines: &mut [RayLine]) {
    if lines.len() <= 4 {
        return;
    }
    let spread = |axis: usize| {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = lines
            .iter()
            .fold(ends, |(low, high), (_, line)| (line[axis].min(low), line[axis].max(high)));
        high - low
    };
    let spreads: [f64; 6] = std::array::from_fn(spread);
    let wider = |widest: usize, axis| if spreads[axis] > spreads[widest] { axis } else { widest };
    let axis = (1..6).fold(0, wider);
    let half = (lines.len() / 2).next_multiple_of(4);
    lines.select_nth_unstable_by(half, |(_, one), (_, other)| one[axis].total_cmp(&other[axis]));
    let (low, high) = lines.split_at_mut(half);
    divide(low);
    divide(high);
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use optics::wave::ComplexVector;

    #[test]
    fn rays_of_a_shuffled_grid_find_their_neighbours() {
        // 64 rays on a square of 8 x 8, in an order that has nothing to do with it.
        let place = |number: usize| {
            let cell = number * 37 % 64;
            DVec3::new(-100.0, (cell % 8) as f64, (cell / 8) as f64)
        };
        let launch = |number: usize| Launch {
            origin: place(number),
            direction: DVec3::X,
            electric: [ComplexVector::default()],
        };
        let order = side_by_side::<1>(&(0..64).map(launch).collect::<Vec<_>>());
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..64).collect::<Vec<_>>());
        for four in order.chunks(4) {
            let middle = four.iter().map(|&number| place(number)).sum::<DVec3>() / 4.0;
            let off = four.iter().map(|&number| place(number).distance(middle));
            assert!(off.fold(0.0, f64::max) < 0.75, "{four:?}");
        }
    }
}
