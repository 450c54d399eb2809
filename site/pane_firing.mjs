// When the cylinders fire: a strip of a cycle, its intervals, and how that sounds at the exhausts.

import { reduced } from "./complex.mjs";
import { html, svg } from "./dom.mjs";
import { short } from "./format.mjs";
import { WORDS } from "./words.mjs";

const STRIP_WIDTH = 900;
const STRIP_END = 24;
const ROW_OF_BANK = 34;

/** The firing of a cycle on a line for each bank; intervals above. */
function strip(engine, firing) {
  const { summary: { strokes, bank } } = engine;
  const cycle = strokes === 2 ? 360 : 720;
  const [start] = firing.angles_deg;
  const rows = [...new Set(bank)].sort((a, b) => a - b);
  const height = 44 + ROW_OF_BANK * rows.length;
  const x = (angle) => STRIP_END + ((STRIP_WIDTH - 2 * STRIP_END) * angle) / cycle;
  const y = (cylinder) => 50 + ROW_OF_BANK * rows.indexOf(bank[cylinder - 1]);
  // `angles_deg` are by cylinder, `order` says who fires after whom.
  const fires = firing.order.map((cylinder) => [cylinder, Number(reduced(firing.angles_deg[cylinder - 1] - start, cycle).toFixed(9)) % cycle]);
  const element = svg("svg", { class: "chart strip", viewBox: `0 0 ${STRIP_WIDTH} ${height}`, role: "img",
    "aria-label": `${WORDS.firing}: ${fires.map(([cylinder, angle]) => `${cylinder}, ${short(angle, 2)}°`).join("; ")}` });
  for (let angle = 0; angle <= cycle; angle += 90) {
    element.append(svg("path", { class: "grid", d: `M${x(angle)} 30V${height - 16}` }),
      svg("text", { class: "tick", x: x(angle), y: height - 3, "text-anchor": "middle" }, `${angle}°`));
  }
  firing.intervals_deg.forEach((interval, k) => {
    const from = fires[k][1];
    if (interval) element.append(svg("text", { class: "tick", x: x(from + interval / 2), y: 16, "text-anchor": "middle" }, `${short(interval, 2)}°`),
      svg("path", { class: "line span", d: `M${x(from) + 3} 22H${x(from + interval) - 3}` }));
  });
  for (const [cylinder, angle] of fires) {
    element.append(svg("circle", { class: `fired bank-${rows.indexOf(bank[cylinder - 1]) % 2}`, cx: x(angle), cy: y(cylinder), r: 12 }),
      svg("text", { class: "cylinder", x: x(angle), y: y(cylinder) + 4, "text-anchor": "middle" }, `${cylinder}`));
  }
  return html("figure", { class: "charted" }, html("figcaption", {}, WORDS.firing), element);
}

export const firingPane = {
  key: "firing",
  title: "Firing",
  when: ({ summary }) => summary.firing,
  make: async ({ engine, bench }, { table }) => {
    const { firing } = engine.summary;
    const columns = [{ label: "cylinder" }, { label: "fires at °" }, { label: "until the next °" }];
    const rows = firing.order.map((cylinder, k) => [`${cylinder}`, firing.angles_deg[cylinder - 1], firing.intervals_deg[k]]);
    return [
      html("p", {}, `${firing.text}, `, firing.even ? WORDS.even : WORDS.uneven(short(firing.unevenness_deg, 2))),
      strip(engine, firing), bench.parts.sound,
      table({ title: WORDS.firingTable, columns, rows }),
    ];
  },
};
