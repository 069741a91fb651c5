//! A plain, slow tracer of the square cloak's ray tree that shares no code with the program's.
//!
//! It works in the world's frame with crossed lines, the cloak's tensors from its map and
//! [`waves::scatter`] at every surface. The cloak is convex: light that is in air again is a leaf.

pub mod cloak;
pub mod waves;

use cloak::{Cloak, FarSide};
use glam::{DVec2, DVec3};
use waves::{AIR, Fields, Outgoing, in_air, poynting, scatter};

/// A branch that has left the cloak.
#[derive(Clone, Debug)]
pub struct PlainLeaf<const N: usize> {
    pub position: DVec3,
    pub direction: DVec3,
    pub optical_path: f64,
    /// How often it was reflected.
    pub reflections: usize,
    /// E and H, of which |Re(E × H*)| is the power.
    pub fields: [Fields; N],
}

impl<const N: usize> PlainLeaf<N> {
    pub fn power(&self) -> [f64; N] {
        powers(&self.fields)
    }
}

#[derive(Debug)]
pub struct PlainTree<const N: usize> {
    pub leaves: Vec<PlainLeaf<N>>,
    pub pruned: [f64; N],
    /// How many surfaces were met.
    pub events: usize,
}

/// A side of a triangle, or the end of the cloak.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Surface {
    Side(usize, usize),
    End,
}

/// A branch inside a triangle, at a surface of it.
struct Branch<const N: usize> {
    triangle: usize,
    last: Surface,
    position: DVec3,
    wave_vector: DVec3,
    fields: [Fields; N],
    optical_path: f64,
    reflections: usize,
}

fn powers<const N: usize>(fields: &[Fields; N]) -> [f64; N] {
    fields.map(|f| poynting(&f).length())
}

fn largest<const N: usize>(powers: &[f64; N]) -> f64 {
    powers.iter().copied().fold(0.0, f64::max)
}

/// The direction of the strongest polarization's power: all run the same way.
fn ray<const N: usize>(fields: &[Fields; N]) -> DVec3 {
    let rays = fields.iter().map(poynting);
    rays.max_by(|a, b| a.length().total_cmp(&b.length())).expect("a field").normalize()
}

impl Cloak {
    /// Where the line o + s d crosses a side: s, if it does for s > 0.
    fn crossing(&self, triangle: usize, side: usize, o: DVec3, d: DVec3) -> Option<f64> {
        let corners = self.triangles[triangle].corners;
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        let (o, d, line) = (o.truncate(), d.truncate(), b - a);
        // o + s d = a + u line, by Cramer's rule.
        let determinant = d.x * -line.y + line.x * d.y;
        let right = a - o;
        let s = (right.x * -line.y + line.x * right.y) / determinant;
        let u = (d.x * right.y - right.x * d.y) / determinant;
        ((0.0..=1.0).contains(&u) && s > 0.0).then_some(s)
    }

    /// The normal of a surface on the side to which `along` points.
    fn normal(&self, surface: Surface, along: DVec3) -> DVec3 {
        let n = match surface {
            Surface::Side(triangle, side) => {
                let corners = self.triangles[triangle].corners;
                (corners[(side + 1) % 3] - corners[side]).perp().normalize().extend(0.0)
            }
            Surface::End => DVec3::Z,
        };
        n * n.dot(along).signum()
    }

    fn triangle_at(&self, point: DVec2) -> Option<usize> {
        self.triangles.iter().position(|triangle| {
            let side = |i: usize| {
                let (a, b) = (triangle.corners[i], triangle.corners[(i + 1) % 3]);
                (b - a).perp_dot(point - a) > 0.0
            };
            side(0) == side(1) && side(1) == side(2)
        })
    }

