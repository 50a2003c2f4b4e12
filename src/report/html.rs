//! A self-contained HTML page: headings, paragraphs, tables, figures. It must be readable on a phone: what is wide
//! scrolls in a box of its own, and no number is broken.

use super::html_text::{code_marked, looks_like_number, svg_width};
use super::svg::escaped;

const STYLE: &str = "*{box-sizing:border-box}body{font-family:system-ui,sans-serif;max-width:110rem;margin:2rem auto;padding:0 1rem;\
color:#222;line-height:1.5}h1{font-size:1.7rem;line-height:1.25;margin:.5rem 0}h2{font-size:1.25rem;margin:2rem 0 .5rem}\
h1,h2,p,figcaption{overflow-wrap:anywhere}p,figcaption{max-width:52rem}.small{font-size:.8rem;color:#666;margin:.2rem 0}\
.first{border-left:.4rem solid #d55e00;background:#f6f3ee;padding:.7rem 1rem;font-size:1.05rem}.first.good{border-color:#009e73}\
.box{overflow-x:auto;max-width:100%;margin:1rem 0}table{border-collapse:collapse}\
th,td{border-bottom:1px solid #ccc;padding:.25rem .8rem;text-align:right;vertical-align:top;white-space:nowrap}\
th:first-child,td:first-child{padding-left:0}.l{text-align:left}td.w{white-space:normal;min-width:18rem}\
code{background:#f0f0f0;padding:0 .2em}figure{margin:1.5rem 0}figure svg{display:block;width:100%;height:auto}figcaption{color:#444}\
@media(max-width:40rem){body{margin:.5rem auto;padding:0 .6rem}h1{font-size:1.35rem}th,td{padding:.25rem .5rem;font-size:.9rem}\
td.w{min-width:14rem}}";

/// A figure is not shown smaller than this share of its own size: its text of 11 px stays above 9 px.
const LEAST_SCALE: f64 = 0.85;
/// A column with a text longer than this (letters) wraps.
const WRAPS_FROM: usize = 48;

/// A page in the making. All text is escaped, `code` between backticks is marked; only figures are taken as they are.
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
}

impl HtmlPage {
    /// A page with a title, which is its first heading too.
    pub fn new(title: &str) -> Self {
        let title = escaped(title);
        Self { body: format!("<h1>{title}</h1>\n"), title }
    }

    /// Adds a heading.
    pub fn heading(&mut self, text: &str) -> &mut Self {
        self.push("h2", "", text)
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) -> &mut Self {
        self.push("p", "", text)
    }

    /// Adds a paragraph in small type: where something came from.
    pub fn small(&mut self, text: &str) -> &mut Self {
        self.push("p", " class=\"small\"", text)
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

    /// Adds an SVG of this module with a caption. Where the window is too narrow for its text it scrolls sideways.
    pub fn figure(&mut self, svg: &str, caption: &str) -> &mut Self {
        let room = svg_width(svg).map_or(String::new(), |width| {
            format!(" style=\"min-width:{:.0}px;max-width:{width:.0}px\"", LEAST_SCALE * width)
        });
        let caption = code_marked(caption);
        self.body.push_str(&format!(
            "<figure>\n<div class=\"box\"><div{room}>\n{svg}</div></div>\n<figcaption>{caption}</figcaption>\n</figure>\n"
        ));
        self
    }

    /// The page as text.
    pub fn finish(&self) -> String {
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
            self.title, self.body
        )
    }

    fn push(&mut self, tag: &str, class: &str, text: &str) -> &mut Self {
        self.body.push_str(&format!("<{tag}{class}>{}</{tag}>\n", code_marked(text)));
        self
    }
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

    #[test]
    fn page_is_whole_and_escaped() {
        let mut page = HtmlPage::new("Rig <1>");
        page.heading("Fit").paragraph("a & b, see `smam run`");
        page.verdict("adequate", "nothing <is> missing", true);
        page.figure("<svg></svg>\n", "Figure");
        let text = page.finish();
        assert!(text.contains("<title>Rig &lt;1&gt;</title>"));
        assert!(text.contains("<p>a &amp; b, see <code>smam run</code></p>"));
        assert!(text.contains("<p class=\"first good\"><strong>adequate</strong> nothing &lt;is&gt; missing</p>"));
        assert!(text.contains("<svg></svg>\n</div></div>\n<figcaption>Figure</figcaption>"));
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

    #[test]
    fn a_wide_figure_scrolls_in_its_box_instead_of_shrinking() {
        let mut page = HtmlPage::new("");
        page.figure("<svg xmlns=\"x\" width=\"1000\" height=\"10\"></svg>", "");
        assert!(page.finish().contains("<div class=\"box\"><div style=\"min-width:850px;max-width:1000px\">"));
    }
}
