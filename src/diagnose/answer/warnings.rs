//! Warnings that several runs share, in one line.

/// Files named in a line; the others are counted.
const NAMED: usize = 2;

/// The warnings with those that say the same of several files (`FILE: TEXT`) put together, each where the first of them
/// stood.
pub(in crate::diagnose) fn together(files: &[&str], warnings: &[String]) -> Vec<String> {
    let mut lines: Vec<(Vec<&str>, &str)> = Vec::new();
    for warning in warnings {
        let mut own = files.iter().copied();
        let of_file = own.find_map(|file| Some((file, warning.strip_prefix(file)?.strip_prefix(": ")?)));
        let Some((file, text)) = of_file else {
            lines.push((Vec::new(), warning));
            continue;
        };
        match lines.iter_mut().find(|(known, own)| !known.is_empty() && *own == text) {
            Some((known, _)) if known.contains(&file) => {}
            Some((known, _)) => known.push(file),
            None => lines.push((vec![file], text)),
        }
    }
    lines.into_iter().map(|(own, text)| line(&own, files.len(), text)).collect()
}

fn line(own: &[&str], all: usize, text: &str) -> String {
    match own {
        [] => text.to_owned(),
        _ if own.len() > NAMED && own.len() == all => format!("all {all} runs: {text}"),
        _ if own.len() > NAMED + 1 => {
            format!("{} and {} more: {text}", own[..NAMED].join(", "), own.len() - NAMED)
        }
        _ => format!("{}: {text}", own.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_several_files_is_said_once() {
        let files = ["a.csv", "b.csv", "c.csv", "d.csv", "e.csv"];
        let said = |count: usize, text: &str| -> Vec<String> {
            files[..count].iter().map(|file| format!("{file}: {text}")).collect()
        };
        let after = |warnings: &[Vec<String>]| together(&files, &warnings.concat());
        assert_eq!(after(&[said(1, "gaps")]), ["a.csv: gaps"]);
        assert_eq!(after(&[said(3, "gaps")]), ["a.csv, b.csv, c.csv: gaps"]);
        assert_eq!(after(&[said(4, "gaps")]), ["a.csv, b.csv and 2 more: gaps"]);
        let of_no_file = vec!["f.csv: gaps".to_owned()];
        assert_eq!(
            after(&[said(1, "late"), of_no_file, said(5, "gaps"), said(2, "late")]),
            ["a.csv, b.csv: late", "f.csv: gaps", "all 5 runs: gaps"]
        );
    }
}
