// The whole page: a bar of commands, forms, pictures, and panes of what the engines do.

import { Design } from "./design.mjs";
import { button, explained, html } from "./dom.mjs";
import { LONGEST_FILE, fileName, saveFile, turningPage } from "./files.mjs";
import { inWords, unitsChoice } from "./form.mjs";
import { designsOf, fragmentOf } from "./fragment.mjs";
import { Jobs, Outdated } from "./jobs.mjs";
import { PANES } from "./panes.mjs";
import { TypingError } from "./quantity.mjs";
import { Slot } from "./slot.mjs";
import { tableOf } from "./table.mjs";
import { UNITS, VERSION } from "./tables.mjs";
import { WORDS } from "./words.mjs";

/** What is shown to someone who brings no engine. */
const FIRST_ENGINE = "v8-crossplane";

/** The address follows what is typed after so long, milliseconds. */
const CALM_ADDRESS = 400;

/** Work that takes longer than this is said to go on, milliseconds. */
const NOTICED = 150;

export class Workbench {
  /** The workbench with the engine of the page's address, or the first one. */
  static async opened(core, module, script) {
    let given = null;
    let trouble = "";
    try {
      given = await designsOf(location.hash);
    } catch (error) {
      trouble = linkFault(error);
    }
    return new Workbench(core, module, script, given ?? { designs: [Design.preset(FIRST_ENGINE)], units: UNITS.settings[0] }, trouble);
  }

  constructor(core, module, script, { designs, units }, trouble) {
    this.core = core;
    this.units = units;
    this.jobs = new Jobs(script, module, (share) => this.busy(share));
    this.said = html("p", { class: "said", role: "status" }, trouble);
    this.share = html("span", {});
    this.working = html("span", { class: "working", hidden: true }, this.share, " ",
      titled(WORDS.cancel, WORDS.cancel, () => this.jobs.cancel()));
    this.forms = html("div", { class: "forms" });
    this.stages = html("div", { class: "stages" });
    this.panes = html("div", { class: "panes" });
    this.slots = [];
    this.pane = PANES[0];
    this.makeBar();
    this.makeTabs();
    this.element = html("div", { class: "crankpin bench" }, this.bar, this.said,
      html("main", {}, html("div", { class: "side" }, this.skip, this.chooser, this.forms),
        html("div", { class: "shown" }, this.stages, this.back, this.tabs, this.panes)),
      html("footer", {}, `${WORDS.footer} crankpin ${VERSION}`));
    this.element.addEventListener("dragover", (event) => event.preventDefault());
    this.element.addEventListener("drop", (event) => {
      event.preventDefault();
      if (event.dataTransfer.files.length) this.openFile(event.dataTransfer.files[0]);
    });
    addEventListener("hashchange", () => this.followAddress());
    // On paper nobody asks for more.
    addEventListener("beforeprint", () => this.panes.querySelectorAll("details").forEach((each) => { each.open = true; }));
    for (const design of designs) this.add(design);
    if (designs.length > 1) this.arrange(0);
  }

  /** Turn the engine, unless the reader wants things still. */
  begin() {
    const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.slots[0].bench?.set({ playing: !isCalm });
  }

  makeBar() {
    this.file = html("input", { type: "file", accept: ".toml,.json", hidden: true, "aria-label": WORDS.openSaid });
    this.file.addEventListener("change", () => {
      if (this.file.files.length) this.openFile(this.file.files[0]);
      this.file.value = "";
    });
    this.compare = titled(WORDS.compare, WORDS.compareSaid, () => (this.slots.length > 1 ? this.remove() : this.add(null)));
    this.choice = unitsChoice(this.units, (units) => {
      this.units = units;
      for (const slot of this.slots) slot.setUnits(units);
    });
    this.bar = html("div", { class: "bar", role: "banner" },
      html("p", { class: "brand" }, "crankpin", html("small", {}, "workbench")), this.file,
      html("div", { class: "commands" },
        titled(WORDS.open, WORDS.openSaid, () => this.file.click()),
        titled(WORDS.save, WORDS.saveSaid, () => this.save()),
        titled(WORDS.link, WORDS.linkSaid, () => this.copyLink()),
        titled(WORDS.page, WORDS.pageSaid, () => this.savePage()),
        titled(WORDS.print, WORDS.printSaid, () => print()),
        this.compare, this.choice, this.working));
    this.chooser = html("div", { class: "chooser", role: "tablist", "aria-label": WORDS.engine, hidden: true });
  }

