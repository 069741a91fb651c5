//! What the soak has found: devices and rays whose power was lost track of, or was no number.
#![allow(clippy::unwrap_used, reason = "a test may")]

use cloakroom::render::{self, PreparedScene};
use cloakroom::scene_file::{self, Loaded};
use cloakroom::trace::{Coherence, Launch, Limits, PathRecorder, PathSegment, TraceStats, Tracer};
use glam::DVec3;
use optics::wave::transverse_basis;
use robustness::Draws;
use std::path::Path;

fn scene(text: &str) -> Result<Loaded, String> {
    let text = format!("[[device]]\n{text}");
    scene_file::parse(&text, "soak", Path::new(""), &[]).map_err(|error| error.to_string())
}

/// Looks at the tree of a ray; what in it is rare.
fn sound(keys: &str, origin: DVec3, direction: DVec3, tolerance: f64) -> TraceStats {
    let loaded = scene(keys).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let tracer = Tracer::new(&assembly, Limits { min_power: 1e-4, tolerance });
    let mut tracer = robustness::timed(tracer, &assembly);
    let (leaves, outcome) = tracer.trace(&launched(origin, direction));
    assert!(robustness::examine(origin, leaves, outcome).is_ok(), "{keys}: {leaves:?} {outcome:?}");
    outcome.stats
}

fn launched(origin: DVec3, direction: DVec3) -> Launch<2> {
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

/// Devices so small that surfaces have no normals in double precision lost light.
#[test]
fn senseless_sizes_are_refused() {
    for (keys, key) in [
        ("kind = \"gaussian-carpet\"\nwidth = 1.0063648067091695e-306\n", "width"),
        ("kind = \"gaussian-carpet\"\nh = 1.1734110701446959e-236\n", "h"),
        ("kind = \"eaton-lens\"\nradius = 2e-201\n", "radius"),
        ("kind = \"square-cloak\"\nrotation = 1.7e308\n", "rotation"),
    ] {
        let message = scene(keys).unwrap_err();
        assert!(
            message.contains(&format!("{key} is ")) && message.contains("must be from"),
            "{message}"
        );
    }
}

/// In a corner of a hyperbolic medium a wave gets shorter at every face, until its fields were no
/// numbers.
#[test]
fn light_that_runs_into_a_corner_of_a_hyperbolic_medium_ends() {
    let prisms = "kind = \"prisms\"\nrotation = 0.30833858620102117\n\
        [[device.prism]]\ncorners = [[10.785691898779323, -7.645163415135461], [10.0, -2.083400603584786], \
        [7.208506828911087, -2.2994805842921853], [2.2205757401597053, -6.0], [6.0, -8.793901199562285], \
        [3.952491679608414, -13.0], [10.789049074511201, -11.628383425259797]]\n\
        permittivity = [[-13309.27594767034, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, 0.3932181403195679]]\n\
        [[device.prism]]\ncorners = [[7.0, 5.0], [5.0, 8.0], [2.800660136634953, 5.3614352432478265], \
        [-3.8679020308049123, 7.519743237573129], [-2.9044891109001147, 2.6893283514490163], \
        [4.0, -2.1921230391605127], [7.534515494848552, -2.0]]\npermeability = -1.8148269154005803\n";
    let origin = DVec3::new(-38.30529692037659, -22.446144844193572, 19.30201199522524);
    let direction = DVec3::new(0.862741895361695, 0.43807378577538286, -0.2525228310552024);
    let stats = sound(prisms, origin, direction, 1.95e-9);
    assert!(matches!(stats, TraceStats { endless: 1.., lost: 0 }), "{stats:?}");
}

/// A permeability of 2e-38 made fields that are no numbers.
#[test]
fn media_whose_fields_are_no_numbers_are_refused() {
    let prism = "kind = \"prisms\"\n[[device.prism]]\ncorners = [[3, -6], [0, 9], [-3, -6]]\npermeability = -2e-38\n";
    let refused = scene(prism).map(|loaded| render::assembly(&loaded.scene).map(|_| ()));
    let message = match refused {
        Err(message) => message,
        Ok(made) => made.unwrap_err().to_string(),
    };
    assert!(message.contains("permeability") && message.contains("1e-12 to 1e12"), "{message}");
}

/// A process whose smallest permittivity is 1e9 made rays in air that were off by 1e-5 of their
/// direction.
#[test]
fn media_too_dense_for_directions_in_air_are_refused() {
    let cloak = |minimum: f64| {
        let text = format!(
            "kind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\n[device.imperfection]\nminimum = {minimum:?}\n"
        );
        scene(&text)
            .map(|loaded| render::assembly(&loaded.scene).map(|_| ()).map_err(|e| e.to_string()))
    };
    assert_eq!(cloak(1e6), Ok(Ok(())));
    let message = cloak(1e9).unwrap_err();
    assert!(message.contains("minimum") && message.contains("-1000000 to 1000000"), "{message}");
}

/// Waves that are evanescent but for a loss of 4e-7 were followed along the surfaces that they decay
/// from, into corners where each reflection made more of them.
#[test]
fn evanescent_waves_in_media_that_hardly_absorb_are_no_rays() {
    let prisms = "kind = \"prisms\"\nrotation = 13\nposition = [1.5, -2, 0.5]\nlength = 18\n\
        [[device.prism]]\ncorners = [[-8, -6], [4, -6], [4, 0], [-2, 0], [-2, 7], [-8, 7]]\npermittivity = 1.44\n\
        [[device.prism]]\ncorners = [[4, -4], [9, -4], [9, -2], [4, -2]]\n\
        permittivity = [[1.3, 0.05, 0], [0.05, 1.4, 0], [0, 0, [1.2, 4e-7]]]\npermeability = [1.03, 1e-7]\n\
        [[device.prism]]\ncorners = [[-2, 0], [1, 0], [1, 5], [-2, 5]]\nmetal = true";
    let loaded = scene(prisms).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-9, tolerance: 1e-6 });
    let origin = DVec3::new(-41.40687795969556, 68.45049640163961, -6.760059984153486);
    let direction = DVec3::new(0.543574349903507, -0.826157068311472, 0.14829505927701575);
    let (leaves, outcome) = tracer.trace(&launched(origin, direction));
    outcome.assert_balanced(leaves, 1e-12, &"the corner");
    for leaf in leaves {
        // Along z nothing turns light but the ends, which it does not reach.
        let along = (leaf.direction.z.abs() - direction.z).abs();
        assert!(leaf.power.iter().all(|power| *power < 1.0) && along < 1e-6, "{leaf:?}");
    }
}

