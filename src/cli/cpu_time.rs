//! CPU time of this process.

/// Seconds of CPU time that all threads of the process have used, in user and system mode.
#[cfg(unix)]
pub fn process_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1.0e-9
}

/// Seconds since the first call, on systems without a clock of the process: as if one thread had
/// worked all the time.
#[cfg(not(unix))]
pub fn process_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}
