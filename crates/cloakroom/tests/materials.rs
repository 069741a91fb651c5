//! Words for media, materials and laws, against tensors that are typed, closed forms and published
//! numbers.

use crate::rays::{assembly, launch, refusal, spread, strongest};
use cloakroom::device::Region;
use cloakroom::trace::{Leaf, Limits, Tracer};
use glam::{DMat3, DVec3};
use optics::material::Material;
use optics::medium::Medium;

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-9 };

/// The medium of a body with these keys, and light of a wavelength.
fn medium(keys: &str, nm: f64) -> Medium {
    let scene = format!("[light]\nwavelength_nm = {nm}\n[[device]]\nkind = \"body\"\n{keys}\n");
    match &assembly(&scene).devices()[0].structure.regions[0] {
        Region::Homogeneous(region) => region.medium,
        _ => panic!("a body is homogeneous"),
    }
}

fn close(one: &Medium, other: &Medium) -> bool {
    let off = |a: &DMat3, b: &DMat3| {
        (*a - *b).to_cols_array().iter().fold(0.0_f64, |m, d| m.max(d.abs()))
    };
    off(one.permittivity(), other.permittivity()) < 1e-13
        && off(one.permeability(), other.permeability()) < 1e-13
}

#[test]
fn words_are_the_tensors_that_they_stand_for() {
    let calcite = Material::named("calcite").unwrap();
    let square = |law: &optics::material::IndexLaw, um: f64| law.at(um).unwrap().permittivity().re;
    for (n, nm) in [488.0, 590.0, 650.0].into_iter().enumerate() {
        let [e, o] = [calcite.extraordinary.as_ref().unwrap(), &calcite.ordinary]
            .map(|law| square(law, nm * 1e-3));
        let angle = spread(n as u32, 1) * 3.0;
        let axis = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let crystal = Medium::uniaxial_electric(1.0, o, e, axis).unwrap();
        let degrees = angle.to_degrees();
        for keys in [
            format!("material = \"calcite\"\noptic_axis = {degrees:?}"),
            format!("material = \"calcite\"\noptic_axis = {:?}", (axis * 3.0).to_array()),
            format!(
                "uniaxial = {{ ordinary = {:?}, extraordinary = {:?}, optic_axis = {degrees:?} }}",
                o.sqrt(),
                e.sqrt()
            ),
        ] {
            assert!(close(&medium(&keys, nm), &crystal), "{keys}");
        }
    }
    assert!(close(&medium("index = 1.5", 550.0), &Medium::isotropic(2.25, 1.0).unwrap()));
    // Of absorbing media, too.
    let metal = Medium::new(num_complex::Complex64::new(0.4, 2.5).powi(2), 1.0).unwrap();
    assert!(medium("index = [0.4, 2.5]", 550.0).absorbs());
    assert!(close(&medium("index = [0.4, 2.5]", 550.0), &metal));
    // The principal axes of a biaxial crystal, typed with few digits.
    let (sin, cos) = 0.6_f64.sin_cos();
    let keys = format!(
        "biaxial = {{ indices = [1.5, 1.6, 1.7], axes = [[{cos:.7}, {sin:.7}, 0], [{:.7}, {cos:.7}, 0], [0, 0, 1]] }}",
        -sin
    );
    let turn = DMat3::from_rotation_z(0.6);
    let squares = DMat3::from_diagonal(DVec3::new(2.25, 2.56, 2.89));
    let expected = turn * squares * turn.transpose();
    let found = medium(&keys, 550.0);
    assert!((*found.permittivity() - expected).abs_diff_eq(DMat3::ZERO, 1e-6));
    let invariant = |m: &DMat3| [m.determinant(), m.x_axis.x + m.y_axis.y + m.z_axis.z];
    let (one, other) = (invariant(found.permittivity()), invariant(&expected));
    assert!((one[0] - other[0]).abs() < 1e-12 && (one[1] - other[1]).abs() < 1e-13);
    // Laws of one's own.
    let um = 0.55_f64;
    let cauchy = 1.5 + 0.004 / (um * um) + 1e-4 / um.powi(4);
    let glass = medium("material = { cauchy = [1.5, 0.004, 1e-4] }", 550.0);
    assert!(close(&glass, &Medium::isotropic(cauchy * cauchy, 1.0).unwrap()));
    let sellmeier = 1.0 + 1.04 * um * um / (um * um - 0.006);
    let glass = medium("material = { sellmeier = [{ strength = 1.04, pole_um2 = 0.006 }] }", 550.0);
    assert!(close(&glass, &Medium::isotropic(sellmeier, 1.0).unwrap()));
    let energy = 1.239_841_984_332 / um;
    let plasma = 2.0 - (3.0 / energy) * (3.0 / energy) + 0.5 * 25.0 / (25.0 - energy * energy);
    let keys = "material = { drude = { plasma_ev = 3 }, lorentz = [{ strength = 0.5, resonance_ev = 5 }], \
                permittivity_infinity = 2 }";
    let found = medium(keys, 550.0).permittivity().x_axis.x;
    assert!((found - plasma).abs() < 1e-9, "{found} {plasma}");
}

