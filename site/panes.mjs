// Panes: what an engine does, each asked of the core when it is shown.

import { anglesPane } from "./pane_angles.mjs";
import { bobPane } from "./pane_bob.mjs";
import { counterweightsPane, shaftsPane } from "./pane_fits.mjs";
import { firingPane } from "./pane_firing.mjs";
import { mountsPane } from "./pane_mounts.mjs";
import { torquePane } from "./pane_torque.mjs";
import { orders } from "./pane_orders.mjs";

const turning = {
  key: "turning",
  title: "Vectors",
  make: async ({ bench }) => [bench.parts.dials, bench.parts.phasors],
};

const curvesOverCrankAngle = {
  key: "timeline",
  title: "Crank angle",
  make: async ({ bench }) => [bench.parts.timeline],
};

export const PANES = [orders, turning, curvesOverCrankAngle, anglesPane, firingPane, torquePane, bobPane, counterweightsPane, shaftsPane, mountsPane];