    /// The first surface that a ray in air meets: how far, which, and what lies behind.
    fn first_met(&self, o: DVec3, d: DVec3) -> Option<(f64, Surface, FarSide)> {
        let mut met = Vec::new();
        for (i, triangle) in self.triangles.iter().enumerate() {
            for side in 0..3 {
                if triangle.beyond[side] == FarSide::Air
                    && let Some(s) = self.crossing(i, side, o, d)
                    && (o.z + s * d.z).abs() < self.half_length
                {
                    met.push((s, Surface::Side(i, side), FarSide::Triangle(i)));
                }
            }
        }
        let to_end = (-self.half_length * d.z.signum() - o.z) / d.z;
        if to_end > 0.0 && to_end.is_finite() {
            let at = (o + d * to_end).truncate();
            match self.triangle_at(at) {
                Some(triangle) => met.push((to_end, Surface::End, FarSide::Triangle(triangle))),
                None if self.metal_at(at) => met.push((to_end, Surface::End, FarSide::Metal)),
                None => {}
            }
        }
        met.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Whether a point lies between the metal sides of the triangles.
    fn metal_at(&self, point: DVec2) -> bool {
        self.triangles.iter().all(|triangle| {
            triangle.beyond.iter().enumerate().all(|(i, beyond)| {
                let (a, b) = (triangle.corners[i], triangle.corners[(i + 1) % 3]);
                let centre_side = (b - a).perp_dot(-a).signum();
                *beyond != FarSide::Metal || (b - a).perp_dot(point - a) * centre_side > 0.0
            })
        })
    }

    /// Follows a ray from air with `N` electric fields to the end of every branch that has at least
    /// `min_power` in some polarization.
    pub fn trace<const N: usize>(
        &self,
        origin: DVec3,
        direction: DVec3,
        electric: [[num_complex::Complex64; 3]; N],
        min_power: f64,
    ) -> PlainTree<N> {
        let fields = electric.map(|e| in_air(direction, e));
        let mut tree = PlainTree { leaves: Vec::new(), pruned: [0.0; N], events: 0 };
        let Some((s, surface, beyond)) = self.first_met(origin, direction) else {
            let leaf = PlainLeaf {
                position: origin,
                direction,
                optical_path: 0.0,
                reflections: 0,
                fields,
            };
            tree.leaves.push(leaf);
            return tree;
        };
        let mut waiting = Vec::new();
        let mut walk = GrowingTree { tree: &mut tree, waiting: &mut waiting, min_power };
        let position = origin + direction * s;
        let n = self.normal(surface, direction);
        let into = match beyond {
            FarSide::Triangle(index) => Some(index),
            _ => None,
        };
        let material = into.map(|index| &self.triangles[index].material);
        for out in scatter(&AIR, material, direction, &fields, n) {
            let place = if out.reflected { None } else { into };
            walk.go_on((place, surface), position, (s, 0), (direction, n), out);
        }
        while let Some(branch) = waiting.pop() {
            let mut walk = GrowingTree { tree: &mut tree, waiting: &mut waiting, min_power };
            self.step(branch, &mut walk);
        }
        tree
    }

    /// From one surface of a triangle to the next.
    fn step<const N: usize>(&self, branch: Branch<N>, walk: &mut GrowingTree<N>) {
        let d = ray(&branch.fields);
        let triangle = &self.triangles[branch.triangle];
        let sides = (0..3).map(|side| Surface::Side(branch.triangle, side));
        let ahead = sides.filter(|side| *side != branch.last).filter_map(|surface| {
            let Surface::Side(index, side) = surface else { return None };
            let s = self.crossing(index, side, branch.position, d)?;
            Some((s, surface, triangle.beyond[side]))
        });
        let to_end = (self.half_length * d.z.signum() - branch.position.z) / d.z;
        let end = (to_end.is_finite()).then_some((to_end, Surface::End, FarSide::Air));
        let Some((s, surface, beyond)) = ahead.chain(end).min_by(|a, b| a.0.total_cmp(&b.0)) else {
            panic!("a ray lost at a corner");
        };
        let step = d * s;
        let position = branch.position + step;
        let optical_path = branch.optical_path + branch.wave_vector.dot(step);
        let n = self.normal(surface, d);
        let (onward, place, next) = match beyond {
            FarSide::Air => (Some(&AIR), None, surface),
            FarSide::Metal => (None, None, surface),
            FarSide::Triangle(neighbour) => {
                let side = |side: &usize| {
                    self.triangles[neighbour].beyond[*side] == FarSide::Triangle(branch.triangle)
                };
                let shared = (0..3).find(side).expect("a common side");
                let other = &self.triangles[neighbour];
                (Some(&other.material), Some(neighbour), Surface::Side(neighbour, shared))
            }
        };
        for out in scatter(&triangle.material, onward, branch.wave_vector, &branch.fields, n) {
            let (place, last) =
                if out.reflected { (Some(branch.triangle), surface) } else { (place, next) };
            walk.go_on((place, last), position, (optical_path, branch.reflections), (d, n), out);
        }
    }
}

struct GrowingTree<'a, const N: usize> {
    tree: &'a mut PlainTree<N>,
    waiting: &'a mut Vec<Branch<N>>,
    min_power: f64,
}

impl<const N: usize> GrowingTree<'_, N> {
    /// Keeps an outgoing wave as a branch in a triangle, or as a leaf in air.
    fn go_on(
        &mut self,
        (place, last): (Option<usize>, Surface),
        position: DVec3,
        (optical_path, reflections): (f64, usize),
        (arrived, n): (DVec3, DVec3),
        out: Outgoing<N>,
    ) {
        self.tree.events += 1;
        if largest(&powers(&out.fields)) == 0.0 {
            return;
        }
        // Fields of a beam, whose width changes as it is reflected or refracted.
        let direction = ray(&out.fields);
        let narrowing = (direction.dot(n) / arrived.dot(n)).abs().sqrt();
        let fields = out.fields.map(|f| f.map(|component| component * narrowing));
        let power = powers(&fields);
        if largest(&power) < self.min_power {
            for (sum, power) in self.tree.pruned.iter_mut().zip(power) {
                *sum += power;
            }
            return;
        }
        let reflections = reflections + usize::from(out.reflected);
        match place {
            None => self.tree.leaves.push(PlainLeaf {
                position,
                direction,
                optical_path,
                reflections,
                fields,
            }),
            Some(triangle) => self.waiting.push(Branch {
                triangle,
                last,
                position,
                wave_vector: out.wave_vector,
                fields,
                optical_path,
                reflections,
            }),
        }
    }
}
