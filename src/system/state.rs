//! The state of a plant: one row of numbers, so that a step of all of them is one loop.

use crate::hydraulics::ChainRow;
use crate::scalar::Scalar;

/// State of a [`super::Plant`].
#[derive(Clone, Debug, PartialEq)]
pub struct PlantState<D> {
    /// What is integrated, in the order of [`Layout`].
    pub(super) row: Vec<D>,
    pub(super) layout: Layout,
    /// Whether a node of a line boils: its pressure then stays and its vapour volume moves. Changed between steps only.
    boiling: Vec<bool>,
    /// Of each muscle: the greatest energy of its wall so far, J, and how far its piston is ahead of the plunger, m.
    pub(super) greatest_j: Vec<D>,
    pub(super) piston_ahead_m: Vec<D>,
}

/// Where everything stands in the row: coordinates, their rates, friction states of the muscles, lines of the muscles,
/// dry frictions of the mechanism and the cables, slow states of the effects.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    dim: usize,
    /// Of each muscle, and once more at the end: where its line begins, in the row and among the nodes.
    lines: Vec<LineAt>,
    slow_at: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct LineAt {
    number: usize,
    node: usize,
}

/// A row to be read. `N` is the number of coordinates where that is known when compiling, else 0 ([`sized`]).
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts<'a, D, const N: usize = 0> {
    row: &'a [D],
    layout: &'a Layout,
}

/// The same to be written.
#[derive(Debug)]
pub(super) struct PartsMut<'a, D, const N: usize = 0> {
    row: &'a mut [D],
    layout: &'a Layout,
}

/// The slice itself, which has `N` entries: a length the compiler can see, so that short loops over it cost no more than
/// what is in them. `N` = 0: any length.
#[inline(always)]
pub(super) fn sized<const N: usize, T>(slice: &[T]) -> &[T] {
    if N == 0 { slice } else { &slice[..N] }
}

/// [`sized`], to be written.
#[inline(always)]
pub(super) fn sized_mut<const N: usize, T>(slice: &mut [T]) -> &mut [T] {
    if N == 0 { slice } else { &mut slice[..N] }
}

impl Layout {
    fn muscles(&self) -> usize {
        self.lines.len() - 1
    }

    /// Where the dry frictions begin.
    #[inline]
    fn joint_z_at(&self) -> usize {
        self.lines[self.muscles()].number
    }

    #[inline]
    fn dim<const N: usize>(&self) -> usize {
        if N == 0 { self.dim } else { N }
    }

    #[inline]
    fn line(&self, muscle: usize) -> std::ops::Range<usize> {
        self.lines[muscle].number..self.lines[muscle + 1].number
    }

    #[inline]
    pub fn parts<'a, D, const N: usize>(&'a self, row: &'a [D]) -> Parts<'a, D, N> {
        Parts { row, layout: self }
    }

    #[inline]
    pub fn parts_mut<'a, D, const N: usize>(&'a self, row: &'a mut [D]) -> PartsMut<'a, D, N> {
        PartsMut { row, layout: self }
    }
}

impl<'a, D: Copy, const N: usize> Parts<'a, D, N> {
    /// Coordinates.
    #[inline]
    pub fn y(&self) -> &'a [D] {
        &self.row[..self.layout.dim::<N>()]
    }

    /// Rates of the coordinates.
    #[inline]
    pub fn w(&self) -> &'a [D] {
        let n = self.layout.dim::<N>();
        sized::<N, D>(&self.row[n..2 * n])
    }

    /// Friction state of a muscle, -1..=1 for the stock law.
    #[inline]
    pub fn z(&self, muscle: usize) -> D {
        self.row[2 * self.layout.dim::<N>() + muscle]
    }

    /// The row of a muscle's line; without segments where the pressure is recorded.
    #[inline]
    pub fn line(&self, muscle: usize) -> &'a [D] {
        &self.row[self.layout.line(muscle)]
    }

    /// Frictions of the mechanism, then the sliding state of each cable.
    #[inline]
    pub fn joint_z(&self) -> &'a [D] {
        &self.row[self.layout.joint_z_at()..self.layout.slow_at]
    }

    /// Slow states of all muscles' effects, m.
    #[inline]
    pub fn slow(&self) -> &'a [D] {
        &self.row[self.layout.slow_at..]
    }
}

impl<D: Copy, const N: usize> PartsMut<'_, D, N> {
    #[inline]
    pub fn y_and_w(&mut self) -> (&mut [D], &mut [D]) {
        let n = self.layout.dim::<N>();
        let (y, rest) = self.row.split_at_mut(n);
        (sized_mut::<N, D>(y), &mut rest[..n])
    }

    #[inline]
    pub fn w(&mut self) -> &mut [D] {
        let n = self.layout.dim::<N>();
        sized_mut::<N, D>(&mut self.row[n..2 * n])
    }

    #[inline]
    pub fn z(&mut self, muscle: usize) -> &mut D {
        &mut self.row[2 * self.layout.dim::<N>() + muscle]
    }

    #[inline]
    pub fn line(&mut self, muscle: usize) -> &mut [D] {
        &mut self.row[self.layout.line(muscle)]
    }

    #[inline]
    pub fn joint_z(&mut self) -> &mut [D] {
        &mut self.row[self.layout.joint_z_at()..self.layout.slow_at]
    }

    #[inline]
    pub fn slow(&mut self) -> &mut [D] {
        &mut self.row[self.layout.slow_at..]
    }
}

