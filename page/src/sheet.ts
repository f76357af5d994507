/** Fine lines as on a drawing board, with a scale at the left and below. */

import { s } from "./dom";
import { lengths, multiples, plain, round } from "./format";
import type { View } from "./view";

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
  const fine = [
    s("path", { class: "fine", d: every(step / 5) }),
    s("path", { class: "bold", d: every(step) }),
  ];
  return { lines: fine, numbers: texts };
}

function text(x: number, y: number, words: string, anchor: string): SVGElement {
  return s("text", { x: x.toFixed(1), y: y.toFixed(1), "text-anchor": anchor }, words);
}
