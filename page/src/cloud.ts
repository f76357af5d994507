/** Designs as lines from axis to axis, and as points over two columns: drawn, brushed, clicked. */

import type { Designs, Kind } from "./designs";
import { h, s, set } from "./dom";
import type { Pair } from "./protocol";
import { levels, marked } from "./scale";
import type { Theme } from "./theme";
import { say } from "./words";

/** Beyond this a press is a drag, pixels; how near a press has to be to a design. */
const [MOVED, NEAR] = [4, 9];
/** Opacity of designs that are not within the ranges. */
const PALE = 0.05;
/** Of pale lines, that are as dark together as one. */
const FEW = 60;

export interface PointerEvents {
  /** Ranges have changed, or are being changed. */
  ranged(): void;
  /** A design is wanted as a machine. */
  opened(i: number): void;
  /** A design is under the pointer, or none. */
  hovered(i: number | null): void;
}

/** What both pictures have: a canvas for designs, an SVG for axes, a pointer that brushes. */
abstract class Picture {
  readonly root: HTMLElement;
  protected readonly canvas = h("canvas", { "aria-hidden": "true" });
  protected readonly svg = s("svg", { "aria-hidden": "true" });
  protected designs: Designs | null = null;
  protected width = 0;
  protected hover: number | null = null;

  constructor(
    name: string,
    protected readonly height: number,
    protected readonly theme: Theme,
    protected readonly events: PointerEvents,
  ) {
    this.root = h("div", { class: "designs", role: "img", "aria-label": name }, this.canvas, this.svg);
    this.svg.addEventListener("pointerdown", (event) => this.press(event));
    this.svg.addEventListener("pointermove", (event) => this.move(event));
    this.svg.addEventListener("pointerleave", () => this.events.hovered(null));
  }

  show(designs: Designs): void {
    this.designs = designs;
    this.draw();
  }

  resize(width: number): void {
    if (width === this.width || width < 60) return;
    this.width = width;
    this.draw();
  }

  /** Show which design is under the pointer, here or in the other picture. */
  mark(i: number | null): void {
    if (i === this.hover) return;
    this.hover = i;
    this.overlay();
  }

