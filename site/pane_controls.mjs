// Fields of panes: what is asked besides the engine, each with its error beside it.

import { plainUnit } from "./design.mjs";
import { html } from "./dom.mjs";
import { quantity } from "./quantity.mjs";

let made = 0;

/**
 * A row of fields `{ name, label, unit, text, choices, listed }` for a pane; their values are `slot.settings[key]`.
 *
 * A number is read with its unit; a text that is none stays with its error, and the values before it stay too.
 */
export function paneFields(slot, key, fields, { units, again }) {
  const values = slot.settings[key] ??= {};
  return html("div", { class: "asked" }, ...fields.map((field) => {
    const { name, label, unit, text, choices, listed } = field;
    const id = `asked-${++made}`;
    const fault = html("small", { class: "fault", role: "alert" });
    const control = choices
      ? html("select", { id, "data-asked": name }, ...Object.entries(choices).map(([value, words]) => html("option", { value }, words)))
      : html("input", { id, "data-asked": name, type: "text", autocomplete: "off", spellcheck: "false" });
    control.value = text;
    const read = () => {
      const typed = control.value.trim();
      if (choices) return typed;
      if (!typed) return listed ? [] : null;
      const form = listed ? "list" : "number";
      const { values } = quantity(slot.core, typed, { unit, plain: plainUnit(unit, units()), name, form });
      return listed ? values : values[0];
    };
    const follow = () => {
      try {
        values[name] = read();
        fault.textContent = "";
        control.removeAttribute("aria-invalid");
        return true;
      } catch (error) {
        fault.textContent = error.hint ?? error.message;
        control.setAttribute("aria-invalid", "true");
        return false;
      }
    };
    follow();
    control.addEventListener(choices ? "change" : "input", () => follow() && again());
    return html("span", { class: "asked-one" }, html("label", { for: id }, label), control, fault);
  }));
}
