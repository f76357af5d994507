/** Taking hold of joints, centres of mass and the crank: by mouse, by touch, by keys. */

import { set } from "./dom";
import { length, lengths, round } from "./format";
import { type Attempts, Gesture } from "./gesture";
import type { Drawable, Edit, Pair, State } from "./protocol";
import { type Grip, type Kind, keyOf, type Stage } from "./stage";
import { ARROWS } from "./view";
import { say, toSay } from "./words";

const ROLES: Record<Kind, string> = {
  point: toSay("joint that can be moved"),
  mass: toSay("centre of mass that can be moved"),
  radius: toSay("base circle that can be changed"),
};
const NAMES: Record<Kind, string> = {
  point: toSay("Joint {name}"),
  mass: toSay("Centre of mass of {name}"),
  radius: toSay("Base circle of {name}"),
};
const STEPS: Record<Kind, string> = {
  point: toSay("move {name}"),
  mass: toSay("move centre of mass of {name}"),
  radius: toSay("change base circle of {name}"),
};
const COARSE = 10;
const FINE = 0.1;
/** A held key pauses no longer than this between two of its events, ms. */
const PAUSE = 600;

interface Held<S extends Drawable = State> {
  talk: Attempts;
  state(): S | null;
  sample(): number;
  chosen(grip: Grip): void;
  /** Something is held now, or nothing any more. */
  holding(on: boolean): void;
  hint(text: string): void;
  /** Points from which a point is to keep its distance. */
  kept(point: string): string[];
}

export class Hands<S extends Drawable = State> {
  private readonly stage: Stage<S>;
  private gesture: Gesture | null = null;
  private grip: Grip | null = null;
  private target: Pair | null = null;
  private keys = false;
  /** The handle that the line below the drawing describes, and a remark. */
  private hinted: [Grip, string] | null = null;

  constructor(
    private readonly page: Held<S>,
    stage: (dress: (grip: Grip, element: SVGGElement) => void) => Stage<S>,
  ) {
    this.stage = stage((grip, element) => this.dress(grip, element));
  }

  get made(): Stage<S> {
    return this.stage;
  }

  /** The server could not do it: show where it was tried, and go on from the last good place. */
  refused(): void {
    if (!this.gesture || !this.grip) return;
    this.stage.ghost(this.grip, this.target);
    if (this.keys) this.target = this.stage.place(this.grip);
  }

  /** What was tried stands: nothing is left to show of what could not. */
  accepted(): void {
    this.stage.ghost(null, null);
  }

  /** Say anew where what is held is, or what was spoken of last. */
  follow(): void {
    if (this.gesture && this.grip) this.tell(this.grip, "");
    else if (this.hinted) this.tell(...this.hinted);
  }

  /** Say anew where everything is: names of handles for those who hear them. */
  describe(): void {
    for (const element of this.stage.grips.values()) {
      const grip = gripOf(element);
      const place = this.stage.place(grip);
      if (!place) continue;
      const [circle] = this.stage.circle(grip) ?? [];
      const { unit, factor } = lengths();
      set(element, {
        "aria-valuetext": circle
          ? `${length(circle.radius)} ${unit}`
          : `x ${length(place[0])} ${unit}, y ${length(place[1])} ${unit}`,
        "aria-valuenow": ((circle?.radius ?? place[0]) * factor).toFixed(2),
      });
    }
  }

  private dress(grip: Grip, element: SVGGElement): void {
    const label = nameOf(grip);
    set(element, {
      role: "slider",
      "aria-label": label,
      "aria-roledescription": say(ROLES[grip.kind]),
      "data-kind": grip.kind,
      "data-name": grip.name,
    });
    element.addEventListener("pointerdown", (event) => this.press(event, grip, element));
    // Browsers do not heed `touch-action` on every part of a drawing: a finger on a joint must not scroll.
    element.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
    element.addEventListener("keydown", (event) => this.key(event, grip));
    element.addEventListener("focus", () => this.focus(grip));
    element.addEventListener("blur", () => this.blur());
    element.addEventListener("pointerenter", () => !this.gesture && this.tell(grip, ""));
    element.addEventListener("pointerleave", () => !this.gesture && this.hush());
  }

