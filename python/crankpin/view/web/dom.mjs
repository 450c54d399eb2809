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

/** A button that acts. */
export function button(content, act, attributes = {}) {
  const element = html("button", { type: "button", ...attributes }, ...[content].flat());
  element.addEventListener("click", act);
  return element;
}

/** A choice of values, given with their names; `act` takes the one that is chosen. */
export function select(names, act, attributes = {}) {
  const element = html("select", attributes, ...Object.entries(names).map(([value, name]) => html("option", { value }, name)));
  element.addEventListener("change", () => act(element.value));
  return element;
}

/** A line of explanation. */
export const explained = (...parts) => html("p", { class: "hint" }, ...parts);

/** Where a pointer is in the pixels of a picture, which may be scaled. */
export const pointerIn = (picture, { clientX, clientY }) =>
  new DOMPoint(clientX, clientY).matrixTransform(picture.getScreenCTM().inverse());

/** The part of the way from one side of a picture to another at which a pointer is. */
export const shareAt = (picture, event, left, right) =>
  Math.min(Math.max((pointerIn(picture, event).x - left) / (right - left), 0), 1);

/** Act on a pointer from where it is pressed, which `begins`, to where it is let go, which `ends` it. */
export function dragged(element, act, ends = null) {
  let held = false;
  element.addEventListener("pointerdown", (event) => {
    held = true;
    element.setPointerCapture(event.pointerId);
    act(event, true);
  });
  element.addEventListener("pointermove", (event) => held && act(event, false));
  for (const end of ["pointerup", "pointercancel"]) {
    element.addEventListener(end, (event) => {
      if (held) ends?.(event);
      held = false;
    });
  }
}