/// A box of a biaxial crystal keeps light for ever, in ever more branches: what is cut of them are
/// the weakest, and the account says how much.
#[test]
fn the_strongest_of_trapped_light_is_followed_first() {
    let crystal = "kind = \"body\"\nshape = \"box\"\nsize = [10, 10, 10]\nrotation = 20\n\
        permittivity = [[6.0, 0.8, 0.5], [0.8, 7.5, 0.4], [0.5, 0.4, 8.2]]";
    let loaded = scene(crystal).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let within = |min_power| Tracer::new(&assembly, Limits { min_power, tolerance: 1e-6 });
    let (mut strong, mut all) = (within(1e-3), within(1e-6));
    let mut cut = 0;
    for i in 0..40 {
        let origin = DVec3::new(-100.0, 0.0, 0.0);
        let aim = DVec3::new(0.0, 0.3 * f64::from(i) - 6.0, 1.0 + 0.05 * f64::from(i));
        let direction = (aim - origin).normalize();
        let launch = launched(origin, direction);
        let (leaves, outcome) = all.trace(&launch);
        outcome.assert_balanced(leaves, 1e-12, &i);
        cut += u32::from(outcome.stats.endless > 0);
        let (expected, outcome) = strong.trace(&launch);
        assert_eq!(outcome.stats, TraceStats::default());
        for leaf in expected {
            let found = leaves.iter().find(|found| found.path == leaf.path).unwrap();
            assert_eq!(found.power, leaf.power);
        }
    }
    assert!(cut > 2, "{cut} of these trees are large");
}