fn leaf(scene: &str, origin: DVec3, direction: DVec3) -> Leaf<2> {
    let bench = assembly(scene);
    let mut tracer = Tracer::<2>::new(&bench, LIMITS).with_group_delays();
    strongest(tracer.trace(&launch(origin, direction)).0)
}

#[test]
fn pulses_take_what_the_law_of_their_material_says() {
    // A slab of 1 cm: light in y is ordinary where the axis is along z, light in z extraordinary.
    let scene = "[light]\nwavelength_nm = 590\n[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = 1\n\
                 material = \"calcite\"\n";
    let bench = assembly(scene);
    let mut tracer = Tracer::<2>::new(&bench, LIMITS).with_group_delays();
    let (leaves, _) = tracer.trace(&launch(DVec3::NEG_X * 5.0, DVec3::X));
    let through = |polarization: usize| {
        let power = |leaf: &&Leaf<2>| leaf.power[polarization];
        leaves.iter().max_by(|a, b| power(a).total_cmp(&power(b))).unwrap()
    };
    let paths = [0, 1].map(|i| (through(i).optical_path, through(i).group_path.unwrap()));
    // cm to ps.
    let split = |a: f64, b: f64| (a - b).abs() / 0.029_979_245_8;
    assert!((split(paths[0].0, paths[1].0) - 5.744).abs() < 5e-4, "{paths:?}");
    assert!((split(paths[0].1, paths[1].1) - 6.453).abs() < 5e-4, "{paths:?}");
    // Obliquely: against the derivative of the phase by the frequency at a fixed direction outside,
    // for which the phase from plane to plane, less what is transverse, is what changes.
    let direction = DVec3::new(1.0, 0.4, 0.3).normalize();
    for keys in ["material = \"bk7\"", "material = \"calcite\"\noptic_axis = [0.3, 0.5, 1]"] {
        let scene = |nm: f64| {
            format!(
                "[light]\nwavelength_nm = {nm:?}\n[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = 1\n{keys}\n"
            )
        };
        let at = |nm: f64| leaf(&scene(nm), DVec3::NEG_X * 5.0, direction);
        let here = at(550.0);
        // d(ωL)/dω along the planes of constant phase far away: L is the phase length to one such
        // plane, wherever the ray leaves the slab.
        let far = here.position + here.direction * 10.0;
        let length = |leaf: &Leaf<2>| leaf.optical_path + (far - leaf.position).dot(leaf.direction);
        let h = 0.01;
        let slope = (length(&at(550.0 + h)) - length(&at(550.0 - h))) / (2.0 * h);
        let expected = length(&here) - 550.0 * slope;
        let found = here.group_path.unwrap() + (far - here.position).dot(here.direction);
        assert!((found - expected).abs() < 1e-8, "{keys}: {found} {expected}");
    }
}

