/**
 * A signal against something: curves over the crank angle, or bars, on uPlot, with numbers on the
 * scales that are not its own.
 */

import uPlot from "uplot";
import { h, set, write } from "./dom";
import { multiples, plain, shown, steady } from "./format";
import { extremes, indexAtOrBelow, levels, marked, type Scale, scaleOf, share, spacing } from "./scale";
import type { Role, Theme } from "./theme";
import { say } from "./words";

export interface Curve {
  label: string;
  role: Role;
  values: Float64Array;
  before?: Float64Array | undefined;
  /** Whether it is points alone, without a line. */
  points?: boolean | undefined;
}

export interface Content {
  title: string;
  /** Values of x; the same array as long as nothing about it changed. */
  x: Float64Array;
  unit: string;
  curves: Curve[];
  /** What is smaller than this is rounding, and shown as zero. */
  least?: number;
  /** Whether the scale of the values is logarithmic. */
  log?: boolean;
}

export interface Look {
  height: number;
  xAxis: boolean;
  xLabel?: string;
  /** Distance of marks on x: 90 for degrees. */
  xStep?: (span: number) => number;
  bars?: boolean;
  /** No values at the cursor in the heading. */
  quiet?: boolean;
  /** Told where on x was pressed. */
  picked?: (x: number) => void;
  control?: HTMLElement;
  /** At the end of the heading. */
  button?: HTMLElement;
}

/** Room around the plot, pixels. */
export const LEFT = 46;
export const RIGHT = 16;
const TOP = 6;
export const BELOW = 22;
export const NARROW = 4;

/** What depends on the values of the moment. */
interface Ways {
  scale(): Scale;
  levels(): number[];
  marks(low: number, high: number): number[];
}

export function optionsOf(look: Look, theme: Theme, curves: Curve[], width: number, ways: Ways): uPlot.Options {
  const none = (_u: uPlot, splits: number[]) => splits.map(() => null);
  const axis = {
    grid: { stroke: () => theme.colours.grid, width: 1 },
    ticks: { show: false },
    border: { show: false },
    values: none,
  };
  const across = { size: look.xAxis ? BELOW : 0, gap: 6 };
  return {
    width,
    height: look.height,
    pxAlign: false,
    legend: { show: false },
    cursor: { show: false },
    padding: [TOP, RIGHT, look.xAxis ? 0 : NARROW, 0],
    scales: {
      x: {
        time: false,
        range: (_u, low, high) => (look.bars ? [low - 0.5, high + 0.5] : [low, high]),
      },
      y: { range: () => ways.scale().ends, distr: ways.scale().log ? 3 : 1 },
    },
    axes: [
      { ...axis, ...across, splits: (_u, _i, low, high) => ways.marks(low, high) },
      { ...axis, size: LEFT, gap: 4, splits: () => ways.levels() },
    ],
    series: [{}, ...curves.flatMap((curve, i) => series(curve, look, theme, i, curves.length))],
    hooks: { drawAxes: [(u) => zero(u, theme.colours.axis, ways.scale())] },
  };
}

/**
 * A curve, behind it what it was before: pale and dotted, or the dashed outline of a bar.
 *
 * The second of two differs from the first without colour too: dashed, or hatched.
 */
function series(curve: Curve, look: Look, theme: Theme, i: number, count: number): uPlot.Series[] {
  const stroke = () => theme.colours[curve.role];
  const base: uPlot.Series = { stroke, width: 1.6, points: { show: false } };
  if (curve.points) return [{ ...base, paths: () => null, points: { show: true, size: 7, fill: stroke } }];
  if (!look.bars) {
    const before: uPlot.Series = { ...base, width: 1.2, dash: [1.5, 2.5], alpha: 0.65 };
    const now =
      curve.role === "quiet" // what was measured: broad, behind nothing
        ? { ...base, width: 3, alpha: 0.7 }
        : i
          ? { ...base, dash: [8, 4] }
          : base;
    return curve.before ? [before, now] : [now];
  }
  const align = count === 1 ? 0 : i ? 1 : -1;
  const paths = uPlot.paths.bars?.({ size: [0.7 / count, 26], align });
  const shape: uPlot.Series = { ...base, width: 1, ...(paths && { paths }) };
  const bars = { ...shape, fill: i ? (u: uPlot) => hatching(u.ctx, stroke()) : stroke };
  const before: uPlot.Series = { ...shape, dash: [2, 2], fill: "transparent", alpha: 0.8 };
  return curve.before ? [before, bars] : [bars];
}

/** What bars have been filled with, by colour and size. */
const tiles = new Map<string, CanvasPattern>();

