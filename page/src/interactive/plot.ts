/** A curve over the crank angle, with where the crank is now; drawn in SVG. */

import { h, s, set, write } from "../dom";
import { steady } from "../format";
import { extremes, levels, marked, scaleOf, share, turning } from "../scale";
import { say } from "../words";
import type { Output } from "./data";
import type { Machine, Solution } from "./machine";

const [WIDE, HIGH, LEFT, BELOW, ABOVE] = [560, 168, 52, 20, 8];
/** Below which a curve is drawn as none, in the unit of its output. */
const LEAST = 1e-12;
const ROLES = ["main", "stress"] as const;

export interface Curve {
  output: Output;
  /** What it is called beside others of the same chart. */
  short: string;
}

export class Plot {
  readonly root: HTMLElement;
  private readonly svg = s("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, role: "img" });
  private readonly grid = s("path", { class: "grid" });
  private readonly axis = s("path", { class: "axis" });
  private readonly texts = s("g", { class: "marks" });
  private readonly before = s("g", { class: "before" });
  private readonly lines = s("g", { class: "curves" });
  private readonly cursor = s("path", { class: "cursor" });
  private readonly legend = h("span", { class: "legend" });
  private readonly readings: HTMLElement[] = [];
  private curves: Curve[] = [];
  private rows: Float64Array[] = [];
  private largest = 0;

  constructor(
    private readonly machine: Machine,
    title: HTMLElement,
    private readonly turn: (degrees: number) => void,
  ) {
    this.svg.append(this.grid, this.axis, this.before, this.lines, this.cursor, this.texts);
    this.root = h("figure", { class: "plot" }, h("figcaption", {}, title, this.legend), this.svg);
    const point = (event: PointerEvent) => {
      const box = this.svg.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * WIDE;
      const part = Math.min(Math.max((x - LEFT) / (WIDE - LEFT - 8), 0), 1);
      this.turn(part * 360 * machine.data.turns);
    };
    this.svg.addEventListener("pointerdown", (event) => {
      this.svg.setPointerCapture(event.pointerId);
      point(event);
    });
    this.svg.addEventListener("pointermove", (event) => event.buttons && point(event));
  }

  choose(curves: Curve[]): void {
    this.curves = curves;
    this.readings.length = 0;
    const several = curves.length > 1;
    const entries = curves.map(({ short }, i) => {
      const reading = h("span", { class: "reading" });
      this.readings.push(reading);
      return h("span", { class: `entry ${ROLES[i]}` }, several && h("i", { class: "key" }), several && short, reading);
    });
    this.legend.replaceChildren(...entries);
  }

  /** Draw a design; pale, and behind, what the original does. */
  show(solution: Solution, original: Solution | null): void {
    const rows = (design: Solution) => this.curves.map(({ output }) => this.values(design, output));
    this.rows = rows(solution);
    const old = original ? rows(original) : [];
    const scale = scaleOf([...this.rows, ...old], LEAST, false);
    this.largest = Math.max(...extremes(this.rows).map(Math.abs));
    const y = (value: number) => HIGH - BELOW - share(value, scale) * (HIGH - BELOW - ABOVE);
    const path = (row: Float64Array) =>
      this.machine.shown
        .map((at, i) => `${i ? "L" : "M"}${this.across(i).toFixed(1)} ${y(row[at] as number).toFixed(1)}`)
        .join("");
    this.before.replaceChildren(...old.map((row) => s("path", { d: path(row) })));
    this.lines.replaceChildren(...this.rows.map((row, i) => s("path", { class: ROLES[i] ?? "main", d: path(row) })));
    this.scale(levels(scale, 5), y, (value, all) => marked(value, scale, all));
    const { label, unit } = (this.curves[0] as Curve).output;
    set(this.svg, { "aria-label": `${label}, ${unit}` });
  }

  private values(design: Solution, { name, factor }: Output): Float64Array {
    return (design.row(name) ?? new Float64Array(this.machine.data.angles)).map((value) => value * factor);
  }

  private x(angle: number): number {
    return LEFT + (angle / (2 * Math.PI * this.machine.data.turns)) * (WIDE - LEFT - 8);
  }

  private scale(marks: number[], y: (value: number) => number, format: (value: number, all: number[]) => string): void {
    const whole = 360 * this.machine.data.turns;
    const step = turning(whole);
    const angles = Array.from({ length: Math.floor(whole / step) + 1 }, (_, i) => i * step);
    const across = (degrees: number) => this.x((degrees * Math.PI) / 180);
    const bars = marks.map((mark) => `M${LEFT} ${y(mark).toFixed(1)}H${WIDE - 8}`);
    const posts = angles.map((degrees) => `M${across(degrees).toFixed(1)} ${ABOVE}V${HIGH - BELOW}`);
    set(this.grid, { d: [...bars, ...posts].join("") });
    set(this.axis, { d: marks.includes(0) ? `M${LEFT} ${y(0).toFixed(1)}H${WIDE - 8}` : "" });
    const text = (x: number, top: number, anchor: string, words: string) =>
      s("text", { x: x.toFixed(1), y: top.toFixed(1), "text-anchor": anchor }, words);
    this.texts.replaceChildren(
      ...marks.map((mark) => text(LEFT - 6, y(mark) + 3.5, "end", format(mark, marks))),
      ...angles.map((degrees) => text(across(degrees), HIGH - 5, degrees === whole ? "end" : "middle", `${degrees}°`)),
    );
  }

  /** Where a point of curves is: the side before a jump at crank angle 0 is at the end of the cycle. */
  private across(i: number): number {
    const { shown, theta, data } = this.machine;
    const [last, here] = [theta[shown[i - 1] ?? 0] ?? 0, theta[shown[i] as number] as number];
    return this.x(here < last ? here + 2 * Math.PI * data.turns : here);
  }

  /** Show where the crank is. */
  point(at: number): void {
    const x = this.x(this.machine.theta[at] as number).toFixed(1);
    set(this.cursor, { d: `M${x} ${ABOVE}V${HIGH - BELOW}` });
    this.rows.forEach((row, i) => {
      const { unit } = (this.curves[i] as Curve).output;
      const value = this.largest < LEAST ? "0" : steady(row[at] as number, this.largest);
      write(this.readings[i] as HTMLElement, `${value}\u00a0${unit}`);
    });
  }
}

/** Charts that come first, and a chart that shows what is chosen. */
export class Plots {
  readonly root = h("div", { class: "plots" });
  private readonly plots: Plot[] = [];
  private readonly chosen: Plot;
  private readonly select: HTMLSelectElement;
  private last: [Solution, Solution | null] | null = null;

