//! A tree of bounding boxes over the solid shapes, so that a ray meets only
//! the few shapes near its path.

use crate::shapes::{Bounds, Ray, Shape};

/// How many shapes a leaf holds at most.
const LEAF: usize = 3;
/// Into how many bins a node's shapes are sorted when it is split.
const BINS: usize = 12;

/// One node: a leaf if `count > 0`, else an inner node whose first child
/// follows it and whose second child is at `first`.
#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    first: u32,
    count: u32,
    axis: u8,
}

/// The shapes, sorted into a tree.
#[derive(Debug)]
pub struct Hierarchy {
    shapes: Vec<Shape>,
    order: Vec<u32>,
    nodes: Vec<Node>,
}

impl Hierarchy {
    /// Sorts the shapes.
    pub fn new(shapes: Vec<Shape>) -> Self {
        let bounds: Vec<Bounds> = shapes.iter().map(Shape::bounds).collect();
        let mut tree =
            Self { order: (0..shapes.len() as u32).collect(), nodes: Vec::new(), shapes };
        let end = tree.order.len();
        tree.split(&bounds, 0, end);
        tree
    }

    /// Builds the node over `order[start..end]` and everything below it.
    fn split(&mut self, bounds: &[Bounds], start: usize, end: usize) {
        let of = |i: u32| bounds[i as usize];
        let middle = |i: u32| 0.5 * (of(i).low + of(i).high);
        let mut all = Bounds::EMPTY;
        let mut spread = Bounds::EMPTY;
        for &i in &self.order[start..end] {
            all = all.join(of(i));
            spread = spread.join(Bounds { low: middle(i), high: middle(i) });
        }
        let here = self.nodes.len();
        let count = (end - start) as u32;
        self.nodes.push(Node { bounds: all, first: start as u32, count, axis: 0 });
        if end - start <= LEAF {
            return;
        }
        let size = spread.high - spread.low;
        let axis = size.max_position();
        let bin = |i: u32| {
            let s = (middle(i)[axis] - spread.low[axis]) / size[axis].max(1e-9);
            ((s * BINS as f32) as usize).min(BINS - 1)
        };
        let mut filled = [(Bounds::EMPTY, 0_usize); BINS];
        for &i in &self.order[start..end] {
            let slot = &mut filled[bin(i)];
            *slot = (slot.0.join(of(i)), slot.1 + 1);
        }
        let cost = |part: &[(Bounds, usize)]| {
            let whole = part.iter().fold((Bounds::EMPTY, 0), |a, b| (a.0.join(b.0), a.1 + b.1));
            if whole.1 == 0 { f32::INFINITY } else { whole.0.area() * whole.1 as f32 }
        };
        let best = (1..BINS)
            .map(|cut| (cost(&filled[..cut]) + cost(&filled[cut..]), cut))
            .fold((f32::INFINITY, 0), |a, b| if b.0 < a.0 { b } else { a });
        let part = &mut self.order[start..end];
        let half = if best.1 == 0 {
            part.len() / 2
        } else {
            part.sort_by_key(|&i| (bin(i) >= best.1, i));
            part.iter().filter(|&&i| bin(i) < best.1).count()
        };
        self.split(bounds, start, start + half);
        let second = self.nodes.len() as u32;
        self.split(bounds, start + half, end);
        let node = &mut self.nodes[here];
        (node.first, node.count, node.axis) = (second, 0, axis as u8);
    }

    /// The shape first met within `reach`, and the distance to it. With
    /// `any`, whichever shape is found first, as a shadow needs no more.
    pub fn meet(&self, ray: &Ray, reach: f32, any: bool) -> Option<(f32, &Shape)> {
        let inverse = ray.direction.recip();
        let mut stack = [0_u32; 64];
        let mut top = 1;
        let mut nearest = reach;
        let mut met = None;
        while top > 0 {
            top -= 1;
            let here = stack[top];
            let node = &self.nodes[here as usize];
            let (near, far) = node.bounds.span(ray.origin, inverse);
            if near > far || far < 0.0 || near > nearest {
                continue;
            }
            if node.count == 0 {
                let forward = ray.direction[node.axis as usize] > 0.0;
                let (sooner, later) =
                    if forward { (here + 1, node.first) } else { (node.first, here + 1) };
                stack[top] = later;
                stack[top + 1] = sooner;
                top += 2;
                continue;
            }
            for &i in &self.order[node.first as usize..(node.first + node.count) as usize] {
                let shape = &self.shapes[i as usize];
                if let Some(t) = shape.enter(ray)
                    && t < nearest
                {
                    nearest = t;
                    met = Some((t, shape));
                    if any {
                        return met;
                    }
                }
            }
        }
        met
    }
}
