// The engine on its mounts: modes of the body, and its state at rest.

import { explained } from "./dom.mjs";
import { WORDS } from "./words.mjs";

const SPACE_AXES = ["x", "y", "z"];

export const mountsPane = {
  key: "mounts",
  title: "Mounts",
  when: ({ summary }) => summary.mounted,
  make: async ({ engine }, { ask, table }) => {
    const { mounts, modes, static: still } = await ask("mounts", { engine: engine.json });
    const { coordinates } = WORDS;
    // Where most of a mode's energy is says what it is called.
    const main = (energies) => {
      const most = energies.indexOf(Math.max(...energies)), name = coordinates[most % coordinates.length];
      return most < coordinates.length ? name : `${WORDS.subframe} ${name}`;
    };
    // Of a subframe, whose coordinates follow, the sum.
    const shares = (energies) => {
      const below = energies.slice(coordinates.length);
      const sum = below.length > 0 ? [below.reduce((a, b) => a + b, 0)] : [];
      return [...energies.slice(0, coordinates.length), ...sum];
    };
    const bodies = modes.frequency.length > coordinates.length ? [...coordinates, WORDS.subframe] : coordinates;
    const ofModes = modes.frequency.map((frequency, k) => [`${k + 1}`, frequency]);
    // Of causes there is the weight alone: nobody asked for torque and thrust.
    const [[sag], [weights]] = [still.displacement, still.force];
    return [
      explained(WORDS.mountsSaid),
      table({
        title: WORDS.modes,
        columns: [{ label: "mode" }, { label: "frequency Hz", key: "frequency" }, { label: "mainly" }, ...bodies.map((label) => ({ label: `${label} %`, decimals: 1 })),
          { label: "purity %", key: "purity", decimals: 1 }, { label: "loss factor" }],
        rows: ofModes.map((row, k) => [...row, main(modes.energy[k]), ...shares(modes.energy[k]), modes.purity[k], modes.loss_factor[k]]),
      }),
      table({
        title: WORDS.strain,
        columns: [{ label: "mode" }, { label: "frequency Hz" }, ...mounts.map((name) => ({ label: `${name} %`, decimals: 1 }))],
        rows: ofModes.map((row, k) => [...row, ...modes.strain.map((shares) => shares[k])]),
      }),
      table({
        title: WORDS.atRest,
        columns: [{ label: "mount" }, ...SPACE_AXES.map((axis) => ({ label: `force ${axis}`, unit: "N", key: `force-${axis}` }))],
        rows: mounts.map((name, k) => [name, ...weights[k]]),
      }),
      table({
        title: WORDS.sag,
        columns: [...SPACE_AXES.map((axis) => ({ label: axis, unit: "m" })), { label: WORDS.margin, unit: "m" }],
        rows: [[...sag.slice(0, 3), still.support_margin]],
      }),
    ];
  },
};
