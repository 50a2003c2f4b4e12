//! A self-contained HTML page: headings, paragraphs, tables, figures. It must be readable on a phone and on paper: what is
//! wide scrolls in a box of its own, and no number is broken.

use super::bars::BarPanel;
use super::figure::{Embedded, Figure, as_json};
use super::heat::HeatMap;
use super::lanes::{self, Lane};
use super::plot::Plot;
use super::script::{SCRIPT, UPLOT_SCRIPT, UPLOT_STYLE};
use super::text::{code_marked, escaped, looks_like_number};
use crate::report::Panel;

const STYLE: &str = include_str!("style.css");
/// The page may run its own script and nothing else, and fetch nothing.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";
/// A column with a text longer than this (letters) wraps.
const WRAPS_FROM: usize = 48;

/// A page in the making. All text is escaped, `code` between backticks is marked.
///
/// ```
/// use smam::report::HtmlPage;
///
/// let mut page = HtmlPage::new("Bench");
/// page.heading("Fit").paragraph("p < 1 MPa");
/// page.table(&["run", "RMSE, mm"], &[vec!["sine".to_owned(), "0.03".to_owned()]]);
/// let text = page.finish();
/// assert!(text.contains("<h2>Fit</h2>") && text.contains("p &lt; 1 MPa") && text.contains("0.03"));
/// ```
#[derive(Clone, Debug)]
pub struct HtmlPage {
    title: String,
    body: String,
    figures: Vec<Embedded>,
    files: Vec<(String, String)>,
}

/// A figure of a chooser: one run, one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    pub run: String,
    pub channel: String,
    pub caption: String,
    pub figure: Figure,
}

impl HtmlPage {
    /// A page with a title, which is its first heading too.
    pub fn new(title: &str) -> Self {
        let title = escaped(title);
        Self { body: format!("<h1>{title}</h1>\n"), title, figures: Vec::new(), files: Vec::new() }
    }

    /// Adds a heading.
    pub fn heading(&mut self, text: &str) -> &mut Self {
        self.push("h2", "", text)
    }

    /// Adds a heading within a section.
    pub fn subheading(&mut self, text: &str) -> &mut Self {
        self.push("h3", "", text)
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) -> &mut Self {
        self.push("p", "", text)
    }

    /// Adds a paragraph in small type: where something came from.
    pub fn small(&mut self, text: &str) -> &mut Self {
        self.push("p", " class=\"small\"", text)
    }

    /// Adds a formula.
    pub fn law(&mut self, text: &str) -> &mut Self {
        self.push("p", " class=\"law\"", text)
    }

    /// Adds the line that a reader takes along who reads no other: a word in bold and a text. Green if it `is_good`.
    pub fn verdict(&mut self, word: &str, text: &str, is_good: bool) -> &mut Self {
        let class = if is_good { "first good" } else { "first" };
        let (word, text) = (escaped(word), code_marked(text));
        self.body.push_str(&format!("<p class=\"{class}\"><strong>{word}</strong> {text}</p>\n"));
        self
    }

    /// Adds a table of a header and rows. Columns of numbers stand at the right, columns of text at the left; long text
    /// wraps, nothing else does.
    pub fn table(&mut self, header: &[&str], rows: &[Vec<String>]) -> &mut Self {
        let columns: Vec<[&str; 2]> = (0..header.len()).map(|c| classes(rows, c)).collect();
        let class = |c: usize, of: usize| columns.get(c).map_or("", |column| column[of]);
        self.body.push_str("<div class=\"box\"><table>\n<tr>");
        for (c, name) in header.iter().enumerate() {
            self.body.push_str(&format!("<th{}>{}</th>", class(c, 0), escaped(name)));
        }
        for row in rows {
            self.body.push_str("</tr>\n<tr>");
            for (c, cell) in row.iter().enumerate() {
                self.body.push_str(&format!("<td{}>{}</td>", class(c, 1), code_marked(cell)));
            }
        }
        self.body.push_str("</tr>\n</table></div>\n");
        self
    }

    /// Adds a figure that a reader can explore.
    pub fn figure(&mut self, figure: impl Into<Figure>, caption: &str) -> &mut Self {
        self.embed(&figure.into(), caption, "")
    }

    /// Adds plots, beside each other where there is room, with a caption for all of them.
    pub fn panels(&mut self, panels: &[Panel], caption: &str) -> &mut Self {
        self.grid(|page| {
            panels.iter().for_each(|panel| {
                page.figure(Plot::from(panel), "");
            });
        });
        if caption.is_empty() { self } else { self.small(caption) }
    }

    /// Adds figures beside each other where there is room.
    pub fn grid(&mut self, fill: impl FnOnce(&mut Self)) -> &mut Self {
        self.body.push_str("<div class=\"grid\">\n");
        fill(self);
        self.body.push_str("</div>\n");
        self
    }

