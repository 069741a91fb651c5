//! The widest instructions that the processor has, chosen at run time.

#[cfg(not(target_arch = "wasm32"))]
use pulp::Arch;

/// Those instructions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instructions(#[cfg(not(target_arch = "wasm32"))] Arch);

impl Instructions {
    pub fn new() -> Self {
        Self(
            #[cfg(not(target_arch = "wasm32"))]
            Arch::new(),
        )
    }

    /// Does `work` with them; it must be `#[inline(always)]`, and all that it calls.
    #[inline(always)]
    pub fn with<R>(self, work: impl FnOnce() -> R) -> R {
        #[cfg(not(target_arch = "wasm32"))]
        return self.0.dispatch(work);
        // Browsers refuse a module in which any function has instructions that they lack, called or not.
        #[cfg(target_arch = "wasm32")]
        work()
    }
}
