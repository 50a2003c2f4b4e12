//! One plot: lines, points, bands and marks over a pair of axes. Every figure is made of these.

/// A line over x.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty: not in the legend.
    pub label: String,
    /// Its colour, as SVG writes it.
    pub colour: &'static str,
    /// Its points; a NaN cuts the line.
    pub x: Vec<f64>,
    /// As many as `x`.
    pub y: Vec<f64>,
}

/// A horizontal band, for instance of +- 2 standard deviations.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Its name in the legend; empty: not in the legend.
    pub label: String,
    /// Its colour, as SVG writes it; drawn pale.
    pub colour: &'static str,
    /// Lower edge, in units of y.
    pub low: f64,
    /// Upper edge, in units of y.
    pub high: f64,
}

/// An upright line at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its name in the legend; empty: not in the legend.
    pub label: String,
    /// Its colour, as SVG writes it.
    pub colour: &'static str,
    /// Where, in units of x.
    pub at: f64,
}

/// A plot with titles, axes, lines, points, bands and marks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// Lines of title, the first one larger; may be empty.
    pub title: Vec<String>,
    /// Text below the x axis; empty: neither text nor room for it.
    pub x_label: String,
    /// Text beside the y axis, with the unit.
    pub y_label: String,
    /// Drawn broad and first: what the lines are to be compared with.
    pub behind: Vec<Series>,
    /// Drawn in this order.
    pub series: Vec<Series>,
    /// Drawn last, a dot at each point.
    pub points: Vec<Series>,
    /// Drawn below the lines.
    pub bands: Vec<Band>,
    /// Drawn below the lines.
    pub marks: Vec<Mark>,
}

impl Panel {
    /// What has a name in the legend, with its colour and opacity.
    pub(super) fn legend(&self) -> Vec<(&str, &'static str, f64)> {
        let lines = self.all().map(|s| (s.label.as_str(), s.colour, 1.0));
        let marks = self.marks.iter().map(|m| (m.label.as_str(), m.colour, 1.0));
        let bands = self.bands.iter().map(|b| (b.label.as_str(), b.colour, 0.25));
        lines.chain(marks).chain(bands).filter(|(label, ..)| !label.is_empty()).collect()
    }

    /// Lines and points, in the order of drawing.
    pub(super) fn all(&self) -> impl Iterator<Item = &Series> {
        self.behind.iter().chain(&self.series).chain(&self.points)
    }
}
