//! Which gas pressure and further loads results of an engine count, in words.

use super::Engine;

/// Most characters of the names of cycles.
const LONGEST_NAMES: usize = 60;
/// Most characters of the numbers of dead cylinders.
const LONGEST_NUMBERS: usize = 30;

impl Engine {
    /// Loads that results count besides those of moving parts: the name of the cycle, which cylinders do
    /// not fire, and the names of further loads.
    #[must_use]
    pub fn loads_counted(&self) -> String {
        let (gas, further) = (self.gas_counted(), self.further_loads());
        if further.is_empty() { gas } else { format!("{gas}; {further}") }
    }

    /// The gas pressure alone, in words.
    #[must_use]
    pub fn gas_counted(&self) -> String {
        let Some(gas) = self.gas() else { return gas_text(&[], 0) };
        let name = |cycle: &Option<usize>| cycle.map(|k| in_one_line(&gas.cycles[k].given().name));
        let names: Vec<Option<String>> = gas.cycle_of.iter().map(name).collect();
        let ends = (0..names.len()).map(|i| gas.crank_end(i).map(|end| end.cycle));
        let ends: Vec<Option<usize>> = ends.collect();
        if ends.iter().all(Option::is_none) {
            return gas_text(&names, self.cycles_in_use());
        }
        let count =
            |of: &[Option<usize>]| (0..gas.cycles.len()).filter(|k| of.contains(&Some(*k))).count();
        let heads = match count(&gas.cycle_of) {
            0 => "gas at crank ends alone".to_owned(),
            count => gas_text(&names, count),
        };
        if ends == gas.cycle_of {
            return format!("{heads}; double acting");
        }
        let crank_ends: Vec<Option<String>> = ends.iter().map(name).collect();
        let (words, ends) = (cycles_text(&crank_ends, count(&ends)), which(&crank_ends));
        format!("{heads}; crank ends{ends}: {words}")
    }

    /// The further loads alone, in words; empty where there are none.
    #[must_use]
    pub fn further_loads(&self) -> String {
        let mut names: Vec<String> = Vec::new();
        for load in self.loads() {
            let name = in_one_line(&load.name);
            if !names.contains(&name) {
                names.push(name);
            }
        }
        if names.is_empty() {
            return String::new();
        }
        format!("loads: {}", cut(&names.join(", "), LONGEST_NAMES))
    }

    /// Number of cycles of the cylinders that differ.
    #[must_use]
    pub fn cycles_in_use(&self) -> usize {
        let Some(gas) = self.gas() else { return 0 };
        (0..gas.cycles.len()).filter(|k| gas.in_use().any(|index| index == *k)).count()
    }

    /// Which cylinders do not fire; empty where all do.
    #[must_use]
    pub fn dead_text(&self) -> String {
        dead_text((0..self.stations().len()).map(|cylinder| self.fires(cylinder)))
    }
}

/// Which gas pressure counts: `gas: petrol; cylinder 3 does not fire`.
///
/// Of the names of the cylinders' cycles, none where there is no cycle; `count` is that of different
/// cycles.
#[must_use]
pub fn gas_text(names: &[Option<String>], count: usize) -> String {
    if names.iter().all(Option::is_none) {
        return "without gas pressure".to_owned();
    }
    let words = cycles_text(names, count);
    match dead_text(names.iter().map(Option::is_some)) {
        dead if dead.is_empty() => format!("gas: {words}"),
        dead => format!("gas: {words}; {dead}"),
    }
}

/// Names of cycles, each once; `count` is that of different ones.
fn cycles_text(names: &[Option<String>], count: usize) -> String {
    let mut named: Vec<&str> = Vec::new();
    for name in names.iter().flatten().map(String::as_str) {
        if !name.is_empty() && !named.contains(&name) {
            named.push(name);
        }
    }
    let list = cut(&named.join(", "), LONGEST_NAMES);
    match (count > named.len().max(1), named.is_empty()) {
        (true, true) => format!("{count} cycles"),
        (true, false) => format!("{count} cycles, {list}"),
        (false, true) => "unnamed cycle".to_owned(),
        (false, false) => list,
    }
}

/// ` of cylinders 1, 3`, of those that have a name; empty where all do.
fn which(names: &[Option<String>]) -> String {
    let present = (1..).zip(names).filter(|(_, name)| name.is_some());
    let numbers: Vec<String> = present.map(|(number, _): (usize, _)| number.to_string()).collect();
    match &numbers[..] {
        all if all.len() == names.len() => String::new(),
        [one] => format!(" of cylinder {one}"),
        some => format!(" of cylinders {}", cut(&some.join(", "), LONGEST_NUMBERS)),
    }
}

/// `cylinder 3 does not fire`, of whether each does; empty where all do.
pub fn dead_text(fires: impl Iterator<Item = bool>) -> String {
    let dead = fires.zip(1..).filter(|(fires, _)| !fires);
    let dead: Vec<String> = dead.map(|(_, number): (bool, usize)| number.to_string()).collect();
    match &dead[..] {
        [] => String::new(),
        [one] => format!("cylinder {one} does not fire"),
        _ => format!("cylinders {} do not fire", cut(&dead.join(", "), LONGEST_NUMBERS)),
    }
}

/// A text in one line, without characters that cannot be seen.
pub(crate) fn in_one_line(text: &str) -> String {
    // A letter in front: an accent by itself is escaped, one behind a letter is seen.
    let is_seen = |c: char| {
        c.is_whitespace()
            || format!("a{c}").escape_debug().eq(['a', c])
            || c == '"'
            || c == '\''
            || c == '\\'
    };
    let seen: String = text.chars().map(|c| if is_seen(c) { c } else { ' ' }).collect();
    seen.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A text that fits a title.
fn cut(text: &str, longest: usize) -> String {
    if text.chars().nth(longest).is_none() {
        return text.to_owned();
    }
    text.chars().take(longest - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(names: &[&str]) -> Vec<Option<String>> {
        names.iter().map(|name| (*name != "-").then(|| (*name).to_owned())).collect()
    }

    #[test]
    fn loads_name_cycles_once_and_dead_cylinders_all() {
        for (names, count, text) in [
            (&["-", "-"][..], 0, "without gas pressure"),
            (&["petrol"; 3], 1, "gas: petrol"),
            (&["petrol", "-", "petrol"], 1, "gas: petrol; cylinder 2 does not fire"),
            (&["-", "", "-"], 1, "gas: unnamed cycle; cylinders 1, 3 do not fire"),
            (&["", ""], 2, "gas: 2 cycles"),
            (&["a", "b"], 2, "gas: a, b"),
            (&["a", "b", "a"], 3, "gas: 3 cycles, a, b"),
        ] {
            assert_eq!(gas_text(&named(names), count), text);
        }
        let long = gas_text(&named(&["é".repeat(61).as_str()]), 1);
        assert_eq!(long, format!("gas: {}…", "é".repeat(59)));
    }

    #[test]
    fn a_text_in_one_line_has_nothing_unseen() {
        assert_eq!(
            in_one_line(" \"a\"\n\u{1b}[2J\u{200b}b\u{a0}e\u{301} 'c'\\"),
            "\"a\" [2J b e\u{301} 'c'\\"
        );
    }
}