#[test]
fn a_prism_has_its_minimum_deviation_at_each_line() {
    // N-BK7 by its published law, F, d and C.
    let law = |um: f64| {
        let l = um * um;
        (1.0 + 1.03961212 * l / (l - 0.00600069867)
            + 0.231792344 * l / (l - 0.0200179144)
            + 1.01046945 * l / (l - 103.560653))
            .sqrt()
    };
    for (nm, published) in [(486.1327, 1.52238), (587.5618, 1.51680), (656.2725, 1.51432)] {
        let index = law(nm * 1e-3);
        assert!((index - published).abs() < 1e-5);
        let half = 30f64.to_radians();
        let expected = 2.0 * (index * half.sin()).asin() - 2.0 * half;
        // Symmetric: the ray within is parallel to the base.
        let height = 10.0 * half.cos();
        let scene = format!(
            "[light]\nwavelength_nm = {nm}\n[[device]]\nkind = \"prisms\"\n[[device.prism]]\n\
             corners = [[-5, 0], [5, 0], [0, {height:?}]]\nmaterial = \"bk7\"\n"
        );
        let incidence = (index * half.sin()).asin();
        // The normal of the left face points to the left and up.
        let normal = DVec3::new(-half.cos(), half.sin(), 0.0);
        let (sin, cos) = (-incidence).sin_cos();
        let direction =
            -DVec3::new(normal.x * cos - normal.y * sin, normal.x * sin + normal.y * cos, 0.0);
        let entry = DVec3::new(-2.5, 0.5 * height, 0.0);
        let found = leaf(&scene, entry - direction * 20.0, direction);
        let deviation = found.direction.angle_between(direction);
        assert!((deviation - expected).to_degrees().abs() < 1e-9, "{nm}: {deviation} {expected}");
    }
}

#[test]
fn designs_have_laws_through_what_they_are() {
    let scene = |keys: &str, nm: f64| {
        format!("[light]\nwavelength_nm = {nm}\n[[device]]\nkind = \"square-cloak\"\n{keys}\n")
    };
    let (origin, direction) = (DVec3::new(-60.0, 1.7, 0.5), DVec3::new(1.0, 0.003, 0.001));
    let causal = leaf(&scene("", 550.0), origin, direction);
    // At its wavelength a design is what it was, and Drude's law the least that causality allows.
    for law in ["drude", "lorentz"] {
        let found = leaf(&scene(&format!("dispersion = \"{law}\""), 550.0), origin, direction);
        assert_eq!((found.position, found.direction), (causal.position, causal.direction));
        let [found, least] = [found, causal].map(|leaf| leaf.group_path.unwrap());
        let more = found - least;
        assert!(if law == "drude" { more.abs() < 1e-9 } else { more > 1.0 }, "{law}: {more}");
    }
    // Pulses in the middle of (iii) are late by 43.5118 cm at least.
    let axis =
        leaf(&scene("dispersion = \"drude\"", 550.0), DVec3::new(-60.0, 1e-5, 0.0), DVec3::X);
    let late = axis.group_path.unwrap() - axis.optical_path;
    assert!((late - 43.5118).abs() < 1e-3, "{late}");
    // It is a cloak there alone; other laws leave it one at every wavelength.
    let off = |leaf: &Leaf<2>| leaf.direction.angle_between(direction.normalize()).to_degrees();
    assert!(off(&causal) < 1e-10);
    for (keys, nm, visible) in [
        ("", 450.0, false),
        ("dispersion = \"none\"", 650.0, false),
        ("dispersion = \"drude\"", 450.0, true),
        ("dispersion = \"drude\"", 650.0, true),
        ("dispersion = \"lorentz\"", 540.0, true),
        ("dispersion = \"drude\"\ndesign_wavelength_nm = 650", 650.0, false),
    ] {
        let found = leaf(&scene(keys, nm), origin, direction);
        assert_eq!(off(&found) > 0.1, visible, "{keys} {nm}: {} degrees", off(&found));
    }
}