  draw(): void {
    const { designs, width, height } = this;
    if (!designs || !width) return;
    const ratio = devicePixelRatio;
    set(this.canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${height}px`;
    set(this.svg, { width, height, viewBox: `0 0 ${width} ${height}` });
    const pen = this.canvas.getContext("2d");
    if (!pen) return;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const pale = Math.min(PALE, FEW / designs.count);
    // Those within the ranges are drawn last, good ones above the others.
    for (const inside of [false, true])
      for (const kind of ["failed", "beyond", "kept"] as Kind[])
        for (let i = 0; i < designs.count; i++)
          if (designs.kind(i) === kind && designs.within(i) === inside)
            this.paint(pen, i, this.colour(kind), inside ? this.strength(kind) : pale);
    this.overlay();
  }

  protected colour(kind: Kind): string {
    const { main, quiet, stress } = this.theme.colours;
    return { kept: main, beyond: quiet, failed: stress }[kind];
  }

  protected abstract strength(kind: Kind): number;
  protected abstract paint(pen: CanvasRenderingContext2D, i: number, colour: string, alpha: number): void;
  protected abstract overlay(): void;
  /** The design at a place of the picture. */
  protected abstract at(x: number, y: number): number | null;
  /** A drag from a place to another; at its end a range that is too short is none. */
  protected abstract brush(from: Pair, to: Pair): void;

  protected spot(event: PointerEvent): Pair {
    const box = this.svg.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private move(event: PointerEvent): void {
    if (!event.buttons) this.events.hovered(this.at(...this.spot(event)));
  }

  private press(event: PointerEvent): void {
    if (event.button) return;
    const from = this.spot(event);
    let far = false;
    this.svg.setPointerCapture(event.pointerId);
    const drag = (now: PointerEvent) => {
      const to = this.spot(now);
      far ||= Math.hypot(to[0] - from[0], to[1] - from[1]) > MOVED;
      if (far) this.brush(from, to);
    };
    const stop = (now: PointerEvent) => {
      this.svg.removeEventListener("pointermove", drag);
      for (const name of ["pointerup", "pointercancel"] as const) this.svg.removeEventListener(name, stop);
      if (far || now.type === "pointercancel") return;
      const design = this.at(...from);
      if (design === null) this.brush(from, from);
      else this.events.opened(design);
    };
    this.svg.addEventListener("pointermove", drag);
    for (const name of ["pointerup", "pointercancel"] as const) this.svg.addEventListener(name, stop);
  }
}

const [ABOVE, BELOW, LEFT, RIGHT] = [46, 10, 46, 30];

/** Every column an axis, side by side; every design a line. */
export class Parallel extends Picture {
  constructor(theme: Theme, events: PointerEvents) {
    super(say("Designs from axis to axis"), 300, theme, events);
  }

  private get axes(): number {
    return this.designs?.columns.length ?? 0;
  }

  private across(k: number): number {
    return LEFT + (k * (this.width - LEFT - RIGHT)) / Math.max(this.axes - 1, 1);
  }

  private down(share: number): number {
    return this.height - BELOW - share * (this.height - ABOVE - BELOW);
  }

  private up(y: number): number {
    return Math.min(Math.max((this.height - BELOW - y) / (this.height - ABOVE - BELOW), 0), 1);
  }

  protected strength(kind: Kind): number {
    const few = Math.min(Math.max(60 / Math.sqrt(this.designs?.count ?? 1), 1), 6);
    return Math.min((kind === "kept" ? 0.16 : 0.1) * few, 0.9);
  }

  protected paint(pen: CanvasRenderingContext2D, i: number, colour: string, alpha: number): void {
    pen.globalAlpha = alpha;
    pen.strokeStyle = colour;
    pen.lineWidth = 1;
    pen.beginPath();
    let on = false;
    for (let k = 0; k < this.axes; k++) {
      const share = this.designs?.share(i, k) ?? NaN;
      if (!Number.isFinite(share)) on = false;
      else if (on) pen.lineTo(this.across(k), this.down(share));
      else {
        pen.moveTo(this.across(k), this.down(share));
        on = true;
      }
    }
    pen.stroke();
  }

  private line(shares: number[], name: string): SVGElement {
    const places = shares.map((share, k) => `${this.across(k).toFixed(1)} ${this.down(share).toFixed(1)}`);
    return s("path", { class: name, d: `M${places.join("L")}` });
  }

  protected overlay(): void {
    const { designs } = this;
    if (!designs || !this.width) return;
    const parts: SVGElement[] = [];
    const room = (this.height - ABOVE - BELOW) / 26;
    const each = (this.width - LEFT - RIGHT) / Math.max(this.axes - 1, 1);
    designs.columns.forEach(({ declared, scale }, k) => {
      const x = this.across(k);
      parts.push(s("path", { class: "rule", d: `M${x} ${this.down(0)}V${this.down(1)}` }));
      const range = designs.ranges.get(k);
      if (range) {
        const [low, high] = range.map((value) => this.down(clip(shareOf(designs, k, value)))) as Pair;
        parts.push(s("rect", { class: "range", x: x - 7, width: 14, y: high, height: low - high }));
      }
      const every = levels(scale, room);
      for (const value of every) {
        const text = marked(value, scale, every);
        parts.push(s("text", { x: x - 5, y: this.down(shareOf(designs, k, value)) + 4, class: "number" }, text));
      }
      const most = Math.max(Math.floor((each - 8) / 6), 6);
      lines(declared.label, most).forEach((text, row) => {
        const anchor = k === 0 ? "start" : k === this.axes - 1 ? "end" : "middle";
        const at = { x: k === 0 ? 4 : k === this.axes - 1 ? this.width - 4 : x, y: 11 + 12 * row };
        parts.push(s("text", { ...at, "text-anchor": anchor, class: "label" }, text));
      });
      parts.push(s("text", { x, y: ABOVE - 3, "text-anchor": "middle", class: "unit" }, declared.unit));
    });
    if (designs.study.own)
      parts.push(
        this.line(
          designs.columns.map(({ own }, k) => shareOf(designs, k, own ?? NaN)),
          "own",
        ),
      );
    if (this.hover !== null) {
      const shares = designs.columns.map((_, k) => designs.share(this.hover as number, k));
      parts.push(this.line(shares.filter(Number.isFinite), "hovered"));
    }
    this.svg.replaceChildren(...parts);
  }

  protected at(x: number, y: number): number | null {
    const { designs } = this;
    if (!designs || y < ABOVE) return null;
    const step = (this.width - LEFT - RIGHT) / Math.max(this.axes - 1, 1);
    const k = Math.min(Math.max(Math.floor((x - LEFT) / step), 0), Math.max(this.axes - 2, 0));
    const part = (x - this.across(k)) / step;
    let [best, least]: [number | null, number] = [null, NEAR / 2];
    for (let i = 0; i < designs.count; i++) {
      if (!designs.within(i) || designs.kind(i) === "failed") continue;
      const share = designs.share(i, k) * (1 - part) + designs.share(i, k + 1) * part;
      const apart = Math.abs(this.down(share) - y);
      if (apart < least) [best, least] = [i, apart];
    }
    return best;
  }

  protected brush([x, y]: Pair, [, to]: Pair): void {
    const { designs } = this;
    if (!designs) return;
    const step = (this.width - LEFT - RIGHT) / Math.max(this.axes - 1, 1);
    const k = Math.min(Math.max(Math.round((x - LEFT) / step), 0), this.axes - 1);
    if (Math.abs(x - this.across(k)) > Math.min(step / 2, 24)) return;
    const range: Pair = [designs.value(k, this.up(y)), designs.value(k, this.up(to))];
    designs.range(k, Math.abs(y - to) > MOVED ? range : null);
    this.events.ranged();
  }
}

const EDGE = { left: 50, right: 12, top: 10, bottom: 26 };

/** Two columns against each other; every design a point. */
export class Scatter extends Picture {
  columns: Pair = [0, 1];

  constructor(theme: Theme, events: PointerEvents) {
    super(say("Designs over two columns"), 300, theme, events);
  }

  private x(share: number): number {
    return EDGE.left + share * (this.width - EDGE.left - EDGE.right);
  }

  private y(share: number): number {
    return this.height - EDGE.bottom - share * (this.height - EDGE.top - EDGE.bottom);
  }

  private place(i: number): Pair {
    const [a, b] = this.columns;
    const [x, y] = [this.designs?.share(i, a) ?? NaN, this.designs?.share(i, b) ?? NaN];
    // A design without a figure stands below all others, or left of them.
    return [this.x(Number.isFinite(x) ? x : 0), this.y(Number.isFinite(y) ? y : 0)];
  }

  protected strength(kind: Kind): number {
    return kind === "kept" ? 0.7 : kind === "beyond" ? 0.4 : 0.6;
  }

  protected paint(pen: CanvasRenderingContext2D, i: number, colour: string, alpha: number): void {
    const [x, y] = this.place(i);
    pen.globalAlpha = Math.max(alpha, 0.08);
    pen.fillStyle = pen.strokeStyle = colour;
    pen.beginPath();
    if (this.designs?.kind(i) === "failed") {
      pen.lineWidth = 1.2;
      pen.moveTo(x - 3, y - 3);
      pen.lineTo(x + 3, y + 3);
      pen.moveTo(x + 3, y - 3);
      pen.lineTo(x - 3, y + 3);
      pen.stroke();
    } else {
      pen.arc(x, y, 2, 0, 2 * Math.PI);
      pen.fill();
    }
  }

  protected overlay(): void {
    const { designs, columns } = this;
    if (!designs || !this.width) return;
    const parts: SVGElement[] = [];
    const [[a, b], foot] = [columns, this.y(0)];
    parts.push(s("path", { class: "rule", d: `M${this.x(0)} ${this.y(1)}V${foot}H${this.x(1)}` }));
    const [first, second] = columns.map((k) => designs.columns[k]);
    if (!first || !second) return;
    const across = levels(first.scale, (this.width - EDGE.left) / 60);
    for (const value of across) {
      const at = { x: this.x(shareOf(designs, a, value)), y: foot + 14, "text-anchor": "middle" };
      parts.push(s("text", { ...at, class: "below" }, marked(value, first.scale, across)));
    }
    const up = levels(second.scale, (this.height - EDGE.top) / 30);
    for (const value of up) {
      const at = { x: this.x(0) - 5, y: this.y(shareOf(designs, b, value)) + 4 };
      parts.push(s("text", { ...at, class: "number" }, marked(value, second.scale, up)));
    }
    for (const limit of first.declared.limits)
      if (limit !== null) parts.push(this.limit(a, limit * first.declared.factor, true));
    for (const limit of second.declared.limits)
      if (limit !== null) parts.push(this.limit(b, limit * second.declared.factor, false));
    parts.push(...this.brushed());
    if (first.own !== null && second.own !== null) {
      const at = { cx: this.x(shareOf(designs, a, first.own)), cy: this.y(shareOf(designs, b, second.own)) };
      parts.push(s("circle", { class: "own", r: 6, ...at }));
    }
    if (this.hover !== null) {
      const [cx, cy] = this.place(this.hover);
      parts.push(s("circle", { class: "hovered", r: 5, cx, cy }));
    }
    this.svg.replaceChildren(...parts);
  }

  private limit(k: number, value: number, upright: boolean): SVGElement {
    const share = this.designs ? shareOf(this.designs, k, value) : 0;
    const seen = share >= 0 && share <= 1;
    const d = upright ? `M${this.x(share)} ${this.y(0)}V${this.y(1)}` : `M${this.x(0)} ${this.y(share)}H${this.x(1)}`;
    return s("path", { class: "bound", d: seen ? d : "" });
  }

  private brushed(): SVGElement[] {
    const { designs, columns } = this;
    const [a, b] = columns.map((k) => designs?.ranges.get(k));
    if (!designs || (!a && !b)) return [];
    const ends = (k: number, range: Pair | undefined): Pair =>
      (range?.map((value) => clip(shareOf(designs, k, value))) as Pair | undefined) ?? [0, 1];
    const [[x0, x1], [y0, y1]] = [ends(columns[0], a), ends(columns[1], b)];
    const size = { width: this.x(x1) - this.x(x0), height: this.y(y0) - this.y(y1) };
    return [s("rect", { class: "range", x: this.x(x0), y: this.y(y1), ...size })];
  }

  protected at(x: number, y: number): number | null {
    const { designs } = this;
    let [best, least]: [number | null, number] = [null, NEAR];
    for (let i = 0; designs && i < designs.count; i++) {
      if (!designs.within(i)) continue;
      const [px, py] = this.place(i);
      const apart = Math.hypot(px - x, py - y);
      if (apart < least) [best, least] = [i, apart];
    }
    return best;
  }

  protected brush(from: Pair, to: Pair): void {
    const { designs } = this;
    if (!designs) return;
    const xs = [from, to].map(([x]) => clip((x - this.x(0)) / (this.x(1) - this.x(0))));
    const ys = [from, to].map(([, y]) => clip((y - this.y(0)) / (this.y(1) - this.y(0))));
    const none = Math.hypot(to[0] - from[0], to[1] - from[1]) <= MOVED;
    this.columns.forEach((k, i) => {
      const shares = (i ? ys : xs).map((share) => designs.value(k, share)) as Pair;
      designs.range(k, none ? null : shares);
    });
    this.events.ranged();
  }
}

function shareOf(designs: Designs, k: number, value: number): number {
  const scale = designs.columns[k]?.scale;
  if (!scale) return NaN;
  const [low, high] = scale.ends;
  return scale.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
}

function clip(share: number): number {
  return Math.min(Math.max(share, 0), 1);
}

/** A label in up to three lines of so many signs. */
function lines(label: string, most: number): string[] {
  const levels: string[] = [];
  for (const word of label.split(" ")) {
    const last = levels[levels.length - 1];
    if (last !== undefined && last.length + 1 + word.length <= most) levels[levels.length - 1] = `${last} ${word}`;
    else levels.push(word);
  }
  if (levels.length <= 2) return levels;
  return [levels[0] as string, `${(levels[1] as string).slice(0, Math.max(most - 1, 3))}…`];
}
