/** The linkage, drawn in SVG: still parts once, moving parts once a frame. */

import { s, set } from "./dom";
import { LAYERS, NOTHING, type Parts, partsOf } from "./parts";
import type { Pair, State } from "./protocol";
import { at, curve, foot, outline, outside, quarters, reach, zigzag } from "./shapes";
import { ruled } from "./sheet";
import { View } from "./view";

export type Kind = "point" | "mass";

/** What can be taken hold of: a joint, or a link's centre of mass. */
export interface Grip {
  kind: Kind;
  name: string;
}

export class Stage {
  readonly svg = s("svg", { class: "linkage", role: "group", "aria-label": "Linkage" });
  /** Fine lines and scales, apart, so that they are not painted with every frame. */
  readonly lines = s("svg", { class: "sheet-lines", "aria-hidden": "true" });
  readonly view = new View();
  readonly grips = new Map<string, SVGGElement>();
  private readonly layer: Record<string, SVGGElement> = {};
  private state: State | null = null;
  /** All is shown, and nobody has moved the sheet since. */
  private fitted = true;
  private k = 0;
  private shape = "";
  private parts: Parts = NOTHING;

  constructor(private readonly dress: (grip: Grip, element: SVGGElement) => void) {
    for (const name of LAYERS) {
      const hidden = name !== "grips";
      this.layer[name] = this.svg.appendChild(
        s("g", { class: name, "aria-hidden": hidden && "true" }),
      );
    }
  }

  /** Take a state; `other` where it is of another machine. Another build is drawn from scratch. */
  show(state: State, other: boolean): void {
    const { scene } = state;
    // Outlines may change while a point is dragged; what is held must stay the same element.
    const bodies = scene.bodies.map(({ name, points }) => [name, points]);
    const shape = JSON.stringify([
      scene.frame,
      bodies,
      scene.guides,
      scene.springs,
      scene.movable,
      scene.mass_centers,
      scene.wheels.map((w) => [w.link, w.center]),
    ]);
    this.state = state;
    this.k = Math.min(this.k, state.angles - 1);
    const built = shape !== this.shape;
    if (built) this.build(shape);
    this.parts.bodies.forEach((body, i) => (body.corners = scene.bodies[i]?.outline ?? []));
    if (other) this.fit();
    else if (built) this.redraw();
    else {
      this.trace();
      this.pose(this.k);
    }
  }

  resize(width: number, height: number): void {
    if (width === this.view.width && height === this.view.height) return;
    const scale = this.view.width
      ? Math.min(width / this.view.width, height / this.view.height)
      : 1;
    [this.view.width, this.view.height] = [width, height];
    for (const svg of [this.svg, this.lines]) set(svg, { viewBox: `0 0 ${width} ${height}` });
    if (this.fitted) this.fit();
    else this.zoom(scale);
  }

  fit(): void {
    if (!this.state || !this.view.width) return;
    this.fitted = true;
    this.view.fit(this.state.scene.box);
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
    this.lines.replaceChildren(...ruled(this.view));
    this.trace();
    this.pose(this.k);
  }

  /** Where a point or a centre of mass is at sample k, m. */
  place(grip: Grip, k = this.k): Pair | null {
    const name = grip.kind === "point" ? `place.${grip.name}` : `mass_center.${grip.name}`;
    const row = this.state?.numbers.get(name);
    return row ? [row[2 * k] as number, row[2 * k + 1] as number] : null;
  }

