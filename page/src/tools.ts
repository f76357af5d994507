/** Making a machine: what a click, a drag or a key on the drawing does with the tool in hand. */

import type { Conversation } from "./conversation";
import { s, set } from "./dom";
import { degrees, length, lengths, signed } from "./format";
import { type Turning, turnable } from "./hands";
import { Palette, partTool, tools } from "./palette";
import type { Made, Pair, State } from "./protocol";
import { type Hit, meant, type Snapping, step } from "./snap";
import type { Grip } from "./stage";
import { ARROWS } from "./view";
import { say } from "./words";

/** Pixels from which on a press is a drag from one place to another. */
const FAR = 10;

/** Tools that need two clicks. */
const TWO = new Set(["link", "pin", "slider"]);

interface Making extends Turning, Snapping {
  talk: Conversation;
  board: HTMLElement;
  sample(): number;
  hint(text: string): void;
  /** Begin a machine from nothing. */
  begin(): void;
}

type Chosen = { what: "point" | "link"; name: string };

export class Tools {
  readonly palette: Palette;
  private tool = "select";
  private pending: Hit | null = null;
  private chosen: Chosen | null = null;
  /** Questions that are not answered yet, and what is done with the tool after them. */
  private unheard = 0;
  private readonly later: (() => void)[] = [];
  private cross: Pair = [0, 0];
  private readonly rubber = s("path", { class: "rubber" });
  private readonly target = s("circle", { class: "aim", r: 7 });
  private readonly crosshair = s(
    "g",
    { class: "crosshair", role: "slider", tabindex: -1, "aria-label": say("Crosshair") },
    s("path", { d: "M-12 0H12M0-12V12" }),
  );
  private readonly layer = s("g", { class: "tooling", display: "none" });

  constructor(private readonly page: Making) {
    this.palette = new Palette({
      chosen: (tool) => this.soon(() => this.take(tool, true)),
      made: () => page.begin(),
      renamed: (name) => this.rename(name),
    });
    this.layer.append(this.rubber, this.target, this.crosshair);
    page.stage.svg.append(this.layer);
    page.board.addEventListener("pointerdown", this.press, true);
    page.board.addEventListener("pointermove", this.hover);
    page.board.addEventListener("keydown", this.key, true);
    for (const name of ["keyup", "wheel", "click"] as const) page.board.addEventListener(name, this.place);
    // A finger draws with a tool, and must not scroll meanwhile.
    const still = (event: Event) => this.tool !== "select" && this.onSheet(event) && event.preventDefault();
    page.board.addEventListener("touchstart", still, { passive: false, capture: true });
    this.palette.show(this.tool, false);
    turnable(page);
  }

  /** A state has come. */
  show(state: State): void {
    this.palette.tell(state.status);
    if (this.pending?.point && !state.numbers.has(`place.${this.pending.point}`)) this.leave();
    const { chosen } = this;
    const bodies = state.scene.bodies;
    const there =
      chosen?.what === "point"
        ? state.numbers.has(`place.${chosen.name}`)
        : bodies.some(({ name }) => name === chosen?.name);
    if (chosen && !there) this.choose(null);
  }

  /** Another machine is there: nothing of the last one is begun or chosen any more. */
  anew(): void {
    this.later.length = 0;
    [this.pending, this.unheard] = [null, 0];
    if (this.tool === "delete") this.take("select"); // which would take away of what is new
    this.choose(null);
    this.palette.show(this.tool, false);
    this.draw(null);
  }

  /** Take no tool any more: the drawing shows poses in which nothing can be made. */
  rest(): void {
    if (this.tool !== "select") this.take("select");
  }

  /** Do something as soon as all that was asked before is there: joints may be among it. */
  private soon(act: () => void): void {
    if (this.unheard || this.later.length) this.later.push(act);
    else act();
  }

  /** What is chosen: for its name, and for Delete. */
  choose(chosen: Chosen | null): void {
    this.chosen = chosen;
    this.palette.choose(chosen?.name ?? null);
  }

