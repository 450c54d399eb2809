// The page for a slide or the output of a lecture's cell: the cross-section and one vector.

import { choice, chosen } from "./controls.mjs";
import { html } from "./dom.mjs";
import { panel, region } from "./panels.mjs";
import { STILL, Scene } from "./scene.mjs";
import { STRINGS } from "./strings.mjs";
import { Arrow, LEAST, Twist } from "./vectors.mjs";
import { View } from "./view.mjs";

/** What the one dial can show; at first force or moment, whichever is balanced less, if one is not. */
const DIALS = ["force", "moment", "torque"];

export class Compact extends View {
  build(title) {
    super.build();
    const { figures, readouts, settings, state, transport } = this;
    state.dial = null;
    this.scenes = [new Scene("cross", [390, 330], [40, 26])];
    this.dials = {
      force: new Arrow(STRINGS.force, "force"),
      moment: new Arrow(STRINGS.moment, "moment"),
      torque: new Twist(STRINGS.torque),
    };
    this.lists = {
      force: readouts.listOf("force"), moment: readouts.listOf("moment"), torque: readouts.listOfTorque(),
    };
    this.choice = choice("dial", Object.fromEntries(DIALS.map((name) => [name, STRINGS[name]])), this,
      !figures.controls.includes("view"));
    this.panel = panel(this.choice);
    this.element = region(title, "compact", this.header.element,
      html("div", { class: "views" },
        panel(STRINGS.crossSection, readouts.angle, this.scenes[0].element), this.panel),
      chosen(figures, {
        crank_angle: html("div", { class: "setting" }, transport.play, transport.slider),
        rpm: settings.rpm.element, bank_angle: settings.bank.element, rod_ratio: settings.rod.element,
      }));
  }

  changed(keys) {
    if (keys.includes("dial")) this.show();
  }

  /** Show the dial that is chosen, with its numbers. */
  show() {
    const { dial } = this.state;
    this.choice.value = dial;
    const [caption] = this.panel.children;
    this.panel.replaceChildren(caption, this.dials[dial].element, this.lists[dial]);
  }

  layout(whole) {
    const { curve, dials, peaks, state } = this;
    for (const name of ["force", "moment"]) dials[name].layout(curve[name], peaks[name], whole[name]);
    dials.torque.layout(peaks.torque);
    if (!state.dial) {
      const share = (name) => peaks[name] / whole[name] || 0;
      const [first] = ["force", "moment"].sort((a, b) => share(b) - share(a));
      state.dial = share(first) >= LEAST ? first : "torque";
      this.show();
    }
    this.settings.show(state);
  }

  draw(pose, strokes) {
    const { dial } = this.state;
    this.scenes[0].pose(pose, strokes, STILL);
    this.dials[dial].pose(pose[dial]);
  }
}
