/** A curve in a plane with equal scales: the shaking force's polar diagram, paths of points. */

import { type Attributes, h, s, set, write } from "./dom";
import { degrees, multiples, plain, round, shown, signed } from "./format";
import type { Unit } from "./protocol";
import { FEWEST, spacing } from "./scale";
import { curve } from "./signs";

export interface Trace {
  /** x and y in turn. */
  points: Float32Array;
  kind: "now" | "before" | "other";
  closed: boolean;
}

export interface Plot extends Unit {
  title: string;
  traces: Trace[];
  /** Samples between marks along the curve "now", and the crank angle at the first sample. */
  every: number;
  /** A horizontal line, with the ground below it. */
  level?: number | undefined;
  /** What is smaller than this is rounding. */
  least: number;
}

/** Free on each side, pixels; numbers stand around a polar curve. */
const EDGE = { polar: 26, path: 18 };
/** Marks nearer than this are one, pixels. */
const TOGETHER = 5;
/** Between two circles of the polar diagram, pixels: the widest with enough numbers is taken. */
const APART = [34, 28, 22];
/** Between two circles where there is room for few, pixels. */
const LEAST = 26;
/** Of a digit, pixels. */
const DIGIT = 7;
/** What a step between numbers below is multiplied with for more room. */
const WIDER = [1, 2, 2.5, 1.5, 1.25, 5];
/** Pixels. */
const UNSEEN = 1e-3;
/** Steps of the crank from mark to mark in the polar diagram, degrees. */
const TWELFTH = 30;

/** Pixels. */
type Spot = [x: number, y: number];

/** Texts of a picture: those of before are used again, as each new one is laid out. */
class Texts {
  readonly root = s("g", { class: "texts" });
  private count = 0;

  begin(): void {
    this.count = 0;
  }

  add(at: Attributes, text: string): void {
    const element = this.root.children[this.count++] ?? this.root.appendChild(s("text"));
    set(element, at);
    write(element, text);
  }

  end(): void {
    while (this.root.children.length > this.count) this.root.lastChild?.remove();
  }
}

/** An SVG picture, `polar` with circles and an arrow from the origin. */
export class Plane {
  readonly root: HTMLElement;
  private readonly svg = s("svg", { class: "plane", "aria-hidden": "true" });
  private readonly grid = s("path", { class: "grid" });
  private readonly axes = s("path", { class: "axes" });
  private readonly ground = s("rect", { class: "soil" });
  private readonly texts = new Texts();
  private readonly curves = s("g", { class: "curves" });
  private readonly marks = s("path", { class: "marks" });
  private readonly numbers = new Texts();
  private readonly arrow = s("path", { class: "arrow" });
  private readonly dot = s("circle", { class: "dot", r: 3.5 });
  private readonly reading = h("span", { class: "legend" });
  private plot: Plot | null = null;
  private k = 0;
  private size: [number, number] = [0, 0];
  private scale = 1;
  private middle: [number, number] = [0, 0];
  /** Where numbers of crank angles stand. */
  private named: Spot[] = [];

  constructor(
    title: string,
    private readonly polar: boolean,
    control?: HTMLElement,
  ) {
    this.svg.append(this.ground, this.grid, this.axes, this.texts.root);
    this.svg.append(this.curves, this.marks, this.numbers.root, this.arrow, this.dot);
    this.root = h(
      "figure",
      { class: "strip square", "aria-label": title },
      h("figcaption", {}, control ?? h("b", {}, title), this.reading),
      this.svg,
    );
  }

