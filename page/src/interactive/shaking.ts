/** The shaking force as an arrow at the pivot of the crank. */

import { s, set } from "../dom";
import type { Drawable, Pair } from "../protocol";
import type { Overlay } from "../signs";
import type { View } from "../view";
import { plus, type Solution, scaled, size } from "./machine";

/** The longest arrow of the original, over the size of its drawing. */
const LONGEST = 0.25;
/** Length and half the width of its head, pixels. */
const HEAD: Pair = [9, 3.6];

export class Shaking implements Overlay<Drawable> {
  readonly element = s("g", { class: "arrows", "aria-hidden": "true" });
  private readonly shaft = s("path", { class: "shaft" });
  private readonly head = s("path", { class: "head" });
  private readonly at: string;
  private readonly force: string;
  /** m of one N: that of the original, so that a smaller force is a shorter arrow. */
  private readonly scale: number;

  constructor(private solution: Solution) {
    const { crank, links, scene, rows } = solution.machine.data;
    const points = crank ? (links[crank]?.points ?? []) : [];
    this.at = points.find((name) => scene.frame.includes(name)) ?? (scene.frame[0] as string);
    this.force = rows.length ? "rows.shaking_force" : "shaking_force";
    const [x0, y0, x1, y1] = scene.box;
    const peak = solution.figures(this.force)?.peak ?? 0;
    this.scale = peak ? (LONGEST * Math.max(x1 - x0, y1 - y0)) / peak : 0;
    this.element.append(s("g", { class: "force" }, this.shaft, this.head));
  }

  /** Where the arrow ends, over the crank angle, m. */
  tips(): Pair[] {
    return this.solution.machine.frames.map((at) => this.tip(at));
  }

  private tip(at: number): Pair {
    return plus(this.solution.point(this.at, at), scaled(this.solution.vector(this.force, at), this.scale));
  }

  take(solution: Solution): void {
    this.solution = solution;
  }

  show(): void {
    // what is drawn is taken before
  }

  pose(view: View, k: number): void {
    const at = this.solution.machine.frames[k] ?? 0;
    const [x, y] = view.px(...this.solution.point(this.at, at));
    const [tipX, tipY] = view.px(...this.tip(at));
    const long = size([tipX - x, tipY - y]);
    const [ux, uy] = [(tipX - x) / (long || 1), (tipY - y) / (long || 1)];
    const behind = (back: number, side: number) =>
      `${(tipX - back * ux - side * uy).toFixed(1)} ${(tipY - back * uy + side * ux).toFixed(1)}`;
    const seen = this.scale > 0 && long > 2;
    set(this.shaft, { d: seen ? `M${x.toFixed(1)} ${y.toFixed(1)}L${behind(Math.min(HEAD[0] - 1, long), 0)}` : "" });
    set(this.head, { d: seen ? `M${behind(0, 0)}L${behind(...HEAD)}L${behind(HEAD[0], -HEAD[1])}Z` : "" });
  }
}
