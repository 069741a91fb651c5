use super::*;

#[test]
fn deviates_are_normal_and_independent() {
    let deviates = Deviates::new([7, 0, 3]);
    let other = Deviates::new([7, 0, 4]);
    let count = 100_000_u32;
    let mean = |value: &dyn Fn(u64) -> f64| {
        (0..u64::from(count)).map(value).sum::<f64>() / f64::from(count)
    };
    // Each within five of its own standard errors.
    let error = f64::from(count).sqrt().recip();
    assert!(mean(&|k| deviates.normal(k)).abs() < 5.0 * error);
    assert!((mean(&|k| deviates.normal(k).powi(2)) - 1.0).abs() < 5.0 * 2f64.sqrt() * error);
    assert!((mean(&|k| deviates.normal(k).powi(4)) - 3.0).abs() < 5.0 * 96f64.sqrt() * error);
    assert!(mean(&|k| deviates.normal(k) * deviates.normal(k + 1)).abs() < 5.0 * error);
    assert!(mean(&|k| deviates.normal(k) * other.normal(k)).abs() < 5.0 * error);
    assert!((mean(&|k| deviates.uniform(k)) - 0.5).abs() < 5.0 * error / 12f64.sqrt());
    assert_eq!(deviates.normal(5), Deviates::new([7, 0, 3]).normal(5));
}
