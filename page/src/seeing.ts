/** What is seen besides the machine: arrows at a point, a pale design, a support that moves. */

import { h, put, s, set, show } from "./dom";
import { plain, round, unbroken } from "./format";
import type { ArrowOf, Numbers, PageRequest, Pair, ResponseMessage, Scene, State } from "./protocol";
import { type ComponentChild, render, v } from "./render";
import { at, curve, type Overlay, Piece } from "./signs";
import type { Stage } from "./stage";
import { Support } from "./support";
import { Variants } from "./variants";
import type { View } from "./view";
import { say } from "./words";

class Ghost implements Overlay {
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
    const signs = scene?.signs.filter(({ compared }) => compared) ?? [];
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

/** The longest arrow of a cycle, pixels. */
const LONGEST = 110;
const HEAD = 9;

interface Drawn {
  arrow: ArrowOf;
  values: Float32Array;
  /** Pixels of one SI unit. */
  scale: number;
  line: SVGPathElement;
  head: SVGPathElement;
}

class Arrows implements Overlay {
  readonly element = s("g", { class: "arrows", "aria-hidden": "true" });
  /** Names of what is drawn, each with an arrow of the stated size. */
  readonly legend = h("ul", { class: "scales" });
  /** Kinds that are wanted. */
  readonly kinds = new Set<ArrowOf["kind"]>(["velocity", "acceleration", "force"]);
  private drawn: Drawn[] = [];
  private place: Float32Array | undefined;
  private shape = "";

  show(state: State): void {
    this.place = state.arrows_at ? state.numbers.get(`place.${state.arrows_at}`) : undefined;
    const arrows = this.place ? state.arrows.filter(({ kind }) => this.kinds.has(kind)) : [];
    const shape = arrows.map(({ label }) => label).join();
    if (shape !== this.shape) this.build(arrows, shape);
    arrows.forEach((arrow, i) => {
      const drawn = this.drawn[i] as Drawn;
      drawn.arrow = arrow;
      drawn.values = state.numbers.get(arrow.array) ?? new Float32Array(0);
    });
    this.measure();
  }

  /** Arrows of one kind have one scale, so that they can be compared. */
  private measure(): void {
    const longest = new Map<string, number>();
    for (const { arrow, values } of this.drawn) {
      let most = longest.get(arrow.kind) ?? 0;
      for (let i = 0; i + 1 < values.length; i += 2)
        most = Math.max(most, Math.hypot(values[i] as number, values[i + 1] as number));
      longest.set(arrow.kind, most);
    }
    const most = (drawn: Drawn) => longest.get(drawn.arrow.kind) ?? 0;
    // The scale moves in steps, so that arrows grow while something is dragged.
    for (const drawn of this.drawn) drawn.scale = most(drawn) > 0 ? LONGEST / round(most(drawn)) : 0;
    render(this.legend, ...this.drawn.map((drawn) => v("li", {}, ...this.scaleOf(drawn, most(drawn)))));
  }

  private scaleOf({ arrow, scale }: Drawn, most: number): ComponentChild[] {
    const value = round((most * arrow.factor) / 2.5);
    const length = (value / arrow.factor) * scale;
    const d = `M0 5H${(length - HEAD).toFixed(1)}`;
    const key = v(
      "svg",
      { width: (length + 2).toFixed(1), height: 10, class: arrow.kind },
      v("path", { class: "shaft", d }),
      v("path", { class: "head", d: head([length, 5], 0) }),
    );
    return [arrow.label, ...(scale ? [key, `${plain(value)}\u00a0${arrow.unit}`] : [": 0"])];
  }

  private build(arrows: ArrowOf[], shape: string): void {
    this.shape = shape;
    this.drawn = arrows.map((arrow) => {
      const line = s("path", { class: "shaft" });
      const tip = s("path", { class: "head" });
      return { arrow, values: new Float32Array(0), scale: 0, line, head: tip };
    });
    this.element.replaceChildren(
      ...this.drawn.map(({ arrow: { kind }, line, head }) => s("g", { class: kind }, line, head)),
    );
  }

