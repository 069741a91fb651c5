//! On the optic axes of biaxial media: one wave vector, a cone of rays.

use crate::long::count;
use crate::random_media::Random;
use glam::{DMat3, DVec3};
use optics::interface::{IncidentWave, OutgoingWaves, Side, split};
use optics::medium::Medium;
use optics::wave::ComplexVector;

/// A biaxial crystal in any pose with one of its optic axes.
struct Crystal {
    medium: Medium,
    /// The wave vector along the axis.
    wave_vector: DVec3,
    /// The unit vector of the axis.
    axis: DVec3,
    /// Rays along `axis` + u lie on the circle through 0 whose diameter ends here.
    diameter: DVec3,
}

impl Crystal {
    fn random(random: &mut Random) -> Self {
        let mut indices = [0; 3].map(|_| random.between(1.3, 2.2));
        indices.sort_by(f64::total_cmp);
        let [a, b, c] = indices.map(|index| 1.0 / (index * index));
        let x = random.direction();
        let y = x.cross(random.direction()).normalize();
        let axes = DMat3::from_cols(x, y, x.cross(y));
        let values = DMat3::from_diagonal(DVec3::from_array(indices.map(|index| index * index)));
        let permittivity = axes * values * axes.transpose();
        let permittivity = (permittivity + permittivity.transpose()) * 0.5;
        // tan² of its angle with the axis of the largest index: Born & Wolf, Principles of Optics,
        // 15.3.
        let (sin, cos) = ((a - b) / (b - c)).sqrt().atan().sin_cos();
        let axis = axes * DVec3::new(sin, 0.0, cos);
        // E of the wave with D in the plane of the axes; the ray is across it. That of the other
        // wave runs along the axis.
        let ray = axes * DVec3::new(sin * c, 0.0, cos * a);
        Self {
            medium: Medium::new(permittivity, 1.0).expect("a crystal"),
            wave_vector: axis * indices[1],
            axis,
            diameter: ray / ray.dot(axis) - axis,
        }
    }
}

/// Light of two polarizations in glass, whose wave vector along a surface is given.
fn in_glass(index: f64, tangential: DVec3, normal: DVec3, random: &mut Random) -> IncidentWave<2> {
    let wave_vector =
        tangential + normal * (index * index - tangential.length_squared()).max(0.0).sqrt();
    let direction = wave_vector / index;
    let (s, p) = direction.any_orthonormal_pair();
    let (sin, cos) = random.between(0.0, 6.0).sin_cos();
    let electric = [s * cos + p * sin, p * cos - s * sin];
    IncidentWave {
        wave_vector,
        attenuation: DVec3::ZERO,
        direction,
        electric: electric.map(|field| ComplexVector::from(field * index.sqrt().recip())),
        power: [1.0; 2],
    }
}

fn reflected(waves: &OutgoingWaves<2>) -> [f64; 2] {
    let back = waves.iter().filter(|wave| wave.side == Side::Reflected);
    back.fold([0.0; 2], |sum, wave| [0, 1].map(|i| sum[i] + wave.power[i]))
}

#[test]
fn light_on_an_optic_axis_goes_into_the_cone() {
    let mut random = Random(17);
    let mut seen = 0;
    for number in 0..count(300, 20_000) {
        let crystal = Crystal::random(&mut random);
        let mut normal = random.direction();
        // Light that comes straight, now and then.
        if number % 4 == 0 {
            normal = crystal.axis;
        }
        let normal = if normal.dot(crystal.axis) < 0.0 { -normal } else { normal };
        let tangential = crystal.wave_vector.reject_from_normalized(normal);
        let index = 2.3;
        // Not where a ray of the cone runs along the surface.
        let radius = 0.5 * crystal.diameter.length();
        if (crystal.axis + 0.5 * crystal.diameter).dot(normal) - radius < 0.3 {
            continue;
        }
        let glass = Medium::dielectric(index);
        let light = in_glass(index, tangential, normal, &mut random);
        let waves = split(&glass, &crystal.medium, &light, normal);
        let onward: Vec<_> = waves.iter().filter(|wave| wave.side == Side::Transmitted).collect();
        assert_eq!(onward.len(), 2, "{:?} {normal}", crystal.medium);
        let offsets: Vec<DVec3> = (onward.iter())
            .map(|wave| {
                assert!(wave.wave_vector.distance(crystal.wave_vector) < 1e-9);
                wave.direction / wave.direction.dot(crystal.axis) - crystal.axis
            })
            .collect();
        for offset in &offsets {
            let off = offset.distance(0.5 * crystal.diameter);
            assert!((off - radius).abs() < 1e-7, "{off} {radius} {:?}", crystal.medium);
        }
        // Straight on they are opposite on the cone, as D of one is across that of the other.
        if number % 4 == 0 {
            assert!((offsets[0] + offsets[1]).distance(crystal.diameter) < 1e-7);
        }
        for polarization in [0, 1] {
            let total: f64 = waves.iter().map(|wave| wave.power[polarization]).sum();
            assert!((total - 1.0).abs() < 1e-12, "{total}");
        }
        // What comes back is as from a direction beside it, where there are two waves in any case.
        let beside = normal.cross(random.direction()).normalize() * 1e-7;
        let near = IncidentWave {
            wave_vector: in_glass(index, tangential + beside, normal, &mut random).wave_vector,
            ..light
        };
        let near = reflected(&split(&glass, &crystal.medium, &near, normal));
        let here = reflected(&waves);
        let alike = (0..2).all(|i| (near[i] - here[i]).abs() < 1e-5);
        // Near a critical angle it grows fast.
        assert!(alike || here[0].max(here[1]) > 0.3, "{near:?} {here:?}");
        // Each ray comes out again along the light that came, whole.
        for wave in onward {
            let inside = IncidentWave {
                wave_vector: wave.wave_vector,
                attenuation: wave.attenuation,
                direction: wave.direction,
                electric: wave.electric,
                power: wave.power,
            };
            let out = split(&crystal.medium, &glass, &inside, normal);
            for polarization in [0, 1] {
                let total: f64 = out.iter().map(|wave| wave.power[polarization]).sum();
                assert!((total - wave.power[polarization]).abs() < 1e-12);
            }
            let through = out.iter().filter(|wave| wave.side == Side::Transmitted);
            assert!(through.clone().all(|out| out.direction.distance(light.direction) < 1e-9));
            let share: f64 = through.map(|out| out.power[0]).sum();
            assert!(number % 4 > 0 || share > 0.9 * wave.power[0]);
        }
        seen += 1;
    }
    assert!(seen > count(100, 10_000), "{seen}");
}