    /// Adds figures of which the reader sees one, by a press on its run and its channel; the figure of number `shown` first.
    pub fn chooser(&mut self, choices: &[Choice], shown: usize) -> &mut Self {
        let Some(first) = choices.get(shown).or(choices.first()) else { return self };
        let (runs, channels) = (names(choices, |c| &c.run), names(choices, |c| &c.channel));
        self.body.push_str("<div class=\"chooser\">\n");
        self.body.push_str(&buttons("run", &runs, &first.run));
        self.body.push_str(&buttons("channel", &channels, &first.channel));
        for choice in choices {
            let place = |all: &[&str], name: &str| all.iter().position(|n| *n == name).unwrap_or(0);
            let (run, channel) = (place(&runs, &choice.run), place(&channels, &choice.channel));
            let hidden = if std::ptr::eq(choice, first) { "" } else { " hidden" };
            let more = format!(" data-run=\"{run}\" data-channel=\"{channel}\"{hidden}");
            self.embed(&choice.figure, &choice.caption, &more);
        }
        self.body.push_str("<p class=\"absent\" hidden>This run has no such channel.</p>\n</div>\n");
        self
    }

    /// Adds runs as lines over time; a press on a marked stretch shows it in the chooser, whose runs have the same order.
    pub fn lanes(&mut self, lanes: &[Lane]) -> &mut Self {
        self.body.push_str(&lanes::html(lanes));
        self
    }

    /// Adds bars with a caption.
    pub fn bars(&mut self, panel: &BarPanel, caption: &str) -> &mut Self {
        self.drawn_by_style("bars", &panel.html(), caption)
    }

    /// Adds a map of numbers with a caption.
    pub(crate) fn heat_map(&mut self, map: &HeatMap, caption: &str) -> &mut Self {
        self.drawn_by_style("map", &map.html(), caption)
    }

    /// Adds what is folded until a reader asks for it.
    pub fn folded(&mut self, title: &str, fill: impl FnOnce(&mut Self)) -> &mut Self {
        self.body.push_str(&format!("<details><summary>{}</summary>\n", escaped(title)));
        fill(self);
        self.body.push_str("</details>\n");
        self
    }

    /// The page as text.
    pub fn finish(&self) -> String {
        let [uplot_style, uplot] = if self.figures.is_empty() { ["", ""] } else { [UPLOT_STYLE, UPLOT_SCRIPT] };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <title>{}</title>\n<style>\n{uplot_style}{STYLE}</style>\n</head>\n<body>\n{}\
             <noscript><p>The figures of this page are drawn by its script, which this browser does not run.</p></noscript>\n\
             <script type=\"application/json\" id=\"figures\">{}</script>\n\
             <script>\n{uplot}</script>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n",
            self.title,
            self.body,
            as_json(&self.figures)
        )
    }

    /// Files that belong beside the page, path and text: all samples of what the page shows in part.
    pub fn files(&self) -> &[(String, String)] {
        &self.files
    }

    fn push(&mut self, tag: &str, class: &str, text: &str) -> &mut Self {
        self.body.push_str(&format!("<{tag}{class}>{}</{tag}>\n", code_marked(text)));
        self
    }

    fn embed(&mut self, figure: &Figure, caption: &str, attributes: &str) -> &mut Self {
        let number = self.figures.len();
        let (embedded, beside) = Embedded::of(figure, number);
        self.figures.push(embedded);
        self.files.extend(beside);
        let caption = code_marked(caption);
        self.body.push_str(&format!(
            "<figure class=\"chart\" data-figure=\"{number}\"{attributes}><figcaption>{caption}</figcaption></figure>\n"
        ));
        self
    }

    fn drawn_by_style(&mut self, name: &str, html: &str, caption: &str) -> &mut Self {
        let caption = code_marked(caption);
        self.body.push_str(&format!(
            "<figure class=\"table\" data-file=\"{name}.csv\">\n{html}<figcaption>{caption}</figcaption></figure>\n"
        ));
        self
    }
}

/// Each name once, in the order in which they come.
fn names<'a>(choices: &'a [Choice], name: impl Fn(&'a Choice) -> &'a String) -> Vec<&'a str> {
    let mut found: Vec<&'a str> = Vec::new();
    for choice in choices {
        if !found.contains(&name(choice).as_str()) {
            found.push(name(choice));
        }
    }
    found
}

fn buttons(axis: &str, names: &[&str], pressed: &str) -> String {
    let button = |(i, name): (usize, &&str)| {
        format!(
            "<button data-axis=\"{axis}\" data-value=\"{i}\" aria-pressed=\"{}\">{}</button>",
            *name == pressed,
            escaped(name)
        )
    };
    let all: String = names.iter().enumerate().map(button).collect();
    format!("<div class=\"choices\"><span>{axis}</span>{all}</div>\n")
}

