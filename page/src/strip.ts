/** A signal against something: curves over the crank angle, on uPlot. */

import uPlot from "uplot";
import { h, set, write } from "./dom";
import { limits, multiples, plain, round, shown, steady } from "./format";
import type { Theme } from "./theme";
import {
  BELOW,
  type Content,
  LEFT,
  type Look,
  NARROW,
  optionsOf,
  RIGHT,
  TOP,
} from "./uplot_options";
import { say } from "./words";

/** Values with null in place of those that are none, where a line breaks off. */
function gapped(values: Float64Array): uPlot.TypedArray | (number | null)[] {
  if (!values.some(Number.isNaN)) return values;
  return Array.from(values, (value) => (Number.isNaN(value) ? null : value));
}

const NONE = new Float64Array(0);

/** One chart with a heading that tells the values at the cursor. */
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
  private range: [number, number] = [-1, 1];
  private ticks = 1;
  private width = 0;
  private at = 0;
  private seen = true;
  private stale = false;

  constructor(
    private readonly look: Look,
    private readonly theme: Theme,
  ) {
    this.root = h(
      "figure",
      { class: "strip" },
      h("figcaption", {}, look.control ?? this.title, this.unit, this.legend),
      this.holder,
    );
    this.holder.append(this.numbers);
  }

  /** Take new values; only their shape (names, before or not) makes a new plot. */
  show(content: Content): void {
    this.content = content;
    let [low, high] = [Infinity, -Infinity];
    for (const curve of content.curves) {
      for (const values of [curve.values, curve.before ?? NONE]) {
        for (const value of values) {
          if (value < low) low = value;
          if (value > high) high = value;
        }
      }
    }
    const zero = Math.max(-low, high) < (content.least ?? 0);
    this.range = zero ? [-1, 1] : limits(low, high);
    this.ticks = this.spacing();
    write(this.unit, content.unit);
    write(this.title, content.title);
    const shape = content.curves.map((c) => `${c.label}|${c.role}|${!!c.before}`).join();
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

  /** Put the cursor at x; the values there (at sample k) go to the heading. */
  point(x: number, k: number | null): void {
    this.at = x;
    if (!this.plot) return;
    this.cursor.style.transform = `translateX(${this.across(x).toFixed(1)}px)`;
    if (k === null) return;
    const largest = Math.max(-this.range[0], this.range[1]);
    this.content.curves.forEach((curve, i) => {
      const reading = this.readings[i];
      if (reading) write(reading, steady(curve.values[k] ?? NaN, largest, 4));
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

  private data(): uPlot.AlignedData {
    const rows = this.content.curves.flatMap((c) => (c.before ? [c.before, c.values] : [c.values]));
    return [this.content.x, ...rows.map(gapped)];
  }

  private build(shape: string): void {
    this.shape = shape;
    this.plot?.destroy();
    this.plot = null;
    this.heading();
    if (!this.width || !this.content.curves.length) return;
    const ways = {
      range: () => this.range,
      levels: () => this.levels(),
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
        h(
          "span",
          { class: "entry" },
          key,
          curve.label,
          this.look.bars || this.look.quiet ? null : reading,
        ),
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
    const [low, high] = this.range;
    const height = this.look.height - TOP - (this.look.xAxis ? BELOW : NARROW);
    return TOP + (1 - (y - low) / (high - low)) * height;
  }

  /** Write numbers at the scales, where they are others than before. */
  private number(): void {
    const { content } = this;
    const [low, high] = [content.x[0] ?? 0, content.x[content.x.length - 1] ?? 1];
    const shape = [...this.range, this.ticks, low, high, this.width].join();
    if (shape === this.numbered) return;
    this.numbered = shape;
    const texts: HTMLElement[] = [];
    const put = (className: string, text: string, x: number, y: number) => {
      const label = h("span", { class: className }, text);
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      texts.push(label);
    };
    for (const y of this.levels()) put("y", steady(y, this.ticks, 1), 0, this.down(y));
    const marks = this.look.xAxis ? this.marks(low, high) : [];
    for (const x of marks) put("x", this.named(x), LEFT + this.across(x), this.look.height - 17);
    this.numbers.replaceChildren(...texts);
  }

  /** What a chart says to those who cannot see it: each curve's extremes. */
  describe(): void {
    const said = this.content.curves.map((curve) => {
      let [low, high] = [Infinity, -Infinity];
      for (const value of curve.values) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
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
      const x = this.plot?.posToVal(
        Math.min(Math.max(moved.clientX - box.left, 0), box.width),
        "x",
      );
      if (x !== undefined) this.look.picked?.(x);
    };
    over.setPointerCapture(event.pointerId);
    over.addEventListener("pointermove", pick);
    const end = () => over.removeEventListener("pointermove", pick);
    over.addEventListener("pointerup", end, { once: true });
    over.addEventListener("pointercancel", end, { once: true });
    pick(event);
  };

  /** The widest round distance of levels that leaves three of them or more. */
  private spacing(): number {
    const span = this.range[1] - this.range[0];
    const most = Math.max(Math.floor(this.look.height / 20), 3);
    for (let parts = 2; parts <= most + 0.5; parts += 0.5) {
      const step = round(span / parts);
      if (multiples(step, ...this.range).length >= 3) return step;
    }
    return round(span / most);
  }

  private marks(low: number, high: number): number[] {
    const step = this.look.xStep?.(high - low) ?? (this.look.bars ? 1 : round((high - low) / 6));
    return multiples(step, low, high);
  }

  private named(x: number): string {
    return this.look.xLabel === "°" ? `${Math.round(x)}°` : plain(x);
  }

  private levels(): number[] {
    return multiples(this.ticks, ...this.range);
  }
}
