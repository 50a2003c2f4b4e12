//! The colours of figures.

/// Colours that stay apart for colour-blind readers (Okabe and Ito 2008).
pub const BLUE: &str = "#0072b2";
/// See [`BLUE`].
pub const VERMILION: &str = "#d55e00";
/// See [`BLUE`].
pub const GREEN: &str = "#009e73";
/// See [`BLUE`].
pub const ORANGE: &str = "#e69f00";
/// See [`BLUE`].
pub const PURPLE: &str = "#cc79a7";
/// For what stands back: residuals, axes.
pub const GREY: &str = "#444444";
/// For what is only compared with: other models, what was tried.
pub const SILVER: &str = "#bdbdbd";
/// Measured lines are broad and pale: the simulated ones lie on them and must not hide them.
pub const MEASURED: &str = "#8fc4e8";

/// What the style of a page calls them: it has others of the same name in the dark.
pub(super) const COLOUR_NAMES: [(&str, &str); 8] = [
    (BLUE, "blue"),
    (VERMILION, "vermilion"),
    (GREEN, "green"),
    (ORANGE, "orange"),
    (PURPLE, "purple"),
    (GREY, "grey"),
    (SILVER, "silver"),
    (MEASURED, "measured"),
];