/** Lines across, that fill a bar. */
function hatching(ctx: CanvasRenderingContext2D, colour: string): CanvasPattern | string {
  const side = Math.round(4 * devicePixelRatio);
  const known = tiles.get(`${colour} ${side}`);
  if (known) return known;
  const tile = document.createElement("canvas");
  tile.width = tile.height = side;
  const pen = tile.getContext("2d");
  if (!pen) return colour;
  pen.strokeStyle = colour;
  pen.lineWidth = side / 3;
  for (const shift of [-side, 0, side]) {
    pen.moveTo(shift - 1, side + 1);
    pen.lineTo(shift + side + 1, -1);
  }
  pen.stroke();
  const pattern = ctx.createPattern(tile, "repeat");
  if (pattern) tiles.set(`${colour} ${side}`, pattern);
  return pattern ?? colour;
}

/** The line of zero, a little stronger than the grid. */
function zero(u: uPlot, colour: string, { ends: [low, high], log }: Scale): void {
  if (log || low > 0 || high < 0) return;
  const y = Math.round(u.valToPos(0, "y", true)) + 0.5;
  u.ctx.save();
  u.ctx.strokeStyle = colour;
  u.ctx.lineWidth = 1;
  u.ctx.beginPath();
  u.ctx.moveTo(u.bbox.left, y);
  u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
  u.ctx.stroke();
  u.ctx.restore();
}

/** Values with null in place of those that are none, or have no logarithm: a line breaks off there. */
function gapped(values: Float64Array, log: boolean): uPlot.TypedArray | (number | null)[] {
  const none = (value: number) => Number.isNaN(value) || (log && value <= 0);
  if (!values.some(none)) return values;
  return Array.from(values, (value) => (none(value) ? null : value));
}

/** Of numbers below each other, pixels. */
const LINE = 13;
const NONE = new Float64Array(0);

/** One chart, with the values at the cursor in its heading. */
export class Strip {
  readonly root: HTMLElement;
  private readonly holder = h("div", { class: "canvas" });
  private readonly legend = h("span", { class: "legend" });
  private readonly title = h("b");
  private readonly unit = h("span", { class: "unit" });
  private readonly cursor = h("div", { class: "cursor" });
  /** Numbers on the scales: text on a canvas would be drawn anew, slowly, at every change. */
  private readonly numbers = h("div", { class: "numbers", "aria-hidden": "true" });
  private numbered = "";
  private readonly readings: HTMLElement[] = [];
  private plot: uPlot | null = null;
  private content: Content = { title: "", x: NONE, unit: "", curves: [] };
  private shape = "";
  private scale: Scale = { ends: [-1, 1], log: false };
  /** Where its numbers are. */
  private levels: number[] = [];
  private width = 0;
  private at = 0;
  /** The sample there, if it has one. */
  private k: number | null = null;
  private seen = true;
  private stale = false;

  constructor(
    private readonly look: Look,
    private readonly theme: Theme,
  ) {
    this.root = h(
      "figure",
      { class: "strip" },
      h("figcaption", {}, look.control ?? this.title, this.unit, this.legend, look.button),
      this.holder,
    );
    this.holder.append(this.numbers);
  }

  /** Take new values; only their shape (names, before or not) makes a new plot. */
  show(content: Content): void {
    this.content = content;
    const every = content.curves.flatMap(({ values, before }) => [values, before ?? NONE]);
    this.scale = scaleOf(every, content.least ?? 0, content.log ?? false, this.look.bars ?? false);
    this.levels = levels(this.scale, (this.look.height - BELOW) / LINE);
    write(this.unit, content.unit);
    write(this.title, content.title);
    const drawn = content.curves.map((c) => `${c.label}|${c.role}|${!!c.before}`);
    const shape = [this.scale.log, ...drawn].join();
    if (shape !== this.shape || !this.plot) this.build(shape);
    else if (this.seen) this.plot.setData(this.data(), true);
    else this.stale = true;
    this.number();
  }

  resize(width: number): void {
    if (width === this.width || width <= 0) return;
    this.width = width;
    if (this.plot) {
      this.plot.setSize({ width, height: this.look.height });
      this.number();
    } else if (this.content.curves.length) this.build(this.shape);
    this.point(this.at, null);
  }

  repaint(): void {
    this.plot?.setData(this.data(), true); // bars keep their colours with their paths
  }

  /** How many values there are. */
  get count(): number {
    return this.content.x.length;
  }

  /** Put the cursor at x, which is at sample k. */
  point(x: number, k: number | null): void {
    this.at = x;
    this.k = k ?? this.k;
    if (this.plot) this.cursor.style.transform = `translateX(${this.across(x).toFixed(1)}px)`;
  }

  /** Put the cursor at x, wherever that is between the samples, and write the values there. */
  play(x: number): void {
    this.point(x, indexAtOrBelow(this.content.x, x));
    this.read();
  }

  /** Write the values at the cursor in the heading. */
  read(): void {
    const { k } = this;
    if (!this.plot || k === null) return;
    const { ends, log } = this.scale;
    const largest = log ? 0 : Math.max(-ends[0], ends[1]);
    this.content.curves.forEach((curve, i) => {
      const reading = this.readings[i];
      const value = curve.values[k] ?? NaN;
      if (reading) write(reading, log ? shown(value) : steady(value, largest, 4));
    });
  }

