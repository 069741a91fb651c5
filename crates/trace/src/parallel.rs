//! Work on all threads with the feature `rayon`, on one without it.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// `work` of each number below `count`, in order.
pub(crate) fn map<T: Send>(count: usize, work: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
    map_each((0..count).collect(), work)
}

/// `work` of each item, in order.
pub(crate) fn map_each<I: Send, T: Send>(
    items: Vec<I>,
    work: impl Fn(I) -> T + Send + Sync,
) -> Vec<T> {
    if items.len() < 2 {
        // Other threads would take longer to be told of it.
        return items.into_iter().map(work).collect();
    }
    #[cfg(feature = "rayon")]
    let items = items.into_par_iter();
    #[cfg(not(feature = "rayon"))]
    let items = items.into_iter();
    items.map(work).collect()
}

/// How many threads there are.
pub(crate) fn threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    return 1;
}
