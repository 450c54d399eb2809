// The engine on its mounts: modes of the body, and its state at rest.

import { tableOf } from "./table.mjs";
import { WORDS } from "./words.mjs";

const MODE_OF = ["x", "y", "z", "about x", "about y", "about z"];

export const mountsPane = {
  key: "mounts",
  title: "Mounts",
  when: ({ summary }) => summary.mounted,
  make: async ({ engine }, { ask, units }) => {
    const { mounts, modes, static: still } = await ask("mounts", { engine: engine.json });
    const named = { units, name: engine.summary.name };
    // Where most of a mode's energy is says what it is called.
    const main = (energies) => MODE_OF[energies.indexOf(Math.max(...energies))];
    return [
      tableOf({
        ...named, title: WORDS.modes,
        columns: [{ label: "mode" }, { label: "mostly" }, { label: "frequency Hz" }, { label: "excited by order 1 at rpm" },
          { label: "purity %" }, { label: "loss factor" }],
        rows: modes.frequency.map((frequency, k) =>
          [`${k + 1}`, main(modes.energy[k]), frequency, 60 * frequency, 100 * modes.purity[k], modes.loss_factor[k]]),
      }),
      tableOf({
        ...named, title: WORDS.atRest,
        columns: [{ label: "mount" }, ...["x", "y", "z"].map((axis) => ({ label: `force ${axis}`, unit: "N" }))],
        rows: mounts.map((name, k) => [name, ...still.force[k]]),
      }),
    ];
  },
};
