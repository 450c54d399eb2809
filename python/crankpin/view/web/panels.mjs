// Boxes that the page is made of.

import { html, svg } from "./dom.mjs";

/** A whole page: what is in it has its style, and its keys once it has the focus. */
export function region(title, name, ...children) {
  const attributes = { class: `crankpin ${name}`, tabindex: "0", role: "region", "aria-label": title };
  return html("div", attributes, ...children);
}

/** A picture under its title. */
export function panel(title, ...children) {
  return html("figure", { class: "panel" }, html("figcaption", {}, title), ...children);
}

/** A part of the page as wide as the page. */
export function section(title, ...children) {
  return html("section", {}, html("h2", {}, title), ...children);
}

/** Names of classes, each beside its mark. */
export function legend(names, words) {
  return html("p", { class: "legend" },
    ...names.map((name) => html("span", {}, mark(name), words[name])));
}

function mark(name) {
  const shape = name === "fires"
    ? svg("path", { class: "fires", d: "M6 1l4.5 5l-4.5 5l-4.5-5z" })
    : name === "tdc" ? svg("path", { class: "tdc", d: "M6 0v12" })
      : svg("rect", { class: `key ${name}`, x: 0, y: 1, width: 12, height: 10, rx: 2 });
  return svg("svg", { viewBox: "0 0 12 12", "aria-hidden": "true" }, shape);
}
