//! Work on all threads with the feature `rayon`, on one without it.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// `work` of each number below `count`, in order.
pub(crate) fn map<T: Send>(count: usize, work: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
    if count < 2 {
        // Other threads would take longer to be told of it.
        return (0..count).map(work).collect();
    }
    #[cfg(feature = "rayon")]
    let numbers = (0..count).into_par_iter();
    #[cfg(not(feature = "rayon"))]
    let numbers = 0..count;
    numbers.map(work).collect()
}

/// How many threads there are.
pub(crate) fn threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    return 1;
}