/// Classes of a column's head and cells.
fn classes(rows: &[Vec<String>], column: usize) -> [&'static str; 2] {
    let cells = || rows.iter().filter_map(|row| row.get(column)).filter(|cell| !cell.is_empty());
    let is_numbers = column > 0 && cells().all(|cell| looks_like_number(cell));
    let wraps = cells().any(|cell| cell.chars().count() > WRAPS_FROM);
    match (is_numbers, wraps) {
        (true, _) => ["", ""],
        (false, false) => [" class=\"l\""; 2],
        (false, true) => [" class=\"l\"", " class=\"l w\""],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{BLUE, Series};

    #[test]
    fn page_is_whole_and_escaped() {
        let mut page = HtmlPage::new("Rig <1>");
        page.heading("Fit").paragraph("a & b, see `smam run`");
        page.verdict("adequate", "nothing <is> missing", true);
        let text = page.finish();
        assert!(text.contains("<title>Rig &lt;1&gt;</title>"));
        assert!(text.contains("<p>a &amp; b, see <code>smam run</code></p>"));
        assert!(text.contains("<p class=\"first good\"><strong>adequate</strong> nothing &lt;is&gt; missing</p>"));
        // Without a figure the plotting library is not in it.
        assert!(!text.contains("Permission is hereby granted") && text.contains("default-src 'none'"));
        assert!(text.ends_with("</html>\n"));
    }

    #[test]
    fn numbers_stand_right_text_left_and_long_text_wraps() {
        let mut page = HtmlPage::new("");
        let long = "because the loop is wider than what the paper's printed model has";
        let cells = |name: &str, rmse: &str| vec![name.to_owned(), rmse.to_owned(), long.to_owned()];
        page.table(&["run", "RMSE", "remark"], &[cells("sine", "0.03 mm"), cells("2", "-1.2e-3")]);
        let text = page.finish();
        assert!(text.contains("<th class=\"l\">run</th><th>RMSE</th><th class=\"l\">remark</th>"));
        assert!(text.contains("<td class=\"l\">sine</td><td>0.03 mm</td><td class=\"l w\">because"));
    }

    fn curve(label: &str) -> Panel {
        let series = Series { label: label.to_owned(), colour: BLUE, x: vec![0.0, 1.0], y: vec![2.0, 3.0] };
        Panel { title: vec![label.to_owned()], series: vec![series], ..Panel::default() }
    }

    #[test]
    fn figures_are_data_and_a_place_and_the_licence_comes_with_the_library() {
        let mut page = HtmlPage::new("");
        page.panels(&[curve("one"), curve("</script>")], "Two <plots>");
        let text = page.finish();
        assert!(text.contains(r#"<figure class="chart" data-figure="1">"#) && text.contains("Two &lt;plots&gt;"));
        assert!(text.contains(r#"[{"type":"Curve","title":"one""#) && text.contains("\\u003c/script\\u003e"));
        assert!(text.contains("Permission is hereby granted") && page.files().is_empty());
        // As many ends as elements: data, library, our own script.
        assert_eq!(text.matches("</script>").count(), 3);
        assert_eq!(text, page.clone().finish());
    }

    #[test]
    fn a_chooser_shows_its_first_figure_and_names_all() {
        let choice = |run: &str, channel: &str| Choice {
            run: run.to_owned(),
            channel: channel.to_owned(),
            caption: String::new(),
            figure: Plot::from(&curve(run)).into(),
        };
        let mut page = HtmlPage::new("");
        page.chooser(&[choice("a\"b", "x"), choice("a\"b", "y"), choice("c", "y")], 0);
        let text = page.finish();
        assert!(text.contains(r#"data-axis="run" data-value="0" aria-pressed="true">a&quot;b<"#));
        assert!(text.contains(r#"data-figure="0" data-run="0" data-channel="0"><"#));
        assert!(text.contains(r#"data-figure="2" data-run="1" data-channel="1" hidden><"#));
        let mut page = HtmlPage::new("");
        page.chooser(&[choice("a", "x"), choice("a", "y")], 1);
        let text = page.finish();
        assert!(text.contains(r#"data-run="0" data-channel="0" hidden><"#));
        assert!(text.contains(r#"data-axis="channel" data-value="1" aria-pressed="true">y<"#));
    }

    #[test]
    fn a_long_figure_has_a_file_beside_the_page() {
        let x: Vec<f64> = (0..9000).map(f64::from).collect();
        let series = Series { label: "long".to_owned(), colour: BLUE, y: x.clone(), x };
        let mut page = HtmlPage::new("");
        page.panels(&[Panel { title: vec!["Long".to_owned()], series: vec![series], ..Panel::default() }], "");
        let [(path, csv)] = page.files() else { panic!("{:?}", page.files().len()) };
        assert_eq!((path.as_str(), csv.lines().count()), ("figures/1_Long.csv", 9001));
        assert!(page.finish().contains(r#""whole":"figures/1_Long.csv""#));
    }
}
