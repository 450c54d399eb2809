// The worker's part: calls of the core that may be long.

import { Core } from "./core.mjs";

let core = null;

self.addEventListener("message", ({ data }) => {
  const { module, id, name, given } = data;
  if (module) core = new Core(module);
  if (id === undefined) return;
  try {
    const answer = core.call(name, given);
    self.postMessage({ id, answer });
  } catch (error) {
    const { message, argument, value, hint } = error;
    self.postMessage({ id, error: { message, argument, value, hint } });
  }
});
