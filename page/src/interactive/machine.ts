/** A machine computed from its numbers: signals, figures, and why it cannot move; without a page. */

import { signed } from "../format";
import type { Pair } from "../protocol";
import { say } from "../words";
import type { Extremes, MachineData, MachineRow, Soil, States } from "./data";

/** Cosine of the angle between a link and the base's, beyond which turns cannot be counted. */
const FAR = -0.5;

export interface Figures {
  mean: number;
  rms: number;
  peak: number;
  max: number;
  min: number;
}

export class Machine {
  readonly theta: Float64Array;
  readonly base: Float64Array;
  /** Crank angles that are equally spaced over the cycle, by their places among all. */
  readonly frames: number[];
  /** Crank angles that curves go through. */
  readonly shown: number[];
  readonly place = new Map<string, number>();
  /** Place of a number in a design, by its path. */
  readonly numbers = new Map<string, number>();
  private readonly grid: Float64Array;
  private readonly rowGrids: Float64Array[];
  private readonly shares: Float64Array | null;
  /** Of samples that resolve jumps: places in the order in which extremes are taken, and panels. */
  private readonly order: number[] | null = null;
  private readonly at: Float64Array | null = null;
  private readonly edges: Float64Array | null = null;

  constructor(
    readonly data: MachineData,
    private readonly states: States,
    private readonly extremes: Extremes,
  ) {
    this.theta = floats(data.theta);
    this.grid = floats(data.grid);
    this.rowGrids = data.rows.map(({ grid }) => floats(grid));
    this.shares = data.shares === null ? null : floats(data.shares);
    this.base = Float64Array.from(data.design);
    const all = Array.from(this.theta, (_, k) => k);
    this.frames = data.frames ?? all;
    this.shown = data.shown ?? all;
    if (data.edges !== null) {
      this.order = [...this.shown, ...all.filter((k) => this.shares?.[k])];
      this.at = Float64Array.from(this.shown, (k) => this.theta[k] as number);
      this.edges = floats(data.edges);
    }
    for (const [k, name] of data.names.entries()) this.place.set(name, k);
    for (const [k, { path }] of data.fields.entries()) this.numbers.set(path, k);
  }

  /** Everything at all crank angles, of a design (numbers in SI units, in the order of the fields). */
  solve(given: Float64Array): Solution {
    let design = given;
    const run = (grid: Float64Array) => {
      const out = new Float64Array(this.data.names.length * this.data.angles);
      this.states(design, grid, this.data.angles, out);
      return out;
    };
    let out = run(this.grid);
    const surface = this.surface(out);
    if (surface !== null && surface !== design[(this.data.soil as Soil).place]) {
      design = design.slice();
      design[(this.data.soil as Soil).place] = surface;
      out = run(this.grid);
    }
    return new Solution(this, design, out, this.rowGrids.map(run));
  }

  /** Height of the soil's surface, which lies by the depth above the lowest point of all tips. */
  private surface(out: Float64Array): number | null {
    const soil = this.data.soil;
    if (!soil) return null;
    const lowest = soil.heights.map((name) => {
      const values = this.signal(out, name);
      return values ? this.range(values)[0] : NaN;
    });
    return Math.min(...lowest) + soil.depth;
  }

  /** A signal among all of them. */
  signal(out: Float64Array, name: string): Float64Array | null {
    const [place, { angles }] = [this.place.get(name), this.data];
    return place === undefined ? null : out.subarray(place * angles, (place + 1) * angles);
  }

  /** Lowest and highest value of the curve of a signal. */
  private range(values: Float64Array): Pair {
    const samples = this.order ? Float64Array.from(this.order, (k) => values[k] as number) : values;
    const gathered = this.extremes(samples, 2 * Math.PI * this.data.turns, this.at, this.edges);
    return [gathered[4] as number, gathered[2] as number];
  }

  figures(values: Float64Array): Figures {
    const count = values.length;
    const share = (k: number) => (this.shares ? (this.shares[k] as number) : 1 / count);
    let [mean, square] = [0, 0];
    for (let k = 0; k < count; k++) {
      const value = values[k] as number;
      mean += share(k) * value;
      square += share(k) * value * value;
    }
    const [min, max] = this.range(values);
    return { mean, rms: Math.sqrt(square), peak: Math.max(max, -min), max, min };
  }
}