  makeTabs() {
    this.tabs = html("div", { class: "tabs", role: "tablist", "aria-label": WORDS.panes });
    this.buttons = PANES.map((pane) => {
      const attributes = { role: "tab", id: `tab-${pane.key}`, "aria-controls": "pane" };
      return button(pane.title, () => this.choose(pane), attributes);
    });
    this.skip = titled(WORDS.toResults, WORDS.panes, () => {
      this.buttons.find((tab) => tab.tabIndex === 0).focus({ preventScroll: true });
      this.tabs.scrollIntoView();
    });
    this.skip.classList.add("skip");
    this.back = titled(WORDS.toForm, WORDS.engine, () => {
      this.current.form.element.querySelector("select").focus({ preventScroll: true });
      this.forms.scrollIntoView();
    });
    this.back.classList.add("back");
    this.panes.setAttribute("id", "pane");
    this.panes.setAttribute("role", "tabpanel");
    this.tabs.append(...this.buttons);
    arrows(this.tabs, this.buttons);
  }

  /** Show a pane. */
  choose(pane) {
    this.pane = pane;
    this.refresh();
  }

  /** The engine whose form is shown. */
  get current() {
    return this.slots.find(({ form }) => !form.element.hidden) ?? this.slots[0];
  }

  /** Show another engine beside the first: its own figures to begin with. */
  add(design) {
    const [first] = this.slots;
    const slot = new Slot(this.core, design ?? first.design.copy(), {
      units: this.units,
      changed: () => this.changed(),
      speed: (one) => {
        for (const other of this.slots) if (other !== one) other.turnAt(one.design.rpm);
        this.changed();
      },
      turned: (one, changed) => {
        if (!changed.includes("angle_deg") && !changed.includes("playing")) return;
        for (const other of this.slots) if (other !== one) other.turnWith(one);
      },
    });
    this.slots.push(slot);
    this.forms.append(slot.form.element);
    this.stages.append(slot.stage);
    this.arrange(this.slots.length - 1);
  }

  remove() {
    this.slots.pop().destroy();
    this.arrange(0);
  }

  /** Put what is there in its place; the form of one engine is shown. */
  arrange(shown) {
    const several = this.slots.length > 1;
    this.element.classList.toggle("two", several);
    this.compare.textContent = several ? WORDS.single : WORDS.compare;
    this.compare.setAttribute("aria-pressed", several);
    this.chooser.hidden = !several;
    const tabs = this.slots.map((slot, k) => {
      slot.name = several ? [WORDS.first, WORDS.second][k] : WORDS.engine;
      slot.form.element.setAttribute("aria-label", slot.name);
      slot.form.element.hidden = k !== shown;
      const attributes = { role: "tab", "aria-selected": `${k === shown}`, tabindex: k === shown ? 0 : -1 };
      return button(slot.name, () => this.arrange(k), attributes);
    });
    arrows(this.chooser, tabs);
    this.chooser.replaceChildren(...tabs);
    this.refresh();
  }

  /** Follow a change of an engine: address, title and the pane that is shown. */
  changed() {
    if (!this.element || !this.slots.length) return;
    document.title = `${this.slots.map(({ engine }) => engine?.summary.name || WORDS.engine).join(" · ")} – ${WORDS.title}`;
    clearTimeout(this.addressing);
    this.addressing = setTimeout(() => this.writeAddress(), CALM_ADDRESS);
    this.refresh();
  }

  /** Make the pane that is shown anew; what was there stays until it is made. */
  async refresh() {
    const shown = PANES.filter((pane) => this.slots.some(({ engine }) => engine && (!pane.when || pane.when(engine))));
    if (!shown.includes(this.pane)) [this.pane] = PANES;
    const { pane } = this;
    this.buttons.forEach((tab, k) => {
      tab.hidden = !shown.includes(PANES[k]);
      tab.setAttribute("aria-selected", PANES[k] === pane);
      tab.tabIndex = PANES[k] === pane ? 0 : -1;
    });
    this.panes.setAttribute("aria-labelledby", `tab-${pane.key}`);
    const turn = this.turn = (this.turn ?? 0) + 1;
    const slots = this.slots.filter(({ engine }) => engine);
    const boxes = this.boxes(pane, slots);
    try {
      const made = await Promise.all(slots.map((slot) => this.made(pane, slot, slots)));
      if (turn !== this.turn) return;
      boxes.forEach(({ title, results }, k) => {
        title.textContent = slots.length > 1 ? `${slots[k].name}: ${slots[k].engine.summary.name}` : "";
        results.classList.toggle("stale", slots[k].faults.length > 0);
        const held = focusable(results).indexOf(document.activeElement);
        results.replaceChildren(...made[k]);
        // Who pressed a button there goes on from it, or from the one before it.
        if (held >= 0) focusable(results).slice(0, held + 1).findLast((each) => !each.disabled)?.focus({ preventScroll: true });
      });
    } catch (error) {
      if (!(error instanceof Outdated)) throw error;
      if (turn !== this.turn) return;
      boxes[0].results.replaceChildren(explained(`${WORDS.cancelled} `,
        titled(WORDS.again, WORDS.again, () => this.refresh())));
    }
  }

