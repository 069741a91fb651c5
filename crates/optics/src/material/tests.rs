use super::*;
use num_complex::Complex64;
use std::borrow::Cow;

fn refraction(name: &str, um: f64) -> [Refraction; 2] {
    let material = Material::named(name).expect(name);
    let ordinary = material.ordinary.at(um).expect("in range");
    let extraordinary = material.extraordinary.map(|law| law.at(um).expect("in range"));
    [ordinary, extraordinary.unwrap_or(ordinary)]
}

/// Published values: n and n_g, ordinary and extraordinary, at a wavelength in µm.
#[test]
fn indices_are_the_published_ones() {
    for (name, um, n, n_g) in [
        ("calcite", 0.590, [1.65830, 1.48611], Some([1.69794, 1.50448])),
        ("calcite", 0.488, [1.66742, 1.49039], None),
        ("calcite", 0.650, [1.65477, 1.48449], None),
        ("bk7", 0.5893, [1.51673; 2], None),
        ("sapphire", 0.5893, [1.76808, 1.76000], None),
        // Data sheets: n_d of N-SF11; crystals and liquids of handbooks.
        ("sf11", 0.5875618, [1.78472; 2], None),
        ("fused-silica", 0.5875618, [1.45846; 2], None),
        ("quartz", 0.5893, [1.54427, 1.55338], None),
        ("water", 0.5893, [1.33336; 2], None),
    ] {
        let found = refraction(name, um);
        for (i, found) in found.into_iter().enumerate() {
            assert!((found.index.re - n[i]).abs() < 1e-4, "{name} {um}: {found:?}");
            let published = n_g.is_none_or(|n_g| (found.group_index.re - n_g[i]).abs() < 6e-6);
            assert!(published, "{name} {um}: {found:?}");
        }
    }
    // One centimetre of calcite parts o and e by 6.453 ps as pulses, by 5.744 ps in phase.
    let [o, e] = refraction("calcite", 0.590);
    let split = |part: fn(&Refraction) -> f64| (part(&o) - part(&e)) / 0.029_979_245_8;
    assert!((split(|r| r.group_index.re) - 6.453).abs() < 1e-3);
    assert!((split(|r| r.index.re) - 5.744).abs() < 1e-3);
}

#[test]
fn group_indices_are_those_of_differences() {
    let check = |law: &IndexLaw, name: &str| {
        let [least, most] = law.range_um;
        for step in 1..40 {
            let um = least + (most - least) * (f64::from(step) + 0.31) / 41.0;
            let h = 1e-5 * um;
            let (Ok(here), Ok(below), Ok(above)) = (law.at(um), law.at(um - h), law.at(um + h))
            else {
                continue;
            };
            let slope = (above.index - below.index) / (2.0 * h);
            let expected = here.index - um * slope;
            let off = (here.group_index - expected).norm();
            assert!(off < 1e-6 * here.group_index.norm(), "{name} {um}: {off}");
        }
    };
    for name in Material::NAMES {
        let material = Material::named(name).expect(name);
        // Measured indices have kinks.
        if !matches!(material.ordinary.dispersion, Dispersion::Table(_)) {
            check(&material.ordinary, name);
        }
        material.extraordinary.iter().for_each(|law| check(law, name));
    }
    let formulas: [(u8, &[f64]); 9] = [
        (1, &[0.1, 1.0, 0.1, 0.3, 9.0]),
        (2, &[0.1, 1.0, 0.01, 0.3, 90.0]),
        (3, &[2.2, 0.01, -2.0, -0.003, 2.0]),
        (4, &[2.0, 0.4, 0.0, 0.08, 1.0, 0.1, 2.0, 11.0, 2.0, 0.001, 2.0]),
        (5, &[1.5, 0.004, -2.0, 1e-4, -4.0]),
        (6, &[0.0, 0.058, 238.0, 0.0017, 57.4]),
        (7, &[1.6, 0.01, 0.001, -1e-4, 1e-6, -1e-8]),
        (8, &[0.3, 0.1, 0.02, -0.001]),
        (9, &[2.2, 0.01, 0.02, 0.1, 1.1, 0.4]),
    ];
    for (number, coefficients) in formulas {
        let dispersion = Dispersion::Formula { number, coefficients: Cow::Borrowed(coefficients) };
        let law = IndexLaw { dispersion, extinction: None, range_um: [0.3, 2.0] };
        assert!(law.at(1.0).is_ok(), "{number}");
        check(&law, &format!("formula {number}"));
    }
    let dispersion = Dispersion::Resonances {
        permittivity_infinity: 1.2,
        plasma_ev: [3.0, 0.1],
        lorentz: vec![[0.7, 4.5, 0.3], [0.1, 2.5, 0.05]],
    };
    check(&IndexLaw { dispersion, extinction: None, range_um: [0.3, 2.0] }, "resonances");
}

/// Without losses a law is causal: d(ωε)/dω is ε at least, and 2 - ε.
#[test]
fn resonances_are_causal() {
    let dispersion = Dispersion::Resonances {
        permittivity_infinity: 1.0,
        plasma_ev: [1.3, 0.0],
        lorentz: vec![[0.9, 5.0, 0.0], [0.3, 0.2, 0.0]],
    };
    let law = IndexLaw { dispersion, extinction: None, range_um: [0.3, 3.0] };
    for step in 0..50 {
        let found = law.at(0.3 + 0.05 * f64::from(step)).expect("an index");
        let (e, derivative) = (found.permittivity(), found.dispersive_permittivity());
        assert!(derivative.im.abs() < 1e-12 * derivative.re);
        let least = e.re.max(2.0 - e.re);
        assert!(derivative.re >= least * (1.0 - 1e-12), "{step}: {e} {derivative}");
    }
}

#[test]
fn measured_indices_are_joined_by_lines() {
    let silver = Material::named("silver").expect("silver").ordinary;
    let at = |um: f64| silver.at(um).expect("in range").index;
    assert_eq!(at(0.5486), Complex64::new(0.06, 3.586));
    let between = at(0.5 * (0.5486 + 0.5821));
    assert!((between - Complex64::new(0.055, 3.722)).norm() < 1e-12);
    assert_eq!(at(1.937), Complex64::new(0.24, 14.08));
    let message = silver.at(3.0).expect_err("out of range").to_string();
    assert_eq!(message, "its law holds from 187.9 to 1937 nm, and the wavelength is 3000 nm");
}

#[test]
fn what_no_medium_has_is_told_with_its_numbers() {
    let table = |values: &[f64]| Table {
        wavelengths_um: vec![0.5, 1.0].into(),
        values: values.to_vec().into(),
    };
    let law = IndexLaw {
        range_um: [0.5, 1.0],
        dispersion: Dispersion::Table(table(&[1.5, 1.5])),
        extinction: Some(table(&[0.5, -1.0])),
    };
    assert_eq!(law.at(0.625).expect("a medium").index.im, 0.125);
    let error = law.at(0.75).expect_err("no medium").to_string();
    assert!(error.contains("n = 1.5, k = -0.25") && error.contains("750 nm"), "{error}");
}
