// The page of all engines: a picture of each, which links to its own page.

import { fixed, html } from "./dom.mjs";
import { frames } from "./frames.mjs";
import { configure, ownSettings, placesAt, strokesAt } from "./places.mjs";
import { STILL, Scene } from "./scene.mjs";

/** Crank angle of the pictures: few engines have a piston at its highest there. */
const ANGLE = 40;

/** Show a picture and a link for each engine. */
export function gallery(engines) {
  const list = html("ul", { class: "gallery" });
  for (const { href, figures, description } of engines) {
    const engine = configure(figures, ownSettings(figures));
    const scene = new Scene(frames(figures).space, [240, 190]);
    scene.layout(engine);
    scene.pose(placesAt(engine, ANGLE), strokesAt(engine, ANGLE), STILL);
    list.append(html("li", {}, html("a", { href }, scene.element,
      html("b", {}, fixed(html, "span", "engine-name", figures.name, figures.name)),
      html("small", {}, description))));
  }
  document.querySelector(".crankpin").append(list);
}
