//! A tree of boxes around triangles.
//!
//! Its boxes are of 64-bit numbers, as the rays are, and are widened for each ray by what rounding may
//! make of the ray: the tree hides no triangle that the exact test would find. Binned by the surface
//! area heuristic (Wald, IEEE Symposium on Interactive Ray Tracing 33 (2007)).

use glam::DVec3;

/// The triangles of a leaf at most.
const LEAF: usize = 4;

/// Classes of middles along an axis.
const BINS: usize = 16;

/// From this depth on halves are of equal numbers, so that no branch is deeper than the stack.
const DEEP: usize = 36;

/// The deepest a tree can be: of 2^27 triangles.
const STACK: usize = 64;

/// A box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aabb {
    pub low: DVec3,
    pub high: DVec3,
}

impl Aabb {
    const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        let add = |all: Self, at: DVec3| Self { low: all.low.min(at), high: all.high.max(at) };
        points.into_iter().fold(Self::EMPTY, add)
    }

    fn joined(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half its surface.
    fn area(&self) -> f64 {
        let DVec3 { x, y, z } = (self.high - self.low).max(DVec3::ZERO);
        x * y + y * z + z * x
    }

    pub fn meets(&self, other: &Self, slack: f64) -> bool {
        self.low.cmple(other.high + slack).all() && other.low.cmple(self.high + slack).all()
    }

    /// Where a ray enters it, widened by `pad`, if it does between 'from' and `to`.
    #[inline]
    fn entry(&self, ray: &TreeRay, to: f64) -> Option<f64> {
        let one = (self.low - ray.pad - ray.origin) * ray.inverse;
        let other = (self.high + ray.pad - ray.origin) * ray.inverse;
        // Of a number and none the number is taken: a ray along a side of the box is in it.
        let enter = one.min(other).max_element().max(ray.from);
        let leave = one.max(other).min_element().min(to);
        (enter <= leave).then_some(enter)
    }
}

/// A ray through a tree.
pub(super) struct TreeRay {
    origin: DVec3,
    inverse: DVec3,
    /// From how far on it is looked at.
    from: f64,
    pad: DVec3,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    around: Aabb,
    /// The first of its triangles in the order of the tree, or its first child.
    first: u32,
    /// How many triangles a leaf has; 0 for others, which have two children side by side.
    count: u32,
}

#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// The numbers of the triangles, those of a leaf side by side.
    order: Vec<u32>,
}

