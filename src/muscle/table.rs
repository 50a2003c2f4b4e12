//! The held wall's pull per Yeoh coefficient, once per geometry.

use std::ops::Mul;

use super::section::Section;
use crate::scalar::Scalar;
use num_dual::{Dual3_64, third_derivative};

/// Nodes are equidistant in 1/lambda, `STEPS` to the unit: the hoop stretch is linear in it, so the
/// cells are narrow where the wall is short and the bore nearly closed, wide where it is long.
const STEPS: f64 = 200.0;
/// First and last node in units of `1/STEPS`: lambda from 0.897 to 5, with lambda = 1 a node.
const FIRST: i32 = 223;
const LAST: i32 = 40;
/// Cells whose middle errs by more than this (share of the pull) are left to the quadrature.
const TOLERANCE: f64 = 1e-10;

/// A [`Cell`] as a row of numbers: start, one over its width, three energies, three quintics.
type Row = [f64; 23];

/// The quintics in a [`Row`], or in the rows of several numbers side by side.
#[inline]
fn pulls<E>(row: &[E; 23]) -> [&[E; 6]; 3] {
    [5, 11, 17].map(|at| row[at..].first_chunk().expect("six more numbers stand there"))
}

/// One cell: quintics in `t = (lambda - start) inverse_width`, for the three coefficients side by side.
#[derive(Clone, Debug)]
struct Cell {
    start: f64,
    inverse_width: f64,
    energy: [f64; 3],
    pull: [[f64; 6]; 3],
}

/// `I_k(lambda) = integral over the wall of (I1 - 3)^k d sigma`, k = 1, 2, 3, with the outer radius held.
///
/// The pull is `pi R_c^2 sum C_k I_k'(lambda)`. `I_k'` is a quintic Hermite interpolant with exact value, slope
/// and curvature at the nodes; `I_k''` is its derivative and `I_k` its integral, so energy, pull and stiffness
/// agree with each other to rounding and with the quadrature to 1e-9.
#[derive(Clone, Debug)]
pub(super) struct HeldTable {
    rows: Vec<Row>,
    first: f64,
}

impl HeldTable {
    pub fn new(section: &Section) -> Self {
        let nodes: Vec<i32> = (LAST..=FIRST).rev().collect();
        let mut rows = Vec::with_capacity(nodes.len());
        let mut first = nodes[0];
        for pair in nodes.windows(2) {
            let cell = Cell::new(section, stretch(pair[0]), stretch(pair[1]));
            if cell.is_exact(section) {
                rows.push(cell.row());
            } else {
                // The bore closes near here (thick walls): the table begins after it.
                rows.clear();
                first = pair[1];
            }
        }
        Self { rows, first: f64::from(first) }
    }

    #[inline]
    fn row(&self, lambda: f64) -> Option<&Row> {
        let place = self.first - STEPS / lambda;
        if lambda > 0.0 && place >= 0.0 { self.rows.get(place as usize) } else { None }
    }

    /// The table of one material in one tube: `c` times `area`, over the elongation of a tube of length `rest`.
    pub fn of_material<D: Scalar>(&self, c: &[D; 3], rest: f64, area: f64) -> MaterialTable<D> {
        let scaled = c.map(|c| c * area);
        let row = |row: &Row| -> MaterialRow<D> {
            let [start, inverse_width] = [(row[0] - 1.0) * rest, row[1] / rest].map(D::constant);
            let [p0, p1, p2, p3, p4, p5] = mix(&scaled, pulls(row));
            [start, inverse_width, p0, p1, p2, p3, p4, p5]
        };
        MaterialTable { rows: self.rows.iter().map(row).collect(), first: self.first, steps: STEPS * rest, rest }
    }

    /// `sum c_k I_k`; none outside the table.
    pub fn energy<D: Scalar>(&self, c: &[D; 3], lambda: D) -> Option<D> {
        let row = lambda.look_up_plain(|lambda| self.row(lambda))?;
        let (start, inverse_width) = (row[0], row[1]);
        let t = (lambda - start) * inverse_width;
        let mut area = D::constant(0.0);
        for (power, &p) in mix(c, pulls(&row)).iter().enumerate().rev() {
            area = (area + p / (power + 1) as f64) * t;
        }
        let [energy] = mix(c, [&[row[2]], &[row[3]], &[row[4]]]);
        Some(energy + area / inverse_width)
    }
}

/// The quintics of one cell, mixed for one material: start, one over its width, six coefficients.
type MaterialRow<D> = [D; 8];

