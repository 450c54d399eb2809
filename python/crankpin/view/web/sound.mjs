// What one hears at the exhausts: a pulse whenever one opens, each bank in its own ear.

import { reduced } from "./complex.mjs";
import { html } from "./dom.mjs";
import { STRINGS } from "./strings.mjs";

/** Crank angle in which a pulse of pressure rises, degrees. */
const RISE = 12;

/** Largest share of full scale, at which nothing is clipped. */
const LOUD = 0.6;

/** Slower engines are not heard, rpm: a cycle would be many seconds of samples. */
const SLOWEST_HEARD = 6;

/** Of each bank its side, from −1 at the left to 1, and the crank angles at which its exhausts open, in order. */
export function openings({ cylinders, cycle }, before) {
  const banks = [];
  for (const { bank, direction: [side], strokes, number, fires_as: as } of cylinders) {
    banks[bank] ??= { side, angles: [] };
    if (!strokes || number !== as) continue; // a dummy piston, or the second of a chamber
    // It opens at the end of the power stroke, a little before.
    banks[bank].angles.push(reduced(strokes[0][2] - before, cycle));
  }
  for (const { angles } of banks) angles.sort((a, b) => a - b);
  return banks;
}

/** Samples of a cycle of a bank's pulses, which repeats without a seam. */
export function samples(angles, cycle, count) {
  const sound = new Float32Array(count);
  for (let k = 0; k < count; k++) {
    for (const angle of angles) {
      // A pulse of the last cycle may not be over yet.
      const since = reduced((k / count) * cycle - angle, cycle) / RISE;
      sound[k] += since * (1 - since / 2) * Math.exp(1 - since);
    }
  }
  const mean = sound.reduce((sum, value) => sum + value, 0) / count;
  const most = sound.reduce((largest, value) => Math.max(largest, Math.abs(value - mean)), 0);
  return sound.map((value) => (LOUD * (value - mean)) / (most || 1));
}

/** A switch, off until the reader wants to hear; `before` is how long before the dead centre exhausts open. */
export class Sound {
  constructor(before) {
    this.before = before;
    this.context = null;
    this.sources = [];
    this.switch = html("input", { type: "checkbox" });
    this.switch.addEventListener("change", () => this.play());
    this.element = html("label", { class: "sound", title: STRINGS.soundSaid },
      this.switch, html("span", {}, STRINGS.sound), html("small", {}, STRINGS.soundSaid));
  }

  /** Follow the engine's settings. */
  layout(engine) {
    this.engine = engine;
    this.play();
  }

  banks() {
    return openings(this.engine, this.before);
  }

  play() {
    for (const source of this.sources) source.stop();
    this.sources = [];
    const { cycle, settings: { rpm } } = this.engine;
    if (!this.switch.checked || rpm < SLOWEST_HEARD) return;
    this.context ??= new AudioContext();
    this.context.resume();
    const { destination, sampleRate } = this.context;
    const exact = (sampleRate * cycle) / (6 * rpm);
    for (const { side, angles } of this.banks()) {
      const buffer = this.context.createBuffer(1, Math.max(2, Math.round(exact)), sampleRate);
      buffer.copyToChannel(samples(angles, cycle, buffer.length), 0);
      const source = this.context.createBufferSource();
      Object.assign(source, { buffer, loop: true });
      source.playbackRate.value = buffer.length / exact;
      const ear = this.context.createStereoPanner();
      ear.pan.value = side;
      source.connect(ear).connect(destination);
      source.start();
      this.sources.push(source);
    }
  }

  destroy() {
    this.switch.checked = false;
    this.play();
    this.context?.close();
  }
}