  select(points: ReadonlySet<string>, link: string | null, grip: Grip | null): void {
    for (const { name, element } of this.parts.bodies)
      element.classList.toggle("chosen", name === link);
    for (const { name, element } of this.parts.paths)
      element.classList.toggle("chosen", points.has(name));
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
    const spots = this.spots(k);
    const spot = (name: string): Pair => spots.get(name) ?? [0, 0];
    for (const { element, corners } of this.parts.bodies) {
      const d = outline(corners.map(spot));
      for (const path of element.children) path.setAttribute("d", d);
    }
    for (const { name, element } of this.parts.feet) element.setAttribute("d", foot(spot(name)));
    for (const { name, element } of this.parts.dots) move(element, spot(name));
    for (const { element, ends } of this.parts.springs) {
      element.setAttribute("d", zigzag(spot(ends[0]), spot(ends[1])));
    }
    for (const { name, element, from } of this.parts.arms) {
      const place = this.place({ kind: "mass", name }, k);
      if (place) element.setAttribute("d", `M${at(spot(from))}L${at(this.view.px(...place))}`);
    }
    this.poseWheels(k, spot);
    this.poseBlocks(k, spot);
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

  private poseWheels(k: number, spot: (name: string) => Pair): void {
    for (const wheel of this.parts.wheels) {
      const [x, y] = spot(wheel.center);
      const r = wheel.radius * this.view.scale;
      const turned = this.state?.numbers.get(`angle.${wheel.link}`)?.[k] ?? 0;
      set(wheel.circle, { cx: x.toFixed(1), cy: y.toFixed(1), r: r.toFixed(1) });
      const rim: Pair = [x + r * Math.cos(turned), y - r * Math.sin(turned)];
      wheel.spoke.setAttribute("d", `M${at([x, y])}L${at(rim)}`);
    }
  }

  private poseBlocks(k: number, spot: (name: string) => Pair): void {
    for (const { name, point, block, line } of this.parts.blocks) {
      const way = this.state?.numbers.get(`guide.${name}`);
      const [ux, uy] = way ? [way[2 * k] as number, way[2 * k + 1] as number] : [1, 0];
      const [x, y] = spot(point);
      const turn = (Math.atan2(-uy, ux) * 180) / Math.PI;
      block.setAttribute("transform", `translate(${at([x, y])}) rotate(${turn.toFixed(2)})`);
      const places = this.state?.numbers.get(`place.${point}`);
      const [back, on] = reach(way, places, k, 26 / this.view.scale);
      const end = (t: number): Pair => [x + ux * t * this.view.scale, y - uy * t * this.view.scale];
      line.setAttribute("d", `M${at(end(back))}L${at(end(on))}`);
    }
  }

  private poseGrips(k: number, spot: (name: string) => Pair): void {
    for (const [key, element] of this.grips) {
      const name = key.slice(key.indexOf(":") + 1);
      if (key.startsWith("point:")) move(element, spot(name));
      else {
        const place = this.place({ kind: "mass", name }, k);
        if (place) move(element, this.view.px(...place));
      }
    }
  }

  /** Names stand outside of the links that meet at the point. */
  private poseLabels(spot: (name: string) => Pair): void {
    for (const { name, element, near } of this.parts.labels) {
      const [x, y] = spot(name);
      const footed = this.parts.feet.some((part) => part.name === name);
      const [dx, dy] = outside([x, y], near.map(spot), footed);
      const away = 20;
      move(element, [x + dx * away, y + dy * away + 4]);
    }
  }

  private trace(): void {
    const { view, state } = this;
    if (!state || !view.width) return;
    for (const { name, element } of this.parts.paths) {
      const row = state.numbers.get(`place.${name}`);
      if (row) set(element, { d: curve(row, (x, y) => view.px(x, y), true) });
    }
  }

  private build(shape: string): void {
    this.shape = shape;
    const { scene } = this.state as State;
    for (const layer of Object.values(this.layer)) layer.replaceChildren();
    this.parts = partsOf(scene, (layer, element) => this.layer[layer]?.append(element));
    this.buildGrips(scene.movable, scene.mass_centers);
  }

  private buildGrips(movable: string[], masses: string[]): void {
    this.grips.clear();
    const add = (grip: Grip, ...parts: SVGElement[]) => {
      const halo = [s("circle", { class: "hit", r: 15 }), s("circle", { class: "halo", r: 11 })];
      const element = s("g", { class: `grip ${grip.kind}`, tabindex: 0 }, ...halo, ...parts);
      this.dress(grip, element);
      this.grips.set(keyOf(grip), element);
      this.layer.grips?.append(element);
    };
    // Those that are added later are above: joints are, because they are asked for more often.
    for (const name of masses) {
      const signs = [
        s("circle", { class: "rim", r: 6.5 }),
        s("path", { class: "quarters", d: quarters(6.5) }),
      ];
      add({ kind: "mass", name }, ...signs);
    }
    for (const name of movable)
      add({ kind: "point", name }, s("circle", { class: "knob", r: 5.5 }));
  }
}

export function keyOf(grip: Grip): string {
  return `${grip.kind}:${grip.name}`;
}

function move(element: SVGElement, place: Pair): void {
  element.setAttribute("transform", `translate(${at(place)})`);
}