  pose(view: View, k: number): void {
    if (!this.place) return;
    const [x, y] = view.px(this.place[2 * k] as number, this.place[2 * k + 1] as number);
    for (const { values, scale, line, head: tip } of this.drawn) {
      const [dx, dy] = [(values[2 * k] ?? 0) * scale, -(values[2 * k + 1] ?? 0) * scale];
      const long = Math.hypot(dx, dy);
      const visible = long > 1 && Number.isFinite(long);
      const short = Math.max(long - HEAD, 0) / (long || 1);
      line.setAttribute("d", visible ? `M${at([x, y])}L${at([x + dx * short, y + dy * short])}` : "");
      tip.setAttribute("d", visible ? head([x + dx, y + dy], Math.atan2(dy, dx)) : "");
    }
  }
}

function head([x, y]: Pair, angle: number): string {
  const corner = (turn: number) => at([x - HEAD * Math.cos(angle + turn), y - HEAD * Math.sin(angle + turn)]);
  return `M${at([x, y])}L${corner(0.38)}L${corner(-0.38)}Z`;
}

export class Seeing {
  readonly root: HTMLElement;
  readonly variants: Variants;
  private readonly arrows = new Arrows();
  private readonly ghost = new Ghost();
  private readonly support = new Support(() => this.again());
  private readonly at: HTMLSelectElement;
  private readonly kinds: HTMLElement;
  private readonly record = h("p", { class: "quiet", role: "status", hidden: true });
  private readonly motion = h("p", { class: "quiet", role: "status" });
  private state: State | null = null;

  constructor(
    private readonly stage: Stage,
    private readonly ask: (request: PageRequest) => void,
    private readonly changed: () => void,
  ) {
    this.variants = new Variants(ask);
    this.at = h("select", {
      "aria-label": say("Arrows at"),
      onchange: () => this.ask({ type: "arrows", point: this.at.value }),
    });
    const kind = (name: ArrowOf["kind"], text: string) => {
      const box = h("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => {
        if (box.checked) this.arrows.kinds.add(name);
        else this.arrows.kinds.delete(name);
        this.again();
      });
      return h("label", { class: name }, box, text);
    };
    this.kinds = h(
      "span",
      { class: "kinds", role: "group", "aria-label": say("Arrows"), hidden: true },
      kind("velocity", say("velocity")),
      kind("acceleration", say("acceleration")),
      kind("force", say("force")),
    );
    this.root = h(
      "div",
      { class: "seeing" },
      h("label", { class: "arrowed" }, h("span", {}, say("Arrows at")), this.at),
      this.kinds,
      this.support.root,
      this.variants.choice,
      this.arrows.legend,
      this.motion,
      this.record,
    );
    stage.overlay(this.ghost, "signs");
    stage.overlay(this.arrows, "ghost");
  }

  /** Take a state, before the drawing shows it. */
  show(state: State, other: boolean): void {
    this.state = state;
    this.support.show(state, other);
    show(this.kinds, !!state.arrows_at);
    this.offer(state);
    this.tell();
    this.beside(state.record);
  }

  /** What was measured, and a button that takes it away. */
  private beside(record: State["record"]): void {
    const left = record?.left_out.join(", ") ?? "";
    const parts = record ? [say("Record {name}", { name: record.name }), ...record.lines] : [];
    if (left) parts.push(say("no outputs of this machine: {names}", { names: left }));
    const remove = () => this.ask({ type: "record", name: "", text: "" });
    const button = v("button", { type: "button", onclick: remove }, say("Remove the record"));
    render(this.record, `${unbroken(parts.join("; "))} `, button);
    show(this.record, parts.length > 0);
  }

  answered(message: ResponseMessage, numbers: Numbers): void {
    this.support.take(message, numbers);
    // While something is held the support stands still, and nothing is to be drawn anew.
    if (this.support.held) this.tell();
    else this.again();
  }

  /** Take the drawing of a pale design. */
  pale(scene: State["scene"] | null, numbers: Numbers): void {
    this.ghost.take(scene, numbers);
    this.again();
  }

  hold(on: boolean): void {
    this.support.held = on;
  }

  /** The crank's sample that is to be drawn, while the clock is at `k`. */
  crank(k: number): number {
    const sample = this.support.crank(k, this.state?.angles ?? 1);
    this.stage.swing = this.support.swing;
    return sample;
  }

  /** Arrows go to what is chosen, where there are any. */
  choose(point: string): void {
    const { state } = this;
    if (state?.arrows_at && state.arrows_at !== point && state.points.includes(point))
      this.ask({ type: "arrows", point });
  }

  private again(): void {
    if (this.state) this.arrows.show(this.state);
    this.tell();
    this.changed();
  }

  private tell(): void {
    const lines = this.support.lines;
    const text = lines.join("; ");
    if (this.motion.textContent !== text) this.motion.textContent = text;
    show(this.motion, !!text);
    show(this.arrows.legend, !!this.state?.arrows_at);
  }

  private offer(state: State): void {
    const options = state.points.map((name) => v("option", { value: name }, name));
    render(this.at, v("option", { value: "" }, say("no point")), ...options);
    put(this.at, state.arrows_at ?? "");
  }
}
