//! Memory for what a file says it holds, which may be more than the machine has.

use crate::format::mebibytes;

/// An empty buffer with room for `length` bytes; the reason where there is not that much memory.
pub(crate) fn reserve(length: usize) -> Result<Vec<u8>, String> {
    if let Some(available) = available().filter(|&available| length as u64 > available) {
        return Err(format!(
            "{} of memory are needed and {} are free; close other programs or take a smaller \
             file",
            mebibytes(length),
            mebibytes(available as usize)
        ));
    }
    let mut bytes = Vec::new();
    let refused = |_| format!("the system gives no {} of memory", mebibytes(length));
    bytes.try_reserve_exact(length).map_err(refused)?;
    Ok(bytes)
}

/// Bytes of memory that are free; `None` where the system does not tell.
#[cfg(target_os = "linux")]
fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix(" kB")?.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(not(target_os = "linux"))]
fn available() -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_no_machine_has_is_refused() {
        assert_eq!(reserve(1000).unwrap().capacity(), 1000);
        for length in [1 << 50, usize::MAX] {
            assert!(reserve(length).unwrap_err().contains("memory"));
        }
    }
}
