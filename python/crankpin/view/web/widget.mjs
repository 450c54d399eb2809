// The module that Jupyter and its kin load: a view whose state is the widget's.

import { View } from "./view.mjs";

/** Traits that the page and Python share, by the names of the state's entries. */
const SHARED = ["angle_deg", "rpm", "bank_angle_deg", "rod_ratio", "hold"];

/** While the engine plays Python hears of the angle no more often than this, milliseconds. */
const PACE = 100;

function render({ model, el }) {
  const view = new View(model.get("figures"));
  // Keys that turn the crank are not the notebook's.
  view.element.setAttribute("data-lm-suppress-shortcuts", "true");
  el.append(view.element);

  const receive = () => view.set(Object.fromEntries(SHARED.map((key) => [key, model.get(key)])));
  const receiveCore = () => view.useCore(model.get("core"));
  for (const key of SHARED) model.on(`change:${key}`, receive);
  model.on("change:core", receiveCore);
  receive();
  receiveCore();

  let waiting = null;
  const send = () => {
    clearTimeout(waiting);
    waiting = null;
    for (const key of SHARED) {
      if (model.get(key) !== view.state[key]) model.set(key, view.state[key]);
    }
    model.save_changes();
  };
  view.listeners.add((changed) => {
    if (!changed.some((key) => SHARED.includes(key) || key === "playing")) return;
    if (!view.state.playing) send();
    else waiting ??= setTimeout(send, PACE);
  });
  return () => {
    clearTimeout(waiting);
    for (const key of SHARED) model.off(`change:${key}`, receive);
    model.off("change:core", receiveCore);
    view.destroy();
  };
}

export default { render };
