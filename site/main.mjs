// The page: one engine or two, their forms and pictures, what they do, and files.

import { Core } from "./core.mjs";
import { Workbench } from "./workbench.mjs";

/** Begin with the bytes of the core; `loader.mjs` calls it. */
globalThis.begin = async (bytes) => {
  const module = await WebAssembly.compile(bytes);
  const core = new Core(module);
  const script = document.getElementById("worker").textContent;
  const workbench = await Workbench.opened(core, module, script);
  document.body.append(workbench.element);
  workbench.begin();
  globalThis.workbench = workbench;
};
