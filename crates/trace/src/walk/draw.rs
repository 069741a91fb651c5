//! One leaf of a tree, drawn by its power without the rest of the tree: at each fork one branch is followed,
//! by the powers there.

use super::branch::Branch;
use super::{PathRecorder, Tracer};
use crate::split_mix::{STEP, mix};

/// A way that has met so many surfaces is cut: trapped light comes back, and each surface costs.
pub(super) const MOST_EVENTS_DRAWN: u32 = 256;

/// Where a way ends in a branch that is pruned, another one is drawn, so that what is pruned is given to the
/// leaves as their powers are; but no more than so many. What is drawn in vain then is lost.
const MOST_WAYS: u32 = 64;

/// A number from 0 to 1 decides at fork after fork, stretched to the share of the branch that it has fallen
/// into, so that evenly spaced numbers draw each leaf as often as it is to be drawn, for as long as shares are
/// above this: then single precision has used up half of its digits, and others take its place.
const DIGITS: f64 = 1.0 / 4096.0;

/// How a way is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draw<const N: usize> {
    root: Option<Branch<N>>,
    /// The number that decides next, and its share of the one that it has been stretched from.
    number: f64,
    share: f64,
    /// The state of the numbers that take its place.
    state: u64,
    /// With which probability the way so far was drawn. The power of its branch is smaller by what has been
    /// absorbed.
    probability: f64,
    /// The power, of all polarizations, that had been pruned when it was looked at last.
    pruned_before: f64,
    /// How many ways have ended in what is pruned.
    in_vain: u32,
    /// What the first one carried, if it has.
    first_pruned: f64,
}

/// What is known of a drawn leaf, or of its absence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    /// With which probability it was drawn, the pruned among what may be.
    pub probability: f64,
    /// What the first way carried if it ended in what is pruned, else 0: on the average the share that is.
    pub pruned: f64,
}

impl<const N: usize> Draw<N> {
    /// By a number from 0 to 1.
    pub fn by(number: f64) -> Self {
        Self {
            root: None,
            number,
            share: 1.0,
            state: number.to_bits(),
            probability: 1.0,
            pruned_before: 0.0,
            in_vain: 0,
            first_pruned: 0.0,
        }
    }

    /// Begins with the launched ray.
    pub fn begin(&mut self, launched: &Branch<N>) {
        self.root = Some(*launched);
    }

    fn replace_number(&mut self) {
        self.number = (mix(self.state) >> 11) as f64 * f64::EPSILON / 2.0;
        self.state = self.state.wrapping_add(STEP);
        self.share = 1.0;
    }

    /// Notes that the number has fallen into a share of all, of which `below` is below it.
    fn fall_into(&mut self, share: f64, below: f64) {
        self.number = ((self.number - below) / share).clamp(0.0, 1.0);
        self.share *= share;
        self.probability *= share;
        if self.share < DIGITS {
            self.replace_number();
        }
    }
}

impl<const N: usize, W: PathRecorder<N>> Tracer<'_, N, W> {
    /// Draws of each ray one leaf, by a number from 0 to 1: of the tree only the way to it is followed.
    pub(super) fn draw_by(&mut self, number: Option<f64>) {
        self.draw = number.map(Draw::by);
    }

    /// What is known of how the last leaf was drawn.
    pub(super) fn drawn(&self) -> Option<Drawn> {
        let Draw { probability, first_pruned, .. } = *self.draw.as_ref()?;
        Some(Drawn { probability, pruned: first_pruned })
    }

    /// Whether one of several branches is to be drawn before the branch at hand goes on.
    #[inline]
    pub(super) fn has_forked(&self) -> bool {
        self.draw.as_ref().is_some_and(|draw| {
            !self.waiting.is_empty() || total(&self.outcome.pruned) != draw.pruned_before
        })
    }

    /// Puts in place of a branch the one that is drawn of those that wait and of what has been pruned; in place
    /// of what was pruned the launched ray again. None if the way has ended.
    pub(super) fn take_drawn(&mut self, branch: &mut Branch<N>) -> Option<()> {
        loop {
            let draw = self.draw.as_mut()?;
            if !self.leaves.is_empty() {
                return None;
            }
            let all_pruned = total(&self.outcome.pruned);
            let pruned = (all_pruned - draw.pruned_before).max(0.0);
            draw.pruned_before = all_pruned;
            let waiting: f64 = self.waiting.iter().map(|branch| total(&branch.power)).sum();
            let all = waiting + pruned;
            if all <= 0.0 {
                return None;
            }
            let mut below = 0.0;
            let mut last = None;
            for (place, waiting) in self.waiting.iter().enumerate() {
                let share = total(&waiting.power) / all;
                if share > 0.0 {
                    last = Some((place, share, below));
                    if draw.number < below + share {
                        break;
                    }
                    below += share;
                }
            }
            // Where nothing was pruned, rounding leaves nothing to it either.
            let drawn =
                last.filter(|(_, share, below)| pruned == 0.0 || draw.number < below + share);
            if let Some((place, share, below)) = drawn {
                draw.fall_into(share, below);
                *branch = self.waiting[place];
                self.waiting.clear();
                return Some(());
            }
            // What of the light has not been absorbed on this way is drawn again.
            let kept = all / (N as f64 * draw.probability);
            let only_way = draw.probability == 1.0 && waiting == 0.0;
            if draw.in_vain == 0 {
                draw.first_pruned = kept;
            }
            draw.in_vain += 1;
            draw.replace_number();
            let again = !only_way && draw.in_vain < MOST_WAYS && draw.number < kept;
            self.waiting.clear();
            if !again {
                return None;
            }
            draw.replace_number();
            draw.probability = 1.0;
            *branch = draw.root?;
            self.start_anew();
            if self.start(branch) {
                return Some(());
            }
        }
    }
}

/// The power of all polarizations.
fn total<const N: usize>(power: &[f64; N]) -> f64 {
    power.iter().sum()
}
