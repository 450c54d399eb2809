// Counterweights and shafts that panes fit to an engine: each pane its own, beside what the engine has.

import { TypingError } from "./quantity.mjs";

/** Panes that fit something: the part of an engine's file that it goes into. */
const FITTED_TO = { bob: "counterweights", counterweights: "counterweights", shafts: "shafts" };

/** An engine's file with fits by pane: bob weights in place of its own counterweights, others beside what is there. */
export function withFits(file, { bob, counterweights, shafts }) {
  return {
    ...file, counterweights: [...(bob ?? file.counterweights ?? []), ...(counterweights ?? [])],
    shafts: [...(file.shafts ?? []), ...(shafts ?? [])],
  };
}

/** What a pane has to fit, of the core's answer: the engine `before` with it. */
export function fitOf(pane, before, { json }) {
  const part = FITTED_TO[pane];
  const [own, all] = [before.json, json].map((text) => JSON.parse(text)[part] ?? []);
  const list = pane === "bob" ? all : all.slice(own.length);
  return list.filter(({ unbalances }) => unbalances?.length !== 0);
}

/** Fits of a link, which has lists by pane and nothing else. */
export function checkedFits(fits) {
  const isFits = Object.entries(fits ?? {}).every(([pane, list]) => Object.hasOwn(FITTED_TO, pane) && Array.isArray(list));
  if (!isFits || Array.isArray(fits) || typeof fits !== "object") throw new TypingError("extra", "…", `has lists of ${Object.keys(FITTED_TO).join(", ")}`);
  return fits;
}
