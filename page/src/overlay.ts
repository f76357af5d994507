/** What is drawn over or under the linkage besides itself, and how its support swings. */

import type { Drawable, Pair, State } from "./protocol";
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
export interface Swung {
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
