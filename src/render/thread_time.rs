//! CPU time of the calling thread: what a sampling thread spends on its own work, however many
//! others share its core.

/// Seconds of CPU time that the calling thread has used, in user and system mode.
#[cfg(unix)]
pub(crate) fn thread_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1.0e-9
}

/// Seconds since the first call, on systems without a clock of the thread: as if the thread had a
/// core to itself.
#[cfg(not(unix))]
pub(crate) fn thread_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn sleeping_costs_nothing_and_working_does() {
        let start = thread_seconds();
        std::thread::sleep(std::time::Duration::from_millis(50));
        let slept = thread_seconds();
        assert!(slept - start < 0.04, "sleeping took {} s of CPU time", slept - start);
        let sum = (0..10_000_000_u64).fold(0, |sum, n| std::hint::black_box(sum ^ n));
        assert!(thread_seconds() > slept, "{sum}");
    }
}