#[test]
fn what_is_wrong_with_a_medium_is_told_at_its_place() {
    let body = |keys: &str| refusal(&format!("[[device]]\nkind = \"body\"\n{keys}\n"));
    for (keys, message) in [
        ("index = -1.3", "write permittivity and permeability"),
        ("index = 0", "not both 0"),
        ("index = [1.4, -0.1]", "n and k of n + ik must be 0 or above"),
        ("index = 1.5\npermittivity = 2.25", "the permittivity is the square of the index"),
        ("index = 1.5\nmaterial = \"bk7\"", "index and material are both given"),
        ("material = \"bk8\"", "did you mean `bk7`?"),
        ("material = \"bk7\"\noptic_axis = 30", "bk7 is isotropic; it has no optic axis"),
        ("index = 1.5\noptic_axis = 30", "optic_axis goes with a material"),
        ("optic_axis = 30", "which is not given"),
        ("material = \"nowhere.yml\"", "cannot read nowhere.yml"),
        ("material = {}", "needs one law"),
        ("material = \"bk7\"\ngroup_index = 1.7", "follows from its law"),
        ("material = { cauchy = [1.5, 0, 0], drude = { plasma_ev = 1 } }", "needs one law"),
        ("material = { cauchy = [1.5, 0, 0], permittivity_infinity = 2 }", "has no use for it"),
        ("material = { ordinary = \"bk7\" }", "no `extraordinary` material"),
        ("material = { ordinary = \"calcite\", extraordinary = \"bk7\" }", "is a crystal itself"),
        ("uniaxial = { ordinary = 1.5 }", "has no `extraordinary`"),
        (
            "uniaxial = { ordinary = 1.5, extraordinary = 1.6, optic_axis = [0, 0, 0] }",
            "must be a direction",
        ),
        ("biaxial = { axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }", "has no `indices`"),
        (
            "biaxial = { indices = [1, 2, 3], axes = [[1, 0, 0], [1, 1, 0], [0, 0, 1]] }",
            "45 degrees off",
        ),
        ("material = \"silver\"\nsurface = {}", "it has no material"),
        ("index = 1.5\nresonance_nm = 300", "is that of dispersion = \"lorentz\""),
        (
            "index = 1.5\ndispersion = \"lorentz\"\nresonance_nm = 600",
            "below the wavelength of the design",
        ),
    ] {
        let refused = body(keys);
        assert!(refused.contains(message), "{keys}: {refused}");
        assert!(refused.starts_with("test:"), "{keys}: {refused}");
    }
    let graded = "[[device]]\nkind = \"luneburg-lens\"\ndispersion = \"drude\"\n";
    assert!(refusal(graded).contains("the device is graded"), "{}", refusal(graded));
    let far = "[light]\nwavelength_nm = 5000\n[[device]]\nkind = \"body\"\nmaterial = \"bk7\"\n";
    assert!(refusal(far).contains("bk7: its law holds from 300 to 2500 nm"), "{}", refusal(far));
    let metal =
        "[[device]]\nkind = \"mirror-detour\"\nmetal = { index = [0.4, 2], material = \"gold\" }\n";
    assert!(refusal(metal).contains("a metal takes one of them"), "{}", refusal(metal));
}

#[test]
fn a_file_may_be_given_wherever_a_material_may() {
    let folder = tempfile::tempdir().expect("a folder");
    let table =
        "DATA:\n  - type: tabulated nk\n    data: |\n        0.3 1.2 1.8\n        0.9 0.3 5.6\n";
    std::fs::write(folder.path().join("metal.yml"), table).expect("written");
    let glass = "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 0.9\n    coefficients: 1.5 0.004 -2\n";
    std::fs::write(folder.path().join("glass.yml"), glass).expect("written");
    let (metal, glass) = ("metal = { material = \"metal.yml\" }", "material = \"glass.yml\"");
    let prism = "[[device.prism]]\ncorners = [[-9, -8], [9, -8], [0, 8]]\n";
    for device in [
        format!("kind = \"body\"\n{glass}"),
        format!("kind = \"body\"\n{metal}"),
        "kind = \"body\"\nmaterial = { ordinary = \"glass.yml\", extraordinary = \"metal.yml\" }"
            .to_owned(),
        format!("kind = \"body\"\nindex = 1.5\ncoating = [{{ {glass}, thickness_nm = 100 }}]"),
        format!("kind = \"lens\"\n{glass}"),
        format!("kind = \"mirror\"\n{metal}"),
        format!("kind = \"square-cloak\"\n{metal}"),
        format!("kind = \"mirror-detour\"\n{metal}"),
        format!("kind = \"double-gaussian-cloak\"\n{metal}"),
        format!("kind = \"prisms\"\n{prism}{glass}"),
        format!("kind = \"prisms\"\n{prism}{metal}"),
    ] {
        let text = format!("[[device]]\n{device}\n");
        let loaded = cloakroom::scene_file::parse(&text, "test", folder.path(), &[]);
        let scene = loaded.unwrap_or_else(|error| panic!("{device}: {error}")).scene;
        let prepared = cloakroom::render::PreparedScene::new(&scene);
        assert!(prepared.is_ok(), "{device}: {:?}", prepared.err());
    }
}
