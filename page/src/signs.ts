/**
 * Signs of a machine: drawn once for a scale, then moved as rigid bodies; with what lies over or under
 * them.
 */

import { s, set } from "./dom";
import type { Drawable, DrawnShape, Pair, Rows, Scene, Sign, State } from "./protocol";
import type { View } from "./view";

/** A layer of its own on the drawing. */
export interface Overlay<S extends Drawable = State> {
  readonly element: SVGGElement;
  /** Another machine, or the same with other numbers. */
  show(state: S): void;
  /** Draw it where everything is at sample k. */
  pose(view: View, k: number): void;
}

/** How all that the support carries is moved. */
export interface Swing {
  /** A displacement of the support's reference (m), and its rotation (rad), at sample k. */
  at(k: number): { place: Pair; angle: number };
  /** What the support turns about, m. */
  readonly reference: Pair;
}

/** As a transformation of the drawing, and of a single place (m). */
interface Swung {
  transform: string;
  place(at: Pair): Pair;
}

export function swung(swing: Swing, view: View, k: number): Swung {
  const { place, angle } = swing.at(k);
  const [cx, cy] = swing.reference;
  const [px, py] = view.px(cx, cy);
  const [dx, dy] = [place[0] * view.scale, -place[1] * view.scale];
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const turn = (-angle * 180) / Math.PI;
  return {
    transform: `translate(${dx.toFixed(2)} ${dy.toFixed(2)}) rotate(${turn.toFixed(4)} ${px.toFixed(2)} ${py.toFixed(2)}) `,
    place: ([x, y]) => [
      cx + place[0] + cos * (x - cx) - sin * (y - cy),
      cy + place[1] + sin * (x - cx) + cos * (y - cy),
    ],
  };
}

/** Shades of links, one after the other. */
const TINTS = 5;

export class Piece {
  readonly element: SVGGElement;
  private readonly parts: SVGElement[];
  /** What the support does to it. */
  private before = "";

  constructor(
    private sign: Sign,
    scene: Scene,
  ) {
    const number = scene.bodies.findIndex(({ name }) => name === sign.link);
    const kind = sign.link ? ` body tint-${number % TINTS}` : "";
    this.parts = runs(sign.shapes).map(([first]) => {
      const [role] = first as DrawnShape;
      const element = isRound(first as DrawnShape) ? s("circle") : s("path");
      element.style.cssText = scene.looks[role] ?? "";
      return element;
    });
    const link = sign.link || null;
    const [what, name] = sign.part ?? [null, null];
    const attributes = { class: `piece${kind}`, "data-link": link, "data-what": what, "data-name": name };
    this.element = s("g", attributes, ...this.parts);
  }

  get link(): string {
    return this.sign.link;
  }

  get ground(): boolean {
    return this.sign.ground;
  }

  /** Draw the shapes of a sign of the same build, with so many pixels a metre. */
  draw(sign: Sign, scale: number): void {
    this.sign = sign;
    for (const [i, run] of runs(sign.shapes).entries()) {
      const element = this.parts[i] as SVGElement;
      const [, , radius, grown, corners] = run[0] as DrawnShape;
      if (isRound(run[0] as DrawnShape)) {
        const [cx, cy] = corner(corners, 0, scale);
        const r = (radius * scale + grown).toFixed(2);
        set(element, { cx: cx.toFixed(2), cy: cy.toFixed(2), r });
      } else set(element, { d: run.map(shapePath(scale)).join("") });
    }
  }

  /** Draw the same with so many pixels a metre. */
  redraw(scale: number): void {
    this.draw(this.sign, scale);
  }

  /** Move it to where it is at sample k, as the support swings. */
  pose(numbers: Rows, view: View, k: number, swung: Swung | null): void {
    const { hold, still } = this.sign;
    this.before = still ? "" : (swung?.transform ?? "");
    if (!hold) return this.place(view.px(0, 0), "");
    if (hold.mount) return this.strut(hold.at ?? [0, 0], hold.ground ?? [1, 0], view, swung);
    const from = pairAt(numbers, `place.${hold.point ?? ""}`, k);
    if (hold.link) {
      const angle = numbers.get(`angle.${hold.link}`)?.[k] ?? 0;
      return this.place(view.px(...from), turned(angle));
    }
    if (hold.guide) {
      const [x, y] = pairAt(numbers, `guide.${hold.guide}`, k);
      return this.place(view.px(...from), turned(Math.atan2(y, x)));
    }
    const to = pairAt(numbers, `place.${hold.to}`, k);
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const longer = hold.rigid ? 1 : Math.hypot(dx, dy) / (hold.length || 1);
    this.place(view.px(...from), `${turned(Math.atan2(dy, dx))} scale(${longer.toFixed(4)} 1)`);
  }