impl<D: Scalar> PlantState<D> {
    /// At rest at the coordinates `y`, without muscles yet.
    pub(super) fn at_rest(y: &[D]) -> Self {
        let mut row = y.to_vec();
        row.resize(2 * y.len(), D::constant(0.0));
        let end = LineAt { number: row.len(), node: 0 };
        Self {
            layout: Layout { dim: y.len(), lines: vec![end], slow_at: row.len() },
            row,
            boiling: Vec::new(),
            greatest_j: Vec::new(),
            piston_ahead_m: Vec::new(),
        }
    }

    /// One muscle more, with the row of its line; before effects are given any memory.
    pub(super) fn add_muscle(&mut self, line: &[D], segments: usize) {
        let Layout { dim, lines, slow_at } = &mut self.layout;
        self.row.insert(2 * *dim + lines.len() - 1, D::constant(0.0));
        lines.iter_mut().for_each(|l| l.number += 1);
        self.row.extend_from_slice(line);
        self.boiling.resize(self.boiling.len() + segments + 1, false);
        lines.push(LineAt { number: self.row.len(), node: self.boiling.len() });
        *slow_at = self.row.len();
        self.greatest_j.push(D::constant(0.0));
        self.piston_ahead_m.push(D::constant(0.0));
    }

    /// The same muscles at rest on other coordinates.
    pub(super) fn on_coordinates(&self, y: &[D]) -> Self {
        let mut state = Self::at_rest(y);
        for muscle in 0..self.layout.muscles() {
            state.add_muscle(self.parts().line(muscle), self.boiling(muscle).len() - 1);
        }
        state
    }

    /// Gives the effects their memory: nothing slides, and the slow states are those given.
    pub(super) fn set_memory(&mut self, dry_frictions: usize, slow: &[D]) {
        self.row.truncate(self.layout.joint_z_at());
        self.row.resize(self.row.len() + dry_frictions, D::constant(0.0));
        self.layout.slow_at = self.row.len();
        self.row.extend_from_slice(slow);
        self.greatest_j.fill(D::constant(0.0));
        self.piston_ahead_m.fill(D::constant(0.0));
    }

    #[inline]
    pub(super) fn parts(&self) -> Parts<'_, D> {
        self.layout.parts(&self.row)
    }

    /// Coordinates.
    pub fn y(&self) -> &[D] {
        self.parts().y()
    }

    /// Rates of the coordinates.
    pub fn w(&self) -> &[D] {
        self.parts().w()
    }

    /// Coordinates and rates to be written.
    pub(super) fn y_and_w_mut(&mut self) -> (&mut [D], &mut [D]) {
        self.row[..2 * self.layout.dim].split_at_mut(self.layout.dim)
    }

    /// Pressures, flows and vapour volumes of a muscle's line.
    pub fn line(&self, muscle: usize) -> ChainRow<'_, D> {
        ChainRow::of(self.parts().line(muscle), self.boiling(muscle).len() - 1)
    }

    /// Pressures at the nodes of a muscle's line, to be written.
    pub(super) fn pressures_mut(&mut self, muscle: usize) -> &mut [D] {
        let (row, boils) = self.line_mut(muscle);
        &mut row[..boils.len()]
    }

    /// Row of a muscle's line and which of its nodes boil, to be written.
    #[inline]
    pub(super) fn line_mut(&mut self, muscle: usize) -> (&mut [D], &mut [bool]) {
        let (from, to) = (self.layout.lines[muscle], self.layout.lines[muscle + 1]);
        (&mut self.row[from.number..to.number], &mut self.boiling[from.node..to.node])
    }

    /// Which nodes of a muscle's line boil.
    #[inline]
    pub fn boiling(&self, muscle: usize) -> &[bool] {
        &self.boiling[self.layout.lines[muscle].node..self.layout.lines[muscle + 1].node]
    }
}

impl PlantState<f64> {
    /// The same state over `D`.
    pub(super) fn lift<D: Scalar>(&self) -> PlantState<D> {
        let all = |values: &[f64]| values.iter().map(|&x| D::constant(x)).collect();
        PlantState {
            row: all(&self.row),
            layout: self.layout.clone(),
            boiling: self.boiling.clone(),
            greatest_j: all(&self.greatest_j),
            piston_ahead_m: all(&self.piston_ahead_m),
        }
    }
}
