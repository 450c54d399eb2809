// Elements of HTML and SVG; text is always text, never markup.

const SVG = "http://www.w3.org/2000/svg";

/** An HTML element with attributes, and children or texts. */
export function html(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

/** An SVG element. */
export function svg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

/** Show a number: text for people, its value in SI units with all digits for scripts. */
export function show(element, value, text) {
  const full = `${value}`;
  if (element.getAttribute("data-value") !== full) element.setAttribute("data-value", full);
  if (element.textContent !== text) element.textContent = text;
}

/** A place for a number that scripts find by name. */
export function numbered(make, tag, name, attributes = {}) {
  return make(tag, { "data-name": name, "data-value": "", ...attributes });
}

/** A number that does not change, such as a tick or a cylinder's. */
export function fixed(make, tag, name, value, text, attributes = {}) {
  return make(tag, { "data-name": name, "data-value": value, ...attributes }, text);
}

/** The path through points; closed if wanted. */
export function path(points, closed = false) {
  let d = "";
  for (const [x, y] of points) d += `${d ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`;
  return closed && d ? `${d}Z` : d;
}

/**
 * Put an element at a place in pixels.
 *
 * @param {Element} element
 * @param {number[]} place
 */
export function place(element, [x, y]) {
  element.setAttribute("x", x.toFixed(2));
  element.setAttribute("y", y.toFixed(2));
}

/**
 * Move an element to a place in pixels, turned by a small angle in radians; it is not laid out anew.
 *
 * @param {Element} element
 * @param {number[]} place
 * @param {number} turn
 */
export function translate(element, [x, y], turn = 0) {
  const [by, at] = [turn.toFixed(5), `${x.toFixed(2)} ${y.toFixed(2)}`];
  const to = turn ? `matrix(1 ${-by} ${by} 1 ${at})` : `translate(${at})`;
  if (element.getAttribute("transform") !== to) element.setAttribute("transform", to);
}

/**
 * Put a circle at a place in pixels.
 *
 * @param {Element} circle
 * @param {number[]} place
 */
export function centre(circle, [x, y]) {
  circle.setAttribute("cx", x.toFixed(2));
  circle.setAttribute("cy", y.toFixed(2));
}

/** Act on a pointer from where it is pressed, which `begins`, to where it is let go. */
export function dragged(element, act) {
  let held = false;
  element.addEventListener("pointerdown", (event) => {
    held = true;
    element.setPointerCapture(event.pointerId);
    act(event, true);
  });
  element.addEventListener("pointermove", (event) => held && act(event, false));
  for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => { held = false; });
}
