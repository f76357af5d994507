/** A chart as the server declares it: one of its choices, drawn from the arrays of its message. */

import { type Chooser, chooser } from "./chooser";
import type { ChartData, Choice, Numbers, State, Unit } from "./protocol";
import { turning } from "./scale";
import { Abscissa, type Columns, column, measured } from "./signals";
import { Strip } from "./strip";
import type { Role, Theme } from "./theme";
import type { Curve } from "./uplot_options";
import { say } from "./words";

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
        ...(typeof x === "object" && (x.at === null ? { picked: (at) => whole.picked(at / x.factor) } : { quiet: true })),
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
    const choice = there.find((one) => one.name === wanted) ?? there[0];
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
    return choice.curves.flatMap((one, i) => {
      const found = column(source, one.array, one.stride, one.part, this.data.x === "angle");
      if (!found) return [];
      const role = source.role ?? ROLES[i] ?? "third";
      const model = { label: one.label, role, points: one.points, ...this.kept(scaled(found, choice), source.state) };
      const { array, stride, part } = one;
      const over = this.data.x === "angle" ? source.state.numbers : null;
      const seen = over && measured(over, array, stride, part, found.values.length);
      return seen ? besides(model, times(seen, choice)) : [model];
    });
  }

  /** Of all orders those that are drawn. */
  private kept(found: Columns, state: State): Columns {
    if (this.data.x !== "order") return found;
    const some = (values: Float64Array) => values.filter((_, i) => drawn(state, i));
    return { values: some(found.values), before: found.before && some(found.before) };
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
  return [{ ...model, label: model.label || say("model") }, { label, role: "quiet", values }];
}

/** Values in SI units in those of something else. */
export function times(values: Float64Array, { factor }: Unit): Float64Array {
  return values.map((value) => value * factor);
}

export function scaled({ values, before }: Columns, unit: Unit): Columns {
  return { values: times(values, unit), before: before && times(before, unit) };
}
