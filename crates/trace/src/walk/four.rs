//! Four trees side by side: neighbouring rays meet the same regions, and some take four rays at
//! once.

use super::branch::Branch;
use super::{Launch, PathRecorder, Tracer};
use crate::device::InnerRay;

/// Traces four rays at once. Each tree is what [`Tracer::trace`] makes of its ray alone.
#[derive(Clone, Debug)]
pub struct FourTracers<'a, const N: usize, W = ()> {
    /// The tracers; each keeps what it has [traced](Tracer::traced) last.
    pub tracers: [Tracer<'a, N, W>; 4],
}

impl<'a, const N: usize, W: PathRecorder<N> + Clone> FourTracers<'a, N, W> {
    /// Four tracers like the given one.
    #[must_use]
    pub fn new(tracer: &Tracer<'a, N, W>) -> Self {
        Self { tracers: std::array::from_fn(|_| tracer.clone()) }
    }

    /// Follows four rays to the end of every branch. See [`Tracer::trace`].
    pub fn trace(&mut self, launches: &[Launch<N>; 4]) {
        let mut branches = std::array::from_fn(|i| Branch::launched(&launches[i]));
        let regions = std::array::from_fn(|i| self.tracers[i].begin(&mut branches[i]));
        self.follow(&mut branches, regions);
    }

    /// Follows of four trees what comes of those branches, and of the launched rays themselves only
    /// where `launched` says so. Group delays are not known then.
    pub fn trace_further_on(
        &mut self,
        launches: &[Launch<N>; 4],
        launched: [bool; 4],
        further_on: &[Vec<Branch<N>>; 4],
    ) {
        let mut branches = std::array::from_fn(|i| Branch::launched(&launches[i]));
        let regions = std::array::from_fn(|i| {
            self.tracers[i].begin_further_on(&mut branches[i], launched[i], &further_on[i])
        });
        self.follow(&mut branches, regions);
    }

    /// Follows the branches that each wait to be taken through a region, and all others.
    fn follow(&mut self, branches: &mut [Branch<N>; 4], mut regions: [Option<(u16, u16)>; 4]) {
        while let Some(&region) = regions.iter().flatten().next() {
            let rays: [Option<InnerRay>; 4] = std::array::from_fn(|i| {
                (regions[i] == Some(region)).then(|| branches[i].inner_ray())
            });
            let passages = self.tracers[0].advance_four(region, &rays);
            for (i, passage) in passages.into_iter().enumerate() {
                if let Some(passage) = passage {
                    regions[i] = self.tracers[i].resume(&mut branches[i], region, passage);
                }
            }
        }
    }
}