/// A graded medium can keep light for longer than it can be followed: that has no end, and is not
/// lost.
#[test]
fn light_that_a_graded_medium_keeps_has_no_end() {
    // With n² = 3 - 2.5 r², r in units of 20 cm, light goes round at r² = 0.6.
    let index = |i: u32, j: u32| {
        let [x, y] = [i, j].map(|k| f64::from(k) / 8.0 - 1.0);
        (3.0 - 2.5 * (x * x + y * y)).max(0.1).sqrt()
    };
    let rows: Vec<String> = (0..17)
        .map(|i| format!("{:?}", (0..17).map(|j| index(i, j)).collect::<Vec<_>>()))
        .collect();
    let keys = format!("kind = \"graded\"\nshape = \"circle\"\nindex = [{}]", rows.join(", "));
    let stats = sound(&keys, DVec3::new(20.0 * 0.6f64.sqrt(), 0.0, 0.0), DVec3::Y, 1e-6);
    assert_eq!((stats.endless, stats.lost), (1, 0));
}

/// Counts the ways from surface to surface; of light that never gets out, too, unless that is cut.
#[derive(Clone, Copy, Default)]
struct Count<const CUTS: bool>(usize);

impl<const N: usize, const CUTS: bool> PathRecorder<N> for Count<CUTS> {
    const CUTS_KEPT_LIGHT: bool = CUTS;

    fn record(&mut self, _segment: impl FnOnce() -> PathSegment<N>) {
        self.0 += 1;
    }
}

/// A ray that starts in an endless carpet and looks along it met 65,000 surfaces, each at the end of a way
/// that is followed step by step.
#[test]
fn light_that_is_trapped_where_ways_take_long_is_followed_along_fewer() {
    let along_a_carpet = "kind = \"grating-carpet\"\nperiod = 20\nfloor = 400\naxis = [0, 1, 0]\n\
        design_wavelength_nm = 550";
    let loaded = scene(along_a_carpet).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let tracer = Tracer::new(&assembly, Limits { min_power: 1e-4, tolerance: 1e-6 });
    let mut tracer = tracer.watched(Count::<false>::default());
    let origin = DVec3::new(-22.0, 68.0, -4.0);
    let mut most = 0;
    for i in 0..8 {
        let direction = (DVec3::Z * f64::from(i) - origin).normalize();
        let (leaves, outcome) = tracer.trace(&launched(origin, direction));
        outcome.assert_balanced(leaves, 1e-9, &i);
        most = most.max(std::mem::take(tracer.recorder()).0);
    }
    assert!((300..5_000).contains(&most), "{most}");
}

/// Light that is shorter along an endless device than any wave in air never gets out: where nobody asks for
/// its way it is not followed. All other light is.
#[test]
fn light_that_an_endless_device_keeps_is_cut_where_it_starts() {
    let mut draws = Draws::Seed(17);
    let (mut kept, mut others) = (0, 0);
    for device in [
        "kind = \"grating-carpet\"",
        "kind = \"gaussian-carpet\"",
        "kind = \"gaussian-carpet\"\nlength = 60",
        "kind = \"body\"\nshape = \"slab\"\nindex = 1.5",
        "kind = \"body\"\nshape = \"slab\"\nlength = 30\nindex = 1.5",
        "kind = \"body\"\nshape = \"cylinder\"\nradius = 8\nindex = 1.3",
        "kind = \"body\"\nshape = \"box\"\nsize = [20, 20, 1e6]\nindex = 1.5",
        "kind = \"body\"\nshape = \"slab\"\nthickness = 12\n\
         uniaxial = { ordinary = 1.5, extraordinary = 1.2, optic_axis = [1, 1, 0.3] }",
        "kind = \"cylinder-cloak\"\nmaterial = \"radial-uniaxial\"\ncore = \"open\"",
        "kind = \"square-cloak\"\nmaterial = \"positive-uniaxial\"",
        "kind = \"double-gaussian-cloak\"",
        "kind = \"graded\"\nwidth = 20\nheight = 20\nindex = [[1, 1, 1, 1], [1, 1.5, 1.5, 1], [1, 1.5, 1.5, 1], [1, 1, 1, 1]]",
    ] {
        let loaded = scene(&format!("{device}\nrotation = 20\naxis = [0.2, 0.1, 1]")).unwrap();
        let assembly = render::assembly(&loaded.scene).unwrap();
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-6 });
        let mut follower = tracer.clone().watched(Count::<false>::default());
        for _ in 0..40 {
            let origin = 6.0 * draws.share() * draws.direction();
            let ray = launched(origin, draws.direction());
            if !matches!(assembly.region_around(origin, ray.direction), Ok(Some(_))) {
                continue;
            }
            let (leaves, outcome) = tracer.trace(&ray);
            let (followed, of_followed) = follower.trace(&ray);
            assert_eq!(leaves, followed, "{device} {ray:?}");
            outcome.assert_balanced(leaves, 1e-9, &(device, ray));
            match outcome == of_followed {
                true => others += 1,
                false => kept += 1,
            }
        }
    }
    assert!(kept > 20 && others > 200, "{kept} {others}");
}

