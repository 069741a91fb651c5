//! Four trees side by side: neighbouring rays meet the same cells, and some cells take four rays at once.

use super::tracer::Suspended;
use super::{Launch, Tracer};

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
        let mut suspended: [Option<Suspended<N>>; 4] =
            std::array::from_fn(|i| self.tracers[i].begin(&launches[i]));
        while let Some(first) = suspended.iter().flatten().next() {
            let cell = first.cell;
            let rays = suspended.each_ref().map(|suspended| {
                let here = suspended.as_ref().filter(|suspended| suspended.cell == cell)?;
                Some(here.branch.inner_ray())
            });
            let passages = self.tracers[0].advance_four(cell, &rays);
            for (i, passage) in passages.into_iter().enumerate() {
                if let Some(Suspended { branch, .. }) = suspended[i].take_if(|s| s.cell == cell) {
                    suspended[i] = self.tracers[i].resume(branch, cell, passage);
                }
            }
        }
    }
}
