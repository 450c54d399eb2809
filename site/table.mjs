// Tables of results, in the units of the setting, which can be saved as CSV.

import { button, html } from "./dom.mjs";
import { csvOf, fileName, saveFile } from "./files.mjs";
import { signed } from "./format.mjs";
import { UNITS } from "./tables.mjs";
import { WORDS } from "./words.mjs";

/** Significant digits. */
const SHOWN_DIGITS = 4;

/** The unit in which a setting shows another, and the factor of its numbers. */
export const shownIn = (units, unit) => UNITS.shown[units][unit] ?? [unit, 1];

/** A number as it is read: four digits, a true minus sign. */
export function readable(value) {
  if (typeof value !== "number") return value ?? "–";
  if (!Number.isFinite(value)) return "–";
  if (Math.abs(value) >= 1e4 && Math.abs(value) < 1e9) return signed(value.toFixed(0));
  if (value && Math.abs(value) < 1e-3) return signed(value.toExponential(2));
  return signed(`${Number(value.toPrecision(SHOWN_DIGITS))}`);
}

/** Columns are `{ label, unit, key, decimals }`, rows their values in the library's units; the first column heads its row. */
export function tableOf({ title, columns, rows, units, name, total = false }) {
  const scaled = columns.map(({ unit }) => (unit ? shownIn(units, unit) : ["", 1]));
  const head = columns.map(({ label }, k) => (scaled[k][0] ? `${label}, ${scaled[k][0]}` : label));
  const values = rows.map((row) => row.map((value, k) => (typeof value === "number" ? value * scaled[k][1] : value)));
  const save = button(WORDS.csv, () => saveFile(fileName(`${name} ${title}`, "csv"), csvOf([head, ...values]), "text/csv"),
    { class: "quiet", "aria-label": `${title}: ${WORDS.csv}` });
  return html("div", { class: "tabled" },
    html("div", { class: "scrolls", tabindex: "0", role: "region", "aria-label": title },
      html("table", {}, html("caption", {}, title, " ", save),
        html("thead", {}, html("tr", {}, ...columns.map(({ label }, k) => html("th", { scope: "col" }, label,
          scaled[k][0] ? html("small", {}, ` ${scaled[k][0]}`) : "")))),
        html("tbody", {}, ...values.map((row, r) => html("tr", { class: total && r === values.length - 1 ? "total" : null }, ...row.map((value, k) => cell(value, rows[r][k], k, columns[k]))))))));
}

function cell(value, own, k, { key, decimals }) {
  const text = decimals === undefined || typeof value !== "number" ? readable(value) : signed(value.toFixed(decimals));
  const made = html(k ? "td" : "th", k ? {} : { scope: "row" }, text);
  if (key && typeof own === "number") {
    made.setAttribute("data-name", key);
    made.setAttribute("data-value", own);
  }
  return made;
}
