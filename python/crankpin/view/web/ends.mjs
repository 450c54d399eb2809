// The orbits of both crank ends.

import { centre, path, svg } from "./dom.mjs";

export const ENDS = ["front", "flywheel"];

/** The orbits of both crank ends, over a scene that shows the engine rocking. */
export class Ends {
  constructor(scene) {
    this.scene = scene;
    this.parts = ENDS.map((end) => ({
      orbit: svg("path", { class: `orbit ${end}` }),
      dot: svg("circle", { class: `dot ${end}`, r: 3.5 }),
    }));
    scene.overlay.append(...this.parts.flatMap(({ orbit, dot }) => [orbit, dot]));
  }

  /** Draw the orbits: displacements of the front and of the flywheel end over a turn, in metres. */
  trace(orbits) {
    const { projection, dimensions: { ends } } = this.scene;
    this.parts.forEach(({ orbit }, k) => {
      const places = orbits[k].map(([x, y]) => projection.point([x, y, ends[k]]));
      orbit.setAttribute("d", path(places, true));
    });
  }

  pose(motion) {
    const { scene, parts } = this;
    parts.forEach(({ dot }, k) => centre(dot, scene.at([0, 0], scene.dimensions.ends[k], motion)));
  }
}