export class Solution {
  /** Signals of all rows together. */
  private readonly sums = new Map<string, Float64Array>();
  /** Why the machine cannot move through its cycle with these numbers; null where it can. */
  readonly refusal: string | null;

  constructor(
    readonly machine: Machine,
    readonly design: Float64Array,
    private readonly out: Float64Array,
    rows: Float64Array[],
  ) {
    this.refusal = this.refused();
    if (rows.length) this.add(rows);
  }

  /** A signal over the crank angles. */
  row(name: string): Float64Array | null {
    return this.sums.get(name) ?? this.machine.signal(this.out, name);
  }

  /** Sum up what all rows do together, each at its own crank angles; see `Analysis.together`. */
  private add(rows: Float64Array[]): void {
    const { machine } = this;
    const { angles, flywheel, acceleration } = machine.data;
    type At = (signal: string) => number;
    const sum = (name: string, of: (at: At, row: MachineRow) => number, shared = 0) => {
      const at = (k: number) =>
        rows.reduce((all, out, r) => {
          const value = of((signal) => machine.signal(out, signal)?.[k] ?? 0, machine.data.rows[r] as MachineRow);
          return all + value;
        }, shared);
      this.sums.set(
        `rows.${name}`,
        Float64Array.from({ length: angles }, (_, k) => at(k)),
      );
    };
    // rows on one shaft share a flywheel
    const shared = (rows.length - 1) * flywheel * (this.number("drive.acceleration") ?? acceleration);
    const [x, y] = ["shaking_force.x", "shaking_force.y"] as const;
    sum(x, (at) => at(x));
    sum(y, (at) => at(y));
    sum("shaking_moment", (at, { offset }) => at("shaking_moment") + offset[0] * at(y) - offset[1] * at(x), shared);
    sum("roll_moment", (at, { lateral }) => at("rocking_moment.x") - lateral * at(y));
    sum("yaw_moment", (at, { lateral }) => at("rocking_moment.y") + lateral * at(x));
    sum("drive_torque", (at) => at("drive_torque"), -shared);
    const [fx, fy] = [this.row(`rows.${x}`), this.row(`rows.${y}`)] as [Float64Array, Float64Array];
    this.sums.set(
      "rows.shaking_force",
      fx.map((value, k) => Math.hypot(value, fy[k] as number)),
    );
  }

  figures(name: string): Figures | null {
    const row = this.row(name);
    return row && this.machine.figures(row);
  }

  /** A vector at a crank angle. */
  vector(name: string, at: number): Pair {
    return [this.row(`${name}.x`)?.[at] ?? NaN, this.row(`${name}.y`)?.[at] ?? NaN];
  }

  /** Where a point is, m. */
  point(name: string, at: number): Pair {
    return this.vector(`points.${name}`, at);
  }

  /** exp(i angle) of a body. */
  rotation(body: string, at: number): Pair {
    return body === "frame" ? [1, 0] : this.vector(`rotation(${body})`, at);
  }

  /** A number of the design by its path, or what it is in the base's pose. */
  number(path: string): number | undefined {
    const place = this.machine.numbers.get(path);
    return place === undefined ? undefined : this.design[place];
  }

  private refused(): string | null {
    for (const [k, links] of this.machine.data.margins.entries()) {
      const row = this.row(`margin ${k}`);
      const why = row && this.unjoined(row, links);
      if (why) return why;
    }
    for (const name of this.machine.data.names) {
      if (name.startsWith("cosine ") && !(this.row(name) ?? []).every((value) => value >= FAR))
        return say("this far from the original the machine cannot be followed here; open the model in Equipoise");
    }
    const at = this.endless();
    if (at === null) return null;
    return say("at crank angle {angle} this machine cannot be computed", { angle: inDegrees(at) });
  }

  /** The first crank angle at which something is no number. */
  private endless(): number | null {
    const { angles } = this.machine.data;
    const bad = this.out.findIndex((value) => !Number.isFinite(value));
    return bad < 0 ? null : (this.machine.theta[bad % angles] as number);
  }

