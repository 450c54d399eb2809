// The module that Jupyter and its kin load: a view whose state is the widget's.

import { Compact } from "./compact.mjs";
import { Full } from "./full.mjs";
import { Mounted } from "./mounted.mjs";

/** While the engine plays Python hears of the angle no more often than this, milliseconds. */
const PACE = 100;

function render({ model, el }) {
  const figures = model.get("figures");
  const kind = figures.mounted ? Mounted : figures.compact ? Compact : Full;
  const view = new kind(figures);
  // JupyterLab looks at the focused control before what it stands in: each must say that its keys
  // are not the notebook's.
  view.element.addEventListener("focusin",
    ({ target }) => target.setAttribute("data-lm-suppress-shortcuts", "true"));
  el.append(view.element);

  const heard = Object.fromEntries(
    kind.SHARED.map((key) => [`change:${key}`, () => view.set({ [key]: model.get(key) })]));
  heard["change:core"] = () => view.useCore(model.get("core"));
  for (const [event, act] of Object.entries(heard)) {
    model.on(event, act);
    act();
  }

  const unsent = new Set();
  let waiting = null;
  const send = () => {
    clearTimeout(waiting);
    waiting = null;
    for (const key of unsent) model.set(key, view.state[key]);
    unsent.clear();
    model.save_changes();
  };
  view.listeners.add((changed) => {
    for (const key of changed) {
      // What comes from Python is not sent back.
      if (kind.SHARED.includes(key) && view.state[key] !== model.get(key)) unsent.add(key);
    }
    if (!unsent.size) return;
    if (!view.state.playing) send();
    else waiting ??= setTimeout(send, PACE);
  });
  return () => {
    clearTimeout(waiting);
    for (const [event, act] of Object.entries(heard)) model.off(event, act);
    view.destroy();
  };
}

export default { render };
