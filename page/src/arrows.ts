/** Arrows at a point: velocity, acceleration and joint forces, with a scale that is told. */

import { h, s } from "./dom";
import { plain, round } from "./format";
import type { Overlay } from "./overlay";
import type { ArrowOf, Pair, State } from "./protocol";
import type { View } from "./view";

/** The longest arrow of a cycle, pixels. */
const LONGEST = 110;
const HEAD = 9;

interface Drawn {
  told: ArrowOf;
  values: Float32Array;
  /** Pixels of one SI unit. */
  scale: number;
  line: SVGPathElement;
  head: SVGPathElement;
}

export class Arrows implements Overlay {
  readonly element = s("g", { class: "arrows", "aria-hidden": "true" });
  /** Names of what is drawn, each with an arrow of the length that is told. */
  readonly legend = h("ul", { class: "scales" });
  /** Kinds that are wanted. */
  readonly kinds = new Set<ArrowOf["kind"]>(["velocity", "acceleration", "force"]);
  private drawn: Drawn[] = [];
  private place: Float32Array | undefined;
  private shape = "";

  show(state: State): void {
    this.place = state.arrows_at ? state.numbers.get(`place.${state.arrows_at}`) : undefined;
    const told = this.place ? state.arrows.filter(({ kind }) => this.kinds.has(kind)) : [];
    const shape = told.map(({ label }) => label).join();
    if (shape !== this.shape) this.build(told, shape);
    told.forEach((one, i) => {
      const drawn = this.drawn[i] as Drawn;
      drawn.told = one;
      drawn.values = state.numbers.get(one.array) ?? new Float32Array(0);
    });
    this.measure();
  }

  /** Arrows of one kind have one scale, so that they can be compared. */
  private measure(): void {
    const longest = new Map<string, number>();
    for (const { told, values } of this.drawn) {
      let most = longest.get(told.kind) ?? 0;
      for (let i = 0; i + 1 < values.length; i += 2)
        most = Math.max(most, Math.hypot(values[i] as number, values[i + 1] as number));
      longest.set(told.kind, most);
    }
    this.drawn.forEach((one, i) => {
      const most = longest.get(one.told.kind) ?? 0;
      // The scale moves in steps, so that arrows grow while something is dragged.
      one.scale = most > 0 ? LONGEST / round(most) : 0;
      const item = this.legend.children[i];
      if (item) item.replaceChildren(...this.scaleOf(one, most));
    });
  }

  private scaleOf({ told, scale }: Drawn, most: number): (Element | string)[] {
    const value = round((most * told.factor) / 2.5);
    const length = (value / told.factor) * scale;
    const key = s("svg", { width: (length + 2).toFixed(1), height: 10, class: told.kind });
    const d = `M0 5H${(length - HEAD).toFixed(1)}`;
    key.append(s("path", { class: "shaft", d }));
    key.append(s("path", { class: "head", d: head([length, 5], 0) }));
    return [told.label, ...(scale ? [key, `${plain(value)}\u00a0${told.unit}`] : [": 0"])];
  }

  private build(told: ArrowOf[], shape: string): void {
    this.shape = shape;
    this.drawn = told.map((one) => {
      const line = s("path", { class: "shaft" });
      const tip = s("path", { class: "head" });
      return { told: one, values: new Float32Array(0), scale: 0, line, head: tip };
    });
    this.element.replaceChildren(
      ...this.drawn.map(({ told: { kind }, line, head }) => s("g", { class: kind }, line, head)),
    );
    this.legend.replaceChildren(...told.map(() => h("li")));
  }

  pose(view: View, k: number): void {
    if (!this.place) return;
    const [x, y] = view.px(this.place[2 * k] as number, this.place[2 * k + 1] as number);
    for (const { values, scale, line, head: tip } of this.drawn) {
      const [dx, dy] = [(values[2 * k] ?? 0) * scale, -(values[2 * k + 1] ?? 0) * scale];
      const long = Math.hypot(dx, dy);
      const shown = long > 1 && Number.isFinite(long);
      const short = Math.max(long - HEAD, 0) / (long || 1);
      line.setAttribute("d", shown ? `M${at(x, y)}L${at(x + dx * short, y + dy * short)}` : "");
      tip.setAttribute("d", shown ? head([x + dx, y + dy], Math.atan2(dy, dx)) : "");
    }
  }
}

function head([x, y]: Pair, angle: number): string {
  const corner = (turn: number) =>
    at(x - HEAD * Math.cos(angle + turn), y - HEAD * Math.sin(angle + turn));
  return `M${at(x, y)}L${corner(0.38)}L${corner(-0.38)}Z`;
}

function at(x: number, y: number): string {
  return `${x.toFixed(1)} ${y.toFixed(1)}`;
}
