//! What a figure gives: panels to look at and rows to compare.

use serde::Serialize;

use crate::report::Panel;

/// How a number of ours stands to the printed one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Within the tolerance that the remark gives.
    Met,
    /// Within it, but a number of the rig or the plunger's trajectory was chosen for it: it tests the fit, and predicts nothing.
    Tuned,
    /// Outside of it: the remark says why.
    NotMet,
    /// Taken from the paper as an input: it cannot fail.
    Given,
    /// Nothing printed to compare with, or printed about data that nobody else has.
    Shown,
}

impl Standing {
    /// As it stands in the table.
    pub fn word(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::Tuned => "tuned",
            Self::NotMet => "not met",
            Self::Given => "given",
            Self::Shown => "shown",
        }
    }
}

/// The unit of a statement: 1 is yes, 0 is no.
pub(super) const YES_NO: &str = "yes/no";

/// One number: the paper's, ours, and what their difference is worth.
///
/// ```
/// use smam::reproduce::{Row, Standing};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let range = Row::compared("range of the loop", "mm", 26.87, 26.9, 0.1, "within 0.1 mm");
/// assert_eq!(range.standing, Standing::Met);
/// assert!((range.deviation().ok_or("both are there")? - 0.03).abs() < 1e-9);
/// // A number that the paper does not print is shown, and has nothing to deviate from.
/// assert_eq!(Row::shown("work of the loop", "mJ", 1.2, "").deviation(), None);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    pub quantity: String,
    pub unit: &'static str,
    /// As printed; none where the paper has no number.
    pub paper: Option<f64>,
    pub ours: Option<f64>,
    pub standing: Standing,
    pub remark: String,
}

impl Row {
    /// Compares with a printed number: met if the two differ by `tolerance` at most.
    pub fn compared(
        quantity: impl Into<String>,
        unit: &'static str,
        paper: f64,
        ours: f64,
        tolerance: f64,
        remark: impl Into<String>,
    ) -> Self {
        let standing = if (ours - paper).abs() <= tolerance { Standing::Met } else { Standing::NotMet };
        Self { quantity: quantity.into(), unit, paper: Some(paper), ours: Some(ours), standing, remark: remark.into() }
    }

    /// A printed statement without a tolerance, met or not by what it says.
    pub fn judged(
        quantity: impl Into<String>,
        unit: &'static str,
        paper: Option<f64>,
        ours: f64,
        met: bool,
        remark: impl Into<String>,
    ) -> Self {
        let standing = if met { Standing::Met } else { Standing::NotMet };
        Self { quantity: quantity.into(), unit, paper, ours: Some(ours), standing, remark: remark.into() }
    }

    /// A statement of the paper that holds here or does not.
    pub fn stated(quantity: impl Into<String>, holds: bool, remark: impl Into<String>) -> Self {
        Self::judged(quantity, YES_NO, Some(1.0), f64::from(u8::from(holds)), holds, remark)
    }

    /// A number of ours that the paper does not print.
    pub fn shown(quantity: impl Into<String>, unit: &'static str, ours: f64, remark: impl Into<String>) -> Self {
        Self {
            quantity: quantity.into(),
            unit,
            paper: None,
            ours: Some(ours),
            standing: Standing::Shown,
            remark: remark.into(),
        }
    }

    /// A printed number about data that are not published, with ours on the rig's own loop; or an attempt at it.
    pub fn about_other_data(
        quantity: impl Into<String>,
        unit: &'static str,
        paper: f64,
        ours: Option<f64>,
        remark: impl Into<String>,
    ) -> Self {
        let standing = Standing::Shown;
        Self { quantity: quantity.into(), unit, paper: Some(paper), ours, standing, remark: remark.into() }
    }

    /// A printed number that the scenes take over.
    pub fn given(quantity: impl Into<String>, unit: &'static str, paper: f64, remark: impl Into<String>) -> Self {
        Self {
            quantity: quantity.into(),
            unit,
            paper: Some(paper),
            ours: Some(paper),
            standing: Standing::Given,
            remark: remark.into(),
        }
    }

    /// A printed number that a scene takes over, as the scene has it: not met where it has another.
    pub fn taken(
        quantity: impl Into<String>,
        unit: &'static str,
        paper: f64,
        ours: f64,
        remark: impl Into<String>,
    ) -> Self {
        let row = Self::given(quantity, unit, paper, remark);
        let standing = if (ours - paper).abs() <= 1e-9 * paper.abs() { Standing::Given } else { Standing::NotMet };
        Self { ours: Some(ours), standing, ..row }
    }

    /// What is met because something was chosen for it.
    pub fn tuned(self) -> Self {
        let standing = if self.standing == Standing::Met { Standing::Tuned } else { self.standing };
        Self { standing, ..self }
    }

    /// Ours less the paper's.
    pub fn deviation(&self) -> Option<f64> {
        Some(self.ours? - self.paper?)
    }
}

/// One figure of the paper, made again.
#[derive(Clone, Debug, Default)]
pub struct Chapter {
    /// What was played and what there is to see, a paragraph each.
    pub text: Vec<String>,
    pub panels: Vec<Panel>,
    pub rows: Vec<Row>,
}