  /** Why the links of a dyad do not reach each other over the whole cycle. */
  private unjoined(row: Float64Array, links: string[]): string | null {
    const {
      frames,
      theta,
      data: { least, crank },
    } = this.machine;
    const values = frames.map((at) => (Number.isFinite(row[at]) ? (row[at] as number) : -Infinity));
    const [low, at] = lowest(values);
    if (low >= least) return null;
    const names = links.map((name) => `'${name}'`);
    const joined =
      names.length > 1 ? say("{first} and {last}", { first: names[0] ?? "", last: names[1] ?? "" }) : (names[0] ?? "");
    const angle = inDegrees(theta[frames[at] as number] as number);
    if (!values.some((value) => value > 0))
      return say("{names} cannot be joined at any crank angle; check their lengths and where their pins are", {
        names: joined,
      });
    if (low >= -least || !values.some((value) => value < 0))
      return say(
        "change point at crank angle {angle}: {names} are stretched out or folded there, and the assembly mode after it is undetermined",
        { angle, names: joined },
      );
    if (crank === null) return say("{names} do not reach each other at crank angle {angle}", { names: joined, angle });
    const ranges = reaching(
      values,
      frames.map((k) => theta[k] as number),
      this.machine.data.turns,
    );
    const parts = ranges.map(([a, b]) => say("from {low} to {high}", { low: inDegrees(a), high: inDegrees(b) }));
    const where = parts.reduce((first, last) => say("{first} and {last}", { first, last }));
    return say("the crank cannot turn fully: {names} reach each other only {ranges} of crank angle", {
      names: joined,
      ranges: where,
    });
  }
}

function inDegrees(angle: number): string {
  return `${signed(((angle * 180) / Math.PI).toFixed(2))} deg`;
}

/** Smallest value over a cycle, also between samples by a parabola, and the sample next to it. */
function lowest(values: number[]): [number, number] {
  let [low, at] = [Infinity, 0];
  const count = values.length;
  for (let k = 0; k < count; k++) {
    const middle = values[k] as number;
    const [before, after] = [values[(k + count - 1) % count] as number, values[(k + 1) % count] as number];
    const bend = before - 2 * middle + after;
    const dip = middle <= before && middle <= after && bend > 0 && Number.isFinite(bend);
    const value = dip ? middle - (after - before) ** 2 / (8 * bend) : middle;
    if (value < low) [low, at] = [value, k];
  }
  return [low, at];
}

/** Ranges of crank angle over which values are above zero, where they pass it between samples. */
function reaching(values: number[], theta: number[], turns: number): Pair[] {
  const count = values.length;
  const period = 2 * Math.PI * turns;
  const at = (k: number) => (theta[((k % count) + count) % count] as number) + period * Math.floor(k / count);
  const value = (k: number) => values[((k % count) + count) % count] as number;
  const crossing = (k: number) => {
    const [a, b] = [value(k - 1), value(k)];
    const share = Number.isFinite(a) && Number.isFinite(b) ? a / (a - b) : 0.5;
    return at(k - 1) + share * (at(k) - at(k - 1));
  };
  const ranges: Pair[] = [];
  for (let k = 0; k < count; k++) {
    if (value(k - 1) > 0 || !(value(k) > 0)) continue;
    let end = k + 1;
    while (value(end) > 0) end++;
    let [a, b] = [crossing(k), crossing(end)];
    if (b > period) [a, b] = [a - period, b - period];
    ranges.push([a, b]);
  }
  return ranges.sort(([a], [b]) => a - b);
}

function floats(text: string): Float64Array {
  const bytes = Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
  return new Float64Array(bytes.buffer);
}

export const plus = (a: Pair, b: Pair): Pair => [a[0] + b[0], a[1] + b[1]];
export const minus = (a: Pair, b: Pair): Pair => [a[0] - b[0], a[1] - b[1]];
export const times = (a: Pair, b: Pair): Pair => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
export const scaled = (a: Pair, by: number): Pair => [a[0] * by, a[1] * by];
export const mirrored = (a: Pair): Pair => [a[0], -a[1]];
export const size = (a: Pair): number => Math.hypot(a[0], a[1]);
export const dot = (a: Pair, b: Pair): number => a[0] * b[0] + a[1] * b[1];
export const towards = (angle: number): Pair => [Math.cos(angle), Math.sin(angle)];

/** The number by which one vector is another. */
export function ratio(a: Pair, b: Pair): Pair {
  return scaled(times(a, mirrored(b)), 1 / (dot(b, b) || 1));
}
