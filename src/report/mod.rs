//! Figures and the HTML page: self-contained text, no fonts or scripts fetched.

mod axis;
mod bar_figure;
mod compare_figure;
mod decimate;
mod diagnosis_bars;
mod diagnosis_law;
mod diagnosis_map;
mod diagnosis_page;
mod diagnosis_words;
mod effect_figure;
mod html;
mod html_text;
mod panel;
mod quantity;
mod svg;
mod symbols;
mod thin;

pub use bar_figure::{Bar, BarPanel, bars_svg};
pub use compare_figure::{ComparedChannel, ComparedRun, compare_svg};
pub use diagnosis_page::diagnosis_page;
pub use effect_figure::{AffectedScene, effect_svg};
pub use html::HtmlPage;
pub use panel::{Band, Panel, Series, figure_svg};
pub use quantity::{Scale, quantity, to_place};
pub use svg::{BLUE, GREEN, GREY, ORANGE, PURPLE, Rect, VERMILION};
pub use symbols::greek;
