/** A design that is kept, drawn pale below the one that is. */

import { s, set } from "./dom";
import type { Overlay } from "./overlay";
import type { Numbers, Scene } from "./protocol";
import { curve } from "./shapes";
import { Piece } from "./signs";
import type { View } from "./view";

/** Layers of signs that tell a design; soil and support would only hide. */
const DRAWN = ["wheels", "links", "pivots", "blocks", "riders", "springs", "joints"];

export class Ghost implements Overlay {
  readonly element = s("g", { class: "pale", "aria-hidden": "true" });
  private readonly paths = s("path", { class: "path" });
  private pieces: Piece[] = [];
  private numbers: Numbers | null = null;
  private scene: Scene | null = null;
  private drawn = 0;
  private count = 1;

  /** Take another design, or none. */
  take(scene: Scene | null, numbers: Numbers): void {
    [this.scene, this.numbers, this.drawn] = [scene, numbers, 0];
    const signs = scene?.signs.filter(({ layer }) => DRAWN.includes(layer)) ?? [];
    this.pieces = scene ? signs.map((sign) => new Piece(sign, scene)) : [];
    this.element.replaceChildren(this.paths, ...this.pieces.map(({ element }) => element));
  }

  show({ angles }: { angles: number }): void {
    this.count = angles;
  }

  pose(view: View, k: number): void {
    const { scene, numbers } = this;
    if (!scene || !numbers) return;
    if (view.scale !== this.drawn) {
      for (const piece of this.pieces) piece.redraw(view.scale);
      set(this.paths, { d: ways(scene, numbers, view.scale) });
      this.drawn = view.scale;
    }
    set(this.paths, { transform: `translate(${view.px(0, 0).join(" ")})` });
    // Where the other has another number of samples, at the same share of the cycle.
    const own = numbers.get("crank_angle")?.length ?? 1;
    const at = Math.round((k / this.count) * own) % own;
    for (const piece of this.pieces) piece.pose(numbers, view, at, null);
  }
}

/** The paths of all points that move, pixels from the origin. */
function ways({ bodies, frame }: Scene, numbers: Numbers, scale: number): string {
  const points = new Set(bodies.flatMap((body) => body.points));
  return [...points]
    .filter((name) => !frame.includes(name))
    .map((name) => numbers.get(`place.${name}`) ?? new Float32Array(0))
    .map((row) => curve(row, (x, y) => [x * scale, -y * scale], true))
    .join("");
}
