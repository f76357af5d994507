/**
 * A chart as the server declares it: one of its choices, drawn from the arrays of its message; what it
 * shows, said on demand.
 */

import { fresh, h, put, set, write } from "./dom";
import type { ChartData, Choice, Numbers, PageRequest, State, Unit } from "./protocol";
import { render, v } from "./render";
import { turning } from "./scale";
import { type Curve, Strip } from "./strip";
import type { Role, Theme } from "./theme";
import { explained, say } from "./words";

/** Values, and those before. */
export interface Columns {
  values: Float64Array;
  before?: Float64Array | undefined;
}

/** Crank angle from the first sample, degrees, with the first sample again at the end. */
export class Abscissa {
  private made = new Map<string, Float64Array>();

  of(count: number, turns: number): Float64Array {
    const key = `${count}/${turns}`;
    let x = this.made.get(key);
    if (!x) {
      x = Float64Array.from({ length: count + 1 }, (_, k) => (k / count) * 360 * turns);
      this.made.set(key, x);
    }
    return x;
  }
}

/** How far an angle may have turned when it is where it was, rad. */
const TURN = 2 * Math.PI;

/**
 * Every `stride`th number from the `part`th on; a periodic one ends with its first value again, an
 * angle that winds as many turns further as it has made.
 */
function taken(values: Float32Array, stride: number, part: number, periodic: boolean, winds = false) {
  const count = values.length / stride;
  const column = new Float64Array(periodic ? count + 1 : count);
  for (let k = 0; k < count; k++) column[k] = values[stride * k + part] as number;
  if (!periodic) return column;
  const [first, last] = [column[0] as number, column[count - 1] as number];
  column[count] = first + (winds ? TURN * Math.round((last - first) / TURN) : 0);
  return column;
}

/** A signal of a message, and the same before. */
export function column(
  { numbers, before }: { numbers: Numbers; before: boolean },
  name: string,
  stride = 1,
  part = 0,
  periodic = true,
  winds = false,
): Columns | null {
  const now = numbers.get(name);
  if (!now) return null;
  const values = taken(now, stride, part, periodic, winds);
  const was = before ? numbers.get(`before.${name}`) : undefined;
  return was && was.length === now.length ? { values, before: taken(was, stride, part, periodic, winds) } : { values };
}

/** What was measured of what a chart's array shows, over the same crank angles; null where nothing was. */
export function measured(
  numbers: Numbers,
  array: string,
  stride: number,
  part: number,
  count: number,
  winds = false,
): Float64Array | null {
  const renamed = array.replace(/^joint\./, "joints.").replace(/^response\./, "gauges.");
  const name = renamed.replace(/^output\./, "") + (stride > 1 ? [".x", ".y"][part] : "");
  const recorded = numbers.get(`measured.${name}`);
  if (!recorded || recorded.length + 1 !== count) return null;
  return taken(recorded, 1, 0, true, winds);
}

interface Chooser {
  label: HTMLElement;
  value: string;
  has(name: string): boolean;
  offer(options: [name: string, label: string][]): void;
}

export function chooser(name: string, changed: () => void): Chooser {
  const select = h("select", { "aria-label": name, onchange: changed });
  const has = (value: string) => [...select.options].some((option) => option.value === value);
  return {
    label: h("span", { class: "heading" }, select),
    get value() {
      return select.value;
    },
    set value(value: string) {
      put(select, value);
    },
    has,
    offer(options) {
      render(select, ...options.map(([value, label]) => v("option", { value }, label)));
    },
  };
}

/** Highest order whose bars are drawn. */
const HIGHEST = 10;
const ROLES: Role[] = ["main", "stress"];
const [PLAIN, WITH_X] = [76, 96];

/** What a chart is drawn from: a message's arrays, with what they were before. */
export interface Source {
  state: State;
  numbers: Numbers;
  before: boolean;
  least?: number;
  role?: Role;
}

const angles = new Abscissa();

export class Chart {
  readonly strip: Strip;
  private readonly choices: Chooser | null = null;
  private offered = "";

  constructor(
    private data: ChartData,
    theme: Theme,
    readonly xAxis: boolean,
    whole: { picked(x: number): void; chosen(): void },
  ) {
    const { x } = data;
    if (data.chooser !== null) this.choices = chooser(data.chooser, () => whole.chosen());
    const over = { xLabel: "°", xStep: turning };
    this.strip = new Strip(
      {
        height: xAxis ? WITH_X : PLAIN,
        xAxis,
        ...(x === "angle" && { ...over, picked: whole.picked }),
        ...(x === "order" && { bars: true }),
        ...(typeof x === "object" &&
          (x.at === null ? { picked: (at) => whole.picked(at / x.factor) } : { quiet: true })),
        ...(this.choices && { control: this.choices.label }),
      },
      theme,
    );
  }

  /** Name of what is chosen. */
  get chosen(): string {
    return this.choices?.value ?? "";
  }

  /** Choose, where there is one of that name. */
  choose(name: string): void {
    if (this.choices?.has(name)) this.choices.value = name;
  }

  /** Take what there is to choose from now; `other` begins with the first of it again. */
  offer(data: ChartData, whose: string, other: boolean): void {
    this.data = data;
    const there = this.there(whose);
    const shape = JSON.stringify(there.map(({ label }) => label));
    if (!this.choices || (shape === this.offered && !other)) return;
    const chosen = this.choices.value;
    this.offered = shape;
    this.choices.offer(there.map(({ name, label }) => [name, label]));
    if (!other) this.choose(chosen);
  }

