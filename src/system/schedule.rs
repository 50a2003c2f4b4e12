//! When a run is recorded.

/// The instants at which a run is recorded, s; increasing, the first one is the start.
///
/// ```
/// use smam::system::Schedule;
///
/// assert_eq!(Schedule::even(1.0, 0.25).times(), [0.0, 0.25, 0.5, 0.75, 1.0]);
/// // The end is there even where the interval does not fit.
/// assert_eq!(Schedule::even(1.0, 0.4).times(), [0.0, 0.4, 0.8, 1.0]);
/// assert_eq!(Schedule::at(vec![0.0, 0.1, 0.5]).last_s(), Some(0.5));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule(Instants);

/// Even ones are counted, not kept: an hour at 1 kHz has 3.6 million of them.
#[derive(Clone, Debug, PartialEq)]
enum Instants {
    /// Multiples of an interval, and an end that is none.
    Even {
        intervals: usize,
        interval_s: f64,
        end_s: Option<f64>,
    },
    At(Vec<f64>),
}

impl Schedule {
    /// Equal intervals from 0 to `duration_s`, both ends included.
    pub fn even(duration_s: f64, interval_s: f64) -> Self {
        let intervals = (duration_s / interval_s + 1e-9).floor() as usize;
        let is_left = duration_s - intervals as f64 * interval_s > 1e-9 * interval_s.max(1e-3);
        Self(Instants::Even { intervals, interval_s, end_s: is_left.then_some(duration_s) })
    }

    /// These instants.
    pub fn at(times_s: Vec<f64>) -> Self {
        Self(Instants::At(times_s))
    }

    /// One instant after the other, s.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = f64> + '_ {
        let count = match &self.0 {
            Instants::Even { intervals, end_s, .. } => intervals + 1 + usize::from(end_s.is_some()),
            Instants::At(times_s) => times_s.len(),
        };
        (0..count).map(|i| match &self.0 {
            Instants::Even { intervals, interval_s, end_s } => {
                end_s.filter(|_| i > *intervals).unwrap_or(i as f64 * interval_s)
            }
            Instants::At(times_s) => times_s[i],
        })
    }

    /// All instants, s.
    pub fn times(&self) -> Vec<f64> {
        self.iter().collect()
    }

    /// The first instant, s; `None` where there is none.
    pub fn first_s(&self) -> Option<f64> {
        self.iter().next()
    }

    /// The last instant, s; `None` where there is none.
    pub fn last_s(&self) -> Option<f64> {
        self.iter().next_back()
    }
}
