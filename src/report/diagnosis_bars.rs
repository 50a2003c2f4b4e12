//! How much, as a picture: error over noise by channel.

use crate::diagnose::{ChannelProof, Outcome};

use super::diagnosis_map::{EDGE, LABELS, ROW, TEXT, WIDTH, label};
use super::svg::{Anchor, BLUE, GREY, Rect, Svg, VERMILION, text_width};

/// Error over noise on the sealed runs by channel, before and after, on a logarithmic axis.
pub fn bars_svg(outcome: &Outcome) -> String {
    let channels = &outcome.diagnosis.fit.channels;
    let mut svg = Svg::new(WIDTH, 2.0 * EDGE + 2.0 * ROW * (channels.len() as f64 + 1.0));
    let ratios = |p: &ChannelProof| [p.rmse_baseline / p.noise_sd, p.rmse_corrected / p.noise_sd];
    let greatest = channels.values().flat_map(ratios).fold(10.0, f64::max);
    let room = WIDTH - LABELS - 2.0 * EDGE - 60.0;
    let (low, high) = (0.5f64.log10(), greatest.log10());
    let x = |ratio: f64| LABELS + room * ((ratio.max(0.5).log10() - low) / (high - low));
    for (i, (column, proof)) in channels.iter().enumerate() {
        let y = EDGE + 2.0 * ROW * i as f64;
        label(&mut svg, y + ROW / 2.0, column);
        for (k, (ratio, colour)) in ratios(proof).into_iter().zip([VERMILION, BLUE]).enumerate() {
            let y = y + ROW * 0.85 * k as f64;
            svg.fill(Rect { x: LABELS, y: y + 3.0, width: x(ratio) - LABELS, height: ROW - 7.0 }, colour, 0.8);
            svg.text((x(ratio) + 6.0, y + 15.0), Anchor::Start, TEXT, &format!("{ratio:.2}"));
        }
    }
    let bottom = EDGE + 2.0 * ROW * channels.len() as f64;
    svg.line((x(1.0), EDGE), (x(1.0), bottom), GREY, 1.0);
    svg.text((x(1.0), bottom + 14.0), Anchor::Middle, TEXT, "noise");
    let mut at = LABELS + 60.0;
    for (text, colour) in [("calibrated scene", VERMILION), ("corrected scene", BLUE)] {
        svg.fill(Rect { x: at, y: bottom + 22.0, width: 12.0, height: 12.0 }, colour, 0.8);
        svg.text((at + 18.0, bottom + 32.0), Anchor::Start, TEXT, text);
        at += 40.0 + text_width(text, TEXT);
    }
    svg.text((at + 10.0, bottom + 32.0), Anchor::Start, TEXT, "error of sealed runs in units of the noise (log)");
    svg.finish()
}
