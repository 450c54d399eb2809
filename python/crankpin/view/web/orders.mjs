// Which orders of force and moment are shown.

import { magnitude } from "./complex.mjs";

/** Orders that are shown at most. */
export const MOST_ORDERS = 6;

/** Orders whose peaks are all below this part of the largest are not shown: as in the library. */
const NEGLIGIBLE = 1e-6;

/** The orders that matter: the largest `most` above the negligible ones, ascending. */
export function shown(all, most) {
  const largest = { force: 0, moment: 0 };
  for (const quantity of ["force", "moment"]) {
    largest[quantity] = Math.max(0, ...all.map((each) => longest(each[quantity])));
  }
  const share = (each) => Math.max(
    ...["force", "moment"].map((q) => (largest[q] ? longest(each[q]) / largest[q] : 0)),
  );
  return all
    .filter((each) => share(each) > NEGLIGIBLE)
    .sort((a, b) => share(b) - share(a))
    .slice(0, most)
    .sort((a, b) => a.order - b.order);
}

/** Longest vector of an order. */
export const longest = ({ forward, backward }) => magnitude(forward) + magnitude(backward);
