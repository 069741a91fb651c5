use super::*;
use optics::geometry::Plane;

#[test]
fn on_the_border_the_direction_decides() {
    let shapes = [
        Convex::Box { half: DVec3::new(1.0, f64::INFINITY, 3.0) },
        Convex::Ball(Sphere { radius: 1.0 }),
        Convex::Cylinder(Cylinder { radius: 1.0, extent: Extent::centred(Some(6.0)) }),
        Convex::CutBall(CutBall {
            sphere: Sphere { radius: 2.0 },
            plane: Plane { normal: DVec3::X, offset: 1.0 },
        }),
    ];
    for shape in shapes {
        for off in [-1e-12, 0.0, 1e-12] {
            let point = DVec3::X * (1.0 + off);
            assert!(shape.holds_ahead(point, DVec3::new(-0.8, 0.6, 0.0), 1e-9), "{shape:?}");
            assert!(!shape.holds_ahead(point, DVec3::new(0.8, 0.6, 0.0), 1e-9), "{shape:?}");
        }
        assert!(shape.holds_ahead(DVec3::X * 0.99, DVec3::X, 1e-9));
        assert!(!shape.holds_ahead(DVec3::X * 1.01, DVec3::NEG_X, 1e-9));
    }
}
