// The worker's part: calls of the core that may be long.

import { load } from "./core.mjs";

let core = null;

self.addEventListener("message", async ({ data }) => {
  const { module, id, name, given } = data;
  if (module) core = load(module);
  if (id === undefined) return;
  try {
    const answer = (await core).call(name, given);
    self.postMessage({ id, answer });
  } catch (error) {
    const { message, argument, value, hint } = error;
    self.postMessage({ id, error: { message, argument, value, hint } });
  }
});
