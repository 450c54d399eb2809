// The orbits of both crank ends.

import { path, place, svg } from "./dom.mjs";
import { STRINGS } from "./strings.mjs";

/** The orbits of both crank ends, over a scene that shows the engine rocking. */
export class Ends {
  constructor(scene) {
    this.scene = scene;
    this.parts = ["front", "flywheel"].map((end) => ({
      orbit: svg("path", { class: `orbit ${end}` }),
      dot: svg("circle", { class: `dot ${end}`, r: 3.5 }),
      name: svg("text", { class: "end-name" }, STRINGS.ends[end]),
    }));
    scene.overlay.append(...this.parts.flatMap(({ orbit, dot, name }) => [orbit, dot, name]));
  }

  /** Draw the orbits: displacements of the front and of the flywheel end over a turn, in metres. */
  trace(orbits) {
    const { projection, dimensions: { ends } } = this.scene;
    this.parts.forEach(({ orbit, name }, k) => {
      const places = orbits[k].map(([x, y]) => projection.point([x, y, ends[k]]));
      orbit.setAttribute("d", path(places, true));
      const [x, y] = projection.point([0, 0, ends[k]]);
      const low = Math.max(...places.map((place) => place[1]), y + 8);
      place(name, [x, Math.min(low + 14, this.scene.size[1] - 4)]);
    });
  }

  pose(motion) {
    const { scene, parts } = this;
    parts.forEach(({ dot }, k) => {
      const [x, y] = scene.at([0, 0], scene.dimensions.ends[k], motion);
      dot.setAttribute("cx", x.toFixed(2));
      dot.setAttribute("cy", y.toFixed(2));
    });
  }
}
