/** A hand-held tool on the page: its side view, which moves, its numbers, figures and curves. */

import { Chart } from "./chart";
import type { Conversation } from "./conversation";
import { h, letsMove, s, set, write } from "./dom";
import { measure, unbroken } from "./format";
import { Heading } from "./heading";
import { Inspector, Locks } from "./inspector";
import type { DrawnShape, Numbers, State, ToolMessage, ToolScene } from "./protocol";
import { comparison } from "./readings";
import { render, v } from "./render";
import { runs, shapePath, at as spot } from "./signs";
import type { Theme } from "./theme";
import { ruled, View } from "./view";
import { say } from "./words";

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

  private drawn(shapes: DrawnShape[]): SVGGElement {
    const { scale } = this.view;
    const elements = runs(shapes).map((run) => {
      const [role, , radius, grown, corners] = run[0] as DrawnShape;
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

class ToolSide {
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
    for (const svg of [this.svg, this.lines]) set(svg, { viewBox: `0 0 ${clientWidth} ${clientHeight}` });
    this.fit();
    this.draw();
  }

  /** Deflect the shaft: real and imaginary parts along it, at a phase from 0 to 1. */
  pose(shape: number[], phase: number): void {
    [this.shape, this.phase] = [shape, phase];
    const [cos, sin] = [Math.cos(2 * Math.PI * phase), Math.sin(2 * Math.PI * phase)];
    const along = this.tool?.along ?? [];
    const still = !shape.length;
    this.now?.pose(along.map((_, i) => (still ? 0 : (shape[2 * i] ?? 0) * cos - (shape[2 * i + 1] ?? 0) * sin)));
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
    const places = scene.stations.map(({ name, text }) => `${name} ${text}`);
    return `${title}: ${places.join(", ")}`;
  }

  /** Stations by name and place, each in the first line where it has room. */
  private names({ scene }: ToolMessage): SVGGElement {
    const group = s("g", { class: "stations" });
    const ends: number[] = [];
    const ordered = [...scene.stations].sort((a, b) => a.place - b.place);
    for (const { name, place, text: station } of ordered) {
      const [x, foot] = this.view.px(place, 0);
      const text = `${name} · ${station}`;
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

/** Of a swing, ms. */
const PERIOD = 1600;

export class ToolView {
  readonly root = h("div", { class: "body tool", hidden: true });
  private readonly side = new ToolSide();
  private readonly heading = new Heading();
  private readonly inspector: Inspector;
  private readonly views: HTMLSelectElement;
  private readonly play: HTMLButtonElement;
  private readonly motion = h("p", { class: "quiet", role: "status" });
  private readonly wrong = h("p", { class: "said bad", role: "status", hidden: true });
  private readonly figures = h("div", { class: "readings figures" });
  private readonly charts = h("div", { class: "charts" });
  private readonly drawn = new Map<string, Chart>();
  private readonly watcher = new ResizeObserver(() => this.measure());
  private tool: ToolMessage | null = null;
  private numbers: Numbers | null = null;
  private playing = letsMove();
  private frame = 0;
  private since = 0;

  constructor(
    talk: Conversation,
    private readonly theme: Theme,
  ) {
    this.inspector = new Inspector(talk, () => undefined, new Locks());
    this.views = h("select", { "aria-label": say("What is shown"), onchange: () => this.pose() });
    this.play = h("button", { type: "button", onclick: () => this.toggle() }, "");
    const stage = h("section", { class: "stage", "aria-label": say("The tool from the side") });
    const bar = h("div", { class: "seeing" }, this.play, this.views, this.motion);
    this.side.root.append(this.wrong);
    stage.append(this.heading.about, this.side.root, bar, this.heading.notes, this.figures);
    const side = h("section", { class: "side", "aria-label": say("Charts") });
    side.append(this.charts);
    const aside = h("section", { class: "inspector", "aria-label": say("Numbers") });
    aside.append(this.inspector.root);
    this.root.append(stage, side, aside);
    this.watcher.observe(this.side.root);
    this.watcher.observe(this.charts);
  }

  /** A sentence, on what cannot be if `bad`; it goes with the next change. */
  say(message: string, bad = false): void {
    write(this.wrong, message);
    this.wrong.classList.toggle("bad", bad);
    this.wrong.hidden = !message;
  }

  close(): void {
    cancelAnimationFrame(this.frame);
    this.watcher.disconnect();
  }

  hide(): void {
    this.root.hidden = true;
    cancelAnimationFrame(this.frame);
    this.tool = null;
  }

  show(tool: ToolMessage, numbers: Numbers): void {
    const other = tool.name !== this.tool?.name;
    [this.tool, this.numbers] = [tool, numbers];
    measure(tool.length);
    this.say("");
    this.root.hidden = false;
    this.offer(tool, other);
    this.side.resize();
    this.side.show(tool, other);
    // What these need of a state a tool has too.
    const state = tool as unknown as State;
    this.heading.show(state);
    this.inspector.show(state);
    render(this.figures, comparison(tool.figures, [say("as opened"), say("now"), say("change")]));
    this.chart();
    this.pose();
  }

  private offer(tool: ToolMessage, other: boolean): void {
    const names = [say("at rest"), ...tool.views.map(({ name }) => name)];
    const chosen = other ? Math.min(1, tool.views.length) : this.views.selectedIndex;
    render(this.views, ...names.map((name, i) => v("option", { value: i }, name)));
    this.views.selectedIndex = Math.min(chosen, names.length - 1);
  }

  private chart(): void {
    const { tool, numbers } = this;
    if (!tool || !numbers) return;
    const before = numbers.names("before.").length > 0;
    for (const data of tool.charts) {
      let chart = this.drawn.get(data.name);
      const whole = { picked: () => undefined, chosen: () => this.chart() };
      if (!chart) {
        chart = new Chart(data, this.theme, true, whole);
        this.drawn.set(data.name, chart);
        this.charts.append(chart.strip.root);
        chart.strip.resize(this.charts.clientWidth);
      }
      chart.offer(data, "", false);
      chart.show({ state: tool as unknown as State, numbers, before }, "", "");
      chart.strip.describe();
    }
    const names = tool.charts.map(({ name }) => name);
    for (const [name, { strip }] of this.drawn) if (!names.includes(name)) strip.root.hidden = true;
  }

  private measure(): void {
    this.side.resize();
    for (const { strip } of this.drawn.values()) strip.resize(this.charts.clientWidth);
  }

  private toggle(): void {
    this.playing = !this.playing;
    this.pose();
  }

  /** Show what is chosen, and swing it if that is wanted. */
  private pose(): void {
    const view = this.tool?.views[this.views.selectedIndex - 1];
    const text = (view?.lines ?? []).join("; ");
    write(this.motion, unbroken(text));
    this.motion.hidden = !text;
    write(this.play, this.playing ? say("Pause") : say("Play"));
    this.play.disabled = !view;
    cancelAnimationFrame(this.frame);
    this.side.pose(view?.shape ?? [], 0);
    if (!view || !this.playing) return;
    this.since ||= performance.now();
    const swing = (now: number) => {
      this.side.pose(view.shape, ((now - this.since) % PERIOD) / PERIOD);
      this.frame = requestAnimationFrame(swing);
    };
    this.frame = requestAnimationFrame(swing);
  }
}
