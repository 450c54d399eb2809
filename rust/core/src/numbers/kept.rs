//! A cache of results in the object from which they follow.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, Mutex};

use crate::numbers::error::Result;

/// Number of results that are kept.
const MOST_KEPT: usize = 8;

/// The last results of questions about a value that does not change.
///
/// They are no part of the value: they do not count in comparisons, and a copy, which may be changed, has
/// none.
#[derive(Default)]
pub(crate) struct Kept(Mutex<Vec<Arc<dyn Any + Send + Sync>>>);

impl Kept {
    /// The result of a type that is such, or a new one.
    pub fn get<T: Any + Send + Sync>(
        &self,
        is_such: impl Fn(&T) -> bool,
        new: impl FnOnce() -> Result<T>,
    ) -> Result<Arc<T>> {
        let has = |one: &&Arc<dyn Any + Send + Sync>| one.downcast_ref().is_some_and(&is_such);
        // Not locked while another one computes, nor for ever in a process that was forked meanwhile.
        let known = self.0.try_lock().ok().and_then(|kept| kept.iter().find(has).cloned());
        if let Some(known) = known.and_then(|known| known.downcast().ok()) {
            return Ok(known);
        }
        let result = Arc::new(new()?);
        if let Ok(mut kept) = self.0.try_lock() {
            if kept.len() == MOST_KEPT {
                kept.remove(0);
            }
            kept.push(Arc::clone(&result) as _);
        }
        Ok(result)
    }
}

impl fmt::Debug for Kept {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Kept").finish_non_exhaustive()
    }
}

impl Clone for Kept {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Kept {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_computed_once_kept_by_type_and_not_copied() {
        let kept = Kept::default();
        let square = |kept: &Kept, number: u32, computed: &mut u32| {
            let new = || {
                *computed += 1;
                Ok((number, number * number))
            };
            kept.get(|(known, _): &(u32, u32)| *known == number, new).unwrap().1
        };
        let mut computed = 0;
        for number in [3, 3, 4, 3] {
            assert_eq!(square(&kept, number, &mut computed), number * number);
        }
        assert_eq!(computed, 2);
        assert_eq!(
            *kept.get(|_: &String| true, || Ok("another type".to_owned())).unwrap(),
            "another type"
        );
        assert_eq!(square(&kept.clone(), 3, &mut computed), 9);
        assert_eq!(computed, 3);
        // The first ones make room.
        for number in 5..15 {
            square(&kept, number, &mut computed);
        }
        square(&kept, 3, &mut computed);
        assert_eq!(computed, 14);
        assert_eq!(kept, Kept::default());
    }
}
