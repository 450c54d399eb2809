// Where an engine is looked at from until the reader chooses.

import { unit } from "./complex.mjs";

/** Below this |x + y| of its direction the isometric projection sees a bore nearly edge-on. */
const EDGE_ON = 0.45;

/** From above if the bores lie rather than stand; isometric unless a bank would be edge-on. */
export function frames({ cylinders }) {
  const directions = cylinders.map(({ bank_deg: degrees }) => unit(degrees));
  const sum = (part) => directions.reduce((total, each) => total + Math.abs(each[part]), 0);
  return {
    side: sum(0) > 0.99 * sum(1) ? "above" : "left",
    space: directions.some(([x, y]) => Math.abs(x + y) < EDGE_ON) ? "oblique" : "isometric",
  };
}