/// The same where the photograph comes close to what is endless, and cuts none of it: it stood in front of a
/// carpet, from whose bounds its plane was not far, and rays took a sixth of a second each.
#[test]
fn a_photograph_beside_an_endless_device_lets_it_keep_light() {
    let loaded = scene("kind = \"grating-carpet\"\nfloor = 400").unwrap();
    let prepared = PreparedScene::new(&loaded.scene).unwrap();
    let limits = Limits { min_power: 1e-3, tolerance: 1e-6 };
    let tracer = Tracer::new(&prepared.assembly, limits).with_screen(prepared.screen);
    let mut follower = tracer.clone().watched(Count::<false>::default());
    let mut tracer = tracer.watched(Count::<true>::default());
    let mut draws = Draws::Seed(3);
    let mut kept = 0;
    for _ in 0..60 {
        let [x, y, slope] =
            [(-5.0, 5.0), (5.0, 9.0), (-0.3, 0.3)].map(|(a, b)| draws.between(a, b));
        let ray = launched(DVec3::new(x, y, 80.0), DVec3::new(0.1, slope, -1.0).normalize());
        if !matches!(prepared.assembly.region_around(ray.origin, ray.direction), Ok(Some(_))) {
            continue;
        }
        let (leaves, outcome) = tracer.trace(&ray);
        let (followed, of_followed) = follower.trace(&ray);
        assert_eq!(leaves, followed, "{ray:?}");
        outcome.assert_balanced(leaves, 1e-9, &ray);
        assert_eq!(outcome, of_followed, "{ray:?}");
        let (ways, all) =
            (std::mem::take(tracer.recorder()).0, std::mem::take(follower.recorder()).0);
        kept += u32::from(ways == 0 && all > 500);
    }
    assert!(kept > 20, "{kept}");
}

/// The parts of an axis beside one of 1e164 were no zeros, but their squares were: light that ran in
/// the face of a hemisphere had no field across it.
#[test]
fn axes_have_no_parts_that_vanish_beside_the_others() {
    let hemisphere = "kind = \"fisheye-hemisphere\"\naxis = [1e164, 2.137734543543963, 1.0]\n";
    let origin = DVec3::new(-120.4735406782299, -5.944445621457249, 0.0);
    let direction = DVec3::new(0.9999687564699546, 0.007904813972037806, 0.0);
    assert_eq!(sound(hemisphere, origin, direction, 7e-6), TraceStats::default());
}

/// A ray that grazes the foot of a bump came to it by the small steps by which what a pulse takes was
/// found, and not by those of its way.
#[test]
fn what_a_pulse_takes_is_along_the_way_of_the_light() {
    let carpet = "kind = \"quasi-conformal-carpet\"\nfloor = 503.8954196273643\n\
        axis = [0.0, 638698.8130304975, 1.9259908616386807]\n";
    let origin = DVec3::new(-27.91436934363442, 2.228178051906128, 0.0);
    let direction = DVec3::new(0.9792352855033787, -0.2027270470981034, 0.0);
    assert_eq!(sound(carpet, origin, direction, 0.00010822768594988541), TraceStats::default());
}

