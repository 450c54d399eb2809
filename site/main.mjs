// The page: one engine or two, their forms and pictures, what they do, and files.

import { Core } from "./core.mjs";
import { WORDS } from "./words.mjs";
import { Workbench } from "./workbench.mjs";

/** The bytes of the core, which stand packed in the page. */
async function coreBytes() {
  const binary = atob(document.getElementById("core").textContent);
  const packed = new Uint8Array(binary.length);
  // By far the fastest way: it is most of the time until the first engine is seen.
  for (let k = 0; k < packed.length; k++) packed[k] = binary.charCodeAt(k);
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

async function begin() {
  const module = await WebAssembly.compile(await coreBytes());
  const core = new Core(module);
  const script = JSON.parse(document.getElementById("worker").textContent);
  const workbench = await Workbench.opened(core, module, script);
  document.body.append(workbench.element);
  globalThis.workbench = workbench;
}

begin().catch((error) => {
  const said = document.createElement("p");
  said.setAttribute("role", "alert");
  said.textContent = `${WORDS.noStart} ${error.message}`;
  document.body.append(said);
  throw error;
});