  show(plot: Plot): void {
    this.plot = plot;
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width === this.size[0] && height === this.size[1]) return;
    this.size = [width, height];
    set(this.svg, { width, height, viewBox: `0 0 ${width} ${height}` });
    this.draw();
  }

  /** Show where the curve is at sample k. */
  point(k: number): void {
    this.k = k;
    const [x, y] = this.here();
    if (!Number.isFinite(x)) return;
    const [px, py] = this.place(x, y);
    set(this.dot, { cx: px.toFixed(1), cy: py.toFixed(1) });
    if (!this.polar) return;
    const [ox, oy] = this.place(0, 0);
    set(this.arrow, { d: `M${ox.toFixed(1)} ${oy.toFixed(1)}L${px.toFixed(1)} ${py.toFixed(1)}` });
  }

  /** Write in the heading where that is. */
  read(): void {
    const [x, y] = this.here();
    if (!this.plot || !Number.isFinite(x)) return;
    const { factor, unit } = this.plot;
    if (this.polar) {
      const [size, turn] = [Math.hypot(x, y), Math.round(degrees(Math.atan2(y, x)))];
      // What nobody sees is rounding, and points nowhere.
      const polar = `${shown(size * factor, 3)} ∠ ${plain(turn)}°`;
      write(this.reading, size * this.scale < UNSEEN ? `0 ${unit}` : polar);
    } else {
      const places = (this.size[0] / this.scale) * factor > 60 ? 0 : 1;
      const [across, up] = [x, y].map((value) => signed((value * factor).toFixed(places)));
      write(this.reading, `${across}, ${up}`);
    }
  }

  /** The place of the curve at the sample that is shown. */
  private here(): Spot {
    const points = this.now();
    return [points?.[2 * this.k] ?? NaN, points?.[2 * this.k + 1] ?? NaN];
  }

  private now(): Float32Array | undefined {
    return this.plot?.traces.find((trace) => trace.kind === "now")?.points;
  }

  private place(x: number, y: number): [number, number] {
    const [width, height] = this.size;
    return [width / 2 + (x - this.middle[0]) * this.scale, height / 2 - (y - this.middle[1]) * this.scale];
  }

  /** Whether a number has room there. */
  private inside(x: number, y: number): boolean {
    const [width, height] = this.size;
    return x > 12 && x < width - 12 && y > 12 && y < height - 6;
  }

  private fit(plot: Plot): void {
    let [x0, y0, x1, y1] = this.polar ? [0, 0, 0, 0] : [Infinity, Infinity, -Infinity, -Infinity];
    for (const { points } of plot.traces) {
      for (let i = 0; i + 1 < points.length; i += 2) {
        const [x, y] = [points[i] as number, points[i + 1] as number];
        if (x < x0) x0 = x;
        if (x > x1) x1 = x;
        if (y < y0) y0 = y;
        if (y > y1) y1 = y;
      }
    }
    if (!Number.isFinite(x0 + x1)) [x0, y0, x1, y1] = [-1, -1, 1, 1];
    // Where there is nothing but rounding, a picture of one unit shows a point.
    const small = Math.max(x1 - x0, y1 - y0) < plot.least ? 1 / plot.factor : 0;
    [x0, y0, x1, y1] = [x0 - small, y0 - small, x1 + small, y1 + small];
    const [width, height] = this.size;
    // Limits move in steps, so that the picture does not breathe while something is dragged.
    const step = round(Math.max(x1 - x0, y1 - y0, 1e-12) / 16);
    [x0, y0] = [Math.floor(x0 / step) * step, Math.floor(y0 / step) * step];
    [x1, y1] = [Math.ceil(x1 / step) * step, Math.ceil(y1 / step) * step];
    this.middle = [(x0 + x1) / 2, (y0 + y1) / 2];
    const edge = this.polar ? EDGE.polar : EDGE.path;
    const room = [Math.max(width - 2 * edge, 1), Math.max(height - 2 * edge, 1)] as const;
    this.scale = Math.min(room[0] / Math.max(x1 - x0, 1e-12), room[1] / Math.max(y1 - y0, 1e-12));
  }

  private draw(): void {
    const { plot } = this;
    if (!plot || !this.size[0]) return;
    this.fit(plot);
    this.along(plot);
    this.texts.begin();
    const [width, height] = this.size;
    this.texts.add({ x: width - 4, y: height - 4, "text-anchor": "end" }, plot.unit);
    if (this.polar) this.circles(plot);
    else this.lines(plot);
    this.texts.end();
    const place = (x: number, y: number) => this.place(x, y);
    const kept = this.curves.children;
    plot.traces.forEach((trace, i) => {
      const path = kept[i] ?? this.curves.appendChild(s("path"));
      set(path, { class: `curve ${trace.kind}`, d: curve(trace.points, place, trace.closed) });
    });
    while (kept.length > plot.traces.length) kept[kept.length - 1]?.remove();
  }

  /** Dots at equal steps of the crank; in the polar diagram with numbers at its quarters. */
  private along(plot: Plot): void {
    const points = this.now();
    this.numbers.begin();
    this.named = [];
    let d = "";
    const count = points ? points.length / 2 : 0;
    const turns = Math.round((count / plot.every / 360) * TWELFTH);
    const quarters: [Spot, angles: number[]][] = [];
    for (let i = 0; points && plot.every > 0 && i * plot.every < count; i++) {
      const k = Math.round(i * plot.every);
      const [x, y] = this.place(points[2 * k] as number, points[2 * k + 1] as number);
      d += `M${x.toFixed(1)} ${y.toFixed(1)}h0`;
      if (!this.polar || i % (3 * turns)) continue;
      const near = quarters.find(([[px, py]]) => Math.hypot(px - x, py - y) < TOGETHER);
      if (near) near[1].push(i * TWELFTH);
      else quarters.push([[x, y], [i * TWELFTH]]);
    }
    set(this.marks, { d });
    const curve = quarters.length ? this.sampled() : [];
    for (const [spot, angles] of quarters) this.crank(spot, angles, curve);
    this.numbers.end();
  }

  /** Some places along the curve "now". */
  private sampled(): Spot[] {
    const points = this.now() ?? new Float32Array(0);
    const step = Math.max(Math.floor(points.length / 144), 1) * 2;
    const spots: Spot[] = [];
    for (let i = 0; i + 1 < points.length; i += step)
      spots.push(this.place(points[i] as number, points[i + 1] as number));
    return spots;
  }

  /** Crank angles beside their mark, away from the origin and off the curve, where there is room. */
  private crank([x, y]: Spot, angles: number[], curve: Spot[]): void {
    const text = angles.map((angle) => `${angle}°`).join(", ");
    const [wide, high] = [2.8 * text.length, 5];
    const [width, height] = this.size;
    const [ox, oy] = this.place(0, 0);
    const away = Math.hypot(x - ox, y - oy) || 1;
    let [best, most]: [Spot | null, number] = [null, -Infinity];
    for (let turn = 0; turn < 360; turn += 22.5) {
      const [ux, uy] = [Math.cos((turn * Math.PI) / 180), Math.sin((turn * Math.PI) / 180)];
      const outward = (ux * (x - ox) + uy * (y - oy)) / away;
      for (const gap of [4, 8, 13, 19]) {
        const [px, py] = [x + ux * (gap + wide), y + uy * (gap + high)];
        const room = Math.min(px - wide, width - px - wide, py - high, height - py - high);
        const taken = this.named.some(([nx, ny]) => Math.abs(nx - px) < wide + 14 && Math.abs(ny - py) < 12);
        if (room < 0 || taken) continue;
        if (6 + 3 * outward - gap / 4 <= most) continue; // no curve is so far away that it would be better
        const clear = clearance(curve, px, py, wide, high, 6);
        const rank = clear + 3 * outward - gap / 4 - (clear < 1 ? 8 : 0);
        if (rank > most) [best, most] = [[px, py], rank];
      }
    }
    if (!best) return;
    this.named.push(best);
    const at = { class: "crank", x: best[0].toFixed(1), y: (best[1] + 4).toFixed(1) };
    this.numbers.add({ ...at, "text-anchor": "middle" }, text);
  }

  private circles(plot: Plot): void {
    const [ox, oy] = this.place(0, 0);
    const [width, height] = this.size;
    const reach = Math.hypot(Math.max(ox, width - ox), Math.max(oy, height - oy));
    let radii: number[] = [];
    let [ux, uy] = [1, 0];
    let numbers: [radius: number, x: number, y: number][] = [];
    const take = (step: number, along?: [number, number]) => {
      radii = multiples(step, step, reach / this.scale).map((radius) => radius * this.scale);
      [ux, uy] = along ?? this.freest(radii.slice(0, FEWEST));
      numbers = radii.map((r) => [r, ox + ux * r, oy + uy * r]);
      numbers = numbers.filter(([, x, y]) => this.inside(x, y));
      return numbers.length >= FEWEST;
    };
    const enough = APART.some((apart) => take(round((apart / this.scale) * plot.factor) / plot.factor));
    if (!enough) {
      // Two circles and the origin, then: as far as there is room in that direction.
      let far = 0;
      while (this.inside(ox + ux * (far + 1), oy + uy * (far + 1))) far++;
      const step = spacing(0, (far / this.scale) * plot.factor, Infinity, far / LEAST + 1);
      take(step / plot.factor, [ux, uy]);
    }
    if (numbers.length < FEWEST) this.text(ox + 6, oy - 3, 0);
    for (const [r, x, y] of numbers) this.text(x, y + 4, (r / this.scale) * plot.factor);
    const circle = (r: number) => `M${ox + r} ${oy}A${r} ${r} 0 1 0 ${ox - r} ${oy}A${r} ${r} 0 1 0 ${ox + r} ${oy}`;
    set(this.grid, { d: radii.map(circle).join("") });
    set(this.axes, { d: `M0 ${oy}H${width}M${ox} 0V${height}` });
  }

  /** The direction from the origin in which numbers on circles are farthest from the curve. */
  private freest(radii: number[]): [number, number] {
    const curve = this.sampled();
    const [ox, oy] = this.place(0, 0);
    let best: [number, number] = [1, 0];
    let most = -Infinity;
    for (let turn = 22.5; turn < 360; turn += 45) {
      const [ux, uy] = [Math.cos((turn * Math.PI) / 180), -Math.sin((turn * Math.PI) / 180)];
      const [r0] = radii;
      const visible = r0 !== undefined && this.inside(ox + ux * r0, oy + uy * r0);
      const spots = radii.map((r): Spot => [ox + ux * r, oy + uy * r]);
      const free = Math.min(apart(spots, curve), apart(spots, this.named) - 12);
      const least = visible ? free : Math.min(free, -1000);
      if (least > most + 2) [best, most] = [[ux, uy], least];
    }
    return best;
  }

  private lines(plot: Plot): void {
    const [width, height] = this.size;
    const { factor } = plot;
    const metres = (px: number) => ((px - width / 2) / this.scale + this.middle[0]) * factor;
    const rising = (py: number) => ((height / 2 - py) / this.scale + this.middle[1]) * factor;
    const most = round((34 / this.scale) * factor);
    let d = "";
    const step = spacing(metres(40), metres(width - 34), most);
    const across = (by: number): Spot[] =>
      multiples(step * by, metres(0), metres(width)).map((x) => [this.place(x / factor, 0)[0], x]);
    const named = (by: number) => across(by).filter(([px]) => px >= 40 && px <= width - 34);
    const by = WIDER.find((step) => named(step).length >= FEWEST && legible(named(step))) ?? 1;
    for (const [px] of across(by)) d += `M${px.toFixed(1)} 0V${height}`;
    for (const [px, x] of named(by)) this.text(px, height - 4, x);
    const up = spacing(rising(height - 14), rising(8), most);
    for (const y of multiples(up, rising(height), rising(0))) {
      const [, py] = this.place(0, y / factor);
      d += `M0 ${py.toFixed(1)}H${width}`;
      if (py >= 8 && py <= height - 14) this.text(3, py - 2, y, "start");
    }
    set(this.grid, { d });
    const level = plot.level === undefined ? height : this.place(0, plot.level)[1];
    const top = Math.min(Math.max(level, 0), height);
    set(this.ground, { x: 0, y: top.toFixed(1), width, height: (height - top).toFixed(1) });
    set(this.axes, { d: level < height ? `M0 ${level.toFixed(1)}H${width}` : "" });
  }

  private text(x: number, y: number, value: number, anchor = "middle"): void {
    const at = { x: x.toFixed(1), y: y.toFixed(1), "text-anchor": anchor };
    this.texts.add(at, plain(value));
  }
}

/** The least distance between two of several places. */
function apart(some: Spot[], others: Spot[]): number {
  let least = Infinity;
  for (const [x, y] of some) for (const [ox, oy] of others) least = Math.min(least, (x - ox) ** 2 + (y - oy) ** 2);
  return Math.sqrt(least);
}

/** From the edge of a text, by half of its width and height, to the nearest place of a curve; `most` at most. */
function clearance(curve: Spot[], x: number, y: number, wide: number, high: number, most: number): number {
  let least = most;
  for (const [cx, cy] of curve) {
    const away = Math.max(Math.abs(cx - x) - wide, Math.abs(cy - y) - high);
    if (away < least) least = away;
  }
  return least;
}

/** Whether numbers (place, value) stand beside each other with room between them. */
function legible(numbers: Spot[]): boolean {
  const wide = (i: number) => DIGIT * plain(numbers[i]?.[1] ?? 0).length;
  const between = (i: number) => (numbers[i]?.[0] ?? 0) - (numbers[i - 1]?.[0] ?? 0);
  return numbers.every((_, i) => !i || between(i) > (wide(i - 1) + wide(i)) / 2 + DIGIT / 2);
}
