// Numbers as people type them, with a unit or in that of the setting: the core reads them, as for the shell.

/** What is wrong with something typed: the library's errors have the same parts. */
export class TypingError extends Error {
  constructor(argument, value, hint) {
    super(`${argument} = "${value}": ${hint}`);
    Object.assign(this, { argument, value, hint });
  }
}

/**
 * What the core reads in a text: `values` in the library's unit, `texts` without units, whether it is `listed`, …
 *
 * `plain` is the unit of numbers without one; `form` is "number", "list", "range" or "several", one number or a list.
 */
export function quantity(core, text, { unit, plain = "", name = "value", form = "number", what = undefined }) {
  try {
    return core.call("quantity", { text, unit, plain, name, form, ...(what ? { what } : {}) });
  } catch (error) {
    throw error.hint ? new TypingError(name, text.trim(), error.hint) : error;
  }
}

/** What was typed with its unit: what a plain number means does not change with the setting. */
export function withUnit(core, text, unit, plain) {
  try {
    return plain && !quantity(core, text, { unit, plain }).unit ? `${text.trim()} ${plain}` : text.trim();
  } catch {
    return text.trim();
  }
}
