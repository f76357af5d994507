/** Beside the drawing: the underlay that is traced over, and the ruler. */

import type { Aim } from "./aim";
import { h, s, set, write } from "./dom";
import { asTyped, degrees, length, lengths, metres, plain } from "./format";
import type { Pair } from "./protocol";
import type { Stage } from "./stage";
import { Underlay } from "./underlay";
import { say } from "./words";

export class Aids {
  readonly root: HTMLDetailsElement;
  readonly underlay: Underlay;
  private readonly said = h("p", { class: "quiet", role: "status", "aria-live": "polite" });
  private readonly own = h("div", { class: "underlay-keys", hidden: true });
  private readonly title = h("b", {});
  private readonly opacity = h("input", {
    type: "range",
    min: 0.05,
    max: 1,
    step: 0.05,
    "aria-label": say("Opacity of the underlay"),
  });
  private readonly hidden = h("input", { type: "checkbox" });
  private readonly angle = h("input", {
    type: "text",
    class: "number",
    "aria-label": say("Angle of the underlay, deg"),
  });
  private readonly distance = h("input", {
    type: "text",
    class: "number",
    "aria-label": say("True distance of the two places"),
  });
  private readonly scaling = h(
    "form",
    { class: "line", hidden: true },
    this.distance,
    h("button", { type: "submit" }, say("Scale")),
  );
  private readonly measured = s("svg", { class: "ruler", "aria-hidden": "true" });
  private readonly tape = s("path", {});
  private readonly written = s("text", { "text-anchor": "middle" });
  private readonly result = h("p", { class: "measured", role: "status", "aria-live": "polite" });
  private ends: [Pair, Pair] | null = null;
  private two: [Pair, Pair] | null = null;

  constructor(
    private readonly stage: Stage,
    private readonly aim: () => Aim,
  ) {
    this.underlay = new Underlay(stage, () => this.tell());
    this.measured.append(this.tape, this.written);
    stage.svg.after(this.measured);
    stage.watchers.push(() => this.draw());
    this.root = h("details", { class: "group aids" }, h("summary", {}, say("Underlay and ruler")));
    this.root.append(this.chooser(), this.own, this.said, this.ruler());
    this.own.append(...this.keys());
    this.underlay.recall();
  }

  /** Lay a picture or drawing below the linkage. */
  async take(file: File): Promise<void> {
    this.root.open = true;
    try {
      write(this.said, await this.underlay.take(file));
    } catch (error) {
      write(this.said, (error as Error).message);
    }
  }

  private chooser(): HTMLElement {
    const file = h("input", {
      type: "file",
      hidden: true,
      tabindex: -1,
      accept: "image/png,image/jpeg,image/webp,image/svg+xml,.dxf",
      "aria-label": say("Picture or DXF drawing"),
    });
    file.addEventListener("change", () => {
      const [chosen] = file.files ?? [];
      file.value = "";
      if (chosen) void this.take(chosen);
    });
    const note = h(
      "p",
      { class: "quiet" },
      say("A picture or DXF drawing to trace over: choose it, drop it on the page, or paste it."),
    );
    return h(
      "div",
      {},
      note,
      h("button", { type: "button", onclick: () => file.click() }, say("Choose underlay")),
      file,
    );
  }

  private keys(): HTMLElement[] {
    this.opacity.addEventListener("input", () => this.underlay.change({ opacity: Number(this.opacity.value) }));
    this.hidden.addEventListener("change", () => this.underlay.change({ hidden: this.hidden.checked }));
    this.angle.addEventListener("change", () => {
      const turn = (numberOf(this.angle.value) * Math.PI) / 180;
      if (Number.isFinite(turn)) this.underlay.turn(turn);
      this.tell();
    });
    this.scaling.addEventListener("submit", (event) => {
      event.preventDefault();
      this.stretch();
    });
    const button = (text: string, onclick: () => void) => h("button", { type: "button", onclick }, text);
    const line = (...parts: (Node | string)[]) => h("div", { class: "line" }, ...parts);
    return [
      this.title,
      line(
        button(say("Scale by two places"), () => void this.scale()),
        button(say("Move"), () => void this.move()),
        button(say("Remove"), () => this.underlay.remove()),
      ),
      this.scaling,
      h("label", { class: "line" }, say("Turn, deg"), this.angle),
      h("label", { class: "line" }, say("Opacity"), this.opacity),
      h("label", { class: "line" }, this.hidden, say("Hidden")),
    ];
  }