  selected(grip: Grip): void {
    this.choose(grip.kind === "point" ? { what: "point", name: grip.name } : null);
  }

  private take(tool: string, focus = false): void {
    const drawing = this.tool !== "select"; // then the crosshair stays where it is
    [this.tool, this.pending] = [tool, null];
    this.page.talk.release();
    const making = tool !== "select";
    if (making) this.page.turn(this.page.angle()); // stands still from now on
    this.page.board.classList.toggle("tooled", making);
    set(this.layer, { display: making ? null : "none" });
    set(this.crosshair, { tabindex: making ? 0 : -1 });
    this.palette.show(tool, false);
    this.draw(null);
    this.page.hint("");
    if (making) {
      const { view } = this.page.stage;
      if (!drawing) this.cross = this.at([view.width / 2, view.height / 2]).place;
      this.aim();
      if (focus) this.crosshair.focus({ preventScroll: true });
    }
  }

  private leave(): void {
    if (!this.pending) return this.take("select");
    this.pending = null;
    this.palette.show(this.tool, false);
    this.draw(null);
  }

  // -- by mouse and touch --------------------------------------------------------------------------

  /** What is meant where the keys are: at a handle, or at the crosshair. */
  focused(element: Element): Hit | null {
    if (element === this.crosshair) return this.at(this.page.stage.view.px(...this.cross));
    const { kind, name } = element.closest<SVGElement>(".grip")?.dataset ?? {};
    if (!kind || !name) return null;
    const place = this.page.stage.place({ kind: kind as Grip["kind"], name });
    if (!place) return null;
    return kind === "point" ? { point: name, place } : { link: name, place };
  }

  /** Do something at once that a tool does. */
  make(made: Made): void {
    this.soon(() => this.ask(made));
  }

  private onSheet(event: Event): boolean {
    return this.page.stage.svg.contains(event.target as Node);
  }