/// Of two polarizations one may be caught in a film while the other has died, to 5e-324 of its power:
/// that was lost.
#[test]
fn polarizations_die_out_and_are_not_lost() {
    let lens = "kind = \"fisheye-lens\"\n\
        [[device.coating]]\nindex = 0.14140796372666956\nthickness_nm = 4976.360905284972\n\
        [[device.coating]]\npermittivity = 0.7659500560054262\nthickness_nm = 82.11196440280335\n";
    let origin = DVec3::new(11.97567927552844, -13.322946814317506, 0.0);
    let direction = DVec3::new(-0.7251096047204221, 0.6886334737305418, 0.0);
    assert_eq!(sound(lens, origin, direction, 1.4e-6), TraceStats::default());
}

/// In the corner of a cloak that absorbs, a wave that decays away from a side and carries power
/// towards it was reflected there without end, and grew.
#[test]
fn waves_that_carry_power_towards_the_side_they_leave_are_no_rays() {
    let cloak = "kind = \"square-cloak\"\n\
        [[device.coating]]\nindex = 2.596332782460377\nthickness_nm = 43.08152300341924\n\
        [device.imperfection]\nerror = 0.3490822655148804\nlevels = 0\n\
        loss_tangent = 0.064131916500628\nmaximum = 0.7031211703393523\nresolution = 1.0853888969868422\n";
    let origin = DVec3::new(-54.074179593271715, 106.8971008325951, -41.51944081438979);
    let direction = DVec3::new(0.49175400655702073, -0.8207917844771357, 0.290652444630966);
    assert_eq!(sound(cloak, origin, direction, 4.3e-7), TraceStats::default());
}

/// Light that grazes a face within 1e-7 had a field that carried its power to 4e-9.
#[test]
fn light_that_grazes_carries_its_power() {
    let cloak = "kind = \"square-cloak\"\ncore = \"open\"\naxis = [0.0, 1.14750184406617, 3.0165967103093863]\n";
    let origin = DVec3::new(45.442281519200115, -36.243348897323095, -95.27395840359677);
    let direction = DVec3::new(-0.4071701302923157, 0.32474621870642073, 0.853669947013259);
    assert_eq!(sound(cloak, origin, direction, 1.58e-9), TraceStats::default());
}

/// Of plates in one another and side by side, those through which the path is shortest were followed first: what they
/// added to fields that waited built up to 600,000 times the power that was sent in.
#[test]
fn fields_do_not_build_up_in_plates_of_strong_contrast() {
    let plates = [
        (0.0, 1e-3, 6.0, 0),
        (2.973_026_7e-5, 6.899_490_4e-4, 1.206_569_8, 1),
        (5.062_945e-4, 1.2589e-5, 1.2, 0),
    ];
    let plates = plates.map(|(middle, thickness, permittivity, priority)| {
        format!(
            "[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = {thickness:?}\nposition = [{middle:?}, 0, 0]\n\
             permittivity = {permittivity:?}\npriority = {priority}\n"
        )
    });
    let loaded = scene_file::parse(&plates.concat(), "soak", Path::new(""), &[]).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let light = Coherence::new(550.0, 0.0);
    let limits = Limits { min_power: 1e-24, tolerance: 1e-9 };
    let mut tracer = Tracer::new(&assembly, limits).joining(light);
    for tenth in 0..20 {
        let direction = DVec3::new(1.0, 0.1 * f64::from(tenth), 1.0).normalize();
        let (leaves, outcome) = tracer.trace(&launched(-5.0 * direction, direction));
        assert_eq!(outcome.stats.lost, 0);
        for i in 0..2 {
            let sum: f64 = light.gather(leaves).iter().map(|leaf| leaf.power[i]).sum();
            assert!((sum - 1.0).abs() < 1e-9, "{tenth} {i}: {sum}");
        }
    }
}
