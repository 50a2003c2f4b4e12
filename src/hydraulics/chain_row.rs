//! The numbers of a line, side by side in one row of a greater state.

/// One line's numbers, or their rates (then each unit per second): a part of a row that whoever integrates owns.
///
/// The row of a line of `N` segments: `N + 1` pressures, `N` flows, `N + 1` vapour volumes.
#[derive(Clone, Copy, Debug)]
pub struct ChainRow<'a, D> {
    /// Gauge pressure of each node, Pa.
    pub pressure_pa: &'a [D],
    /// Flow through each segment, m³/s.
    pub flow_m3_s: &'a [D],
    /// Vapour volume at each node, m³.
    pub vapour_m3: &'a [D],
}

/// The same to be written.
#[derive(Debug)]
pub struct ChainRowMut<'a, D> {
    pub pressure_pa: &'a mut [D],
    pub flow_m3_s: &'a mut [D],
    pub vapour_m3: &'a mut [D],
}

impl<'a, D> ChainRow<'a, D> {
    /// How many numbers a line of so many segments has.
    pub(crate) const fn len_of(segments: usize) -> usize {
        3 * segments + 2
    }

    /// Takes a row apart.
    #[inline]
    pub fn of(row: &'a [D], segments: usize) -> Self {
        let (pressure_pa, rest) = row.split_at(segments + 1);
        let (flow_m3_s, vapour_m3) = rest.split_at(segments);
        Self { pressure_pa, flow_m3_s, vapour_m3 }
    }
}

impl<'a, D> ChainRowMut<'a, D> {
    /// Takes a row apart.
    #[inline]
    pub fn of(row: &'a mut [D], segments: usize) -> Self {
        let (pressure_pa, rest) = row.split_at_mut(segments + 1);
        let (flow_m3_s, vapour_m3) = rest.split_at_mut(segments);
        Self { pressure_pa, flow_m3_s, vapour_m3 }
    }
}
