//! How much memory is free.

/// Memory that this process can take without swapping, in bytes: what the system has, what is left
/// of its control group (a container, a job of a cluster), and of its own limit (`ulimit -v`);
/// `None` where the system does not say.
#[must_use]
pub fn available() -> Option<u64> {
    of_what_is_read(&|path| std::fs::read_to_string(path).ok())
}

/// There is not enough memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("needs {needed_mb} MB of memory, but only {available_mb} MB are free")]
pub struct Shortage {
    /// Memory needed, in 10^6 bytes.
    pub needed_mb: u64,
    /// Memory free, in 10^6 bytes.
    pub available_mb: u64,
}

impl Shortage {
    /// Of bytes needed and free.
    pub(crate) fn new(needed: u64, available: u64) -> Self {
        let [needed_mb, available_mb] = [needed, available].map(|bytes| bytes / 1_000_000);
        Self { needed_mb, available_mb }
    }
}

/// Refuses what takes more bytes than are [`available`], or than `most` wherever that is less.
///
/// # Errors
///
/// [`Shortage`].
pub fn check(needed: u64, most: u64) -> Result<(), Shortage> {
    let available = available().unwrap_or(most).min(most);
    if needed > available { Err(Shortage::new(needed, available)) } else { Ok(()) }
}

/// Makes room for one more in a list whose length nobody knows before it has ended; each takes so
/// many bytes, with what it owns.
///
/// # Errors
///
/// [`Shortage`], where there is no memory for twice as many.
pub(crate) fn make_room<T>(list: &mut Vec<T>, each: usize) -> Result<(), Shortage> {
    if list.len() == list.capacity() {
        let more = list.len().max(1024);
        // Those that are there may be copied.
        check((list.len() * size_of::<T>() + more * each) as u64, u64::MAX)?;
        list.reserve_exact(more);
    }
    Ok(())
}

/// The least of all limits, each from files that `read` gives the text of.
fn of_what_is_read(read: &dyn Fn(&str) -> Option<String>) -> Option<u64> {
    let system = field(&read("/proc/meminfo")?, "MemAvailable:").map(|kib| kib * 1024);
    [system, of_group(read), of_process(read)].into_iter().flatten().min()
}

/// What is left of the control group's limit; the files of the second version, or else of the
/// first.
fn of_group(read: &dyn Fn(&str) -> Option<String>) -> Option<u64> {
    let groups = read("/proc/self/cgroup")?;
    let path = |controller: &str| {
        let line = groups.lines().find(|line| line.split(':').nth(1) == Some(controller))?;
        Some(line.splitn(3, ':').nth(2)?.trim_end_matches('/').to_owned())
    };
    let version = |root: &str, controller: &str, [limit, used, cache]: [&str; 3]| {
        // In a container its own group is the root, though it may be called by the name it has
        // outside.
        let folders = [path(controller)?, String::new()];
        folders.iter().find_map(|folder| {
            let file = |name: &str| read(&format!("{root}{folder}/{name}"));
            let number = |name: &str| file(name)?.trim().parse::<u64>().ok();
            let limit = number(limit)?;
            // Files that were read are forgotten where memory is needed.
            let cache = file("memory.stat").and_then(|stat| field(&stat, cache)).unwrap_or(0);
            Some(limit.saturating_sub(number(used)?.saturating_sub(cache)))
        })
    };
    let names = ["memory.max", "memory.current", "file "];
    version("/sys/fs/cgroup", "", names).or_else(|| {
        let names = ["memory.limit_in_bytes", "memory.usage_in_bytes", "total_cache "];
        version("/sys/fs/cgroup/memory", "memory", names)
    })
}

/// Address space that the allocator of the C library reserves for a thread that has not begun to
/// allocate: the one that waits for signals.
const RESERVED: u64 = 64 << 20;

/// What is left of the address space that the process may have.
fn of_process(read: &dyn Fn(&str) -> Option<String>) -> Option<u64> {
    let limit = field(&read("/proc/self/limits")?, "Max address space")?;
    let taken = field(&read("/proc/self/status")?, "VmSize:")? * 1024;
    Some(limit.saturating_sub(taken + RESERVED))
}

/// The number after a name at the beginning of a line; `None` where there is none, as in
/// `unlimited`.
fn field(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEMORY: (&str, &str) = ("/proc/meminfo", "MemTotal: 16000 kB\nMemAvailable: 8000 kB\n");

    fn available(files: &[(&str, &str)]) -> Option<u64> {
        of_what_is_read(&|path| {
            files.iter().find(|(name, _)| *name == path).map(|(_, text)| (*text).to_owned())
        })
    }

    #[test]
    fn the_least_limit_counts() {
        assert_eq!(available(&[]), None);
        assert_eq!(available(&[MEMORY]), Some(8000 << 10));
        let status = ("/proc/self/status", "VmPeak: 9 kB\nVmSize:\t    1000 kB\n");
        let limits = |limit| {
            let files = [("/proc/self/limits", limit), status, MEMORY];
            available(&files)
        };
        assert_eq!(limits("Max address space  unlimited  unlimited  bytes\n"), Some(8000 << 10));
        let limit = 3_072_000 + RESERVED;
        let limited = format!("Max address space  {limit}  unlimited  bytes\n");
        assert_eq!(limits(&limited), Some(2000 << 10));
        assert_eq!(limits("Max address space  1024  1024  bytes\n"), Some(0));
    }

    #[test]
    fn control_groups_of_both_versions_are_read() {
        let second = [
            MEMORY,
            ("/proc/self/cgroup", "0::/job\n"),
            ("/sys/fs/cgroup/job/memory.max", "4000000\n"),
            ("/sys/fs/cgroup/job/memory.current", "3000000\n"),
            ("/sys/fs/cgroup/job/memory.stat", "anon 1\nfile 500000\nfile_mapped 7\n"),
        ];
        assert_eq!(available(&second), Some(1_500_000));
        let container = [
            MEMORY,
            ("/proc/self/cgroup", "0::/outside/name\n"),
            ("/sys/fs/cgroup/memory.max", "max\n"),
            ("/sys/fs/cgroup/memory.current", "3000000\n"),
        ];
        assert_eq!(available(&container), Some(8000 << 10));
        let first = [
            MEMORY,
            ("/proc/self/cgroup", "5:cpu:/\n4:memory:/a/b\n0::/\n"),
            ("/sys/fs/cgroup/memory/a/b/memory.limit_in_bytes", "2000\n"),
            ("/sys/fs/cgroup/memory/a/b/memory.usage_in_bytes", "1500\n"),
        ];
        assert_eq!(available(&first), Some(500));
    }
}
