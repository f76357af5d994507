/**
 * The linkage, drawn in SVG: still parts once, moving parts once a frame; lengths at the link that is
 * chosen.
 */

import { s, set, write } from "./dom";
import { degrees, length, lengths, signed } from "./format";
import type { Circle, Drawable, Pair, Scene, State } from "./protocol";
import { at, build, curve, type Overlay, outside, Piece, quarters, type Swing, swung } from "./signs";
import { ruled, View } from "./view";
import { say } from "./words";

/** Most points of a link between all of which lines are labelled. */
const MOST = 4;
/** Pixels between a line and what is written at it. */
const BESIDE = 12;

class Dimensions {
  readonly layer = s("g", { class: "dims", "aria-hidden": "true" });
  private lines: { from: string; to: string; text: SVGTextElement }[] = [];

  /** Label the lines between points; none where nothing is selected. */
  choose(points: readonly string[]): void {
    const labelled = points.slice(0, MOST);
    this.lines = labelled.flatMap((from, i) =>
      labelled.slice(i + 1).map((to) => ({ from, to, text: s("text", { "text-anchor": "middle" }) })),
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

/** From below to above. */
const LAYERS = ["ground", "signs", "paths", "ghost", "grips", "labels"] as const;
/** Those that the support carries as a whole. */
const SWUNG = ["paths", "ghost", "grips", "labels"] as const;
/** Pixels from a point to the middle of its name. */
const AWAY = 20;
/** Of a letter of a name, and how high one is, pixels: others stand no closer. */
const [WIDE, HIGH] = [9, 12];
/** Half of a handle of a joint, pixels. */
const KNOB = 6;

interface Named {
  name: string;
  element: SVGElement;
}

/** A name, other points of the links that meet there, and whether a foot hangs below. */
interface Label extends Named {
  near: string[];
  footed: boolean;
}

export type Kind = "point" | "mass" | "radius";

/** What can be taken hold of: a joint, a link's centre of mass, or a circle of a part. */
export interface Grip {
  kind: Kind;
  name: string;
}

export class Stage<S extends Drawable = State> {
  readonly svg = s("svg", { class: "linkage", role: "group", "aria-label": say("Linkage"), tabindex: -1 });
  /** Fine lines and scales, apart, so that they are not painted with every frame. */
  readonly lines = s("svg", { class: "sheet-lines", "aria-hidden": "true" });
  /** Over the linkage: below its soil they could not be read. */
  readonly numbers = s("svg", { class: "sheet-lines numbered", "aria-hidden": "true" });
  readonly view = new View();
  private readonly dims = new Dimensions();
  private readonly rim = s("circle", { class: "rim" });
  readonly grips = new Map<string, SVGGElement>();
  /** Called when another part of the plane is shown. */
  readonly watchers: (() => void)[] = [];
  private readonly layer: Record<string, SVGGElement> = {};
  private state: S | null = null;
  /** All is shown, and nobody has moved the sheet since. */
  private fitted = true;
  private k = 0;
  private names = "";
  private signs = "";
  private link: string | null = null;
  private pieces: Piece[] = [];
  private paths: Named[] = [];
  private labels: Label[] = [];
  private readonly overlays: Overlay<S>[] = [];
  /** Places of what lies below the linkage, m, which are in sight where all is. */
  beneath: () => Pair[] = () => [];
  /** How what the support carries moves; null where it is at rest. */
  swing: Swing | null = null;

  constructor(private readonly dress: (grip: Grip, element: SVGGElement) => void) {
    for (const name of LAYERS) {
      const hidden = name !== "grips";
      this.layer[name] = this.svg.appendChild(s("g", { class: name, "aria-hidden": hidden && "true" }));
    }
    this.svg.append(this.dims.layer);
  }

  /** Take a state, before it is posed; `other` is of another machine, another build is drawn from scratch. */
  show(state: S, other: boolean): void {
    const { frame, bodies, movable, mass_centers, circles } = state.scene;
    // While a point is dragged signs may change their order, but what is held must stay the same.
    const names = JSON.stringify([frame, bodies, movable, mass_centers, circles.map(({ name }) => name)]);
    const signs = build(state.scene);
    const built = names !== this.names;
    this.state = state;
    this.k = Math.min(this.k, state.angles - 1);
    for (const overlay of this.overlays) overlay.show(state);
    if (built) this.name(state.scene);
    if (built || signs !== this.signs) this.build(state.scene);
    [this.names, this.signs] = [names, signs];
    if (other) this.fit();
    else if (built) this.redraw();
    else this.draw();
  }

  /** Draw something more, below one of the layers. */
  overlay(overlay: Overlay<S>, below: (typeof LAYERS)[number]): void {
    this.overlays.push(overlay);
    this.svg.insertBefore(overlay.element, this.layer[below] ?? null);
  }

  resize(width: number, height: number): void {
    if (width === this.view.width && height === this.view.height) return;
    const scale = this.view.width ? Math.min(width / this.view.width, height / this.view.height) : 1;
    [this.view.width, this.view.height] = [width, height];
    for (const svg of [this.svg, this.lines, this.numbers]) set(svg, { viewBox: `0 0 ${width} ${height}` });
    if (this.fitted) this.fit();
    else this.zoom(scale);
  }

  fit(): void {
    if (!this.state || !this.view.width) return;
    this.fitted = true;
    let [x0, y0, x1, y1] = this.state.scene.box;
    for (const [x, y] of this.beneath())
      [x0, y0, x1, y1] = [Math.min(x0, x), Math.min(y0, y), Math.max(x1, x), Math.max(y1, y)];
    this.view.fit([x0, y0, x1, y1]);
    this.redraw();
  }

  zoom(factor: number, px?: number, py?: number): void {
    this.fitted = false;
    this.view.zoom(factor, px, py);
    this.redraw();
  }

  pan(dx: number, dy: number): void {
    this.fitted = false;
    this.view.pan(dx, dy);
    this.redraw();
  }

  /** Everything that depends on what of the plane is shown. */
  private redraw(): void {
    if (!this.state) return;
    const { lines, numbers } = ruled(this.view);
    this.lines.replaceChildren(...lines);
    this.numbers.replaceChildren(...numbers);
    for (const watch of this.watchers) watch();
    this.draw();
    this.pose(this.k);
  }

  /** Where what can be taken hold of is at sample k, m. */
  place(grip: Grip, k = this.k): Pair | null {
    if (grip.kind === "radius") return this.across(grip, k);
    const name = grip.kind === "point" ? `place.${grip.name}` : `mass_center.${grip.name}`;
    const row = this.state?.numbers.get(name);
    return row ? [row[2 * k] as number, row[2 * k + 1] as number] : null;
  }

  /** The circle that is taken hold of, if one is, and its centre, m. */
  circle(grip: Grip, k = this.k): [circle: Circle, axis: Pair] | null {
    const circles = grip.kind === "radius" ? this.state?.scene.circles : [];
    const circle = circles?.find(({ name }) => name === grip.name);
    const axis = circle && this.place({ kind: "point", name: circle.axis }, k);
    return circle && axis ? [circle, axis] : null;
  }

  /** On a circle, across from its point, m. */
  private across(grip: Grip, k: number): Pair | null {
    const [circle, axis] = this.circle(grip, k) ?? [];
    const rider = circle && this.place({ kind: "point", name: circle.point }, k);
    if (!axis || !rider) return null;
    const [dx, dy] = [axis[0] - rider[0], axis[1] - rider[1]];
    const share = circle.radius / (Math.hypot(dx, dy) || 1);
    return [axis[0] + share * dx, axis[1] + share * dy];
  }

  /** Every point by its name, m. */
  joints(): [name: string, place: Pair][] {
    const names = this.state?.numbers.names("place.") ?? [];
    const points = names.map((name) => name.slice("place.".length));
    return points.map((name) => [name, this.place({ kind: "point", name }) ?? [NaN, NaN]]);
  }

  /** The first link that has a point. */
  linkOf(point: string): string | null {
    return this.state?.scene.bodies.find((body) => body.points.includes(point))?.name ?? null;
  }

  select(points: ReadonlySet<string>, link: string | null, grip: Grip | null): void {
    this.link = link;
    this.dims.choose(link ? [...points] : []);
    this.dims.pose((name) => this.place({ kind: "point", name }), this.view);
    this.mark();
    for (const { name, element } of this.paths) element.classList.toggle("chosen", points.has(name));
    const key = grip && keyOf(grip);
    for (const [name, element] of this.grips) element.classList.toggle("chosen", name === key);
  }

  /** Draw where something was tried that cannot be there, or nothing. */
  ghost(grip: Grip | null, tried: Pair | null): void {
    const layer = this.layer.ghost as SVGGElement;
    const from = grip && this.place(grip);
    if (!from || !tried) return layer.replaceChildren();
    const [a, b] = [this.view.px(...from), this.view.px(...tried)];
    const line = s("path", { class: "tie", d: `M${at(a)}L${at(b)}` });
    layer.replaceChildren(line, s("circle", { class: "tried", cx: b[0], cy: b[1], r: 9 }));
  }

  /** Move what moves to sample k. */
  pose(k: number): void {
    this.k = k;
    if (!this.state || !this.view.width) return;
    const moved = this.swing && swung(this.swing, this.view, k);
    for (const piece of this.pieces) piece.pose(this.state.numbers, this.view, k, moved);
    for (const overlay of this.overlays) overlay.pose(this.view, k);
    const carried = SWUNG.map((name) => this.layer[name] as SVGGElement);
    for (const layer of [...carried, ...this.overlays.map(({ element }) => element)])
      set(layer, { transform: moved?.transform ?? null });
    const spots = this.spots(k);
    const spot = (name: string): Pair => spots.get(name) ?? [0, 0];
    this.dims.pose((name) => this.place({ kind: "point", name }), this.view);
    this.poseGrips(k, spot);
    this.poseLabels(spot);
  }

  private spots(k: number): Map<string, Pair> {
    const spots = new Map<string, Pair>();
    for (const name of this.state?.numbers.names("place.") ?? []) {
      const row = this.state?.numbers.get(name) as Float32Array;
      spots.set(name.slice(6), this.view.px(row[2 * k] as number, row[2 * k + 1] as number));
    }
    return spots;
  }

  private poseGrips(k: number, spot: (name: string) => Pair): void {
    for (const [key, element] of this.grips) {
      const name = key.slice(key.indexOf(":") + 1);
      if (key.startsWith("point:")) move(element, spot(name));
      else {
        const kind = key.startsWith("radius:") ? "radius" : "mass";
        const place = this.place({ kind, name }, k);
        if (!place) continue;
        const [px, py] = this.view.px(...place);
        move(element, [px, py]);
        const [circle, axis] = this.circle({ kind, name }, k) ?? [];
        if (!circle || !axis) continue;
        const [cx, cy] = this.view.px(...axis);
        set(element.firstElementChild as SVGElement, { cx: cx - px, cy: cy - py, r: circle.radius * this.view.scale });
      }
    }
  }

  /** Names stand outside of the links that meet at the point, or where other names let them. */
  private poseLabels(spot: (name: string) => Pair): void {
    const taken: [...Pair, wide: number][] = [];
    const joints = this.labels.map(({ name }) => spot(name));
    for (const { name, element, near, footed } of this.labels) {
      const [x, y] = spot(name);
      const [dx, dy] = outside([x, y], near.map(spot), footed);
      const ways = [
        [dx, dy],
        [dx, -dy],
        [dy, dx],
        [-dy, -dx],
        [-dx, dy],
      ] as const;
      const places = ways.map(([across, up]): Pair => [x + across * AWAY, y + up * AWAY + 4]);
      const wide = (WIDE * name.length) / 2;
      const apart = ([px, py]: Pair) =>
        taken.every(([ox, oy, other]) => Math.abs(px - ox) > wide + other || Math.abs(py - oy) > HIGH);
      const beside = ([px, py]: Pair) =>
        joints.every(([ox, oy]) => Math.abs(px - ox) > wide + KNOB || Math.abs(py - 4 - oy) > HIGH / 2 + KNOB);
      const free = places.filter(apart);
      const place = free.find(beside) ?? free[0] ?? (places[0] as Pair);
      taken.push([...place, wide]);
      move(element, place);
    }
  }

  /** Everything that does not change while the machine turns. */
  private draw(): void {
    const { view, state } = this;
    if (!state || !view.width) return;
    this.pieces.forEach((piece, i) => {
      const sign = state.scene.signs[i];
      if (sign) piece.draw(sign, view.scale);
    });
    for (const { name, element } of this.paths) {
      const row = state.numbers.get(`place.${name}`);
      if (row) set(element, { d: curve(row, (x, y) => view.px(x, y), !this.state?.open) });
    }
    this.drawRim(state);
  }

  /** The way of the crank's end, by which it is turned. */
  private drawRim({ status, scene }: S): void {
    const points = scene.bodies.find(({ name }) => name === status.drive)?.points ?? [];
    const places = points.map((name) => this.place({ kind: "point", name }) as Pair);
    const pivot = places[points.findIndex((name) => scene.frame.includes(name))];
    if (!pivot || !status.finished) return set(this.rim, { r: 0 });
    const [cx, cy] = this.view.px(...pivot);
    const far = places.map(([x, y]) => Math.hypot(x - pivot[0], y - pivot[1]));
    set(this.rim, { cx, cy, r: Math.max(...far) * this.view.scale });
  }

  private build(scene: Scene): void {
    this.pieces = scene.signs.map((sign) => new Piece(sign, scene));
    const ground = this.pieces.filter((piece) => piece.ground);
    const near = this.pieces.filter((piece) => !piece.ground);
    this.layer.ground?.replaceChildren(...ground.map(({ element }) => element));
    this.layer.signs?.replaceChildren(...near.map(({ element }) => element));
    this.mark();
  }

  /** Show which link is chosen. */
  private mark(): void {
    for (const { link, element } of this.pieces) element.classList.toggle("chosen", !!link && link === this.link);
  }

  /** What has the name of a point or link: paths, names, and what can be taken hold of. */
  private name(scene: Scene): void {
    const root = this.svg.getRootNode() as Document | ShadowRoot;
    const focused = [...this.grips].find(([, element]) => element === root.activeElement)?.[0];
    for (const layer of Object.values(this.layer)) layer.replaceChildren();
    const points = [...new Set(scene.bodies.flatMap((body) => body.points))];
    const moving = points.filter((name) => !scene.frame.includes(name));
    this.paths = moving.map((name) => ({ name, element: s("path", { class: "path" }) }));
    this.layer.paths?.append(...this.paths.map(({ element }) => element), this.rim);
    this.labels = [...new Set([...scene.frame, ...points])].map((name) => labelOf(name, scene));
    this.layer.labels?.append(...this.labels.map(({ element }) => element));
    this.buildGrips(scene);
    // Keys go on where they were; those of what was deleted, on the drawing.
    if (focused) (this.grips.get(focused) ?? this.svg).focus({ preventScroll: true });
  }

  private buildGrips({ movable, mass_centers, circles }: Scene): void {
    this.grips.clear();
    const add = (grip: Grip, ...parts: SVGElement[]) => {
      const halo = [s("circle", { class: "hit", r: 15 }), s("circle", { class: "halo", r: 11 })];
      const element = s("g", { class: `grip ${grip.kind}`, tabindex: 0 }, ...halo, ...parts);
      if (grip.kind === "radius") element.prepend(s("circle", { class: "base" }));
      this.dress(grip, element);
      this.grips.set(keyOf(grip), element);
      this.layer.grips?.append(element);
    };
    // Those that are added later are above: joints are, because they are asked for more often.
    for (const { name } of circles)
      add({ kind: "radius", name }, s("path", { class: "knob", d: "M0-6L6 0L0 6L-6 0z" }));
    for (const name of mass_centers) {
      const signs = [s("circle", { class: "rim", r: 6.5 }), s("path", { class: "quarters", d: quarters(6.5) })];
      add({ kind: "mass", name }, ...signs);
    }
    for (const name of movable) add({ kind: "point", name }, s("circle", { class: "knob", r: 5.5 }));
  }
}

export function keyOf(grip: Grip): string {
  return `${grip.kind}:${grip.name}`;
}

function labelOf(name: string, scene: Scene): Label {
  const met = scene.bodies.filter((body) => body.points.includes(name));
  const near = met.flatMap((body) => body.points).filter((other) => other !== name);
  const element = s("text", { "text-anchor": "middle" }, name);
  return { name, element, near, footed: scene.standing.includes(name) };
}

function move(element: SVGElement, place: Pair): void {
  set(element, { transform: `translate(${at(place)})` });
}
