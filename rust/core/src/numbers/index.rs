//! Indices: those into different lists are different types.
//!
//! Cylinders are counted by plain numbers, which are their users'; so are orders in their lists. An index
//! into another list looks up nothing but that list, and no plain number does.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

/// Position in a list of its own kind.
pub trait ListIndex: Copy + Eq {
    /// Of a position.
    #[must_use]
    fn new(position: usize) -> Self;

    /// The position.
    #[must_use]
    fn position(self) -> usize;
}

impl ListIndex for usize {
    fn new(position: usize) -> Self {
        position
    }

    fn position(self) -> usize {
        self
    }
}

/// Indices as people number cylinders. 0 becomes an index that no engine has, and engines say where it stands.
pub(crate) mod number_from_one {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::ref_option, reason = "as serde calls it")]
    pub fn serialize<S: Serializer>(index: &Option<usize>, to: S) -> Result<S::Ok, S::Error> {
        index.map(|index| index.wrapping_add(1)).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<usize>, D::Error> {
        let number = Option::<usize>::deserialize(from)?;
        Ok(number.map(|number| number.wrapping_sub(1)))
    }
}

/// Declares an index.
macro_rules! list_index {
    ($(#[$doc:meta])* $visibility:vis $name:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        $visibility struct $name(usize);

        impl $crate::numbers::index::ListIndex for $name {
            fn new(position: usize) -> Self {
                Self(position)
            }

            fn position(self) -> usize {
                self.0
            }
        }
    };
}
pub(crate) use list_index;

/// A list that its own indices alone look up.
///
/// ```
/// # let single = crankpin_core::engine::file::from_toml(
/// #     "schema = 1
/// #     cylinder = { crank_radius = 0.043, rod_length = 0.145, reciprocating_mass = 0.66 }
/// #     placements = [{ tdc_deg = 0, bank_deg = 90, z = 0 }]",
/// # )?;
/// assert_eq!(single.cranks()[single.crank_of(0)].ratio, crankpin_core::SpeedRatio::ONE);
/// # Ok::<(), crankpin_core::Error>(())
/// ```
///
/// A running gear's index, or a cylinder's, is no crank's:
///
/// ```compile_fail,E0308
/// fn speed(engine: &crankpin_core::Engine) -> crankpin_core::SpeedRatio {
///     engine.cranks()[engine.distinct_cylinder_of(0)].ratio
/// }
/// ```
#[derive(Clone, PartialEq)]
pub struct List<I, T>(Vec<T>, PhantomData<fn() -> I>);

impl<I: ListIndex, T> List<I, T> {
    /// Of entries in their order.
    pub(crate) fn new(entries: Vec<T>) -> Self {
        Self(entries, PhantomData)
    }

    /// Indices of the entries, ascending.
    pub fn indices(&self) -> impl DoubleEndedIterator<Item = I> + use<I, T> {
        (0..self.0.len()).map(I::new)
    }

    /// Adds an entry at the end, and returns its index.
    pub(crate) fn push(&mut self, entry: T) -> I {
        self.0.push(entry);
        I::new(self.0.len() - 1)
    }

    /// Of each entry the index of the first one with an equal key.
    pub(crate) fn first_equal<K: PartialEq>(&self, key: impl FnMut(&T) -> K) -> List<I, I> {
        let keys: Vec<K> = self.0.iter().map(key).collect();
        let first = |(i, key)| keys.iter().position(|other| other == key).unwrap_or(i);
        keys.iter().enumerate().map(first).map(I::new).collect()
    }

    /// Keeps the entries that are such; indices of those behind others change.
    pub(crate) fn retain(&mut self, is_such: impl FnMut(&T) -> bool) {
        self.0.retain(is_such);
    }

    /// Of each entry another, by the same index.
    pub(crate) fn map_to<U>(&self, of: impl FnMut(&T) -> U) -> List<I, U> {
        self.0.iter().map(of).collect()
    }
}

/// Values without repetition, and of each value its index among these.
pub(crate) fn distinct<I: ListIndex, T: PartialEq>(
    values: impl Iterator<Item = T>,
) -> (List<I, T>, Vec<I>) {
    let mut list = List::default();
    let mut index = |value: T| {
        let known = list.iter().position(|other| *other == value);
        known.map_or_else(|| list.push(value), I::new)
    };
    let index_of = values.map(&mut index).collect();
    (list, index_of)
}

impl<I, T> FromIterator<T> for List<I, T> {
    fn from_iter<E: IntoIterator<Item = T>>(entries: E) -> Self {
        Self(entries.into_iter().collect(), PhantomData)
    }
}

impl<I, T> Default for List<I, T> {
    fn default() -> Self {
        Self(Vec::new(), PhantomData)
    }
}

impl<I, T> Deref for List<I, T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<I, T> DerefMut for List<I, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

impl<I: ListIndex, T> Index<I> for List<I, T> {
    type Output = T;

    fn index(&self, index: I) -> &T {
        &self.0[index.position()]
    }
}

impl<I: ListIndex, T> IndexMut<I> for List<I, T> {
    fn index_mut(&mut self, index: I) -> &mut T {
        &mut self.0[index.position()]
    }
}

impl<'a, I, T> IntoIterator for &'a List<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<I, T: fmt::Debug> fmt::Debug for List<I, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
