/** The side view of a hand-held tool: shaft, stations, hands, at rest, at work and in its modes. */

import { at as spot } from "./shapes";
import { h, s, set } from "./dom";
import { ruled } from "./sheet";
import { runs, shapePath } from "./signs";
import type { Shape, ToolMessage, ToolScene } from "./protocol";
import { View } from "./view";

/** Half the width of a shaft whose diameter is not known, pixels. */
const THIN = 4.4;
/** From the upper end of the drawing to the names of stations, and between two of them, pixels. */
const [NAMED, APART] = [16, 15];

interface Part {
  place: number;
  turns: boolean;
  element: SVGGElement;
}

/** A tool that is drawn: in its parts, each moved as the shaft is deflected. */
class Drawing {
  readonly element = s("g");
  private readonly tubes: SVGPathElement[];
  private readonly parts: Part[];

  constructor(
    private readonly scene: ToolScene,
    private readonly along: number[],
    private readonly view: View,
  ) {
    const layer = (name: string) =>
      scene.pieces
        .filter((piece) => piece.layer === name)
        .map(({ place, turns, shapes }) => ({ place, turns, element: this.drawn(shapes) }));
    const [below, above] = [layer("below"), layer("above")];
    this.tubes = scene.tubes.map(() => {
      const path = s("path");
      path.style.cssText = scene.looks.rim ?? "";
      return path;
    });
    this.parts = [...below, ...above];
    const elements = (parts: Part[]) => parts.map(({ element }) => element);
    this.element.append(...elements(below), ...this.tubes, ...elements(above));
  }

  private drawn(shapes: Shape[]): SVGGElement {
    const { scale } = this.view;
    const elements = runs(shapes).map((run) => {
      const [role, , radius, grown, corners] = run[0] as Shape;
      const round = radius + grown > 0;
      const element = round ? s("circle") : s("path");
      element.style.cssText = this.scene.looks[role] ?? "";
      if (!round) set(element, { d: run.map(shapePath(scale)).join("") });
      else {
        const [x, y, dx, dy] = corners as [number, number, number, number];
        const r = (radius * scale + grown).toFixed(2);
        set(element, { cx: x * scale + dx, cy: -y * scale - dy, r });
      }
      return element;
    });
    return s("g", { class: "piece" }, ...elements);
  }

  /** Draw it deflected, m at each of the places along the shaft. */
  pose(deflected: number[]): void {
    const { along, view } = this;
    const high = (x: number) => interpolated(along, deflected, x);
    this.scene.tubes.forEach(([start, stop, diameter], i) => {
      const half = diameter ? (diameter / 2) * view.scale : THIN;
      const places = [start, ...along.filter((x) => x > start && x < stop), stop];
      const middle = places.map((x) => view.px(x, high(x)));
      const edge = (side: number) => middle.map(([x, y]): [number, number] => [x, y + side * half]);
      const around = [...edge(-1), ...edge(1).reverse()];
      set(this.tubes[i] as SVGPathElement, { d: `M${around.map(spot).join("L")}Z` });
    });
    const step = (along[1] ?? 1) / 2;
    for (const { place, turns, element } of this.parts) {
      const slope = (high(place + step) - high(place - step)) / (2 * step);
      const ends = place < step || place > (along[along.length - 1] ?? 0) - step ? 2 : 1;
      const angle = turns ? (-Math.atan(slope * ends) * 180) / Math.PI : 0;
      const [x, y] = view.px(place, high(place));
      set(element, { transform: `translate(${spot([x, y])}) rotate(${angle.toFixed(3)})` });
    }
  }
}

export class ToolSide {
  readonly root = h("div", { class: "board" });
  readonly view = new View();
  private readonly lines = s("svg", { class: "sheet-lines", "aria-hidden": "true" });
  private readonly svg = s("svg", { class: "linkage tool-side", role: "img" });
  private tool: ToolMessage | null = null;
  private now: Drawing | null = null;
  private shape: number[] = [];
  private phase = 0;

