//! The state of a plant: one row of numbers, so that a step of all of them is one loop.

mod lanes;

use crate::hydraulics::ChainRow;
use crate::scalar::Scalar;

use super::plant::Plant;

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
    /// And how far laws of its plunger have put its piston, m.
    pub(super) piston_law_m: Vec<D>,
    /// Time of the run's clock, s.
    pub(super) time_s: f64,
}

/// Where everything stands in the row: coordinates, their rates, friction states of the muscles, lines of the muscles,
/// dry frictions of the mechanism and the cables, slow states of the effects, states of the laws.
///
/// All lines have room for the same number of segments; that of a muscle whose pressure is recorded stands empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layout {
    dim: usize,
    muscles: usize,
    segments: usize,
    slow_at: usize,
    laws_at: usize,
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

/// Segments of a line where the number of coordinates is known when compiling.
const SEGMENTS: usize = 1;

impl Layout {
    /// Whether the lines are those that a known number of coordinates goes with ([`sized`]).
    pub fn is_of_one_segment(&self) -> bool {
        self.segments == SEGMENTS
    }

    #[inline]
    fn dim<const N: usize>(&self) -> usize {
        if N == 0 { self.dim } else { N }
    }

    #[inline]
    fn segments<const N: usize>(&self) -> usize {
        if N == 0 { self.segments } else { SEGMENTS }
    }

    /// Where the row of a muscle's line begins.
    #[inline]
    fn line_at<const N: usize>(&self, muscle: usize) -> usize {
        2 * self.dim::<N>() + self.muscles + muscle * ChainRow::<()>::len_of(self.segments::<N>())
    }

    #[inline]
    fn line_of<'a, D, const N: usize>(&self, row: &'a [D], muscle: usize) -> &'a [D] {
        &row[self.line_at::<N>(muscle)..][..ChainRow::<()>::len_of(self.segments::<N>())]
    }

    #[inline]
    fn line_of_mut<'a, D, const N: usize>(&self, row: &'a mut [D], muscle: usize) -> &'a mut [D] {
        &mut row[self.line_at::<N>(muscle)..][..ChainRow::<()>::len_of(self.segments::<N>())]
    }

    /// Where the dry frictions begin.
    #[inline]
    fn joint_z_at(&self) -> usize {
        self.line_at::<0>(self.muscles)
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

    /// The row of a muscle's line.
    #[inline]
    pub fn line(&self, muscle: usize) -> &'a [D] {
        self.layout.line_of::<_, N>(self.row, muscle)
    }

    /// Frictions of the mechanism, then the sliding state of each cable.
    #[inline]
    pub fn joint_z(&self) -> &'a [D] {
        &self.row[self.layout.joint_z_at()..self.layout.slow_at]
    }

    /// Slow states of all muscles' effects, m.
    #[inline]
    pub fn slow(&self) -> &'a [D] {
        &self.row[self.layout.slow_at..self.layout.laws_at]
    }

    /// States of all laws, each in its own unit.
    #[inline]
    pub fn law_states(&self) -> &'a [D] {
        &self.row[self.layout.laws_at..]
    }

    /// The whole row.
    pub fn row(&self) -> &'a [D] {
        self.row
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

    /// Coordinates, and slow states of all muscles' effects.
    pub fn y_and_slow(&mut self) -> (&mut [D], &mut [D]) {
        let (n, from, to) = (self.layout.dim::<N>(), self.layout.slow_at, self.layout.laws_at);
        let (before, slow) = self.row[..to].split_at_mut(from);
        (&mut before[..n], slow)
    }

    /// Coordinates with their rates, and states of the laws.
    pub fn moving_and_law_states(&mut self) -> (&mut [D], &mut [D]) {
        let (n, from) = (2 * self.layout.dim::<N>(), self.layout.laws_at);
        let (before, laws) = self.row.split_at_mut(from);
        (&mut before[..n], laws)
    }

    /// Rates of the coordinates, and frictions of the mechanism and the cables.
    pub fn w_and_joint_z(&mut self) -> (&mut [D], &mut [D]) {
        let (n, from, to) = (self.layout.dim::<N>(), self.layout.joint_z_at(), self.layout.slow_at);
        let (moving, rest) = self.row.split_at_mut(from);
        (&mut moving[n..2 * n], &mut rest[..to - from])
    }

    #[inline]
    pub fn z(&mut self, muscle: usize) -> &mut D {
        &mut self.row[2 * self.layout.dim::<N>() + muscle]
    }

    #[inline]
    pub fn line(&mut self, muscle: usize) -> &mut [D] {
        self.layout.line_of_mut::<_, N>(self.row, muscle)
    }

    #[inline]
    pub fn joint_z(&mut self) -> &mut [D] {
        &mut self.row[self.layout.joint_z_at()..self.layout.slow_at]
    }

    #[inline]
    pub fn slow(&mut self) -> &mut [D] {
        &mut self.row[self.layout.slow_at..self.layout.laws_at]
    }

    #[inline]
    pub fn law_states(&mut self) -> &mut [D] {
        &mut self.row[self.layout.laws_at..]
    }
}

