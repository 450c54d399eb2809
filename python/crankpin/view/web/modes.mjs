// The table of modes: frequency, motion and where the energy is; a choice of one shows its shape.

import { button, explained, html, numbered, show } from "./dom.mjs";
import { short } from "./format.mjs";
import { MOUNT_STRINGS } from "./mount_strings.mjs";

/** Coordinates in the order of the library's tables, as places in (x, y, z, about x, y, z). */
const COORDINATES = [["fore-aft", 2], ["lateral", 0], ["bounce", 1], ["roll", 5], ["pitch", 3], ["yaw", 4]];

export class Modes {
  /** `choose` takes the number of a mode from 0, or null for what the engine makes; without it none is chosen. */
  constructor(choose) {
    this.rows = Array.from({ length: 6 }, (_, k) => {
      const chooses = button(number(k), () => choose(chooses.getAttribute("aria-pressed") === "true" ? null : k),
        { "aria-pressed": "false", disabled: !choose });
      const cell = (name) => numbered(html, "td", `mode-${k + 1}-${name}`, { class: name });
      const cells = {
        frequency: cell("frequency"), main: html("td", { class: "main" }), purity: cell("purity"),
        shares: COORDINATES.map(([name]) => cell(name)),
      };
      const element = html("tr", {}, html("th", { scope: "row" }, chooses), cells.frequency, cells.main, cells.purity,
        ...cells.shares);
      return { chooses, cells, element };
    });
    const heads = [MOUNT_STRINGS.mode, MOUNT_STRINGS.frequencyHead, MOUNT_STRINGS.mainMotion, MOUNT_STRINGS.share];
    const head = (text, name = "") => html("th", { scope: "col", class: name }, text);
    this.table = html("table", { class: "modes" },
      html("thead", {}, html("tr", {}, ...heads.map((text) => head(text)),
        ...COORDINATES.map(([name]) => head(MOUNT_STRINGS.coordinates[name], "of-coordinate")))),
      html("tbody", {}, ...this.rows.map(({ element }) => element)));
    this.note = explained();
    this.element = html("div", {}, this.table, this.note);
  }

  /** Write modes, or that there are none; `chosen` is the number of one, or null. */
  layout(modes, chosen) {
    this.table.hidden = !modes;
    const free = modes?.some(({ frequency }) => frequency === 0);
    this.note.textContent = modes ? (free ? MOUNT_STRINGS.freeMotion : "") : MOUNT_STRINGS.noModes;
    this.note.hidden = !this.note.textContent;
    if (!modes) return;
    this.rows.forEach(({ chooses, cells, element }, k) => {
      const { frequency, energy, purity } = modes[k];
      element.classList.toggle("chosen", k === chosen);
      chooses.setAttribute("aria-pressed", k === chosen);
      chooses.setAttribute("aria-label", `${MOUNT_STRINGS.mode} ${k + 1}`);
      show(cells.frequency, frequency, frequency ? frequency.toFixed(2) : "0");
      show(cells.purity, purity, `${purity.toFixed(0)} %`);
      const shares = COORDINATES.map(([, place]) => energy[place]);
      const main = shares.indexOf(Math.max(...shares));
      cells.main.textContent = MOUNT_STRINGS.coordinates[COORDINATES[main][0]];
      shares.forEach((share, at) => {
        show(cells.shares[at], share, short(share, 0));
        cells.shares[at].style.setProperty("--share", `${Math.min(Math.max(share, 0), 100).toFixed(0)}%`);
      });
    });
  }
}

function number(k) {
  const element = numbered(html, "span", "mode");
  show(element, k + 1, `${k + 1}`);
  return element;
}