  /** Draw what is chosen, or what is of a name. */
  show(source: Source, whose: string, name: string): void {
    const there = this.there(whose);
    const wanted = this.choices ? this.choices.value : name;
    const choice = there.find((choice) => choice.name === wanted) ?? there[0];
    const curves = choice ? this.curves(choice, source) : [];
    this.strip.root.hidden = !curves.length;
    if (!choice || !curves.length) return;
    const x = this.across(source, curves[0]?.values.length ?? 0);
    const least = (source.least ?? 0) * choice.factor;
    const unit =
      typeof this.data.x === "object"
        ? say("{unit}, over {x}", { unit: choice.unit, x: this.data.x.unit })
        : choice.unit;
    this.strip.show({ title: choice.label, x, unit, curves, least, log: choice.log });
    const { x: over } = this.data;
    if (typeof over === "object" && over.at !== null) this.strip.point(over.at * over.factor, null);
  }

  /** Whether what it would draw of a source is nothing but zero. */
  static idle(data: ChartData, { numbers, least = 0, before }: Source, whose: string): boolean {
    if (data.chooser !== null) return false;
    const choice = data.choices.find(({ of }) => of === null || of === whose);
    const names = (choice?.curves ?? []).map(({ array }) => array);
    const arrays = names.flatMap((name) => [name, ...(before ? [`before.${name}`] : [])]);
    const seen = names.some((name) => numbers.names(`measured.${name}`).length > 0);
    return !seen && arrays.every((name) => numbers.get(name)?.every((value) => Math.abs(value) <= least));
  }

  /** Where a chart over the crank angle is, at a share of the cycle. */
  point(share: number, degrees: number): void {
    if (this.data.x !== "angle" || this.strip.root.hidden) return;
    const count = this.strip.count - 1;
    if (count > 0) this.strip.point(degrees, Math.round(share * count) % count);
  }

  /** Where a chart over what is played is, in SI units of its x axis. */
  play(at: number): void {
    if (typeof this.data.x === "object") this.strip.play(at * this.data.x.factor);
  }

  private there(whose: string): Choice[] {
    return this.data.choices.filter(({ of }) => of === null || of === whose);
  }

  private curves(choice: Choice, source: Source): Curve[] {
    return choice.curves.flatMap((curve, i) => {
      const columns = column(source, curve.array, curve.stride, curve.part, this.data.x === "angle");
      if (!columns) return [];
      const role = source.role ?? ROLES[i] ?? "third";
      const model = {
        label: curve.label,
        role,
        points: curve.points,
        ...this.kept(scaled(columns, choice), source.state),
      };
      const { array, stride, part } = curve;
      const over = this.data.x === "angle" ? source.state.numbers : null;
      const seen = over && measured(over, array, stride, part, columns.values.length);
      return seen ? besides(model, times(seen, choice)) : [model];
    });
  }

  /** Of all orders those that are drawn. */
  private kept(columns: Columns, state: State): Columns {
    if (this.data.x !== "order") return columns;
    const some = (values: Float64Array) => values.filter((_, i) => drawn(state, i));
    return { values: some(columns.values), before: columns.before && some(columns.before) };
  }

  private across({ state, numbers }: Source, count: number): Float64Array {
    const { x } = this.data;
    if (x === "angle") return angles.of(count - 1, state.turns);
    if (x === "order") return Float64Array.from(state.orders.filter((_, i) => drawn(state, i)));
    return times(Float64Array.from(numbers.get(x.array) ?? []), x);
  }
}

function drawn({ orders, turns }: State, i: number): boolean {
  const order = orders[i] ?? 0;
  return order > 0 && order <= (turns > 1 ? HIGHEST / 2 : HIGHEST);
}

/** A curve, and what was measured of the same. */
export function besides(model: Curve, values: Float64Array): Curve[] {
  const label = [model.label, say("measured")].filter(Boolean).join(" ");
  return [
    { ...model, label: model.label || say("model") },
    { label, role: "quiet", values },
  ];
}

/** Values in SI units in those of something else. */
export function times(values: Float64Array, { factor }: Unit): Float64Array {
  return values.map((value) => value * factor);
}

export function scaled({ values, before }: Columns, unit: Unit): Columns {
  return { values: times(values, unit), before: before && times(before, unit) };
}

export type Ask = (request: PageRequest) => void;

/** Put a "?" at the end of the heading of a chart of that title; `choice` gives which of its signals is shown. */
export function explain(figure: HTMLElement, title: string, name: string, ask: Ask, choice: () => string): void {
  const heading = figure.querySelector("figcaption");
  if (!heading || heading.querySelector(".why")) return;
  const id = fresh("why");
  const keep = (format: "svg" | "png") =>
    h(
      "button",
      {
        type: "button",
        class: "keeps",
        onclick: () => ask({ type: "download", kind: "chart", chart: name, choice: choice(), format }),
      },
      format.toUpperCase(),
    );
  const shows = h("p", {});
  const explanation = h(
    "div",
    { class: "explained", id, hidden: true },
    shows,
    h("p", { class: "keeping" }, say("Keep this chart as"), " ", keep("svg"), keep("png")),
  );
  const button = h(
    "button",
    {
      type: "button",
      class: "why",
      "aria-label": say("{chart}: what does it show?", { chart: title }),
      title: say("What does this chart show?"),
      "aria-expanded": "false",
      "aria-controls": id,
      onclick: () => {
        explanation.hidden = !explanation.hidden;
        write(shows, explained(name)); // which goes by the machine that is open
        set(button, { "aria-expanded": String(!explanation.hidden) });
      },
    },
    "?",
  );
  heading.append(button);
  heading.after(explanation);
}
