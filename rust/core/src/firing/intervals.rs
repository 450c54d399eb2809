//! Groups of cylinders, and the crank angles between firings within them.

use super::schedule::Firing;
use crate::numbers::angle::Angle;
use crate::numbers::error::{Error, Result};

/// From one cylinder's firing to the next one's in a group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Index of the cylinder that fires first.
    pub before: usize,
    /// Index of the next one; the same where it is alone.
    pub after: usize,
    /// Crank angle between them.
    pub gap: Angle,
}

impl Firing {
    /// The cylinders of each bank, by index.
    #[must_use]
    pub fn banks(&self) -> Vec<Vec<usize>> {
        self.engine().cylinders_of_banks()
    }

    /// The groups given by cylinder number, or the banks, by index.
    pub fn groups(&self, numbers: Option<&[Vec<usize>]>) -> Result<Vec<Vec<usize>>> {
        let Some(numbers) = numbers else {
            return Ok(self.banks());
        };
        let count = self.engine().stations().len();
        let mut seen = vec![false; count];
        for (k, group) in numbers.iter().enumerate() {
            if group.is_empty() {
                let hint = "name at least one cylinder in each group";
                return Err(Error::value(format!("groups[{k}]"), "[]", hint));
            }
            for &number in group {
                match number.checked_sub(1).and_then(|i| seen.get_mut(i)) {
                    Some(seen) if !*seen => *seen = true,
                    _ => {
                        let hint = format!("name cylinders from 1 to {count}, each once");
                        return Err(Error::value(format!("groups[{k}]"), number, hint));
                    }
                }
            }
        }
        Ok(numbers.iter().map(|group| group.iter().map(|number| number - 1).collect()).collect())
    }

    /// Crank angles between firings within groups of cylinders, each in firing order.
    #[must_use]
    pub fn gaps(&self, groups: &[Vec<usize>]) -> Vec<Vec<Gap>> {
        let of_group = |group: &Vec<usize>| {
            let mut members = self.in_order(group);
            members.retain(|member| self.fired().contains(member));
            (0..members.len())
                .map(|k| {
                    let (before, after) = (members[k], members[(k + 1) % members.len()]);
                    let gap = self.times[after] - self.times[before];
                    // Round the end of the cycle; cylinders that fire together stay 0 apart.
                    let gap =
                        if k + 1 == members.len() { gap + self.strokes().cycle() } else { gap };
                    Gap { before, after, gap }
                })
                .collect()
        };
        groups.iter().map(of_group).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{engine, vee};
    use super::*;
    use crate::layout::{FiringOrder, Side, Strokes};
    use crate::numbers::cancel::Cancel;

    #[test]
    fn groups_are_by_number_and_apart() {
        let v8 = engine(&vee(90.0, 0.0, &[0.0, 90.0, 270.0, 180.0], Side::Left));
        let order: FiringOrder = "1-8-4-3-6-5-7-2".parse().unwrap();
        let firing = Firing::named(&v8, &order, Strokes::Four, &Cancel::new()).unwrap();
        assert_eq!(firing.groups(None).unwrap(), firing.banks());
        assert_eq!(firing.banks(), [[0, 2, 4, 6], [1, 3, 5, 7]]);
        let numbers = [vec![1, 8], vec![4]];
        assert_eq!(firing.groups(Some(&numbers)).unwrap(), [vec![0, 7], vec![3]]);
        for bad in [vec![vec![]], vec![vec![0]], vec![vec![9]], vec![vec![1], vec![1]]] {
            assert!(firing.groups(Some(&bad)).is_err(), "{bad:?}");
        }
        let gaps = firing.gaps(&[vec![0, 7], vec![3]]);
        let gap = |k: usize| -> Vec<_> {
            gaps[k].iter().map(|g| (g.before, g.after, g.gap.degrees())).collect()
        };
        assert_eq!(gap(0), [(0, 7, 90.0), (7, 0, 630.0)]);
        assert_eq!(gap(1), [(3, 3, 720.0)]);
    }
}
