/** Showing a place on the drawing: by a click, a tap, or a crosshair that arrow keys move. */

import type { Board } from "./board";
import { s, set } from "./dom";
import { length, lengths, round } from "./format";
import type { Pair } from "./protocol";
import type { Stage } from "./stage";
import { ARROWS, ZOOMS } from "./view";
import { say } from "./words";

/** A joint, or an end of a line of the underlay, that is so near is meant, pixels. */
const NEAR = 12;

export interface Spot {
  /** m. */
  at: Pair;
  /** Name of the point that is there, and of the link. */
  point: string | null;
  link: string | null;
}

export class Aim {
  private readonly svg = s("svg", { class: "picking", tabindex: 0, role: "application" });
  private readonly cross = s("path", { class: "cross" });
  private readonly ring = s("circle", { class: "ring", r: 9 });
  private at: Pair = [0, 0];
  /** What was shown before: with Shift, level with it or straight above or below. */
  private from: Pair | null = null;
  private answer: ((spot: Spot | null) => void) | null = null;
  private before: Element | null = null;

  /** `snaps` are places that what is shown near them means, m. */
  constructor(
    private readonly stage: Stage,
    private readonly board: Board,
    private readonly snaps: () => Pair[],
  ) {
    this.svg.append(this.cross, this.ring);
    this.svg.addEventListener("pointermove", (event) => this.move(this.under(event)));
    this.svg.addEventListener("wheel", (event) => {
      event.preventDefault();
      stage.svg.dispatchEvent(new WheelEvent("wheel", event));
    });
    stage.watchers.push(() => this.answer && this.show());
    this.svg.addEventListener("pointerdown", (event) => event.preventDefault());
    this.svg.addEventListener("click", (event) => this.take(this.under(event)));
    this.svg.addEventListener("keydown", (event) => this.key(event));
  }

  /** Ask for a place; null where the question is taken back. */
  ask(prompt: string, from: Pair | null = null): Promise<Spot | null> {
    this.end();
    const { view } = this.stage;
    this.from = from;
    set(this.svg, { "aria-label": prompt });
    this.before = (this.board.root.getRootNode() as Document | ShadowRoot).activeElement;
    this.board.root.append(this.svg);
    this.board.say(prompt, false);
    this.board.root.scrollIntoView({ block: "nearest" });
    this.svg.focus({ preventScroll: true });
    this.move(from ?? view.metres(view.width / 2, view.height / 2));
    return new Promise((done) => (this.answer = done));
  }

  /** Take the question back. */
  end(): void {
    this.finish(null);
  }

  private finish(spot: Spot | null): void {
    const { answer } = this;
    if (!answer) return;
    this.answer = null;
    this.svg.remove();
    this.board.say("", false);
    this.board.hint("");
    // On a narrow screen the drawing is far from where the place was asked for.
    if (this.before instanceof HTMLElement) this.before.focus();
    answer(spot);
  }

  private under(event: MouseEvent): Pair {
    const box = this.svg.getBoundingClientRect();
    const [x, y] = this.stage.view.metres(event.clientX - box.left, event.clientY - box.top);
    if (!event.shiftKey || !this.from) return [x, y];
    const [fx, fy] = this.from;
    return Math.abs(x - fx) > Math.abs(y - fy) ? [x, fy] : [fx, y];
  }

  /** What is meant by a place: a joint, an end of the underlay, or the place itself. */
  private meant(at: Pair): Spot {
    const { view } = this.stage;
    const [px, py] = view.px(...at);
    const away = (place: Pair) => {
      const [x, y] = view.px(...place);
      return Math.hypot(x - px, y - py);
    };
    let [best, least]: [Spot, number] = [{ at, point: null, link: this.linkAt(px, py) }, NEAR];
    for (const [name, place] of this.stage.joints()) {
      const link = this.stage.linkOf(name);
      if (away(place) < least) [best, least] = [{ at: place, point: name, link }, away(place)];
    }
    for (const place of this.snaps())
      if (away(place) < least) [best, least] = [{ at: place, point: null, link: null }, away(place)];
    return best;
  }

  private linkAt(px: number, py: number): string | null {
    const box = this.svg.getBoundingClientRect();
    const root = this.board.root.getRootNode() as Document | ShadowRoot;
    const elements = root.elementsFromPoint(px + box.left, py + box.top);
    const body = elements.map((element) => element.closest<SVGElement>(".body")).find((element) => element);
    return body?.dataset.link ?? null;
  }

  private move(at: Pair): void {
    this.at = at;
    this.show();
  }

  private show(): void {
    const spot = this.meant(this.at);
    const [x, y] = this.stage.view.px(...spot.at);
    const { width, height } = this.stage.view;
    set(this.svg, { viewBox: `0 0 ${width} ${height}` });
    set(this.cross, { d: `M${x.toFixed(1)} 0V${height}M0 ${y.toFixed(1)}H${width}` });
    const on = spot.at !== this.at;
    set(this.ring, { cx: x.toFixed(1), cy: y.toFixed(1), class: on ? "ring on" : "ring" });
    const where = `${length(spot.at[0])}, ${length(spot.at[1])} ${lengths().unit}`;
    this.board.hint(spot.point ? say("{name}: {place}", { name: spot.point, place: where }) : where);
  }

  private take(at: Pair): void {
    this.finish(this.meant(at));
  }

  private key(event: KeyboardEvent): void {
    event.stopPropagation();
    if (event.key === "Escape") return this.finish(null);
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      return this.take(this.at);
    }
    const zoom = ZOOMS[event.key];
    if (zoom) return this.stage.zoom(zoom);
    const way = ARROWS[event.key];
    if (!way) return;
    event.preventDefault();
    const pixels = event.shiftKey ? 60 : event.altKey ? 1 : 8;
    const step = round(pixels / this.stage.view.scale);
    this.move([this.at[0] + way[0] * step, this.at[1] + way[1] * step]);
  }
}
