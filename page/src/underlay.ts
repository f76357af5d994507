/** A picture or drawing below the linkage, to trace over; it is of the page, not of the model. */

import { s, set } from "./dom";
import { type Drawing, drawingOf } from "./dxf";
import type { Pair } from "./protocol";
import type { Stage } from "./stage";
import { say } from "./words";

/** Bytes of a file that is read, and signs of what outlives a reload. */
const LARGEST = 20e6;
const KEPT = 2e6;
const KEY = "equipoise underlay";
const PICTURES = /^image\/(png|jpeg|webp|svg\+xml|gif)$/;
const NAMES = /\.(png|jpe?g|webp|svg|gif)$/i;
const DXF = /\.dxf$/i;
/** Share of the sheet's width that a picture takes at first. */
const WIDE = 0.8;

/** Where it lies: m of the frame at its origin, turned by an angle (rad), m in one of its units. */
interface Pose {
  at: Pair;
  turn: number;
  scale: number;
}

export interface Shown extends Pose {
  name: string;
  /** A picture as a data address, with its width and height in pixels, its origin in the middle. */
  picture?: { href: string; size: Pair };
  /** A drawing in m. */
  drawing?: Drawing;
  opacity: number;
  hidden: boolean;
}

/** Whether a file can lie below the linkage. */
export function traceable(file: File): boolean {
  return PICTURES.test(file.type) || NAMES.test(file.name) || DXF.test(file.name);
}

export class Underlay {
  readonly svg = s("svg", { class: "underlay", "aria-hidden": "true" });
  private readonly group = s("g");
  private held: Shown | null = null;

  /** `changed` hears of it when it is another, or lies elsewhere. */
  constructor(
    private readonly stage: Stage,
    private readonly changed: () => void,
  ) {
    this.svg.append(this.group);
    stage.watchers.push(() => this.place());
    stage.beneath = () => this.places();
    stage.svg.before(this.svg);
  }

  get shown(): Shown | null {
    return this.held;
  }

  /** Places that a point may snap to, m. */
  snaps(): Pair[] {
    const { held } = this;
    if (!held?.drawing || held.hidden) return [];
    return held.drawing.snaps.map((point) => toFrame(held, point));
  }

  /** Places that it reaches, m. */
  private places(): Pair[] {
    const { held } = this;
    if (!held || held.hidden) return [];
    const [x, y] = (held.picture?.size ?? [0, 0]).map((size) => size / 2) as Pair;
    const corners: Pair[] = [
      [-x, -y],
      [x, -y],
      [x, y],
      [-x, y],
    ];
    return (held.drawing?.lines.flat() ?? corners).map((point) => toFrame(held, point));
  }

  /** Read a file; returns what there is to say of it. Throws an `Error` of one sentence. */
  async take(file: File): Promise<string> {
    if (file.size > LARGEST) {
      const values = { name: file.name, size: (file.size / 1e6).toFixed(1), most: LARGEST / 1e6 };
      throw new Error(say("{name} has {size} MB; at most {most} MB are drawn below the linkage.", values));
    }
    const common = { name: file.name, opacity: 0.5, hidden: false, turn: 0 };
    if (DXF.test(file.name)) {
      const drawing = drawingOf(await file.text(), file.name);
      this.show({ ...common, drawing, at: [0, 0], scale: 1 });
      this.stage.fit(); // it is as large as it is
    } else {
      const href = await dataOf(file);
      const size = await sizeOf(href, file.name);
      const { view } = this.stage;
      const scale = (WIDE * view.width) / view.scale / size[0];
      const at = view.metres(view.width / 2, view.height / 2);
      this.show({ ...common, picture: { href, size }, at, scale });
    }
    const said = this.held?.drawing?.hasUnit === false ? say("The file tells no unit: it is read in mm.") : "";
    return [said, this.keep()].filter((text) => text).join(" ");
  }

  change(changes: Partial<Shown>): void {
    if (!this.held) return;
    this.show({ ...this.held, ...changes });
    this.keep();
  }