/// Pull and stiffness of the held wall over its elongation: the innermost law of every time step, and so a table of its
/// own for every material.
#[derive(Clone, Debug)]
pub(super) struct MaterialTable<D> {
    rows: Vec<MaterialRow<D>>,
    first: f64,
    steps: f64,
    rest: f64,
}

impl<D: Scalar> MaterialTable<D> {
    /// Pull and its slope; none outside the table.
    #[inline]
    pub fn pull_and_stiffness(&self, elongation: D) -> Option<(D, D)> {
        let [start, inverse_width, p @ ..] = elongation.look_up(|elongation| self.row(elongation))?;
        let t = (elongation - start) * inverse_width;
        // Estrin's order: short chains.
        let tt = t * t;
        let pull = (p[0] + t * p[1]) + tt * ((p[2] + t * p[3]) + tt * (p[4] + t * p[5]));
        let slope = (p[1] + t * p[2] * 2.0) + tt * ((p[3] * 3.0 + t * p[4] * 4.0) + tt * p[5] * 5.0);
        Some((pull, slope * inverse_width))
    }

    #[inline]
    fn row(&self, elongation: f64) -> Option<&MaterialRow<D>> {
        let length = self.rest + elongation;
        let place = self.first - self.steps / length;
        if length > 0.0 && place >= 0.0 { self.rows.get(place as usize) } else { None }
    }
}

impl Cell {
    fn new(section: &Section, start: f64, end: f64) -> Self {
        let width = end - start;
        let (left, right) = (basis(section, start), basis(section, end));
        let pull = std::array::from_fn(|k| {
            quintic([left[k], right[k]].map(|[_, g, slope, curvature]| [g, slope * width, curvature * width * width]))
        });
        Self { start, inverse_width: width.recip(), energy: left.map(|values| values[0]), pull }
    }

    fn row(&self) -> Row {
        let numbers = [self.start, self.inverse_width].into_iter().chain(self.energy);
        let mut row = [0.0; 23];
        let all = numbers.chain(self.pull.as_flattened().iter().copied());
        row.iter_mut().zip(all).for_each(|(to, number)| *to = number);
        row
    }

    /// Whether the middle of the cell agrees with the quadrature.
    fn is_exact(&self, section: &Section) -> bool {
        let exact = basis(section, self.start + 0.5 / self.inverse_width);
        // Powers of (I1 - 3) vanish faster than the first at lambda = 1, where they carry no load.
        let scale = exact[0][1].abs();
        (0..3).all(|k| {
            let middle = self.pull[k].iter().rev().fold(0.0, |sum, c| sum * 0.5 + c);
            (middle - exact[k][1]).abs() <= TOLERANCE * (scale + exact[k][1].abs())
        })
    }
}

fn stretch(node: i32) -> f64 {
    STEPS / f64::from(node)
}

/// `sum over k of c_k rows_k`, entry by entry.
#[inline]
fn mix<D: Scalar + Mul<E, Output = D>, E: Copy, const N: usize>(c: &[D; 3], rows: [&[E; N]; 3]) -> [D; N] {
    std::array::from_fn(|i| c[0] * rows[0][i] + c[1] * rows[1][i] + c[2] * rows[2][i])
}

/// `I_k` and its first three derivatives, k = 1, 2, 3.
fn basis(section: &Section, lambda: f64) -> [[f64; 4]; 3] {
    [1, 2, 3].map(|k| {
        section.integrate(|sigma| {
            let power = |l: Dual3_64| Scalar::powi(&held_invariant(l, sigma), k);
            let (value, d1, d2, d3) = third_derivative(power, lambda);
            [value, d1, d2, d3]
        })
    })
}

/// `I1 - 3` of the ring at `sigma`, outer radius held.
pub(super) fn held_invariant<D: Scalar>(lambda: D, sigma: f64) -> D {
    let hoop = (-(lambda.recip() * (1.0 - sigma)) + 1.0) / sigma;
    let axial = lambda * lambda;
    axial + hoop + (axial * hoop).recip() - 3.0
}

/// Coefficients of the quintic on [0, 1] with value, slope and curvature given at both ends.
fn quintic([[f0, s0, c0], [f1, s1, c1]]: [[f64; 3]; 2]) -> [f64; 6] {
    let value = f1 - f0 - s0 - 0.5 * c0;
    let slope = s1 - s0 - c0;
    let curvature = c1 - c0;
    [
        f0,
        s0,
        0.5 * c0,
        10.0 * value - 4.0 * slope + 0.5 * curvature,
        -15.0 * value + 7.0 * slope - curvature,
        6.0 * value - 3.0 * slope + 0.5 * curvature,
    ]
}
