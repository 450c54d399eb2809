// Charts of the panes: curves over a number, and bars by order; text for those who do not see them.

import { explained, html, path, pointerIn, svg } from "./dom.mjs";
import { short } from "./format.mjs";
import { WORDS } from "./words.mjs";

/** Pixels before it is scaled: texts stay legible on a phone, and where charts share a line. */
const CHART_SIZE = [440, 220];
const WIDE_SIZE = [860, 260];
const WIDE_SCREEN = "(min-width: 56em)";
const LEFT = 58;
const RIGHT = 14;
const TOP = 12;
const BOTTOM = 34;

/** Ticks at round numbers from `low` to `high`, about `count` of them. */
export function ticksOf(low, high, count = 5) {
  const span = high - low || 1;
  const raw = span / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].find((each) => each * power >= raw) * power;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

/** Ticks of angles, with their texts: parts of a turn. */
export function anglesTicks(low, high) {
  const step = [5, 10, 15, 30, 45, 60, 90, 180].find((each) => (high - low) / each <= 8) ?? 360;
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, k) => [(first + k) * step, `${(first + k) * step}°`]);
}

/** The frame of a chart: its scales, its axes, and where to draw. */
function framed({ title, x: [left, right], y: [low, high], across, ticks, described, wide = false }) {
  const [width, height] = wide && matchMedia(WIDE_SCREEN).matches ? WIDE_SIZE : CHART_SIZE;
  const [x0, x1] = [LEFT, width - RIGHT];
  const [y0, y1] = [height - BOTTOM, TOP];
  const toX = (value) => x0 + ((x1 - x0) * (value - left)) / (right - left || 1);
  const toY = (value) => y0 + ((y1 - y0) * (value - low)) / (high - low || 1);
  const element = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart", role: "img", "aria-label": described ?? title });
  for (const value of ticksOf(low, high)) {
    const y = toY(value).toFixed(1);
    element.append(svg("path", { class: "grid", d: `M${x0} ${y}H${x1}` }),
      svg("text", { class: "tick", x: x0 - 6, y: Number(y) + 4, "text-anchor": "end" }, short(value, 9)));
  }
  for (const [value, text] of ticks) {
    const x = toX(value).toFixed(1);
    element.append(svg("path", { class: "zero-line", d: `M${x} ${y0}v4` }),
      svg("text", { class: "tick", x, y: y0 + 16, "text-anchor": "middle" }, text));
  }
  element.append(svg("path", { class: "frame", d: `M${x0} ${y1}V${y0}H${x1}` }),
    svg("text", { class: "axis", x: x1, y: height - 3, "text-anchor": "end" }, across));
  return { element, toX, toY, x0, x1, y0, y1 };
}

/** Curves: each a class, a label and values at `x`; `marks` are values of x with a line and a text. */
export function curves({ title, x, lines, across, up, ticks, marks = [], about = false, wide = false, choose = null }) {
  const finite = lines.flatMap(({ values }) => Array.from(values)).filter(Number.isFinite);
  const top = Math.max(...finite, 0);
  const bottom = about ? Math.min(...finite, 0) : 0;
  const pad = 0.05 * (top - bottom) || 1;
  const [from, to] = [x[0], x[x.length - 1]];
  const described = `${title}. ${lines.map(({ label, values }) =>
    `${label}: ${short(Math.min(...values), 4)} to ${short(Math.max(...values), 4)} ${up}`).join("; ")}`;
  const frame = framed({
    title, described, wide, x: [from, to], y: [about ? bottom - pad : 0, top + pad], across,
    ticks: ticks ?? ticksOf(from, to).map((value) => [value, short(value, 9)]),
  });
  const { element, toX, toY, y0, y1 } = frame;
  if (about) element.append(svg("path", { class: "zero-line", d: `M${frame.x0} ${toY(0)}H${frame.x1}` }));
  for (const { name, values, label } of lines) {
    const points = Array.from(values, (value, k) => [toX(x[k]), toY(value)]).filter(([, y]) => Number.isFinite(y));
    element.append(svg("path", { class: `line ${name}`, d: path(points) }, svg("title", {}, label)));
  }
  for (const { at, text, name = "own" } of marks) {
    const place = toX(at);
    if (!(place >= frame.x0 - 1 && place <= frame.x1 + 1)) continue;
    element.append(svg("path", { class: `mark ${name}`, d: `M${place.toFixed(1)} ${y1}V${y0}` }),
      svg("text", {
        class: "tick", x: place + (place > frame.x1 - 90 ? -4 : 4), y: y1 + 22, "text-anchor": place > frame.x1 - 90 ? "end" : "start",
      }, text));
  }
  if (choose) {
    element.classList.add("chosen-at");
    element.addEventListener("click", (event) => {
      const { x: at } = pointerIn(element, event);
      if (at >= frame.x0 && at <= frame.x1) choose(from + ((to - from) * (at - frame.x0)) / (frame.x1 - frame.x0));
    });
  }
  return charted(`${title}, ${up}`, element, keysOf(lines, "0 0 22 8", (name) => svg("path", { class: `line ${name}`, d: "M1 4H21" })));
}

/** A chart, or what is in place of one, under its title. */
export const charted = (title, ...parts) => html("figure", { class: "charted" }, html("figcaption", {}, title), ...parts);

/** What several series are called, each beside its mark. */
function keysOf(series, viewBox, mark) {
  if (series.length < 2) return "";
  return html("p", { class: "keys" }, ...series.map(({ name, label }) =>
    html("span", {}, svg("svg", { viewBox, "aria-hidden": "true" }, mark(name)), label)));
}

/** Bars side by side for each entry of `names`; `top` is the highest of several charts of one scale. */
export function bars({ title, names, series, across, up, top = Math.max(...series.flatMap(({ values }) => values), 0) }) {
  if (series.every(({ values }) => values.every((value) => !value))) return charted(`${title}, ${up}`, explained(WORDS.zeroAtAll));
  const described = `${title}. ${names.map((name, k) =>
    `${name}: ${series.map(({ label, values }) => `${label} ${short(values[k], 2)} ${up}`).join(", ")}`).join("; ")}`;
  const { element, toX, toY, y0 } = framed({
    title, described, x: [0, names.length], y: [0, top * 1.05], across, ticks: names.map((name, k) => [k + 0.5, name]),
  });
  const width = Math.min((toX(1) - toX(0)) * 0.8 / series.length, 34);
  series.forEach(({ name, values, label }, s) => values.forEach((value, k) => {
    const x = toX(k + 0.5) + (s - series.length / 2) * width;
    element.append(svg("rect", { class: `column ${name}`, x: x.toFixed(1), y: toY(value).toFixed(1), width: Math.max(width - 1, 1).toFixed(1), height: (y0 - toY(value)).toFixed(1) },
      svg("title", {}, `${label}, ${names[k]}: ${short(value, 3)} ${up}`)));
  }));
  return charted(`${title}, ${up}`, element, keysOf(series, "0 0 12 12", (name) => svg("rect", { class: `column ${name}`, width: 12, height: 12, rx: 2 })));
}
