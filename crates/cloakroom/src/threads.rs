//! How many threads the work uses.

/// Lets all work of this process use the given number of threads; 0 stands for all cores. To be
/// called once, before any work.
///
/// # Errors
///
/// If the threads cannot be started, or work has begun before.
pub fn use_threads(threads: usize) -> Result<(), rayon::ThreadPoolBuildError> {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()
}

/// How many threads the work uses.
#[must_use]
pub fn count() -> usize {
    rayon::current_num_threads()
}
