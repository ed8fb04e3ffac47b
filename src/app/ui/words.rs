//! Numbers of a render in words: samples, times, shares.

/// A number of samples in about two digits or more.
pub fn samples(spp: f64) -> String {
    if spp < 10.0 { format!("{spp:.1}") } else { format!("{spp:.0}") }
}

/// Seconds that are left, in words.
pub fn time_left(left: f64) -> String {
    if left < 60.0 { format!("{:.0} s", left.ceil()) } else { seconds(left) }
}

/// A fraction in percent, in about three digits.
pub fn percent(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    let decimals = match percent {
        _ if percent < 10.0 => 2,
        _ if percent < 100.0 => 1,
        _ => 0,
    };
    format!("{percent:.decimals$}")
}

/// A time in seconds, or in minutes and seconds from a minute on.
pub fn seconds(seconds: f64) -> String {
    if seconds < 60.0 {
        return format!("{seconds:.1} s");
    }
    let minutes = (seconds / 60.0).floor();
    format!("{minutes:.0}:{:02.0} min", (seconds - 60.0 * minutes).floor())
}