  constructor(
    private readonly machine: Machine,
    turn: (degrees: number) => void,
  ) {
    const { outputs } = machine.data;
    const byName = new Map(outputs.map((output) => [output.name, output]));
    for (const output of outputs.filter(({ first, name }) => first && !/\.[xy]$/.test(name))) {
      const parts = ["x", "y"].flatMap((axis) => byName.get(`${output.name}.${axis}`) ?? []);
      const plot = new Plot(machine, h("b", {}, capital(output.label)), turn);
      const curves = parts.length
        ? parts.map((part, i) => ({ output: part, short: "xy"[i] as string }))
        : [{ output, short: "" }];
      plot.choose(curves);
      this.plots.push(plot);
    }
    this.select = h("select", { "aria-label": say("Any output over crank angle") }, ...grouped(outputs));
    this.chosen = new Plot(machine, this.select, turn);
    this.plots.push(this.chosen);
    this.select.addEventListener("change", () => this.choose(this.select.value));
    const first = outputs.find(({ kind }) => kind === "joints") ?? outputs[0];
    if (first) this.choose(first.name);
    this.root.append(...this.plots.map(({ root }) => root));
  }

  private choose(name: string): void {
    const output = this.machine.data.outputs.find((output) => output.name === name);
    if (!output) return;
    this.select.value = name;
    this.chosen.choose([{ output, short: "" }]);
    if (this.last) this.chosen.show(...this.last);
    this.point(this.at);
  }

  private at = 0;

  show(solution: Solution, original: Solution | null): void {
    this.last = [solution, original];
    for (const plot of this.plots) plot.show(solution, original);
  }

  point(at: number): void {
    this.at = at;
    if (this.last) for (const plot of this.plots) plot.point(at);
  }
}

function grouped(outputs: Output[]): HTMLElement[] {
  const groups = [...new Set(outputs.map(({ group }) => group))];
  return groups.map((group) =>
    h(
      "optgroup",
      { label: group },
      ...outputs
        .filter((output) => output.group === group)
        .map(({ name, label }) => h("option", { value: name }, capital(label))),
    ),
  );
}

export function capital(text: string): string {
  return text.slice(0, 1).toUpperCase() + text.slice(1);
}
