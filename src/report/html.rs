//! A self-contained HTML page: headings, paragraphs, tables, figures.

use super::svg::escaped;

const STYLE: &str = "body{font-family:system-ui,sans-serif;max-width:110rem;margin:2rem auto;padding:0 1rem;\
color:#222;line-height:1.5}table{display:block;overflow-x:auto;border-collapse:collapse;margin:1rem 0}th,td{border-bottom:1px solid #ccc;\
padding:.25rem .8rem;text-align:right}th:first-child,td:first-child{text-align:left}\
.remarks td{white-space:nowrap;vertical-align:top}.remarks td:nth-child(2),.remarks td:last-child,\
.remarks th:nth-child(2),.remarks th:last-child{text-align:left;white-space:normal}\
figure{margin:1.5rem 0}figure svg{max-width:100%;height:auto}figcaption{color:#444}";

/// A page in the making. All text is escaped; only figures are taken as they are.
///
/// ```
/// use smam::report::HtmlPage;
///
/// let mut page = HtmlPage::new("Bench");
/// page.heading("Fit").paragraph("p < 1 MPa");
/// page.table(&["run", "RMSE, mm"], &[vec!["sine".to_owned(), "0.03".to_owned()]]);
/// let text = page.finish();
/// assert!(text.contains("<h2>Fit</h2>") && text.contains("p &lt; 1 MPa") && text.contains("<td>0.03</td>"));
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
        self.push("h2", text)
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) -> &mut Self {
        self.push("p", text)
    }

    /// Adds a table of a header and rows of text.
    pub fn table(&mut self, header: &[&str], rows: &[Vec<String>]) -> &mut Self {
        self.table_of("", header, rows)
    }

    /// A table whose second and last columns are text that wraps; numbers between them stay on a line.
    pub fn table_of_remarks(&mut self, header: &[&str], rows: &[Vec<String>]) -> &mut Self {
        self.table_of(" class=\"remarks\"", header, rows)
    }

    fn table_of(&mut self, class: &str, header: &[&str], rows: &[Vec<String>]) -> &mut Self {
        self.body.push_str(&format!("<table{class}>\n<tr>"));
        for name in header {
            self.body.push_str(&format!("<th>{}</th>", escaped(name)));
        }
        for row in rows {
            self.body.push_str("</tr>\n<tr>");
            for cell in row {
                self.body.push_str(&format!("<td>{}</td>", escaped(cell)));
            }
        }
        self.body.push_str("</tr>\n</table>\n");
        self
    }

    /// Adds an SVG of this module with a caption.
    pub fn figure(&mut self, svg: &str, caption: &str) -> &mut Self {
        self.body.push_str(&format!("<figure>\n{svg}<figcaption>{}</figcaption>\n</figure>\n", escaped(caption)));
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

    fn push(&mut self, tag: &str, text: &str) -> &mut Self {
        self.body.push_str(&format!("<{tag}>{}</{tag}>\n", escaped(text)));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn page_is_whole_and_escaped() {
        let mut page = HtmlPage::new("Rig <1>");
        page.heading("Fit").paragraph("a & b");
        page.table(&["run", "RMSE"], &[vec!["sine".into(), "0.03".into()]]);
        page.figure("<svg></svg>\n", "Figure");
        let text = page.finish();
        assert!(text.contains("<title>Rig &lt;1&gt;</title>") && text.contains("<p>a &amp; b</p>"));
        assert!(text.contains("<tr><th>run</th><th>RMSE</th></tr>\n<tr><td>sine</td><td>0.03</td></tr>"));
        assert!(text.contains("<figure>\n<svg></svg>\n<figcaption>Figure</figcaption>"));
        assert!(text.ends_with("</html>\n"));
    }
}
