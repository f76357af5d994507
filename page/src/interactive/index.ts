/** An interactive file: a machine that is dragged and changed, and computes itself. */

import { h, icon, letsMove, write } from "../dom";
import { follow, measure } from "../format";
import type { Attempts } from "../gesture";
import { Hands, turnable } from "../hands";
import { Player, TransportBar } from "../player";
import type { Drawable, Edit } from "../protocol";
import { type Grip, Stage } from "../stage";
import { say, speak } from "../words";
import { changed, toml } from "./changes";
import type { Extremes, MachineData, States } from "./data";
import { Drawing } from "./drawing";
import { massMoved, moved, reaches } from "./edits";
import { Machine, type Solution } from "./machine";
import { Inputs, Readout } from "./numbers";
import { Plots } from "./plot";
import { Shaking } from "./shaking";

export { toml } from "./changes";
export { Drawing } from "./drawing";
export { moved, outside, typed, withLength } from "./edits";
export { Machine } from "./machine";

class Page implements Attempts {
  readonly open: Attempts["open"] = new Set();
  private readonly original: Solution;
  private readonly drawing: Drawing;
  private readonly player = new Player();
  private readonly hands: Hands<Drawable>;
  private readonly stage: Stage<Drawable>;
  private readonly transport: TransportBar;
  private readonly plots: Plots;
  private readonly inputs: Inputs;
  private readonly readout: Readout;
  private readonly shaking: Shaking | null;
  private readonly status = h("p", { class: "said", role: "status" });
  private readonly hint = h("p", { class: "hint", "aria-hidden": "true" });
  private readonly lines = h("textarea", {
    readonly: true,
    rows: 6,
    "aria-label": say("Changed numbers as lines of the model file"),
  });
  private readonly undoButton: HTMLButtonElement;
  private readonly resetButton: HTMLButtonElement;
  private readonly copies: HTMLElement;
  private readonly past: Float64Array[] = [];
  private shown: Drawable;
  private solution: Solution;
  /** What was last committed, and from which a drag begins. */
  private settled: Solution;

  constructor(
    root: HTMLElement,
    private readonly machine: Machine,
  ) {
    this.original = this.solution = this.settled = machine.solve(machine.base);
    this.shaking = machine.place.has("shaking_force.x") ? new Shaking(this.original) : null;
    this.drawing = new Drawing(machine, this.shaking?.tips());
    this.shown = this.drawing.of(this.solution);
    this.hands = new Hands<Drawable>(
      {
        talk: this,
        state: () => this.shown,
        sample: () => this.player.sample,
        chosen: (grip) => this.stage.select(new Set([grip.name]), null, grip),
        holding: (on) => this.hold(on),
        hint: (text) => write(this.hint, text),
        kept: () => [],
      },
      (dress) => new Stage<Drawable>(dress),
    );
    this.stage = this.hands.made;
    if (this.shaking) this.stage.overlay(this.shaking, "grips");
    this.transport = new TransportBar(
      this.player,
      () => this.toggle(),
      () => this.point(),
    );
    this.plots = new Plots(machine, (degrees) => this.turn(degrees));
    const attempt = (design: Float64Array) => this.commit(design);
    this.inputs = new Inputs(machine, this.original, attempt, (sentence) => this.tell(sentence, !!sentence));
    this.readout = new Readout(machine);
    this.undoButton = h("button", { type: "button", disabled: true, onclick: () => this.undo() }, say("Undo"));
    this.resetButton = h("button", { type: "button", disabled: true, onclick: () => this.reset() }, say("Reset all"));
    this.copies = h(
      "details",
      { class: "copies", hidden: true },
      h("summary", {}, say("Changed numbers")),
      h(
        "p",
        { class: "quiet" },
        say("Put these lines in the place of those in the model file, or copy them to whoever keeps it."),
      ),
      this.lines,
      h("button", { type: "button", onclick: () => void this.copy() }, say("Copy")),
    );
    this.lay(root);
    this.begin();
  }