  private focus(grip: Grip): void {
    this.page.chosen(grip);
    const step = `${length(this.step())} ${lengths().unit}`;
    const values = { step, coarse: COARSE, fine: 1 / FINE };
    this.tell(grip, say("arrow keys {step}, Shift × {coarse}, Alt ÷ {fine}", values));
  }

  private blur(): void {
    if (this.keys) this.gesture?.end();
    this.hush();
  }

  private hush(): void {
    this.hinted = null;
    this.page.hint("");
  }

  private tell(grip: Grip, more: string): void {
    const place = this.stage.place(grip);
    if (!place) return;
    const [circle] = this.stage.circle(grip) ?? [];
    const measure = circle ? length(circle.radius) : `${length(place[0])}, ${length(place[1])}`;
    const where = `${nameOf(grip)}: ${measure} ${lengths().unit}`;
    this.hinted = [grip, more];
    this.page.hint(more ? `${where} · ${more}` : where);
  }

  private begin(grip: Grip, keys: boolean): void {
    if (this.gesture && this.grip && keyOf(this.grip) === keyOf(grip) && this.keys === keys) return;
    this.page.talk.release();
    [this.grip, this.keys] = [grip, keys];
    this.target = this.stage.place(grip);
    this.page.holding(true);
    const what = say(STEPS[grip.kind], { name: grip.name });
    const gesture: Gesture = new Gesture(this.page.talk, what, () => {
      if (this.gesture !== gesture) return;
      this.gesture = this.grip = null;
      this.stage.ghost(null, null);
      this.page.holding(false);
    });
    this.gesture = gesture;
  }

  private move(to: Pair, stamp: number): void {
    const { grip, gesture } = this;
    if (!grip || !gesture) return;
    this.target = to;
    const edit = this.edit(grip, to);
    if (edit) gesture.move([edit], stamp);
  }

  private edit(grip: Grip, to: Pair): Edit | null {
    const at = this.page.sample();
    if (grip.kind === "point") return { move: grip.name, to, at, keep: this.page.kept(grip.name) };
    if (grip.kind === "mass") return { move_mass: grip.name, to, at };
    const [circle, axis] = this.stage.circle(grip) ?? [];
    return circle && axis ? { set: circle.path, value: Math.hypot(to[0] - axis[0], to[1] - axis[1]) } : null;
  }

  private press(event: PointerEvent, grip: Grip, element: SVGGElement): void {
    if (event.button) return;
    event.preventDefault();
    event.stopPropagation();
    element.focus({ preventScroll: true });
    element.setPointerCapture(event.pointerId);
    const start = this.stage.place(grip);
    if (!start) return;
    const [px, py] = this.stage.view.px(...start);
    const [offX, offY] = [px - event.clientX, py - event.clientY];
    let moved = false;
    const drag = (now: PointerEvent) => {
      if (now.pointerId !== event.pointerId) return;
      if (!moved && Math.hypot(now.clientX - event.clientX, now.clientY - event.clientY) < 2) return;
      if (!moved) this.begin(grip, false);
      moved = true;
      const to = this.stage.view.metres(now.clientX + offX, now.clientY + offY);
      this.move(now.shiftKey ? straight(start, to) : to, now.timeStamp);
    };
    const stop = (now: PointerEvent) => {
      if (now.pointerId !== event.pointerId) return;
      element.removeEventListener("pointermove", drag);
      for (const name of ["pointerup", "pointercancel"] as const) element.removeEventListener(name, stop);
      if (moved) this.gesture?.end();
    };
    element.addEventListener("pointermove", drag);
    for (const name of ["pointerup", "pointercancel"] as const) element.addEventListener(name, stop);
  }

