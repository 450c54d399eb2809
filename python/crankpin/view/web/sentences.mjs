// How the engine shakes, in sentences: the library's, of the engine as it was given.

import { fixed, html } from "./dom.mjs";
import { short } from "./format.mjs";
import { STRINGS } from "./strings.mjs";

/** Sentences that are shown before the reader asks for the others. */
const FIRST = 3;

export class Sentences {
  constructor({ sentences, rpm }) {
    const list = (few) => html("ul", {}, ...few.map((text) => fixed(html, "li", "sentence", text, text)));
    const [first, rest] = [sentences.slice(0, FIRST), sentences.slice(FIRST)];
    const speed = fixed(html, "span", "sentences-rpm", rpm, `${short(rpm, 3)} ${STRINGS.rpm}`);
    this.element = html("div", { class: "sentences" }, html("p", {}, `${STRINGS.asGiven} `, speed), list(first),
      rest.length ? html("details", {}, html("summary", {}, STRINGS.more), list(rest)) : "");
    this.known = sentences.length > 0;
  }

  /** Show them while the engine is the one that they are about; else they keep their place, so that nothing jumps. */
  layout(settings, own) {
    const same = Object.keys(own).every((key) => key === "rpm" || key === "hold" || settings[key] === own[key]);
    this.element.hidden = !this.known;
    this.element.style.visibility = same ? "" : "hidden";
  }
}
