//! The root of a monotone function.

/// The root of a monotone function between two abscissae, to rounding: Newton's method held in a
/// shrinking bracket, so that it cannot run away. `function` gives value and slope. Without a
/// change of sign, the end nearer to one.
pub(crate) fn root_between(a: f64, b: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (at_a, at_b) = (function(a).0, function(b).0);
    if at_a * at_b > 0.0 {
        return if at_a.abs() < at_b.abs() { a } else { b };
    }
    root_in_bracket((a, at_a), (b, at_b), function)
}

/// As [`root_between`], for known values of opposite sign (or zero) at the ends.
pub(crate) fn root_in_bracket(
    (mut a, at_a): (f64, f64),
    (mut b, at_b): (f64, f64),
    function: impl Fn(f64) -> (f64, f64),
) -> f64 {
    if at_a == 0.0 {
        return a;
    }
    if at_b == 0.0 {
        return b;
    }
    let mut x = (a * at_b - b * at_a) / (at_b - at_a);
    // The secant keeps x inside; rounding, infinities and NaN do not.
    if !(x > a.min(b) && x < a.max(b)) {
        x = 0.5 * (a + b);
    }
    let mut last_step = (b - a).abs();
    // Bisection alone would be done after about 60 rounds.
    for _ in 0..100 {
        let (value, slope) = function(x);
        if value == 0.0 {
            return x;
        }
        if (value > 0.0) == (at_a > 0.0) {
            a = x;
        } else {
            b = x;
        }
        let step = value / slope;
        let newton = x - step;
        let inside = newton > a.min(b) && newton < a.max(b);
        let next = if inside && step.abs() < 0.5 * last_step { newton } else { 0.5 * (a + b) };
        last_step = (next - x).abs();
        if last_step <= 2.0 * f64::EPSILON * next.abs() || next == a || next == b {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::root_between;

    #[test]
    fn finds_roots_that_mislead_newton() {
        let steep = |x: f64| ((x - 0.3).cbrt(), (x - 0.3).abs().powf(-2.0 / 3.0) / 3.0);
        assert!((root_between(-10.0, 3.0, steep) - 0.3).abs() < 1e-12);
        let flat = |x: f64| ((x - 0.3).powi(5), 5.0 * (x - 0.3).powi(4));
        assert!((root_between(3.0, -10.0, flat) - 0.3).abs() < 1e-3);
        assert!(
            (root_between(0.0, 1.0, |x| (x * x - 0.5, 2.0 * x)) - 0.5_f64.sqrt()).abs() < 1e-15
        );
    }

    #[test]
    fn answers_with_an_end_where_there_is_none() {
        assert_eq!(root_between(1.0, 2.0, |x| (x, 1.0)), 1.0);
        assert_eq!(root_between(-1.0, 0.0, |x| (x, 1.0)), 0.0);
    }
}
