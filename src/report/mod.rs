//! Pages that one can explore, and figures as SVG: self-contained text, no fonts or scripts fetched.

mod axis;
mod channel_figure;
mod colour;
mod diagnosis_law;
mod diagnosis_next;
mod diagnosis_page;
mod diagnosis_sure;
mod diagnosis_where;
mod diagnosis_words;
mod effect_figure;
mod formula;
mod kit;
mod panel;
mod panel_svg;
mod quantity;
mod svg;
mod symbols;
mod thin;

pub use channel_figure::{ComparedChannel, ComparedRun, choices};
pub use colour::{BLUE, GREEN, GREY, MEASURED, ORANGE, PURPLE, SILVER, VERMILION};
pub use diagnosis_page::diagnosis_page;
pub use effect_figure::{AffectedScene, effect_svg};
pub use kit::{
    Area, Bar, BarPanel, Choice, Exploration, FIGURES, Figure, HeatMap, HtmlPage, Key, Lane, Line, Measure, Plot,
    TimeSeries, Window,
};
pub use panel::{Band, Mark, Panel, Series};
pub use panel_svg::figure_svg;
pub use quantity::{Scale, quantity, to_place};

pub use symbols::greek;