  constructor() {
    this.root.append(this.lines, this.svg);
  }

  /** Take a tool; its box stays while numbers change a little, so that the drawing does not breathe. */
  show(tool: ToolMessage, other: boolean): void {
    this.tool = tool;
    if (other || !this.view.width) this.fit();
    this.draw();
  }

  resize(): void {
    const { clientWidth, clientHeight } = this.root;
    if (!clientWidth || (clientWidth === this.view.width && clientHeight === this.view.height)) return;
    [this.view.width, this.view.height] = [clientWidth, clientHeight];
    for (const svg of [this.svg, this.lines])
      set(svg, { viewBox: `0 0 ${clientWidth} ${clientHeight}` });
    this.fit();
    this.draw();
  }

  /** Deflect the shaft: real and imaginary parts along it, at a phase from 0 to 1. */
  pose(shape: number[], phase: number): void {
    [this.shape, this.phase] = [shape, phase];
    const [cos, sin] = [Math.cos(2 * Math.PI * phase), Math.sin(2 * Math.PI * phase)];
    const along = this.tool?.along ?? [];
    const still = !shape.length;
    this.now?.pose(
      along.map((_, i) =>
        still ? 0 : (shape[2 * i] ?? 0) * cos - (shape[2 * i + 1] ?? 0) * sin,
      ),
    );
  }

  private fit(): void {
    const { tool } = this;
    if (!tool || !this.view.width) return;
    const swing = 0.05 * (tool.along[tool.along.length - 1] ?? 1);
    const [x0, y0, x1, y1] = tool.scene.box;
    this.view.fit([x0, y0 - swing, x1, y1 + swing]);
  }

  private draw(): void {
    const { tool, view } = this;
    if (!tool || !view.width) return;
    const { lines, numbers } = ruled(view);
    this.lines.replaceChildren(...lines, ...numbers);
    this.now = new Drawing(tool.scene, tool.along, view);
    const parts: SVGElement[] = [];
    if (tool.before) {
      const was = new Drawing(tool.before, tool.along, view);
      was.pose(tool.along.map(() => 0));
      was.element.classList.add("pale");
      parts.push(was.element);
    }
    this.svg.replaceChildren(...parts, this.now.element, this.names(tool));
    set(this.svg, { "aria-label": this.words(tool) });
    this.pose(this.shape, this.phase);
  }

  private words({ scene, title }: ToolMessage): string {
    const places = scene.stations.map(({ name, told }) => `${name} ${told}`);
    return `${title}: ${places.join(", ")}`;
  }

  /** Stations by name and place, each in the first line where it has room. */
  private names({ scene }: ToolMessage): SVGGElement {
    const group = s("g", { class: "stations" });
    const ends: number[] = [];
    const ordered = [...scene.stations].sort((a, b) => a.place - b.place);
    for (const { name, place, told } of ordered) {
      const [x, foot] = this.view.px(place, 0);
      const text = `${name} · ${told}`;
      const wide = 7 * text.length;
      const left = Math.min(Math.max(x - wide / 2, 4), Math.max(this.view.width - wide - 50, 4));
      let row = ends.findIndex((end) => end < left - 8);
      if (row < 0) row = ends.length;
      ends[row] = left + wide;
      const y = NAMED + row * APART;
      group.append(
        s("path", { class: "flag", d: `M${x.toFixed(1)} ${y + 4}V${foot.toFixed(1)}` }),
        s("text", { x: left.toFixed(1), y }, text),
      );
    }
    return group;
  }
}

function interpolated(along: number[], values: number[], x: number): number {
  const last = along.length - 1;
  const step = (along[last] ?? 1) / (last || 1);
  const at = Math.min(Math.max(x / step, 0), last);
  const k = Math.min(Math.floor(at), Math.max(last - 1, 0));
  const [low, high] = [values[k] ?? 0, values[k + 1] ?? 0];
  return low + (high - low) * (at - k);
}
