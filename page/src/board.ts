/**
 * The sheet that the linkage is drawn on: moving it, zooming, also by two fingers, and what is said on
 * it.
 */

import { withCure } from "./cure";
import { h, icon, write } from "./dom";
import type { Pair } from "./protocol";
import type { Stage } from "./stage";
import { say } from "./words";

class Touch {
  private readonly fingers = new Map<number, Pair>();

  constructor(private readonly stage: Stage) {
    const { svg } = stage;
    svg.addEventListener("pointerdown", (event) => this.down(event), true);
    svg.addEventListener("pointermove", (event) => this.move(event), true);
    for (const name of ["pointerup", "pointercancel"] as const)
      svg.addEventListener(name, (event) => this.fingers.delete(event.pointerId), true);
    // Two fingers never scroll or zoom the page; one does where there is something to scroll.
    const two = (event: TouchEvent) => event.touches.length > 1 && event.preventDefault();
    svg.addEventListener("touchstart", two, { passive: false });
    svg.addEventListener("touchmove", two, { passive: false });
  }

  /** Whether more than one finger is down, so that none of them drags. */
  get pinching(): boolean {
    return this.fingers.size > 1;
  }

  private down(event: PointerEvent): void {
    if (event.pointerType !== "touch") return;
    // What was touched before and did not end here, such as a finger that left the window.
    if (event.isPrimary) this.fingers.clear();
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  private move(event: PointerEvent): void {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const now: Pair = [event.clientX, event.clientY];
    this.fingers.set(event.pointerId, now);
    if (this.fingers.size !== 2) return;
    event.stopPropagation();
    const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
    if (!other) return;
    const [was, is] = [apart(before, other), apart(now, other)];
    const box = this.stage.svg.getBoundingClientRect();
    const middle = [(now[0] + other[0]) / 2 - box.left, (now[1] + other[1]) / 2 - box.top] as const;
    this.stage.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
    if (was > 10 && is > 10) this.stage.zoom(is / was, ...middle);
  }
}

function apart(first: Pair, second: Pair): number {
  return Math.hypot(first[0] - second[0], first[1] - second[1]);
}

/** How long a sentence about a mistake stays at least, once nothing is held any more, ms. */
const READING = 4000;

export class Board {
  readonly root: HTMLElement;
  private since = 0;
  private later = 0;
  private readonly touch: Touch;
  /** It lies on the drawing, and goes when it is clicked. */
  private readonly spoken = h("p", {
    class: "said",
    role: "status",
    "aria-live": "polite",
    onclick: () => this.say("", false),
  });
  private readonly hinted = h("p", { class: "hint", "aria-hidden": "true" });

  constructor(
    private readonly stage: Stage,
    private readonly chosen: (link: string) => void,
  ) {
    const button = (path: string, name: string, onclick: () => void) =>
      h("button", { type: "button", "aria-label": name, title: name, onclick }, icon(path));
    const zooms = h(
      "div",
      { class: "zooms" },
      button("M8 3v10M3 8h10", say("Zoom in"), () => stage.zoom(1.25)),
      button("M3 8h10", say("Zoom out"), () => stage.zoom(0.8)),
      button("M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10", say("Show all"), () => stage.fit()),
    );
    this.root = h("div", { class: "board" }, stage.lines, stage.svg, stage.numbers, this.hinted, zooms, this.spoken);
    this.touch = new Touch(stage);
    stage.svg.addEventListener("pointerdown", this.press);
    stage.svg.addEventListener("wheel", this.wheel, { passive: false });
  }

  /** Something worked: take the last sentence away, but let one about a mistake be read first. */
  clear(now: boolean): void {
    const left = this.since + READING - performance.now();
    if (now || left <= 0 || !this.spoken.classList.contains("bad")) this.say("", false);
    else if (!this.later) this.later = window.setTimeout(() => this.say("", false), left);
  }

  /** A sentence about what was asked; `bad` where it cannot be. */
  say(text: string, bad: boolean, cure: HTMLElement | null = null): void {
    this.since = performance.now();
    clearTimeout(this.later);
    this.later = 0;
    write(this.spoken, text);
    withCure(this.spoken, cure);
    this.spoken.classList.toggle("bad", bad && text !== "");
  }

  /** Where something is that is touched or held. */
  hint(text: string): void {
    write(this.hinted, text);
  }

  private readonly press = (event: PointerEvent): void => {
    if (event.button || (event.target as Element).closest(".grip")) return;
    const link = (event.target as Element).closest<SVGElement>(".body")?.dataset.link;
    const { svg } = this.stage;
    let [x, y] = [event.clientX, event.clientY];
    let far = false;
    const drag = (now: PointerEvent) => {
      if (now.pointerId !== event.pointerId || this.touch.pinching) return;
      if (!far && Math.hypot(now.clientX - x, now.clientY - y) < 4) return;
      if (!far) svg.setPointerCapture(event.pointerId);
      far = true;
      this.stage.pan(now.clientX - x, now.clientY - y);
      [x, y] = [now.clientX, now.clientY];
    };
    const stop = () => {
      svg.removeEventListener("pointermove", drag);
      for (const name of ["pointerup", "pointercancel"] as const) svg.removeEventListener(name, stop);
      if (!far && link) this.chosen(link);
    };
    svg.addEventListener("pointermove", drag);
    for (const name of ["pointerup", "pointercancel"] as const) svg.addEventListener(name, stop);
  };

  /** The wheel scrolls where there is something to scroll, else it zooms. */
  private readonly wheel = (event: WheelEvent): void => {
    const still = this.root.closest(".equipoise-page") && getComputedStyle(this.root).touchAction === "none";
    if (!still && !event.ctrlKey) return;
    event.preventDefault();
    const box = this.stage.svg.getBoundingClientRect();
    const factor = Math.exp(-Math.max(-200, Math.min(200, event.deltaY)) / 500);
    this.stage.zoom(factor, event.clientX - box.left, event.clientY - box.top);
  };
}
