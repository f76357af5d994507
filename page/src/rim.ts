/** The crank, turned by hand: its body is its rim, and only its handle changes its length. */

import type { Drawable, State } from "./protocol";
import type { Stage } from "./stage";

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
  const held = (event: Event): string | null => {
    const target = event.target as Element;
    if (target.closest(".rim")) return page.state()?.status.drive ?? null;
    const link = target.closest(".grip") ? undefined : target.closest<SVGElement>(".body")?.dataset.link;
    const status = page.state()?.status;
    return link && status?.finished && link === status.drive ? link : null;
  };
  svg.addEventListener(
    "pointerdown",
    (event) => {
      const link = held(event);
      if (event.button || !link) return;
      event.preventDefault();
      event.stopPropagation();
      follow(page, event, link);
    },
    true,
  );
  svg.addEventListener("touchstart", (event) => held(event) && event.preventDefault(), {
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
    for (const name of ["pointerup", "pointercancel"] as const)
      stage.svg.removeEventListener(name, stop);
    if (!moved) page.chosen(link);
  };
  stage.svg.setPointerCapture(event.pointerId);
  stage.svg.addEventListener("pointermove", drag);
  for (const name of ["pointerup", "pointercancel"] as const) stage.svg.addEventListener(name, stop);
}
