//! The page's script, and the library that draws its plots.

/// uPlot with its licence, which asks to be in every copy.
pub(super) const UPLOT_SCRIPT: &str =
    concat!("/*\n", include_str!("uplot/LICENSE"), "*/\n", include_str!("uplot/uPlot.iife.min.js"), "\n");
pub(super) const UPLOT_STYLE: &str = concat!(include_str!("uplot/uPlot.min.css"), "\n");

/// One function around all parts: they share their names, and leave none behind.
pub(super) const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("script/text.js"),
    include_str!("script/theme.js"),
    include_str!("script/touch.js"),
    include_str!("script/tools.js"),
    include_str!("script/curve.js"),
    include_str!("script/time_series.js"),
    include_str!("script/scatter.js"),
    include_str!("script/chooser.js"),
    include_str!("script/map.js"),
    include_str!("script/parallel.js"),
    include_str!("script/point_table.js"),
    include_str!("script/point_plots.js"),
    include_str!("script/exploration.js"),
    include_str!("script/start.js"),
    "})();\n"
);
