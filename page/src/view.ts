/**
 * From metres to pixels and back: what of the plane the stage shows, and the fine lines of its sheet
 * with their scale.
 */

import { s } from "./dom";
import { lengths, multiples, plain, round } from "./format";
import type { Pair } from "./protocol";

/** The direction of each arrow key on a drawing, y upward. */
export const ARROWS: Record<string, Pair> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
/** By how much a key makes a drawing larger. */
export const ZOOMS: Record<string, number> = { "+": 1.25, "=": 1.25, "-": 0.8 };

const MARGIN = 0.05;

export class View {
  width = 0;
  height = 0;
  /** Pixels a metre. */
  scale = 1;
  private center: Pair = [0, 0];

  /** Show a box with some room around it, the more below and left for the scales there. */
  fit(box: readonly [number, number, number, number], least = 20): void {
    const [x0, y0, x1, y1] = box;
    const [w, h] = [Math.max(x1 - x0, 1e-9), Math.max(y1 - y0, 1e-9)];
    const room = Math.min(this.width, this.height) * MARGIN + least;
    const [freeX, freeY] = [Math.max(this.width - 2 * room, 20), Math.max(this.height - 2 * room, 20)];
    this.scale = Math.min(freeX / w, freeY / h);
    this.center = [(x0 + x1) / 2, (y0 + y1) / 2];
  }

  px(x: number, y: number): Pair {
    return [this.width / 2 + (x - this.center[0]) * this.scale, this.height / 2 - (y - this.center[1]) * this.scale];
  }

  metres(px: number, py: number): Pair {
    return [this.center[0] + (px - this.width / 2) / this.scale, this.center[1] - (py - this.height / 2) / this.scale];
  }

  /** Zoom so that what is at a pixel stays there. */
  zoom(factor: number, px = this.width / 2, py = this.height / 2): void {
    const [x, y] = this.metres(px, py);
    this.scale *= factor;
    const [nowX, nowY] = this.metres(px, py);
    this.center = [this.center[0] + x - nowX, this.center[1] + y - nowY];
  }

  pan(dx: number, dy: number): void {
    this.center = [this.center[0] - dx / this.scale, this.center[1] + dy / this.scale];
  }
}

/** Pixels between two bold lines, at least. */
const APART = 70;

export function ruled(view: View): { lines: SVGElement[]; numbers: SVGElement[] } {
  const { width, height } = view;
  const { unit, factor } = lengths();
  const step = round((APART / view.scale) * factor) / factor;
  const [x0, y0] = view.metres(0, height);
  const [x1, y1] = view.metres(width, 0);
  const across = (x: number) => view.px(x, 0)[0];
  const down = (y: number) => view.px(0, y)[1];
  const every = (apart: number) =>
    multiples(apart, x0, x1)
      .map((x) => `M${across(x).toFixed(1)} 0V${height}`)
      .join("") +
    multiples(apart, y0, y1)
      .map((y) => `M0 ${down(y).toFixed(1)}H${width}`)
      .join("");
  const texts: SVGElement[] = [text(width - 8, height - 6, unit, "end")];
  for (const x of multiples(step, x0, x1)) {
    const px = across(x);
    if (px > 34 && px < width - 52) texts.push(text(px, height - 6, plain(x * factor), "middle"));
  }
  for (const y of multiples(step, y0, y1)) {
    const py = down(y);
    if (py > 14 && py < height - 22) texts.push(text(6, py + 3.5, plain(y * factor), "start"));
  }
  const fine = [s("path", { class: "fine", d: every(step / 5) }), s("path", { class: "bold", d: every(step) })];
  return { lines: fine, numbers: texts };
}

function text(x: number, y: number, words: string, anchor: string): SVGElement {
  return s("text", { x: x.toFixed(1), y: y.toFixed(1), "text-anchor": anchor }, words);
}
