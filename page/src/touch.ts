/** Two fingers on the drawing: pinching zooms, moving both pans. */

import type { Pair } from "./protocol";
import type { Stage } from "./stage";

export class Touch {
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

function apart(one: Pair, other: Pair): number {
  return Math.hypot(one[0] - other[0], one[1] - other[1]);
}