  private ruler(): HTMLElement {
    const start = h("button", { type: "button", onclick: () => void this.measure() }, say("Measure"));
    const end = h("button", { type: "button", onclick: () => this.lay(null) }, say("Clear"));
    return h("div", {}, h("div", { class: "line" }, start, end), this.result);
  }

  /** Bring the controls to what the underlay is. */
  private tell(): void {
    const shown = this.underlay?.shown ?? null;
    this.own.hidden = !shown;
    if (!shown) return;
    write(this.title, shown.name);
    this.opacity.value = String(shown.opacity);
    this.hidden.checked = shown.hidden;
    this.angle.value = plain(degrees(shown.turn));
  }

  private async pair(first: string, second: string): Promise<[Pair, Pair] | null> {
    const from = await this.aim().ask(first);
    const other = from && (await this.aim().ask(second, from.at));
    return from && other ? [from.at, other.at] : null;
  }

  private async scale(): Promise<void> {
    const first = say("Click the first of two places whose distance you know.");
    this.two = await this.pair(first, say("Click the second place."));
    this.scaling.hidden = !this.two;
    if (!this.two) return;
    const [[x0, y0], [x1, y1]] = this.two;
    this.distance.value = `${length(Math.hypot(x1 - x0, y1 - y0))} ${lengths().unit}`;
    this.distance.select();
    this.distance.focus();
  }

  private stretch(): void {
    const typed = metresOf(this.distance.value);
    if (typed === null) {
      set(this.distance, { "aria-invalid": "true" });
      return write(this.said, say("Give a length above 0 with its unit, such as 250 mm."));
    }
    set(this.distance, { "aria-invalid": null });
    if (this.two) this.underlay.stretch(...this.two, typed);
    this.scaling.hidden = true;
    write(this.said, "");
  }

  private async move(): Promise<void> {
    const first = say("Click a place of the underlay.");
    const ends = await this.pair(first, say("Click where it is to be."));
    if (ends) this.underlay.move(...ends);
  }

  private async measure(): Promise<void> {
    const ends = await this.pair(say("Click where to measure from."), say("Click where to measure to."));
    if (ends) this.lay(ends);
  }

  /** Lay the ruler from place to place, or put it away. */
  private lay(ends: [Pair, Pair] | null): void {
    this.ends = ends;
    this.draw();
    if (!ends) return write(this.result, "");
    const [[x0, y0], [x1, y1]] = ends;
    const { unit } = lengths();
    const values = {
      distance: `${length(Math.hypot(x1 - x0, y1 - y0))} ${unit}`,
      angle: plain(Number(degrees(Math.atan2(y1 - y0, x1 - x0)).toFixed(2))),
      across: `${length(x1 - x0)} ${unit}`,
      up: `${length(y1 - y0)} ${unit}`,
    };
    write(this.result, say("{distance} at {angle}°; {across} along x, {up} along y", values));
  }

  private draw(): void {
    const { view } = this.stage;
    set(this.measured, { viewBox: `0 0 ${view.width} ${view.height}` });
    set(this.measured, { hidden: !this.ends });
    if (!this.ends) return;
    const [from, to] = this.ends;
    const [[ax, ay], [bx, by]] = [view.px(...from), view.px(...to)];
    const [away, turn] = [Math.hypot(bx - ax, by - ay) || 1, 6];
    const [nx, ny] = [((ay - by) / away) * turn, ((bx - ax) / away) * turn];
    const end = (x: number, y: number) => `M${x - nx} ${y - ny}L${x + nx} ${y + ny}`;
    set(this.tape, { d: `${end(ax, ay)}${end(bx, by)}M${ax} ${ay}L${bx} ${by}` });
    set(this.written, { x: (ax + bx) / 2 + 3 * nx, y: (ay + by) / 2 + 3 * ny });
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    write(this.written, `${length(Math.hypot(dx, dy))} ${lengths().unit}`);
  }
}

function numberOf(text: string): number {
  return Number(asTyped(text).replace(/ *(deg|°)$/, ""));
}

/** A typed length, m; null where it is none. */
function metresOf(text: string): number | null {
  const match = /^([\d.eE+-]+) *([a-z]*)$/.exec(asTyped(text));
  const metresTyped = Number(match?.[1]) * metres(match?.[2] || lengths().unit);
  return metresTyped > 0 && Number.isFinite(metresTyped) ? metresTyped : null;
}