  private lay(root: HTMLElement): void {
    const { data } = this.machine;
    const sheet = h("div", { class: "sheet" });
    root.className = "equipoise equipoise-page interactive";
    root.dataset.settled = ""; // nothing is waited for: all is computed at once
    const fit = h(
      "button",
      {
        type: "button",
        class: "fit",
        title: say("Show all"),
        "aria-label": say("Show all"),
        onclick: () => this.stage.fit(),
      },
      icon("M2.500 6v-3.500h3.500M10 2.500h3.500v3.500M13.500 10v3.500h-3.500M6 13.500h-3.500v-3.500"),
    );
    sheet.append(this.stage.lines, this.stage.svg, this.stage.numbers, this.hint, this.status, fit);
    root.replaceChildren(
      h(
        "header",
        {},
        h("h1", {}, data.title),
        h("p", { class: "quiet" }, data.description),
        ...data.notes.map((note) => h("p", { class: "note" }, note)),
      ),
      this.motion(sheet),
      this.beside(),
      h("section", { class: "charts", "aria-label": say("Charts") }, this.plots.root),
    );
    new ResizeObserver(() => this.stage.resize(sheet.clientWidth, sheet.clientHeight)).observe(sheet);
    this.stage.resize(sheet.clientWidth, sheet.clientHeight);
    root.addEventListener("keydown", (event) => this.key(event));
    turnable({
      stage: this.stage,
      state: () => this.shown,
      angle: () => this.player.angle,
      turn: (degrees) => this.turn(degrees),
      chosen: () => undefined,
    });
  }

  private motion(sheet: HTMLElement): HTMLElement {
    return h(
      "section",
      { class: "motion", "aria-label": say("Linkage") },
      sheet,
      this.transport.root,
      h(
        "details",
        { class: "about" },
        h("summary", {}, say("What a drag changes")),
        h(
          "p",
          {},
          say(
            "A joint that is dragged gets new coordinates in each link that has it, or new lengths to the other joints of the link. At the crank angle shown, all other joints stay where they are. On a guide it moves along the guide. Masses and moments of inertia stay as they are.",
          ),
        ),
      ),
    );
  }

  private beside(): HTMLElement {
    const { data } = this.machine;
    return h(
      "div",
      { class: "beside" },
      h("section", { class: "figures", "aria-label": say("Figures") }, h("h2", {}, say("Figures")), this.readout.root),
      h(
        "section",
        { class: "values", "aria-label": say("Numbers") },
        h("h2", {}, say("Numbers"), this.undoButton, this.resetButton),
        this.copies,
        data.fields.length
          ? this.inputs.root
          : h(
              "p",
              { class: "quiet" },
              say("The numbers of this machine cannot be changed here; open its model in Equipoise."),
            ),
      ),
    );
  }