impl Tree {
    /// The tree around items of some boxes, one at least.
    pub fn new(boxes: &[Aabb]) -> Self {
        let order = (0..boxes.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), order };
        tree.nodes.push(tree.leaf(boxes, 0, boxes.len()));
        tree.divide(boxes, 0, 0);
        tree
    }

    fn leaf(&self, boxes: &[Aabb], first: usize, count: usize) -> Node {
        let own = self.order[first..first + count].iter().map(|item| boxes[*item as usize]);
        let around = own.fold(Aabb::EMPTY, Aabb::joined);
        Node { around, first: first as u32, count: count as u32 }
    }

    fn divide(&mut self, boxes: &[Aabb], node: usize, depth: usize) {
        let Node { around, first, count } = self.nodes[node];
        let (first, count) = (first as usize, count as usize);
        if count <= LEAF {
            return;
        }
        let middle = |item: u32| {
            let own = boxes[item as usize];
            0.5 * (own.low + own.high)
        };
        let own = &mut self.order[first..first + count];
        let middles = Aabb::around(own.iter().map(|item| middle(*item)));
        let size = middles.high - middles.low;
        let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
        let split = (depth < DEEP && size[axis] > 0.0)
            .then(|| {
                let scale = BINS as f64 / size[axis];
                let bin = |item: u32| {
                    (((middle(item)[axis] - middles.low[axis]) * scale) as usize).min(BINS - 1)
                };
                let mut bins = [(Aabb::EMPTY, 0_usize); BINS];
                for item in own.iter() {
                    let (around, count) = &mut bins[bin(*item)];
                    (*around, *count) = (around.joined(boxes[*item as usize]), *count + 1);
                }
                let cost = |bins: &[(Aabb, usize)]| {
                    let all = bins.iter().fold((Aabb::EMPTY, 0), |(all, sum), (around, count)| {
                        (all.joined(*around), sum + count)
                    });
                    if all.1 == 0 { f64::INFINITY } else { all.0.area() * all.1 as f64 }
                };
                let costs = (1..BINS).map(|at| (at, cost(&bins[..at]) + cost(&bins[at..])));
                let (at, least) = costs.min_by(|a, b| a.1.total_cmp(&b.1))?;
                if least >= around.area() * count as f64 && count <= 4 * LEAF {
                    return None;
                }
                least.is_finite().then(|| {
                    let mut low = 0;
                    for i in 0..own.len() {
                        if bin(own[i]) < at {
                            own.swap(i, low);
                            low += 1;
                        }
                    }
                    low
                })
            })
            .flatten();
        if split.is_none() && count <= 4 * LEAF {
            return;
        }
        let low = split.unwrap_or_else(|| {
            let by_middle = |a: &u32, b: &u32| middle(*a)[axis].total_cmp(&middle(*b)[axis]);
            own.select_nth_unstable_by(count / 2, by_middle);
            count / 2
        });
        let children = self.nodes.len();
        let halves = [(first, low), (first + low, count - low)];
        for (first, count) in halves {
            self.nodes.push(self.leaf(boxes, first, count));
        }
        self.nodes[node].first = children as u32;
        self.nodes[node].count = 0;
        self.divide(boxes, children, depth + 1);
        self.divide(boxes, children + 1, depth + 1);
    }

    pub fn around(&self) -> Aabb {
        self.nodes[0].around
    }

    /// A ray from `from` (cm) on.
    pub fn ray(&self, origin: DVec3, direction: DVec3, from: f64) -> TreeRay {
        let Aabb { low, high } = self.around();
        let far = (origin - low).abs().max((origin - high).abs());
        TreeRay { origin, inverse: direction.recip(), from, pad: 1e-13 * far }
    }

    /// Shows the triangles near a ray, nearer boxes first, up to a distance that `meet` shortens.
    #[inline]
    pub fn along(&self, ray: &TreeRay, mut meet: impl FnMut(u32, &mut f64)) {
        let mut to = f64::INFINITY;
        let mut stack = [(0_u32, 0.0_f64); STACK];
        let mut depth = 0;
        let Some(start) = self.nodes[0].around.entry(ray, to) else { return };
        let mut next = Some((0_u32, start));
        while let Some((number, _)) = next {
            let node = &self.nodes[number as usize];
            next = None;
            if node.count > 0 {
                let (first, count) = (node.first as usize, node.count as usize);
                for item in &self.order[first..first + count] {
                    meet(*item, &mut to);
                }
            } else {
                let entry = |child: u32| {
                    self.nodes[child as usize].around.entry(ray, to).map(|entry| (child, entry))
                };
                next = match [entry(node.first), entry(node.first + 1)] {
                    [Some(one), Some(other)] => {
                        let (near, far) =
                            if one.1 <= other.1 { (one, other) } else { (other, one) };
                        stack[depth] = far;
                        depth += 1;
                        Some(near)
                    }
                    [one, other] => one.or(other),
                };
            }
            while next.is_none() && depth > 0 {
                depth -= 1;
                next = Some(stack[depth]).filter(|(_, entry)| *entry <= to);
            }
        }
    }

    /// Shows the items whose boxes may meet another box.
    pub fn near(&self, other: &Aabb, slack: f64, mut meet: impl FnMut(u32)) {
        let mut waiting = vec![0_u32];
        while let Some(number) = waiting.pop() {
            let node = &self.nodes[number as usize];
            if !node.around.meets(other, slack) {
                continue;
            }
            if node.count > 0 {
                let (first, count) = (node.first as usize, node.count as usize);
                self.order[first..first + count].iter().for_each(|item| meet(*item));
            } else {
                waiting.extend([node.first, node.first + 1]);
            }
        }
    }
}
