//! History of the noise of a render over CPU time.

/// Points of noise over CPU time, thinned to lie evenly on a logarithmic axis however long the
/// render takes and however often it is measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NoiseHistory {
    points: Vec<[f64; 2]>,
}

/// Points in a factor of ten of CPU time.
const PER_DECADE: f64 = 24.0;

impl NoiseHistory {
    /// Whether enough CPU time has passed for another point, so that the noise need not be measured
    /// in vain.
    pub fn wants(&self, cpu_seconds: f64) -> bool {
        cpu_seconds > 0.0
            && self.points.last().is_none_or(|last| cpu_seconds >= last[0] * spacing())
    }

    /// Adds the noise after `cpu_seconds` of CPU time. The latest point always stays; it replaces
    /// the one before where both lie close together. Points that a logarithmic axis cannot show, or
    /// that go back in time, are left out.
    pub fn push(&mut self, cpu_seconds: f64, noise: f64) {
        let is_later = self.points.last().is_none_or(|last| cpu_seconds >= last[0]);
        let can_be_shown = [cpu_seconds, noise].iter().all(|&x| x > 0.0 && x.is_finite());
        if !is_later || !can_be_shown {
            return;
        }
        if let [.., before, last] = &self.points[..]
            && last[0] < before[0] * spacing()
        {
            self.points.pop();
        }
        self.points.push([cpu_seconds, noise]);
    }

    /// Notes the noise of a render that may have begun anew, and then begins the history anew.
    pub fn follow(&mut self, cpu_seconds: f64, noise: f64) {
        match self.points.last() {
            Some(last) if cpu_seconds < last[0] => self.points.clear(),
            Some(last) if cpu_seconds == last[0] => return,
            _ => {}
        }
        self.push(cpu_seconds, noise);
    }

    /// The points, earliest first: seconds of CPU time and noise, as
    /// [`FilmStats::noise`](crate::render::FilmStats::noise).
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }
}

fn spacing() -> f64 {
    10_f64.powf(1.0 / PER_DECADE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_evenly_on_a_logarithmic_axis_and_end_with_the_latest() {
        let mut history = NoiseHistory::default();
        for step in 1..=100_000 {
            let seconds = f64::from(step) * 0.001;
            history.push(seconds, 1.0 / seconds.sqrt());
        }
        let points = history.points();
        assert_eq!(points[0][0], 0.001);
        assert_eq!(points.last().unwrap()[0], 100.0);
        let decade = |from: f64| points.iter().filter(move |p| (from..from * 10.0).contains(&p[0]));
        assert_eq!(decade(1.0).count() as f64, PER_DECADE);
        assert_eq!(decade(10.0).count() as f64, PER_DECADE);
        assert!(points.is_sorted_by(|a, b| a[0] < b[0]));
    }

    #[test]
    fn a_render_that_begins_anew_has_a_history_of_its_own() {
        let mut history = NoiseHistory::default();
        for (seconds, noise) in [(1.0, 0.5), (2.0, 0.4), (2.0, 0.3)] {
            history.follow(seconds, noise);
        }
        assert_eq!(history.points(), [[1.0, 0.5], [2.0, 0.4]]);
        history.follow(0.5, 0.9);
        assert_eq!(history.points(), [[0.5, 0.9]]);
    }

    #[test]
    fn what_cannot_be_shown_is_left_out() {
        let mut history = NoiseHistory::default();
        assert!(!history.wants(0.0) && history.wants(0.1));
        history.push(0.0, 1.0);
        history.push(1.0, 0.0);
        history.push(1.0, f64::NAN);
        assert!(history.points().is_empty());
        history.push(1.0, 0.5);
        history.push(0.5, 0.5);
        assert_eq!(history.points(), [[1.0, 0.5]]);
        assert!(!history.wants(1.05) && history.wants(1.2));
    }
}