impl<D: Scalar> PlantState<D> {
    /// At rest at the coordinates `y`, with muscles whose lines have so many segments.
    pub(super) fn at_rest(y: &[D], muscles: usize, segments: usize) -> Self {
        let mut layout = Layout { dim: y.len(), muscles, segments, slow_at: 0, laws_at: 0 };
        layout.slow_at = layout.joint_z_at();
        layout.laws_at = layout.slow_at;
        let mut row = y.to_vec();
        row.resize(layout.slow_at, D::constant(0.0));
        Self {
            row,
            layout,
            boiling: vec![false; muscles * (segments + 1)],
            greatest_j: vec![D::constant(0.0); muscles],
            piston_ahead_m: vec![D::constant(0.0); muscles],
            piston_law_m: vec![D::constant(0.0); muscles],
            time_s: 0.0,
        }
    }

    /// The same muscles at rest on other coordinates.
    pub(super) fn on_coordinates(&self, y: &[D]) -> Self {
        let mut state = Self::at_rest(y, self.layout.muscles, self.layout.segments);
        let (from, to) = (2 * self.layout.dim, 2 * y.len());
        let len = state.row.len() - to;
        state.row[to..].copy_from_slice(&self.row[from..from + len]);
        state
    }

    /// Gives the effects their memory: nothing slides, and the slow states are those given.
    pub(super) fn set_memory(&mut self, dry_frictions: usize, slow: &[D]) {
        self.row.truncate(self.layout.joint_z_at());
        self.row.resize(self.row.len() + dry_frictions, D::constant(0.0));
        self.layout.slow_at = self.row.len();
        self.row.extend_from_slice(slow);
        self.layout.laws_at = self.row.len();
        self.greatest_j.fill(D::constant(0.0));
        self.piston_ahead_m.fill(D::constant(0.0));
        self.piston_law_m.fill(D::constant(0.0));
    }

    /// Gives the laws their memory.
    pub(super) fn set_law_states(&mut self, states: &[D]) {
        self.row.truncate(self.layout.laws_at);
        self.row.extend_from_slice(states);
    }

    /// States of the laws, to be written.
    pub(super) fn law_states_mut(&mut self) -> &mut [D] {
        &mut self.row[self.layout.laws_at..]
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

    /// All its numbers: the row, then what is remembered of each muscle.
    pub(super) fn numbers(&self) -> impl Iterator<Item = &D> {
        self.row.iter().chain(&self.greatest_j).chain(&self.piston_ahead_m).chain(&self.piston_law_m)
    }

    /// The same, to be written.
    pub(super) fn numbers_mut(&mut self) -> impl Iterator<Item = &mut D> {
        let remembered = self.greatest_j.iter_mut().chain(&mut self.piston_ahead_m).chain(&mut self.piston_law_m);
        self.row.iter_mut().chain(remembered)
    }

    /// Places of those that something in the plant goes by.
    pub(super) fn states_in_use(&self, plant: &Plant<D>) -> Vec<usize> {
        let extras = || plant.muscles.iter().map(|m| &m.extras);
        let softens = extras().map(|e| e.mullins.is_some());
        let lags = extras().map(|e| e.backlash.is_some());
        let is_moved = plant.laws.as_ref().is_some_and(|laws| laws.moves_pistons());
        let moved = plant.muscles.iter().map(|_| is_moved);
        let all = self.row.iter().map(|_| true).chain(softens).chain(lags).chain(moved);
        all.enumerate().filter_map(|(i, used)| used.then_some(i)).collect()
    }

    /// Coordinates and rates to be written.
    pub(super) fn y_and_w_mut(&mut self) -> (&mut [D], &mut [D]) {
        self.row[..2 * self.layout.dim].split_at_mut(self.layout.dim)
    }

    /// Pressures, flows and vapour volumes of a muscle's line.
    pub fn line(&self, muscle: usize) -> ChainRow<'_, D> {
        ChainRow::of(self.parts().line(muscle), self.layout.segments)
    }

    /// Number of segments of the lines.
    pub fn segments(&self) -> usize {
        self.layout.segments
    }

    /// Pressures at the nodes of a muscle's line, to be written.
    pub(super) fn pressures_mut(&mut self, muscle: usize) -> &mut [D] {
        let nodes = self.layout.segments + 1;
        &mut self.line_mut(muscle).0[..nodes]
    }

    /// Row of a muscle's line and which of its nodes boil, to be written.
    #[inline]
    pub(super) fn line_mut(&mut self, muscle: usize) -> (&mut [D], &mut [bool]) {
        let nodes = self.layout.segments + 1;
        let row = self.layout.line_of_mut::<_, 0>(&mut self.row, muscle);
        (row, &mut self.boiling[muscle * nodes..][..nodes])
    }

    /// Which nodes of a muscle's line boil.
    #[inline]
    pub fn boiling(&self, muscle: usize) -> &[bool] {
        self.boiling_of::<0>(muscle)
    }

    #[inline]
    pub(super) fn boiling_of<const N: usize>(&self, muscle: usize) -> &[bool] {
        let nodes = self.layout.segments::<N>() + 1;
        &self.boiling[muscle * nodes..][..nodes]
    }
}

impl PlantState<f64> {
    /// The same state over `D`.
    pub(super) fn lift<D: Scalar>(&self) -> PlantState<D> {
        let all = |values: &[f64]| values.iter().map(|&x| D::constant(x)).collect();
        PlantState {
            row: all(&self.row),
            layout: self.layout,
            boiling: self.boiling.clone(),
            greatest_j: all(&self.greatest_j),
            piston_ahead_m: all(&self.piston_ahead_m),
            piston_law_m: all(&self.piston_law_m),
            time_s: self.time_s,
        }
    }
}