  /** What results are put into: a title, the pane's controls, which stay while results change, and a place. */
  boxes(pane, slots) {
    const same = this.shownBoxes && this.shownBoxes.pane === pane && this.shownBoxes.slots.join() === slots.map(({ id }) => id).join();
    if (!same) {
      const boxes = slots.map((slot) => {
        slot.controls[pane.key] ??= pane.controls?.(slot, { units: () => this.units, again: () => this.refresh() }) ?? "";
        const [title, results] = [html("h2", {}), html("div", { class: "results" })];
        return { title, results, element: html("div", { class: `pane ${pane.key}` }, title, slot.controls[pane.key], results) };
      });
      this.shownBoxes = { pane, slots: slots.map(({ id }) => id), boxes };
      this.panes.replaceChildren(...boxes.map(({ element }) => element));
    }
    return this.shownBoxes.boxes;
  }

  async made(pane, slot, slots) {
    const ask = (name, given) => this.jobs.ask(`${slot.id} ${name}`, name, given);
    const { core, units } = this;
    const table = (given) => tableOf({ units, name: slot.engine.summary.name, ...given });
    const tools = { ask, core, units, slots, table };
    try {
      return await pane.make(slot, tools);
    } catch (error) {
      if (error instanceof Outdated) throw error;
      return [html("p", { class: "fault", role: "alert" }, error.hint ? inWords(error.message) : WORDS.mistake(error.message))];
    }
  }

  /** Show which share of what was asked is computed; null when nobody waits. */
  busy(share) {
    if (share !== null) {
      this.share.textContent = WORDS.computing(share);
      this.noticing ??= setTimeout(() => { this.working.hidden = false; }, NOTICED);
      return;
    }
    clearTimeout(this.noticing);
    this.noticing = null;
    this.working.hidden = true;
  }

  say(text) {
    this.said.textContent = text;
  }

  async openFile(file) {
    try {
      const text = file.size > LONGEST_FILE ? null : await file.text();
      if (text === null) throw new TypingError("file", `${file.size} bytes`, `an engine’s file has at most ${LONGEST_FILE}`);
      const { json } = this.core.call("read", { engine: text });
      this.current.take(Object.assign(Design.file(json), { rpm: this.current.design.rpm }));
      this.say(WORDS.fromFile(file.name));
    } catch (error) {
      this.say(`${WORDS.noFile(file.name)}${error.hint ? error.message : WORDS.unreadable}`);
    }
  }

  /** The engine that is typed and shown; where that is none, the page says so. */
  get typed() {
    const { typed, form } = this.current;
    this.say(typed ? "" : WORDS.nothingToSave(form.whole));
    return typed;
  }

  save() {
    const engine = this.typed;
    if (engine) saveFile(fileName(engine.summary.name, "toml"), engine.toml, "application/toml");
  }

  savePage() {
    const engine = this.typed;
    if (!engine) return;
    saveFile(fileName(engine.summary.name, "html"), turningPage(this.current.figures({ rod_ratios: true })), "text/html");
  }

  async writeAddress() {
    const fragment = await fragmentOf(this.slots.map(({ design }) => design), this.units);
    if (fragment === location.hash) return;
    this.address = fragment;
    history.replaceState(null, "", fragment);
  }

  async copyLink() {
    await this.writeAddress();
    try {
      await navigator.clipboard.writeText(location.href);
      this.say(WORDS.linked);
    } catch {
      this.say(WORDS.linkByHand);
    }
  }

  /** Follow another link to this page. */
  async followAddress() {
    if (location.hash === this.address) return;
    try {
      const given = await designsOf(location.hash);
      if (!given) return;
      const [first, second] = given.designs;
      this.units = given.units;
      this.choice.value = given.units;
      while (this.slots.length > 1) this.remove();
      this.slots[0].units = given.units;
      this.slots[0].take(first);
      if (second) this.add(second);
      this.say("");
    } catch (error) {
      this.say(linkFault(error));
    }
  }
}

/** What is wrong with a link: typed figures have the library's hints, what is packed is whole or not. */
const linkFault = (error) => (error.hint ? error.message : WORDS.badLink);

/** A button with a name for people and a longer one for those who do not see the page. */
const titled = (text, title, act) => button(text, act, { title });

const focusable = (element) => [...element.querySelectorAll("button, summary, [tabindex]")];

/** Arrow keys go from tab to tab. */
function arrows(list, tabs) {
  list.onkeydown = (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    const open = tabs.filter((tab) => !tab.hidden);
    if (!step || !open.includes(event.target)) return;
    event.preventDefault();
    const next = open[(open.indexOf(event.target) + step + open.length) % open.length];
    next.focus();
    next.click();
  };
}
