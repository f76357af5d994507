/** Lengths and directions of a link's lines, written at the link that is chosen. */

import { s, set, write } from "./dom";
import { degrees, length, lengths, signed } from "./format";
import type { Pair } from "./protocol";
import type { View } from "./view";

/** Points of a link of which every two have their line told. */
const MOST = 4;
/** Pixels between a line and what is written at it. */
const BESIDE = 12;

export class Dimensions {
  readonly layer = s("g", { class: "dims", "aria-hidden": "true" });
  private lines: { from: string; to: string; text: SVGTextElement }[] = [];

  /** Of which points lines are told; of none where nothing is chosen. */
  choose(points: readonly string[]): void {
    const told = points.slice(0, MOST);
    this.lines = told.flatMap((from, i) =>
      told.slice(i + 1).map((to) => ({ from, to, text: s("text", { "text-anchor": "middle" }) })),
    );
    this.layer.replaceChildren(...this.lines.map(({ text }) => text));
  }

  pose(place: (point: string) => Pair | null, view: View): void {
    for (const { from, to, text } of this.lines) {
      const [a, b] = [place(from), place(to)];
      if (!a || !b) continue;
      const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
      const size = Math.hypot(dx, dy);
      const angle = signed(degrees(Math.atan2(dy, dx)).toFixed(1));
      write(text, `${length(size)} ${lengths().unit} ∠ ${angle}°`);
      const [x, y] = view.px((a[0] + b[0]) / 2, (a[1] + b[1]) / 2);
      const [nx, ny] = size ? [-dy / size, -dx / size] : [0, -1];
      set(text, { x: (x + nx * BESIDE).toFixed(1), y: (y + ny * BESIDE + 4).toFixed(1) });
    }
  }
}