  private begin(): void {
    const { data, frames } = this.machine;
    this.player.take({ angles: frames.length, turns: data.turns, speed: data.speed });
    this.player.suit();
    this.player.angle = data.begin;
    this.transport.take();
    this.show(this.solution, true);
    if (letsMove()) this.toggle();
    const tick = (now: number) => {
      if (this.player.tick(now)) this.point();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  // -- what is shown ------------------------------------------------------------------------------

  private show(solution: Solution, first = false): void {
    this.solution = solution;
    this.shown = this.drawing.of(solution);
    this.shaking?.take(solution);
    this.stage.show(this.shown, first);
    const changes = changed(this.machine, solution.design);
    const before = changes.length ? this.original : null;
    this.plots.show(solution, before);
    this.readout.show(solution, before);
    this.inputs.show(solution);
    const speed = solution.number("drive.speed") ?? this.machine.data.speed;
    this.player.take({ angles: this.machine.frames.length, turns: this.machine.data.turns, speed });
    this.lines.value = toml(this.machine, solution.design);
    this.copies.hidden = !changes.length;
    this.resetButton.disabled = !changes.length;
    this.undoButton.disabled = !this.past.length;
    this.point();
  }

  private point(): void {
    this.stage.pose(this.player.sample);
    if (!this.player.playing) this.hands.describe();
    this.hands.follow();
    this.transport.point();
    this.plots.point(this.machine.frames[this.player.sample] as number);
  }

  private turn(degrees: number): void {
    this.player.playing = false;
    this.transport.state();
    this.player.angle = degrees;
    this.point();
  }

  private toggle(): void {
    this.player.playing = !this.player.playing;
    this.transport.state();
    this.point();
  }

  private tell(sentence: string, bad: boolean): void {
    write(this.status, sentence);
    this.status.classList.toggle("bad", bad);
  }

  // -- what is changed ----------------------------------------------------------------------------

  /** While something is held the crank stands still. */
  private hold(on: boolean): void {
    if (!on) return;
    this.player.playing = false;
    this.transport.state();
  }

  release(): void {
    for (const gesture of [...this.open]) gesture.end();
  }

  rest(): void {
    if (this.solution !== this.settled) this.show(this.settled);
  }

  attempt(_label: string, edits: Edit[], _stamp: number, done: (refusal: string | null) => void): void {
    const [solution, why] = this.edited(edits);
    if (why) this.hands.refused();
    else {
      this.hands.accepted();
      this.show(solution);
    }
    this.tell(why ?? this.changes(solution), !!why);
    done(why);
  }

  ask({ edits }: { edits: Edit[] }): void {
    const [solution, why] = this.edited(edits);
    if (!why) this.settle(solution);
    else this.rest();
  }

  /** A machine with edits, from where it was before they began; why it cannot be, or null. */
  private edited(edits: Edit[]): [Solution, string | null] {
    const at = this.machine.frames[this.player.sample] as number;
    let design = this.settled.design;
    let goal: Extract<Edit, { move: string }> | null = null;
    for (const edit of edits) {
      if ("move" in edit) [design, goal] = [moved(this.settled, edit.move, edit.to, at), edit];
      else if ("move_mass" in edit) design = massMoved(this.settled, edit.move_mass, edit.to, at);
    }
    const solution = this.machine.solve(design);
    if (solution.refusal) return [solution, solution.refusal];
    if (
      goal &&
      !reaches(solution, goal.move, goal.to, at) &&
      !reaches(solution, goal.move, this.settled.point(goal.move, at), at)
    ) {
      const side = this.onGuide(goal.move)
        ? null
        : say(
            "{name} would need its links on their other side, which this file cannot do; open the model in Equipoise",
            { name: goal.move },
          );
      return [solution, side];
    }
    return [solution, null];
  }

  private onGuide(name: string): boolean {
    return (
      this.machine.data.sliders.some(({ point }) => point === name) ||
      this.machine.data.driven.some((link) => this.machine.data.links[link]?.sized === "length")
    );
  }

  /** Of which bodies a drag has changed numbers. */
  private changes(solution: Solution): string {
    const { fields } = this.machine.data;
    const other = fields.filter((_, k) => solution.design[k] !== this.settled.design[k]);
    const bodies = [...new Set(other.map(({ heading }) => heading))];
    return bodies.length ? say("changed: {what}", { what: bodies.join(say(", ")) }) : "";
  }

  private commit(design: Float64Array): string | null {
    const solution = this.machine.solve(design);
    if (!solution.refusal) this.settle(solution);
    return solution.refusal;
  }

  private settle(solution: Solution): void {
    if (solution.design.some((value, k) => value !== this.settled.design[k])) this.past.push(this.settled.design);
    this.settled = solution;
    this.show(solution);
  }

  private undo(): void {
    const design = this.past.pop();
    if (!design) return;
    this.settled = this.machine.solve(design);
    this.tell("", false);
    this.show(this.settled);
  }

  private reset(): void {
    this.tell("", false);
    this.settle(this.original);
  }

  private async copy(): Promise<void> {
    this.lines.select();
    try {
      await navigator.clipboard.writeText(this.lines.value);
      this.tell(say("copied"), false);
    } catch {
      this.lines.focus(); // what is selected can be copied by hand
    }
  }

  private key(event: KeyboardEvent): void {
    const typing = event.target instanceof HTMLInputElement || event.target instanceof HTMLTextAreaElement;
    if (typing && (event.target as HTMLInputElement).type !== "range") return;
    if (event.key === "z" && (event.ctrlKey || event.metaKey)) this.undo();
    else if (
      event.key === " " &&
      !(event.target instanceof HTMLButtonElement) &&
      !(event.target instanceof HTMLElement && event.target.closest("summary, select"))
    ) {
      event.preventDefault();
      this.toggle();
    }
  }
}

export type { Grip };

if (typeof document !== "undefined") {
  const root = document.getElementById("equipoise-interactive");
  const text = document.getElementById("equipoise-machine")?.textContent;
  const { states, extremes } = globalThis as unknown as { states?: States; extremes?: Extremes };
  if (root && text && states && extremes) {
    const data = JSON.parse(text) as MachineData;
    speak(data.language, data.words, data.decimal);
    follow(data.rules);
    measure(data.length);
    new Page(root, new Machine(data, states, extremes));
  }
}
