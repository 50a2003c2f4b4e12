//! A report in Markdown as a page: headings, tables, paragraphs.

use smam::report::HtmlPage;

/// Adds a report as our own commands write them.
pub fn add_markdown(page: &mut HtmlPage, text: &str) {
    let mut table: Vec<Vec<String>> = Vec::new();
    for line in text.lines().chain([""]) {
        if let Some(row) = line.trim().strip_prefix('|') {
            table.push(row.trim_end_matches('|').split('|').map(|cell| plain(cell.trim())).collect());
            continue;
        }
        add_table(page, &std::mem::take(&mut table));
        match line.trim_start_matches('#').trim() {
            "" => {}
            words if line.starts_with("## ") || line.starts_with("# ") => {
                page.heading(&plain(words));
            }
            words if line.starts_with('#') => {
                page.subheading(&plain(words));
            }
            words => {
                page.paragraph(&plain(words));
            }
        }
    }
}

fn add_table(page: &mut HtmlPage, rows: &[Vec<String>]) {
    // The second line tells heads from rows.
    let is_rule = |row: &Vec<String>| row.iter().all(|cell| cell.chars().all(|c| matches!(c, '-' | ':')));
    if let Some((head, rows)) = rows.split_first() {
        let heads: Vec<&str> = head.iter().map(String::as_str).collect();
        page.table(&heads, &rows.iter().filter(|row| !is_rule(row)).cloned().collect::<Vec<_>>());
    }
}

/// Without the marks of bold type.
fn plain(text: &str) -> String {
    text.replace("**", "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_tables_and_paragraphs_are_told_apart() {
        let mut page = HtmlPage::new("Proof");
        add_markdown(&mut page, "### By rig\n\n| rig | right |\n|---|---|\n| bench | 3 of **4** |\n\nRead <this>.\n");
        let text = page.finish();
        for part in [
            "<h3>By rig</h3>",
            "<th class=\"l\">rig</th><th>right</th>",
            "<td>3 of 4</td>",
            "<p>Read &lt;this&gt;.</p>",
        ] {
            assert!(text.contains(part), "{part} in {text}");
        }
        assert!(!text.contains("---"));
    }
}