  private key(event: KeyboardEvent, grip: Grip): void {
    if (event.key === "Escape" || event.key === "Enter") return this.gesture?.end();
    const way = ARROWS[event.key];
    if (!way || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.begin(grip, true);
    const place = this.target ?? this.stage.place(grip);
    if (!place) return;
    const step = this.step() * (event.shiftKey ? COARSE : event.altKey ? FINE : 1);
    const [, axis] = this.stage.circle(grip) ?? [];
    const [dx, dy] = axis ? outward(axis, place, way) : way;
    this.move([place[0] + dx * step, place[1] + dy * step], event.timeStamp);
    this.gesture?.endSoon(PAUSE);
  }

  /** A round length, about a 300th of the machine. */
  private step(): number {
    const box = this.page.state()?.scene.box ?? [0, 0, 1, 1];
    return round(Math.max(box[2] - box[0], box[3] - box[1]) / 300);
  }
}

/** Away from an axis by keys to the right and up, towards it by the others. */
function outward(axis: Pair, place: Pair, way: Pair): Pair {
  const [dx, dy] = [place[0] - axis[0], place[1] - axis[1]];
  const share = (way[0] + way[1]) / (Math.hypot(dx, dy) || 1);
  return [share * dx, share * dy];
}

/** In the row or the column of where it was, whichever is nearer. */
function straight([x, y]: Pair, [toX, toY]: Pair): Pair {
  return Math.abs(toX - x) > Math.abs(toY - y) ? [toX, y] : [x, toY];
}

export function nameOf(grip: Grip): string {
  return say(NAMES[grip.kind], { name: grip.name });
}

function gripOf(element: SVGElement): Grip {
  const { kind, name } = element.dataset;
  return { kind: kind as Grip["kind"], name: name as string };
}

/** Pixels from which on a press is a drag. */
const FAR = 3;

export interface Turning<S extends Drawable = State> {
  stage: Stage<S>;
  state(): S | null;
  angle(): number;
  /** Put the crank at an angle, degrees. */
  turn(degrees: number): void;
  chosen(link: string): void;
}

/** Let the crank of a stage be turned by mouse and finger. */
export function turnable<S extends Drawable>(page: Turning<S>): void {
  const { svg } = page.stage;
  const driven = (event: Event): string | null => {
    const target = event.target as Element;
    if (target.closest(".rim")) return page.state()?.status.drive ?? null;
    const link = target.closest(".grip") ? undefined : target.closest<SVGElement>(".body")?.dataset.link;
    const status = page.state()?.status;
    return link && status?.finished && link === status.drive ? link : null;
  };
  svg.addEventListener(
    "pointerdown",
    (event) => {
      const link = driven(event);
      if (event.button || !link) return;
      event.preventDefault();
      event.stopPropagation();
      follow(page, event, link);
    },
    true,
  );
  svg.addEventListener("touchstart", (event) => driven(event) && event.preventDefault(), {
    passive: false,
  });
}

function follow<S extends Drawable>(page: Turning<S>, event: PointerEvent, link: string): void {
  const { stage } = page;
  const { frame = [], bodies = [] } = page.state()?.scene ?? {};
  const points = bodies.find(({ name }) => name === link)?.points ?? [];
  const pivot = points.find((name) => frame.includes(name));
  const center = pivot === undefined ? null : stage.place({ kind: "point", name: pivot });
  if (!center) return;
  const box = stage.svg.getBoundingClientRect();
  const [x, y] = stage.view.px(...center);
  const way = (now: PointerEvent) => Math.atan2(box.top + y - now.clientY, now.clientX - box.left - x);
  let [last, angle, moved] = [way(event), page.angle(), false];
  const drag = (now: PointerEvent) => {
    if (now.pointerId !== event.pointerId) return;
    moved ||= Math.hypot(now.clientX - event.clientX, now.clientY - event.clientY) > FAR;
    if (!moved) return;
    const next = way(now);
    const by = ((((next - last) * 180) / Math.PI + 540) % 360) - 180;
    [last, angle] = [next, angle + by];
    page.turn(angle);
  };
  const stop = (now: PointerEvent) => {
    if (now.pointerId !== event.pointerId) return;
    stage.svg.removeEventListener("pointermove", drag);
    for (const name of ["pointerup", "pointercancel"] as const) stage.svg.removeEventListener(name, stop);
    if (!moved) page.chosen(link);
  };
  stage.svg.setPointerCapture(event.pointerId);
  stage.svg.addEventListener("pointermove", drag);
  for (const name of ["pointerup", "pointercancel"] as const) stage.svg.addEventListener(name, stop);
}