  /** Stretch a mount from its place on the support to the ground, which stands still. */
  private strut(at: Pair, [gx, gy]: Pair, view: View, swung: Swung | null): void {
    const [x, y] = view.px(...at);
    const [px, py] = view.px(...(swung?.place(at) ?? at));
    const [dx, dy] = [x + gx - px, y - gy - py];
    const longer = Math.hypot(dx, dy) / (Math.hypot(gx, gy) || 1);
    this.before = "";
    this.place([px, py], `${turned(Math.atan2(-dy, dx))} scale(${longer.toFixed(4)} 1)`);
  }

  private place([x, y]: Pair, more: string): void {
    const here = `translate(${x.toFixed(2)} ${y.toFixed(2)})${more}`;
    set(this.element, { transform: this.before + here });
  }
}

/** What has to be the same for elements to be used again. */
export function build(scene: Scene): string {
  const drawn = scene.signs.map(({ link, part, hold, shapes }) => [
    link,
    part,
    hold && [hold.point, hold.link, hold.guide, hold.to, hold.mount],
    runs(shapes).map(([first]) => [first?.[0], isRound(first as DrawnShape)]),
  ]);
  return JSON.stringify(drawn);
}

/** Neighbours that are drawn alike: lines of a role together, circles each by itself. */
export function runs(shapes: DrawnShape[]): DrawnShape[][] {
  const groups: DrawnShape[][] = [];
  for (const shape of shapes) {
    const last = groups[groups.length - 1];
    const alike = last && last[0]?.[0] === shape[0] && !isRound(shape);
    if (alike) last.push(shape);
    else groups.push([shape]);
  }
  return groups;
}

/** Whether a shape is a circle, and no outline. */
function isRound([, , radius, grown]: DrawnShape): boolean {
  return radius + grown > 0;
}

/** The outline of a shape with so many pixels a metre. */
export function shapePath(scale: number): (shape: DrawnShape) => string {
  return ([, closed, , , corners]) => {
    let d = "";
    for (let i = 0; i < corners.length; i += 4) {
      const [x, y] = corner(corners, i, scale);
      d += `${i ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`;
    }
    return closed ? `${d}Z` : d;
  };
}

function corner(corners: number[], i: number, scale: number): Pair {
  const [x, y, dx, dy] = corners.slice(i, i + 4) as [number, number, number, number];
  return [x * scale + dx, -y * scale - dy];
}

function pairAt(numbers: Rows, name: string, k: number): Pair {
  const row = numbers.get(name);
  return row ? [row[2 * k] as number, row[2 * k + 1] as number] : [0, 0];
}

function turned(angle: number): string {
  return `rotate(${((-angle * 180) / Math.PI).toFixed(3)})`;
}

export function at([x, y]: Pair): string {
  return `${x.toFixed(1)} ${y.toFixed(1)}`;
}

/** The sign of a centre of mass: two of the quarters of a circle. */
export function quarters(radius: number): string {
  const r = radius;
  return `M0 0V${-r}A${r} ${r} 0 0 1 ${r} 0ZM0 0V${r}A${r} ${r} 0 0 1 ${-r} 0Z`;
}

/** Samples of a curve nearer than this to the last one that is drawn are left out, pixels. */
const NEAR = 1;

/** A curve through x and y in turn; every so many samples suffice. */
export function curve(points: Float32Array, px: (x: number, y: number) => Pair, closed: boolean): string {
  const step = Math.max(Math.round(points.length / 720), 1) * 2;
  let [d, x0, y0] = ["", 0, 0];
  for (let i = 0; i + 1 < points.length; i += step) {
    const [x, y] = px(points[i] as number, points[i + 1] as number);
    if (!Number.isFinite(x + y)) continue; // more than a number of 32 bits holds
    const ends = !i || i + step + 1 >= points.length;
    if (!ends && (x - x0) ** 2 + (y - y0) ** 2 < NEAR ** 2) continue;
    d += (d ? "L" : "M") + at([x, y]);
    [x0, y0] = [x, y];
  }
  return d && closed ? `${d}Z` : d;
}

/** The direction away from the other points of the links that meet at a point, of size 1. */
export function outside([x, y]: Pair, near: Pair[], footed: boolean): Pair {
  let [dx, dy] = [0, 0];
  for (const [ox, oy] of near) {
    const away = Math.hypot(x - ox, y - oy) || 1;
    dx += (x - ox) / away;
    dy += (y - oy) / away;
  }
  // The foot of a pivot on the frame hangs below it: the name goes beside or above.
  if (footed) return [Math.abs(dx) > 1e-3 ? Math.sign(dx) * 0.85 : 0.85, -0.5];
  const size = Math.hypot(dx, dy);
  return size > 1e-3 ? [dx / size, dy / size] : [0.7, -0.7];
}
