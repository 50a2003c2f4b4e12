//! The kit that all pages are made of: one self-contained HTML file each, with figures that one can explore. Nothing is
//! fetched: style, script, the plotting library uPlot (MIT, `uplot/LICENSE`) and the data are in the page.

mod bars;
mod decimate;
mod exploration;
mod figure;
mod heat;
mod lanes;
mod page;
mod plot;
mod rounding;
mod script;
mod text;
mod time_series;

pub use bars::{Bar, BarPanel};
pub(super) use decimate::decimate;
pub use exploration::{Exploration, Key, Measure};
pub use figure::{FIGURES, Figure};
pub use heat::HeatMap;
pub use lanes::{Lane, Window};
pub use page::{Choice, HtmlPage};
pub use plot::{Area, Plot};
pub use time_series::{Line, TimeSeries};
