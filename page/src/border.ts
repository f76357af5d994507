/** The border between the drawing and the charts: dragged, moved by keys, and remembered. */

import { h, set } from "./dom";
import { say } from "./words";

const KEPT = "equipoise-border";
/** Per cent of the room that the drawing has at least and at most, and by how much a key moves it. */
const [LEAST, MOST, STEP] = [25, 80, 5];
/** Per cent from which on charts that are pushed out on one side come in on the other. */
const OUT = 90;

type Side = "beside" | "below";

export class Border {
  readonly root = h("div", {
    class: "border",
    role: "separator",
    tabindex: 0,
    "aria-label": say("Border between drawing and charts"),
    "aria-valuemin": LEAST,
    "aria-valuemax": MOST,
    title: say(
      "Drag it to give the drawing more room or less; drag it to the edge, or press Enter, to have the charts below the drawing or beside it",
    ),
  });
  private share: number | null = null;
  private side: Side = "beside";

  /** body : whose parts it divides. moved : called when they have another size. */
  constructor(
    private readonly body: HTMLElement,
    private readonly moved: () => void,
  ) {
    [this.share, this.side] = remembered();
    this.root.addEventListener("pointerdown", this.press);
    this.root.addEventListener("keydown", this.key);
    this.root.addEventListener("dblclick", () => this.put(null, this.side));
    this.show();
  }

  private put(share: number | null, side: Side): void {
    this.share = share === null ? null : Math.min(MOST, Math.max(LEAST, share));
    this.side = side;
    this.show();
    remember(this.share, side);
    this.moved();
  }

  private show(): void {
    set(this.body, { "data-charts": this.side });
    if (this.share === null) this.body.style.removeProperty("--share");
    else this.body.style.setProperty("--share", String(this.share / 100));
    set(this.root, {
      "aria-orientation": this.side === "beside" ? "vertical" : "horizontal",
      "aria-valuenow": Math.round(this.share ?? 56),
    });
  }

  /** Where a pointer is, in per cent of what drawing and charts have together. */
  private at(event: PointerEvent): number {
    const stage = this.root.previousElementSibling as HTMLElement;
    const charts = this.root.nextElementSibling as HTMLElement;
    const [first, last] = [stage.getBoundingClientRect(), charts.getBoundingClientRect()];
    return this.side === "beside"
      ? ((event.clientX - first.left) / (last.right - first.left)) * 100
      : ((event.clientY - first.top) / (last.bottom - first.top)) * 100;
  }

  private readonly press = (event: PointerEvent): void => {
    if (event.button) return;
    event.preventDefault();
    this.root.focus({ preventScroll: true });
    this.root.setPointerCapture(event.pointerId);
    const drag = (now: PointerEvent) => {
      const share = this.at(now);
      if (share <= OUT) return this.put(share, this.side);
      this.put(null, this.side === "beside" ? "below" : "beside");
      stop();
    };
    const stop = () => {
      this.root.removeEventListener("pointermove", drag);
      for (const name of ["pointerup", "pointercancel"] as const) this.root.removeEventListener(name, stop);
    };
    this.root.addEventListener("pointermove", drag);
    for (const name of ["pointerup", "pointercancel"] as const) this.root.addEventListener(name, stop);
  };

  private readonly key = (event: KeyboardEvent): void => {
    const way = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1 }[event.key];
    if (way) this.put((this.share ?? 56) + way * STEP, this.side);
    else if (event.key === "Enter") this.put(null, this.side === "beside" ? "below" : "beside");
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
}

function remembered(): [number | null, Side] {
  try {
    const [side, share] = (localStorage.getItem(KEPT) ?? "").split(" ");
    const value = Number(share);
    const known = value >= LEAST && value <= MOST ? value : null;
    return [known, side === "below" ? "below" : "beside"];
  } catch {
    return [null, "beside"]; // nothing may be kept here
  }
}

function remember(share: number | null, side: Side): void {
  try {
    localStorage.setItem(KEPT, share === null ? side : `${side} ${share.toFixed(1)}`);
  } catch {
    // then it holds until the page is closed
  }
}
