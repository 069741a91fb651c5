use super::*;

#[test]
fn the_field_has_its_variance_and_its_correlation() {
    let grid = Grid { corner: DVec2::new(-3.0, 1.0), spacing: 0.5, count: [9, 9] };
    let correlation = 2.0;
    let draws = 2000;
    let fields: Vec<Vec<f64>> = (0..draws)
        .map(|k| grid.random_field(correlation, &Deviates::new([1, 0, k]), Half::Upper))
        .collect();
    let mean = |a: usize, b: usize| {
        fields.iter().map(|field| field[a] * field[b]).sum::<f64>() / fields.len() as f64
    };
    // Within five standard errors of a covariance, at most sqrt(2/N).
    let error = 5.0 * (2.0 / draws as f64).sqrt();
    for (a, b) in [(0, 0), (40, 40), (0, 4), (0, 36), (10, 50), (0, 80)] {
        let distance = grid.place(a).distance(grid.place(b));
        let expected = (-0.5 * (distance / correlation).powi(2)).exp();
        let found = mean(a, b);
        assert!((found - expected).abs() < error, "{distance}: {found} {expected}");
    }
}

#[test]
fn what_is_much_wider_than_the_device_smooths_to_the_mean() {
    let grid = Grid { corner: DVec2::ZERO, spacing: 1.0, count: [3, 4] };
    for width in [1e9, 1e300] {
        let mut values: Vec<DVec2> = (0..12).map(|k| DVec2::new(f64::from(k), 1.0)).collect();
        grid.smooth(&mut values, width);
        assert!(values.iter().all(|value| *value == DVec2::new(66.0, 12.0)), "{values:?}");
    }
}

#[test]
fn the_field_is_one_of_places_not_of_grids() {
    let deviates = Deviates::new([4, 2, 0]);
    let coarse = Grid { corner: DVec2::new(-1.0, 0.0), spacing: 0.5, count: [5, 5] };
    let fine = Grid { corner: DVec2::new(-1.0, 0.0), spacing: 0.25, count: [9, 9] };
    let [coarse, fine] = [coarse, fine].map(|grid| grid.random_field(1.0, &deviates, Half::Upper));
    for (k, value) in coarse.iter().enumerate() {
        let same = fine[(k / 5) * 2 * 9 + (k % 5) * 2];
        assert!((value - same).abs() < 1e-12, "{value} {same}");
    }
    // In the lower half the plane goes on: the mirror image of y is -y.
    let grid = |y: f64| Grid { corner: DVec2::new(0.0, y), spacing: 1.0, count: [4, 1] };
    let [upper, lower] = [
        grid(-2.0).random_field(1.0, &deviates, Half::Upper),
        grid(2.0).random_field(1.0, &deviates, Half::Lower),
    ];
    assert_eq!(upper, lower);
}
