//! Long work: without the interpreter's lock, with progress, stopped by Ctrl-C, its panics as
//! exceptions.

use crate::errors::Failure;
use cloakroom::render::Supervision;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// How often signals are looked for and progress is told.
const BEAT: Duration = Duration::from_millis(50);

/// More threads than any machine has.
const MOST_THREADS: usize = 4096;

/// How far the work is.
#[derive(Debug, Default)]
pub struct Watch {
    done: AtomicU64,
    total: AtomicU64,
}

impl Watch {
    /// Says how many steps there are.
    pub fn begin(&self, steps: u64) {
        self.total.store(steps, Ordering::Relaxed);
    }

    /// How many of them are left.
    pub fn left(&self) -> u64 {
        let [done, total] = [&self.done, &self.total].map(|n| n.load(Ordering::Relaxed));
        total.saturating_sub(done)
    }

    fn tell(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        if let Some(progress) = progress {
            let [done, total] = [&self.done, &self.total].map(|n| n.load(Ordering::Relaxed));
            progress.call1(py, (done, total))?;
        }
        Ok(())
    }
}

/// Runs work on all threads while other Python threads go on; `progress` is called with the steps
/// done and the steps in all, of which the work tells what it is watched and supervised by.
///
/// # Errors
///
/// That of the work; what a signal handler or `progress` raises, after the work has been stopped;
/// `RuntimeError` for a panic.
pub fn supervised<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch, &Supervision<'_>) -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    let pool = Pool::take()?;
    let (watch, stop) = (Watch::default(), AtomicBool::new(false));
    let rows_done = |rows| _ = watch.done.fetch_add(rows, Ordering::Relaxed);
    let supervision = Supervision { rows_done: &rows_done, stop: &stop };
    let (result, raised) = py.detach(|| {
        thread::scope(|scope| {
            let (finished, news) = channel::<()>();
            let worker = scope.spawn(|| {
                let _finished = finished;
                // What a panic leaves behind is dropped with it.
                catch_unwind(AssertUnwindSafe(|| pool.run(|| work(&watch, &supervision))))
            });
            let mut raised = None;
            while news.recv_timeout(BEAT) == Err(RecvTimeoutError::Timeout) {
                if raised.is_some() {
                    continue;
                }
                let told =
                    Python::attach(|py| py.check_signals().and_then(|()| watch.tell(py, progress)));
                if let Err(error) = told {
                    stop.store(true, Ordering::Relaxed);
                    raised = Some(error);
                }
            }
            (worker.join().and_then(|result| result), raised)
        })
    });
    match (raised, result) {
        (Some(error), _) => Err(error.into()),
        (None, Err(panic)) => Err(panicked(&*panic).into()),
        (None, Ok(result)) => {
            watch.tell(py, progress)?;
            result
        }
    }
}

/// Runs work that takes no longer than it would take to tell other threads of it.
///
/// # Errors
///
/// That of the work; `RuntimeError` for a panic.
pub fn at_once<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Supervision<'_>) -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    let stop = AtomicBool::new(false);
    let result = py.detach(|| {
        // What a panic leaves behind is dropped with it.
        catch_unwind(AssertUnwindSafe(|| work(&Supervision { rows_done: &|_| {}, stop: &stop })))
    });
    result.unwrap_or_else(|panic| Err(panicked(&*panic).into()))
}

/// A panic as an exception.
fn panicked(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    PyRuntimeError::new_err(format!("a mistake in cloakroom, not in your input: {text}"))
}

/// The threads of this process: each work has a pool of its own, so that it neither waits for that
/// of another Python thread nor is ended by it. A process that was forked off another has none of
/// the other's threads.
struct Pools {
    process: u32,
    threads: usize,
    /// Those that no work is using.
    idle: Vec<ThreadPool>,
}

static POOLS: Mutex<Pools> = Mutex::new(Pools { process: 0, threads: 0, idle: Vec::new() });

/// Those of this process.
fn pools() -> MutexGuard<'static, Pools> {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if pools.process != std::process::id() {
        // Threads of the parent process cannot be joined here.
        std::mem::forget(std::mem::take(&mut pools.idle));
        pools.process = std::process::id();
    }
    pools
}

/// A pool that nobody uses, which goes back when it is dropped.
struct Pool {
    pool: Option<ThreadPool>,
    /// What had been asked for when it was built.
    threads: usize,
}

impl Pool {
    fn take() -> PyResult<Self> {
        let mut pools = pools();
        let idle = pools.idle.pop();
        let built =
            idle.map_or_else(|| ThreadPoolBuilder::new().num_threads(pools.threads).build(), Ok);
        let failed = |error| PyRuntimeError::new_err(format!("cannot start threads: {error}"));
        Ok(Self { pool: Some(built.map_err(failed)?), threads: pools.threads })
    }

    fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        let mut pools = pools();
        if let Some(pool) = self.pool.take()
            && self.threads == pools.threads
        {
            pools.idle.push(pool);
        }
    }
}

/// Lets work use so many threads from now on; 0 stands for all cores.
#[pyfunction]
pub fn set_threads(count: i64) -> PyResult<()> {
    let threads = usize::try_from(count).ok().filter(|threads| *threads <= MOST_THREADS);
    let threads = threads.ok_or_else(|| {
        PyValueError::new_err(format!("count is {count}; it must be from 0 to {MOST_THREADS}"))
    })?;
    let mut pools = pools();
    pools.threads = threads;
    pools.idle.clear();
    Ok(())
}

/// How many threads work uses.
#[pyfunction]
pub fn threads() -> PyResult<usize> {
    Ok(Pool::take()?.run(rayon::current_num_threads))
}

/// Panics, for the test that a panic does not take the interpreter down.
#[pyfunction]
pub fn fail_on_purpose(py: Python<'_>) -> Result<(), Failure> {
    supervised(py, None, |_, _| panic!("on purpose"))
}