  /** Charts that are scrolled away are drawn when they come into sight. */
  set visible(seen: boolean) {
    this.seen = seen;
    if (seen) this.settle();
  }

  /** Draw what was put off. */
  settle(): void {
    if (this.stale && this.plot) this.plot.setData(this.data(), true);
    this.stale = false;
  }

  /** Take it away; what its curves hear of the window is let go, and they with it. */
  close(): void {
    this.plot?.destroy();
    this.root.remove();
  }

  private data(): uPlot.AlignedData {
    const rows = this.content.curves.flatMap((c) => (c.before ? [c.before, c.values] : [c.values]));
    return [this.content.x, ...rows.map((row) => gapped(row, this.scale.log))];
  }

  private build(shape: string): void {
    this.shape = shape;
    this.plot?.destroy();
    this.plot = null;
    this.heading();
    if (!this.width || !this.content.curves.length) return;
    const ways = {
      scale: () => this.scale,
      levels: () => this.levels,
      marks: (low: number, high: number) => this.marks(low, high),
    };
    const options = optionsOf(this.look, this.theme, this.content.curves, this.width, ways);
    this.plot = new uPlot(options, this.data(), this.holder);
    const { over } = this.plot;
    if (!this.look.bars) over.append(this.cursor);
    if (this.look.picked) over.addEventListener("pointerdown", this.press);
    this.plot.ctx.canvas.setAttribute("aria-hidden", "true");
    this.numbered = "";
    this.number();
    this.point(this.at, null);
  }

  private heading(): void {
    this.legend.replaceChildren();
    this.readings.length = 0;
    for (const curve of this.content.curves) {
      const reading = h("span", { class: "reading" });
      this.readings.push(reading);
      const key = h("i", { class: `key ${curve.role}${this.look.bars ? " box" : ""}` });
      this.legend.append(
        h("span", { class: "entry" }, key, curve.label, this.look.bars || this.look.quiet ? null : reading),
      );
    }
  }

  /** Where x is in the plot, and y below the upper edge of the chart, pixels. */
  private across(x: number): number {
    const half = this.look.bars ? 0.5 : 0;
    const values = this.content.x;
    const [low, high] = [(values[0] ?? 0) - half, (values[values.length - 1] ?? 1) + half];
    return ((x - low) / (high - low)) * (this.width - LEFT - RIGHT);
  }

  private down(y: number): number {
    const height = this.look.height - TOP - (this.look.xAxis ? BELOW : NARROW);
    return TOP + (1 - share(y, this.scale)) * height;
  }

  /** Write numbers at the scales, where they are others than before. */
  private number(): void {
    const { content } = this;
    const [low, high] = [content.x[0] ?? 0, content.x[content.x.length - 1] ?? 1];
    const shape = [...this.scale.ends, ...this.levels, low, high, this.width].join();
    if (shape === this.numbered) return;
    this.numbered = shape;
    const kept = this.numbers.children;
    let count = 0;
    const put = (name: string, text: string, x: number, y: number) => {
      const label = kept[count++] ?? this.numbers.appendChild(h("span"));
      set(label, { class: name });
      write(label, text);
      (label as HTMLElement).style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    };
    const marks = this.look.xAxis ? this.marks(low, high) : [];
    for (const x of marks) put("x", this.named(x), LEFT + this.across(x), this.look.height - 17);
    for (const y of this.levels) put("y", marked(y, this.scale, this.levels), 0, this.down(y));
    while (kept[count]) kept[count]?.remove();
  }

  /** What a chart says to those who cannot see it: each curve's extremes. */
  describe(): void {
    const said = this.content.curves.map((curve) => {
      const [low, high] = extremes([curve.values]);
      const { unit } = this.content;
      const values = { low: shown(low, 3), high: shown(high, 3), unit };
      const range = say("from {low} to {high} {unit}", values);
      return `${curve.label} ${range}`.trim();
    });
    set(this.root, { "aria-label": `${this.content.title}: ${said.join("; ")}` });
  }

  private readonly press = (event: PointerEvent): void => {
    const { over } = this.plot as uPlot;
    if (event.button || event.pointerType === "touch") return;
    const pick = (moved: PointerEvent) => {
      const box = over.getBoundingClientRect();
      const x = this.plot?.posToVal(Math.min(Math.max(moved.clientX - box.left, 0), box.width), "x");
      if (x !== undefined) this.look.picked?.(x);
    };
    over.setPointerCapture(event.pointerId);
    over.addEventListener("pointermove", pick);
    const end = () => over.removeEventListener("pointermove", pick);
    over.addEventListener("pointerup", end, { once: true });
    over.addEventListener("pointercancel", end, { once: true });
    pick(event);
  };

  private marks(low: number, high: number): number[] {
    const usual = this.look.xStep?.(high - low) ?? (this.look.bars ? 1 : spacing(low, high, (high - low) / 4));
    return multiples(usual, low, high);
  }

  private named(x: number): string {
    return this.look.xLabel === "°" ? `${Math.round(x)}°` : plain(x);
  }
}
