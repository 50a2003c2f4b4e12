//! Work on all threads, its results in order.
//!
//! Every closure that goes through `rayon`'s iterators is compiled with all of their machinery; here that is one call through a pointer.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// What `work` makes of each item.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    map_indices(items.len(), |i| work(&items[i]))
}

/// What `work` makes of each number below `count`.
pub(crate) fn map_indices<R: Send>(count: usize, work: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let slots: Vec<Mutex<Option<R>>> = (0..count).map(|_| Mutex::new(None)).collect();
    each(count, &|i| {
        let made = work(i);
        *slots[i].lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
    });
    slots.into_iter().filter_map(|slot| slot.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
}

fn each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().with_max_len(1).for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_whatever_takes_longest() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("threads");
        let slow_first = |i: usize| {
            std::thread::sleep(std::time::Duration::from_millis(5 * (7 - i) as u64));
            i * i
        };
        assert_eq!(pool.install(|| map_indices(7, slow_first)), [0, 1, 4, 9, 16, 25, 36]);
        assert_eq!(map(&["a", "bc", ""], |word| word.len()), [1, 2, 0]);
        assert!(map(&[0; 0], |x| *x).is_empty());
    }
}
