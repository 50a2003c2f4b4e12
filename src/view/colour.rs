//! Colour maps: tension (grey when slack, blue to red), pressure (slate to yellow), age, and series.

/// Red, green, blue.
pub(super) type Rgb = [u8; 3];

/// A cable that pulls nothing.
pub(super) const SLACK: Rgb = [140, 140, 140];
/// Contact points and forces.
pub(super) const CONTACT: Rgb = [255, 150, 40];
/// Hinges.
pub(super) const MARKER: Rgb = [245, 245, 245];
/// The way of the tip.
pub(super) const TRACE: Rgb = [120, 200, 255];
/// Axes, ticks and frames of drawn plots.
pub(super) const AXIS: Rgb = [150, 150, 150];
/// Where a loop is now.
pub(super) const NOW: Rgb = [255, 255, 255];

/// What was measured, and what the calibrated and the corrected scene make of it.
pub(super) const MEASURED: Rgb = [120, 230, 140];
pub(super) const CALIBRATED: Rgb = [255, 150, 50];
pub(super) const CORRECTED: Rgb = [90, 170, 255];

const TENSION: [Rgb; 3] = [[70, 130, 255], [200, 80, 210], [255, 50, 40]];
const PRESSURE: [Rgb; 3] = [[80, 95, 125], [50, 200, 200], [255, 230, 60]];
const AGE: [Rgb; 3] = [[50, 70, 140], [40, 170, 170], [250, 220, 60]];

/// Twelve lines that stay apart on a dark ground.
const SERIES: [Rgb; 12] = [
    [90, 170, 255],
    [255, 160, 60],
    [110, 220, 120],
    [255, 100, 110],
    [190, 140, 255],
    [250, 225, 90],
    [90, 220, 220],
    [240, 150, 210],
    [200, 200, 200],
    [150, 190, 60],
    [205, 130, 90],
    [130, 130, 230],
];

/// Colour of a cable at a tension.
pub(super) fn tension(tension_n: f64, slack_below_n: f64, scale_n: f64) -> Rgb {
    if tension_n.is_nan() || tension_n < slack_below_n {
        return SLACK;
    }
    blend(&TENSION, tension_n / scale_n)
}

/// Colour of a muscle at a pressure.
pub(super) fn pressure(pressure_pa: f64, scale_pa: f64) -> Rgb {
    blend(&PRESSURE, pressure_pa / scale_pa)
}

/// Colour of a piece of a loop: 0 the oldest, 1 the newest.
pub(super) fn age(fraction: f64) -> Rgb {
    blend(&AGE, fraction)
}

/// Colour of the n-th line of a plot.
pub(super) fn series(index: usize) -> Rgb {
    SERIES[index % SERIES.len()]
}

/// Opaque Rerun colour.
pub(super) fn opaque([red, green, blue]: Rgb) -> rerun::Color {
    rerun::Color::from_rgb(red, green, blue)
}

fn blend(stops: &[Rgb; 3], fraction: f64) -> Rgb {
    let place = if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) } * 2.0;
    let (from, to) = if place < 1.0 { (stops[0], stops[1]) } else { (stops[1], stops[2]) };
    let share = if place < 1.0 { place } else { place - 1.0 };
    std::array::from_fn(|channel| {
        let (a, b) = (f64::from(from[channel]), f64::from(to[channel]));
        (a + share * (b - a)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slack_is_grey_and_the_scale_ends_in_red() {
        assert_eq!(tension(0.0, 0.02, 10.0), SLACK);
        assert_eq!(tension(f64::NAN, 0.02, 10.0), SLACK);
        assert_eq!(tension(10.0, 0.02, 10.0), TENSION[2]);
        assert_eq!(tension(1e9, 0.02, 10.0), TENSION[2]);
        assert_eq!(tension(0.02, 0.02, 1e12), TENSION[0]);
    }

    #[test]
    fn half_way_is_the_middle_stop() {
        assert_eq!(pressure(5e5, 1e6), PRESSURE[1]);
        assert_eq!(pressure(-1.0, 1e6), PRESSURE[0]);
        assert_eq!(age(f64::NAN), AGE[0]);
    }
}