  private spot(event: PointerEvent): Pair {
    const box = this.page.stage.svg.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** What is meant at a pixel of the drawing. */
  at(px: Pair, level = false): Hit {
    const box = this.page.stage.svg.getBoundingClientRect();
    const below = document.elementsFromPoint(box.left + px[0], box.top + px[1]);
    const root = this.page.stage.svg.getRootNode() as Document | ShadowRoot;
    const inside = "elementsFromPoint" in root ? root.elementsFromPoint(box.left + px[0], box.top + px[1]) : below;
    const parts = inside.flatMap((element) => element.closest<SVGElement>("[data-link], [data-what]") ?? []);
    const link = parts.map(({ dataset }) => dataset.link).find(Boolean);
    const from = level ? (this.pending?.place ?? null) : null;
    const hit = meant(this.page, px, link, from);
    const { what, name } = parts[0]?.dataset ?? {};
    // A block lies on its joint, all else about one.
    if (what && (what === "slider" || !hit.point)) hit.part = { what, name: name ?? "" };
    return hit;
  }

  private readonly press = (event: PointerEvent): void => {
    if (this.tool === "select" || event.button || !this.onSheet(event)) return;
    event.preventDefault();
    event.stopPropagation();
    const start = this.spot(event);
    const { svg } = this.page.stage;
    svg.setPointerCapture(event.pointerId);
    let begins = false;
    this.soon(() => {
      begins = this.pending === null;
      this.put(this.at(start, event.shiftKey));
    });
    const stop = (now: PointerEvent) => {
      if (now.pointerId !== event.pointerId) return;
      for (const name of ["pointerup", "pointercancel"] as const) svg.removeEventListener(name, stop);
      const end = this.spot(now);
      // On the screen: where lines above wrap, the sheet moves below a finger that rests.
      const far = Math.hypot(now.clientX - event.clientX, now.clientY - event.clientY) > FAR;
      if (now.type !== "pointerup" || !far) return;
      this.soon(() => begins && this.pending && this.put(this.at(end, now.shiftKey)));
    };
    for (const name of ["pointerup", "pointercancel"] as const) svg.addEventListener(name, stop);
  };

  private readonly hover = (event: PointerEvent): void => {
    if (this.tool === "select" || !this.onSheet(event)) return;
    this.draw(this.at(this.spot(event), event.shiftKey));
  };

  /** Show what a click would do, with the length and the direction of a line. */
  private draw(hit: Hit | null): void {
    const { view } = this.page.stage;
    const [x, y] = hit ? view.px(...hit.place) : [-99, -99];
    set(this.target, { cx: x, cy: y, class: hit?.point ? "aim joint" : "aim" });
    if (!hit || !this.pending) {
      set(this.rubber, { d: "" });
      return hit ? this.page.hint(where(hit)) : undefined;
    }
    const from = this.pending.place;
    const [a, b] = view.px(...from);
    set(this.rubber, { d: `M${a} ${b}L${x} ${y}` });
    const [dx, dy] = [hit.place[0] - from[0], hit.place[1] - from[1]];
    const angle = signed(degrees(Math.atan2(dy, dx)).toFixed(1));
    this.page.hint(`${length(Math.hypot(dx, dy))} ${lengths().unit} ∠ ${angle}°; ${where(hit)}`);
  }

  // -- by keys -------------------------------------------------------------------------------------

  private readonly key = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || !this.onSheet(event)) return;
    const pressed = event.key === "Backspace" ? "delete" : event.key.toLowerCase();
    const tool = toolOf(pressed);
    if (pressed === "delete" && this.tool === "select" && this.chosen) {
      this.ask({ do: "delete", ...this.chosen });
    } else if (tool && !event.altKey) this.soon(() => this.take(tool.tool, true));
    else if (this.tool === "select") return;
    else if (event.key === "Escape") this.leave();
    else if (event.key === "Enter") this.enter(event);
    else if (ARROWS[event.key] && event.target === this.crosshair) this.steer(event);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };

  /** Take a tool by its key, where something else than the drawing has the focus; returns whether there is such a tool. */
  pick(key: string): boolean {
    const tool = toolOf(key.toLowerCase());
    if (!tool || tool.tool === "delete") return false;
    this.soon(() => this.take(tool.tool, true));
    return true;
  }

  private enter(event: KeyboardEvent): void {
    const { kind, name } = (event.target as SVGElement).closest<SVGElement>(".grip")?.dataset ?? {};
    const place = kind === "point" && name ? this.page.stage.place({ kind, name }) : null;
    const cross = this.cross;
    if (place && name) this.soon(() => this.put({ point: name, place }));
    else this.soon(() => this.put(this.at(this.page.stage.view.px(...cross))));
  }

  private steer(event: KeyboardEvent): void {
    const [dx, dy] = ARROWS[event.key] as Pair;
    const size = step(this.page) * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1);
    const [x, y] = this.cross;
    this.cross = [Number((x + dx * size).toPrecision(12)), Number((y + dy * size).toPrecision(12))];
    this.aim();
    this.draw(this.at(this.page.stage.view.px(...this.cross)));
  }

  /** Put the crosshair where it is: the sheet may have been moved below it. */
  private readonly place = (): void => {
    const [px, py] = this.page.stage.view.px(...this.cross);
    set(this.crosshair, { transform: `translate(${px},${py})` });
  };

  /** The same, and say where. */
  private aim(): void {
    this.place();
    const [x, y] = [length(this.cross[0]), length(this.cross[1])];
    set(this.crosshair, {
      "aria-valuenow": (this.cross[0] * lengths().factor).toFixed(2),
      "aria-valuetext": `x ${x} ${lengths().unit}, y ${y} ${lengths().unit}`,
    });
    this.page.hint(`${x}, ${y} ${lengths().unit}`);
  }

  // -- what is done --------------------------------------------------------------------------------

  /** One click of the tool. */
  private put(hit: Hit): void {
    if ((TWO.has(this.tool) || partTool(this.tool)) && !this.pending) {
      if (this.tool === "pin" && !hit.point) return;
      if (partTool(this.tool) && !this.linkOf(hit)) return;
      this.pending = hit;
      this.palette.show(this.tool, true);
      return;
    }
    const made = this.making(hit, this.pending);
    this.pending = null;
    this.palette.show(this.tool, false);
    this.draw(null);
    if (made) this.ask(made);
  }

  private making(hit: Hit, first: Hit | null): Made | null {
    const link = this.linkOf(hit);
    const part = partTool(this.tool);
    if (part) {
      const driver = first && this.linkOf(first);
      const options = this.palette.optionsOf(part);
      return driver && link ? { do: part.tool, driver, driven: link, spot: spot(hit), ...options } : null;
    }
    switch (this.tool) {
      case "point":
        return hit.point ? null : { do: "point", spot: spot(hit), on: hit.link ?? "frame" };
      case "link":
        return first && { do: "link", from: spot(first), to: spot(hit) };
      case "slider":
        return first && { do: "slider", from: spot(first), to: spot(hit) };
      case "pin":
        return first?.point ? this.pin(first.point, hit.point) : null;
      case "separate":
        return hit.point ? { do: "separate", point: hit.point } : null;
      case "drive":
        return link ? { do: "drive", link } : null;
      case "delete":
        return deleted(hit, link);
      default:
        return null;
    }
  }

  private pin(point: string, to: string | undefined): Made {
    if (to && to !== point) return { do: "pin", point, to };
    const pinned = this.page.state()?.scene.frame.includes(point);
    return { do: pinned ? "free" : "ground", point };
  }

  /**
   * The link that is meant; at a joint the one that turns about a point of the frame, and for a part
   * whose link may slide the one that does.
   */
  private linkOf(hit: Hit): string | undefined {
    const { bodies = [], frame = [] } = this.page.state()?.scene ?? {};
    const block = partTool(this.tool)?.slides && hit.part?.what === "slider" ? hit.part.name : "";
    const sliding = bodies.find(({ name }) => block.startsWith(`${name} on `));
    if (sliding) return sliding.name;
    const met = bodies.filter(({ points }) => hit.point && points.includes(hit.point));
    const turning = met.find(({ points }) => points.some((point) => frame.includes(point)));
    return hit.link ?? (turning ?? met[0])?.name;
  }

  private rename(to: string): void {
    const { chosen } = this;
    if (!chosen || to === chosen.name) return;
    this.ask({ do: "rename", ...chosen, to }, () => this.choose({ ...chosen, name: to }));
  }

  private ask(made: Made, then?: () => void): void {
    this.page.talk.release();
    const at = this.page.state() ? this.page.sample() : 0;
    this.unheard++;
    this.page.talk.ask({ type: "make", at, ...made }, (refusal) => {
      this.unheard = Math.max(this.unheard - 1, 0);
      if (refusal === null) then?.();
      while (!this.unheard && this.later.length) this.later.shift()?.();
    });
  }
}

/** The place that is meant, as it is rounded. */
function where({ point, place: [x, y] }: Hit): string {
  const text = `${length(x)}, ${length(y)} ${lengths().unit}`;
  return point ? say("{name}: {place}", { name: point, place: text }) : text;
}

function deleted({ part, point }: Hit, link: string | undefined): Made | null {
  if (part) return { do: "delete", ...part };
  if (point) return { do: "delete", what: "point", name: point };
  return link ? { do: "delete", what: "link", name: link } : null;
}

function toolOf(key: string) {
  return tools().find((tool) => tool.key.toLowerCase() === key);
}

function spot(hit: Hit): object {
  if (hit.point) return { point: hit.point };
  return { place: hit.place, ...(hit.link && { on: hit.link }) };
}
