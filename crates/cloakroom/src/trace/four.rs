//! Four trees side by side: neighbouring rays meet the same cells, and some cells take four rays at once.

use super::branch::Branch;
use super::{Launch, Leaf, Outcome, Tracer};
use crate::device::InnerRay;

/// Traces four rays at once. Each tree is what [`Tracer::trace`] makes of its ray alone.
#[derive(Clone, Debug)]
pub struct FourTracers<'a, const N: usize> {
    tracers: [Tracer<'a, N>; 4],
}

impl<'a, const N: usize> FourTracers<'a, N> {
    /// Four tracers like the given one.
    #[must_use]
    pub fn new(tracer: &Tracer<'a, N>) -> Self {
        Self { tracers: std::array::from_fn(|_| tracer.clone()) }
    }

    /// The tracers; each keeps what it has [traced](Tracer::traced) last.
    #[must_use]
    pub fn each(&self) -> &[Tracer<'a, N>; 4] {
        &self.tracers
    }

    /// Follows four rays to the end of every branch. They must start in air.
    pub fn trace(&mut self, launches: &[Launch<N>; 4]) {
        let mut branches = launches.each_ref().map(Branch::launched);
        let mut cells = [None; 4];
        for (i, cell) in cells.iter_mut().enumerate() {
            *cell = self.tracers[i].begin(&mut branches[i]);
        }
        while self.advance(&mut branches, &mut cells) {}
    }

    /// Follows any number of rays; where one has come to its end, the next one takes its place. `ended` is told the
    /// number of each ray, its leaves and its account, in the order in which they end. They must start in air.
    pub fn trace_all(
        &mut self,
        launches: &[Launch<N>],
        mut ended: impl FnMut(usize, &[Leaf<N>], &Outcome<N>),
    ) {
        let Some(first) = launches.first() else { return };
        let mut branches = [Branch::launched(first); 4];
        let mut cells = [None; 4];
        let mut under_way = [None; 4];
        let mut waiting = launches.iter().enumerate();
        loop {
            for (i, tracer) in self.tracers.iter_mut().enumerate() {
                while cells[i].is_none() {
                    if let Some(ray) = under_way[i].take() {
                        let (leaves, outcome) = tracer.traced();
                        ended(ray, leaves, outcome);
                    }
                    let Some((ray, launch)) = waiting.next() else { break };
                    under_way[i] = Some(ray);
                    branches[i] = Branch::launched(launch);
                    cells[i] = tracer.begin(&mut branches[i]);
                }
            }
            if !self.advance(&mut branches, &mut cells) {
                return;
            }
        }
    }

    /// Takes those that wait before one cell through it, and on to the next such cell; `false` if none waits.
    fn advance(
        &mut self,
        branches: &mut [Branch<N>; 4],
        cells: &mut [Option<(u16, u16)>; 4],
    ) -> bool {
        let Some(&cell) = cells.iter().flatten().next() else { return false };
        let rays: [Option<InnerRay>; 4] =
            std::array::from_fn(|i| (cells[i] == Some(cell)).then(|| branches[i].inner_ray()));
        let passages = self.tracers[0].advance_four(cell, &rays);
        for (i, passage) in passages.iter().enumerate() {
            if rays[i].is_some() {
                cells[i] = self.tracers[i].resume(&mut branches[i], cell, passage.as_ref());
            }
        }
        true
    }
}
