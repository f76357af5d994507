/** All charts beside the linkage. */

import { type Ask, Chart, chooser, explain, type Source } from "./chart";
import { h, show, write } from "./dom";
import { lengths } from "./format";
import { Outputs } from "./outputs";
import { Plane, type Trace } from "./plane";
import type { ChartData, Numbers, ResponseMessage, State, Strokes } from "./protocol";
import { capital } from "./readings";
import type { Strip } from "./strip";
import type { Role, Theme } from "./theme";
import { say } from "./words";

/** What stands before the names of all rows together. */
const ROWS = "rows.";
const THIRD: Role = "third";

export class Charts {
  readonly root: HTMLElement;
  private readonly squares = h("div", { class: "squares" });
  private readonly whose = chooser(say("Forces of"), () => this.chosen());
  private readonly whoseRow = h("div", { class: "whose" }, this.whose.label);
  private readonly pathOf = chooser(say("Path of"), () => this.chosen());
  private readonly polar = new Plane(say("Shaking force, polar"), true, h("b", {}, say("Polar force")));
  private readonly path = new Plane(say("Path"), false, this.pathOf.label);
  private readonly forces = h("div", { class: "group" });
  private readonly answers = h("div", { class: "group" });
  private readonly links = h("div", { class: "group" });
  private readonly zeros = h("p", { class: "quiet zeros", hidden: true });
  private readonly outputs: Outputs;
  /** Those that the server declares, by name. */
  private readonly declared = new Map<string, Chart>();
  private state: State | null = null;
  /** An unfinished machine has nothing to draw. */
  private asleep = false;
  /** Paths that are offered. */
  private paths = "";
  private firstPath = "";
  /** The charts that come first. */
  private leads: State["first"] | null = null;
  /** Of a design that is drawn pale. */
  private ghost: Numbers | null = null;
  private heard: [ResponseMessage, Numbers] | null = null;
  /** Loads along links. */
  private loads: [Strokes, Numbers] | null = null;
  private at = 0;
  /** Something is dragged: what is written follows more seldom. */
  private held = false;
  private width = 0;
  private readonly watcher = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const strip = this.strips.find(({ root }) => root === target);
      if (strip) strip.visible = isIntersecting;
    }
  });

  constructor(
    private readonly theme: Theme,
    private readonly picked: (degrees: number) => void,
    wanted: (names: string[]) => void,
    private readonly ask: Ask,
  ) {
    this.outputs = new Outputs(theme, picked, wanted, (strip, { name, label }) => {
      this.watcher.observe(strip.root);
      explain(strip.root, capital(label), "output", ask, () => name);
    });
    explain(this.polar.root, say("Shaking force, polar"), "polar", ask, () => "");
    explain(this.path.root, say("Path"), "path", ask, () => "");
    this.squares.append(this.polar.root, this.path.root);
    this.root = h("div", { class: "charts" });
  }

  close(): void {
    this.watcher.disconnect();
    for (const strip of this.strips) strip.close();
  }

  private get strips(): Strip[] {
    return [...[...this.declared.values()].map(({ strip }) => strip), ...this.outputs.strips];
  }

  /** What stands before the names of the forces that are shown. */
  private get rows(): string {
    return this.whoseRow.hidden ? "" : this.whose.value;
  }

  hold(on: boolean): void {
    this.held = on;
  }

  /** Write in the headings what there is at the crank angle that is shown. */
  read(): void {
    if (this.asleep) return;
    this.polar.read();
    this.path.read();
    for (const strip of this.strips) strip.read();
  }

  /** Draw what is out of sight too, and describe it in words. */
  settle(): void {
    for (const strip of this.strips) {
      strip.settle();
      strip.describe();
    }
  }

  resize(width: number): void {
    if (width < 40) return;
    this.width = width;
    for (const strip of this.strips) strip.resize(width);
    this.outputs.resize(width);
    const side = Math.floor((width - 8) / 2);
    const height = Math.max(Math.min(side, 216), 150);
    this.polar.resize(side, height);
    this.path.resize(this.polar.root.hidden ? width : side, height);
  }

  /** Draw a state, before it is pointed at a crank angle. */
  show(state: State, opened: boolean): void {
    const other = opened || this.asleep;
    this.asleep = !state.status.finished;
    if (this.asleep) return;
    this.state = state;
    const forces = state.numbers.has("shaking_force");
    if (other || !state.scene.reference || !forces) {
      this.heard = null;
      this.draw([], { state, numbers: state.numbers, before: false }, this.answers, other);
    }
    if (other || !forces) this.loaded(null);
    show(this.polar.root, forces);
    this.squares.classList.toggle("alone", !forces);
    // Rows that stand still have no forces together.
    show(this.whoseRow, state.numbers.has(`${ROWS}shaking_force`));
    if (state.first !== this.leads) this.arrange(state.first);
    this.offer(state, other);
    this.again(other);
  }

  /** A state's response came; it is kept while the next is computed. */
  answered(message: ResponseMessage, numbers: Numbers): void {
    const first = !this.heard;
    this.heard = [message, numbers];
    this.answer(first);
  }

  /** What links bear along their length came with the figures of a state; null where it is another machine. */
  loaded(message: Strokes | null, numbers?: Numbers): void {
    const { state } = this;
    const other = !this.loads;
    this.loads = message && numbers ? [message, numbers] : null;
    if (state) this.drawLoads(state, other);
  }

  private drawLoads(state: State, other: boolean): void {
    const [message, numbers] = this.loads ?? [{ charts: [] }, state.numbers];
    this.draw(message.charts, { state, numbers, before: false }, this.links, other);
  }

  /** Draw the path of a pale design behind that of the machine. */
  pale(numbers: Numbers): void {
    this.ghost = numbers;
    if (this.state && !this.asleep) this.drawPath(this.state);
  }

  /** The joint whose force is shown, and the point whose path is, where there is one of that name. */
  choose(name: string): void {
    this.declared.get("joint")?.choose(`joint.${name}`);
    this.again(false);
    this.repoint();
  }

  point(k: number, degrees: number): void {
    if (this.asleep) return;
    this.at = k;
    this.polar.point(k);
    this.path.point(k);
    this.outputs.point(degrees, k);
    const share = k / (this.state?.angles ?? 1);
    for (const chart of this.declared.values()) chart.point(share, degrees);
    if (!this.held) this.read();
  }

  repaint(): void {
    for (const strip of this.strips) strip.repaint();
  }

  /** Charts in their order, but first those of what the machine is for. */
  private arrange(first: State["first"]): void {
    this.leads = first;
    const { squares, forces, answers } = this;
    const groups = { squares, forces, output: this.outputs.root, answers, links: this.links };
    this.root.append(this.whoseRow, ...Object.values(groups));
    this.whoseRow.after(groups[first]);
  }

  private offer(state: State, other: boolean): void {
    const names = state.numbers.names("place.").map((name) => name.slice(6));
    const moving = names.filter((name) => !state.scene.frame.includes(name));
    const first = state.traced;
    const points = [...first, ...moving.filter((name) => !first.includes(name))];
    const ground = (state.planting?.tips ?? []).map((point): [string, string] => [
      `ground.${point}`,
      say("{point} over ground", { point }),
    ]);
    const paths = points.map((point): [string, string] => [point, say("Path of {point}", { point })]);
    const options = [...ground, ...paths];
    const shape = JSON.stringify(options);
    if (shape === this.paths && !other) return;
    const chosen = this.pathOf.value;
    const leads = options[0]?.[0] ?? "";
    this.paths = shape;
    this.pathOf.offer(options);
    // The first is what the machine is for: until that is another, what was chosen stays.
    if (!other && leads === this.firstPath && this.pathOf.has(chosen)) this.pathOf.value = chosen;
    this.firstPath = leads;
    if (!other) return;
    this.whose.offer([
      [ROWS, say("Forces of all rows together")],
      ["", say("Forces of one row")],
    ]);
  }

  private chosen(): void {
    this.again(false);
    this.repoint();
    this.answer(false);
    if (this.state) this.drawLoads(this.state, false);
    this.settle();
  }

  private again(other: boolean): void {
    const { state } = this;
    if (!state) return;
    const source = { state, numbers: state.numbers, before: state.before, least: state.least };
    this.drawPath(state);
    if (!this.polar.root.hidden) this.drawPolar(state);
    this.draw(state.charts, source, this.forces, other);
    this.outputs.show(state);
  }

  /** Point at the same crank angle in what has been drawn anew. */
  private repoint(): void {
    const { state, at } = this;
    if (state) this.point(at, (at / state.angles) * 360 * state.turns);
  }

  private answer(other: boolean): void {
    const { state, heard } = this;
    if (!state) return;
    const [message, numbers] = heard ?? [{ charts: [] }, state.numbers];
    const source = { state, numbers, before: false, role: THIRD };
    this.draw(message.charts, source, this.answers, other);
  }

  /** Draw charts in their order; those that are no longer sent are hidden. */
  private draw(all: ChartData[], source: Source, within: HTMLElement, other: boolean): void {
    const { rows } = this;
    const idle = all.filter((data) => Chart.idle(data, source, rows));
    const active = all.filter((data) => !idle.includes(data));
    if (within === this.forces) this.tellIdle(idle);
    const names = active.map(({ name }) => name);
    for (const [name, { strip }] of this.declared)
      if (strip.root.parentElement === within && !names.includes(name)) strip.root.hidden = true;
    let leader: Chart | null = null;
    active.forEach((data, i) => {
      const shared = data.x === "angle" && data.chooser === null && active[i + 1]?.chooser === null;
      const chart = this.of(data, !shared);
      chart.offer(data, rows, other);
      chart.show(source, rows, data.chooser === null ? (leader?.chosen ?? "") : "");
      if (data.chooser !== null) leader = chart;
    });
    const roots = active.flatMap(({ name }) => this.declared.get(name)?.strip.root ?? []);
    if (roots.some((root, i) => within.children[i] !== root)) within.prepend(...roots);
  }

  /** What has no chart, as it would be a line along zero. */
  private tellIdle(idle: ChartData[]): void {
    const names = idle.map(({ choices }) => choices[0]?.label ?? "").join("; ");
    write(this.zeros, names && say("Zero at every crank angle: {names}", { names }));
    this.zeros.hidden = !names;
    if (this.zeros.parentElement !== this.forces) this.forces.append(this.zeros);
  }

  /** The chart that is declared, with numbers below it or without. */
  private of(data: ChartData, xAxis: boolean): Chart {
    const known = this.declared.get(data.name);
    if (known?.xAxis === xAxis) return known;
    if (known) {
      this.watcher.unobserve(known.strip.root);
      known.strip.close();
    }
    return this.made(data, xAxis);
  }

  private made(data: ChartData, xAxis: boolean): Chart {
    const { picked } = this;
    const chart = new Chart(data, this.theme, xAxis, { picked, chosen: () => this.chosen() });
    this.declared.set(data.name, chart);
    this.watcher.observe(chart.strip.root);
    const [first] = data.choices;
    const title = data.chooser ?? first?.label ?? "";
    explain(chart.strip.root, title, data.name, this.ask, () => chart.chosen || (first?.name ?? ""));
    chart.strip.resize(this.width);
    return chart;
  }

  private drawPolar(state: State): void {
    const force = `${this.rows}shaking_force`;
    const traces: Trace[] = [];
    const was = state.before ? state.numbers.get(`before.${force}`) : undefined;
    if (was) traces.push({ points: was, kind: "before", closed: true });
    const now = state.numbers.get(force);
    if (now) traces.push({ points: now, kind: "now", closed: true });
    const every = state.angles / (12 * state.turns);
    const output = state.outputs.find(({ name }) => name === force);
    const { label, unit, factor } = output ?? { label: "", unit: "", factor: 1 };
    this.polar.show({ title: capital(label), unit, factor, traces, every, least: state.least });
  }

  private drawPath(state: State): void {
    const name = this.pathOf.value;
    // Without speed nothing goes over the ground: then the path is that on the machine.
    const over = name.startsWith("ground.") && state.numbers.has(name);
    const array = over ? name : `place.${name.replace("ground.", "")}`;
    const points = state.numbers.get(array);
    if (!points) return;
    const every = state.angles / (24 * state.turns);
    const level = over ? state.planting?.surface : undefined;
    const traces: Trace[] = [{ points, kind: "now", closed: !over }];
    const was = this.ghost?.get(array);
    if (was) traces.unshift({ points: was, kind: "before", closed: !over });
    this.path.show({ title: say("Path"), ...lengths(), traces, every, level, least: 1e-6 });
  }
}
