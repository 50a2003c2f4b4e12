//! Results of `--check` as JUnit XML, which CI systems read.

use smam::system::Verdict;

/// One test suite, one test case per expectation.
pub fn report(scene: &str, verdicts: &[Verdict]) -> String {
    let failures = verdicts.iter().filter(|v| !v.passed).count();
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{failures}\">\n",
        escape(scene),
        verdicts.len()
    );
    for v in verdicts {
        let message = format!("{} {} expected {}", v.value, v.unit, v.bounds);
        let body = if v.passed {
            format!("<system-out>{}</system-out>", escape(&message))
        } else {
            format!("<failure message=\"{}\"/>", escape(&message))
        };
        text +=
            &format!("  <testcase classname=\"{}\" name=\"{}\">{body}</testcase>\n", escape(scene), escape(&v.name));
    }
    text + "</testsuite>\n"
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
