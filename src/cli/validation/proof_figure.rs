//! The picture of a proof: probabilities that hold, and what is seen and named at which misfit.

use smam::proof::{Row, Share, detection, naming, reliability};
use smam::report::{BLUE, ORANGE, Panel, SILVER, Series, figure_svg};

const SIZE: (f64, f64) = (640.0, 300.0);

/// Two panels as SVG.
pub fn proof_svg(rows: &[Row]) -> String {
    figure_svg(&proof_panels(rows), SIZE.0, SIZE.1)
}

/// The same, for a page.
pub fn proof_panels(rows: &[Row]) -> [Panel; 2] {
    [reliability_panel(rows), misfit_panel(rows)]
}

fn reliability_panel(rows: &[Row]) -> Panel {
    let diagonal = line("as often as said", SILVER, vec![0.0, 1.0], vec![0.0, 1.0]);
    let at = |share: &Share| share.mean;
    Panel {
        title: vec!["Probability given to an effect, and how often it was there".to_owned()],
        x_label: "probability given (-)".to_owned(),
        y_label: "share that was there (-)".to_owned(),
        behind: vec![diagonal],
        series: with_bars("effects named (bars: 95 % interval)", BLUE, &reliability(rows), at),
        ..Panel::default()
    }
}

fn misfit_panel(rows: &[Row]) -> Panel {
    // The first bin begins at zero: it is drawn a decade below its end.
    let at = |share: &Share| share.mean.max(1e-3).log10();
    let detected = with_bars("something is said to be missing", BLUE, &detection(rows), at);
    let named = with_bars("one effect hidden: it is the first answer", ORANGE, &naming(rows), at);
    Panel {
        title: vec!["What is seen, by the misfit that the calibration leaves".to_owned()],
        x_label: "log10 of excess chi2 per sample (-)".to_owned(),
        y_label: "share of cases (-)".to_owned(),
        series: [detected, named].concat(),
        ..Panel::default()
    }
}

/// A line through the shares, and a bar over the interval of each.
fn with_bars(label: &str, colour: &'static str, shares: &[Share], at: impl Fn(&Share) -> f64) -> Vec<Series> {
    let own: Vec<&Share> = shares.iter().filter(|s| s.count > 0).collect();
    let through = line(label, colour, own.iter().map(|s| at(s)).collect(), own.iter().map(|s| s.value()).collect());
    let bar = |s: &&Share| {
        let [low, high] = s.interval();
        line("", colour, vec![at(s); 2], vec![low, high])
    };
    std::iter::once(through).chain(own.iter().map(bar)).collect()
}

fn line(label: &str, colour: &'static str, x: Vec<f64>, y: Vec<f64>) -> Series {
    Series { label: label.to_owned(), colour, x, y }
}