  /** So that what is at one place comes to another, m. */
  move(from: Pair, to: Pair): void {
    const at = this.held?.at;
    if (at) this.change({ at: [at[0] + to[0] - from[0], at[1] + to[1] - from[1]] });
  }

  /** So that two places are so far apart, m; the first one stays. */
  stretch(from: Pair, to: Pair, distance: number): void {
    const now = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (!this.held || !(now > 0) || !(distance > 0)) return;
    const factor = distance / now;
    const { at, scale } = this.held;
    const next: Pair = [from[0] + (at[0] - from[0]) * factor, from[1] + (at[1] - from[1]) * factor];
    this.change({ at: next, scale: scale * factor });
  }

  /** Turned about its origin to an angle, rad. */
  turn(turn: number): void {
    this.change({ turn });
  }

  remove(): void {
    this.show(null);
    try {
      sessionStorage.removeItem(KEY);
    } catch {
      // nothing was kept
    }
  }

  /** Show what was there before the page was loaded again. */
  recall(): void {
    try {
      const kept = sessionStorage.getItem(KEY);
      if (kept) this.show(JSON.parse(kept) as Shown);
    } catch {
      // nothing was kept
    }
  }

  /** Keep it over a reload where the browser can; else returns that it will not be there. */
  private keep(): string {
    const text = JSON.stringify(this.held);
    try {
      if (text.length > KEPT) throw new Error();
      sessionStorage.setItem(KEY, text);
      return "";
    } catch {
      try {
        sessionStorage.removeItem(KEY);
      } catch {
        // nothing is kept at all
      }
      return say("It is too large to be kept when the page is loaded again.");
    }
  }

  private show(shown: Shown | null): void {
    const other = shown?.picture !== this.held?.picture || shown?.drawing !== this.held?.drawing;
    this.held = shown;
    if (other) this.draw();
    this.place();
    this.changed();
  }

  private draw(): void {
    const { picture, drawing } = this.held ?? {};
    this.group.replaceChildren();
    if (picture) {
      const [width, height] = picture.size;
      const corner = { x: -width / 2, y: -height / 2 };
      this.group.append(s("image", { href: picture.href, ...corner, width, height }));
    } else if (drawing) {
      const d = drawing.lines.map((line) => `M${line.map(([x, y]) => `${x} ${y}`).join("L")}`).join("");
      this.group.append(s("path", { d, "vector-effect": "non-scaling-stroke" }));
    }
  }

  private place(): void {
    const { view } = this.stage;
    set(this.svg, { viewBox: `0 0 ${view.width} ${view.height}` });
    if (!this.held) return;
    const { at, turn, scale, picture, opacity, hidden } = this.held;
    const [x, y] = view.px(...at);
    const [c, n] = [Math.cos(turn), Math.sin(turn)].map((part) => part * scale * view.scale) as Pair;
    // In pictures y goes down, as on the screen; in drawings up.
    const down = picture ? -1 : 1;
    const matrix = [c, -n, -n * down, -c * down, x, y].map((value) => Number(value.toPrecision(9)));
    set(this.group, { transform: `matrix(${matrix.join(" ")})`, opacity, visibility: hidden ? "hidden" : "visible" });
  }
}

function toFrame({ at, turn, scale }: Pose, [x, y]: Pair): Pair {
  const [c, n] = [Math.cos(turn) * scale, Math.sin(turn) * scale];
  return [at[0] + x * c - y * n, at[1] + x * n + y * c];
}

function dataOf(file: File): Promise<string> {
  return new Promise((done, failed) => {
    const reader = new FileReader();
    reader.onload = () => done(String(reader.result));
    reader.onerror = () => failed(new Error(noPicture(file.name)));
    reader.readAsDataURL(file);
  });
}

function sizeOf(href: string, name: string): Promise<Pair> {
  return new Promise((done, failed) => {
    const image = new Image();
    image.onload = () => done([image.naturalWidth || 1000, image.naturalHeight || 1000]);
    image.onerror = () => failed(new Error(noPicture(name)));
    image.src = href;
  });
}

function noPicture(name: string): string {
  return say("{name} is no picture that the browser can show; give PNG, JPEG, WebP, SVG or DXF.", { name });
}
