/** Figures of what shakes, and what balancing made of them; those that are pinned on the drawing. */

import { h, icon, set, show, write } from "./dom";
import { decimals, unbroken } from "./format";
import type { Balanced, Change, Figure, Planted, State, Strokes } from "./protocol";
import { say } from "./words";

const KEPT = "equipoise-pinned";

/** A figure in words: of what it is, and its values. */
interface Reading {
  name: string;
  label: string;
  text: string;
}

class Pins {
  readonly root = h("ul", { class: "pins", "aria-label": say("Figures on the drawing"), hidden: true });
  private readonly names = new Set<string>(remembered());
  private shape = "";

  has(name: string): boolean {
    return this.names.has(name);
  }

  turn(name: string): void {
    if (!this.names.delete(name)) this.names.add(name);
    try {
      localStorage.setItem(KEPT, JSON.stringify([...this.names]));
    } catch {
      // then it holds until the page is closed
    }
  }

  show(readings: Reading[]): void {
    const pinned = readings.filter(({ name }) => this.names.has(name));
    const shape = pinned.map(({ label }) => label).join("\n");
    if (shape !== this.shape) {
      this.shape = shape;
      this.root.replaceChildren(...pinned.map(({ label }) => h("li", {}, h("span", {}, label), h("b"))));
      this.root.hidden = !pinned.length;
    }
    for (const [i, { text }] of pinned.entries()) write(this.root.children[i]?.lastElementChild as Element, text);
  }
}

function remembered(): string[] {
  try {
    const names: unknown = JSON.parse(localStorage.getItem(KEPT) ?? "[]");
    return Array.isArray(names) ? names.map(String) : [];
  } catch {
    return []; // nothing may be kept here
  }
}

const PIN = "M5.500 2.500h5M6.500 2.500v4l-2 2.500h7l-2-2.500v-4M8 9v4.500";

interface Line {
  name: string;
  label: string;
  unit: string;
  rms?: Figure;
  peak?: Figure;
}

/** A table of RMS and peak, a line for each signal. */
export class Readings {
  readonly root = h("div", { class: "readings" });
  /** Those that are pinned, which stand on the drawing. */
  readonly pins = new Pins();
  private lines: Line[] = [];
  private shape = "";
  private cells = new Map<string, { value: HTMLElement; before: HTMLElement | null }>();

  show(state: State): void {
    const lines = [...byLine(state.figures).values()];
    const shape = JSON.stringify([lines.map((l) => [l.label, !!l.rms, !!l.peak]), state.compared]);
    if (shape !== this.shape) this.build(lines, state, shape);
    for (const figure of state.figures) {
      const cell = this.cells.get(figure.name);
      if (!cell) continue;
      write(cell.value, decimals(figure.text));
      if (cell.before) write(cell.before, decimals(figure.was ?? ""));
    }
    this.lines = lines;
    this.pin();
  }

  private pin(): void {
    const pinned = (line: Line) => {
      const rms = line.rms && say("RMS {value} {unit}", { value: line.rms.text, unit: line.unit });
      const peak = line.peak && say("peak {value} {unit}", { value: line.peak.text, unit: line.unit });
      return { name: line.name, label: line.label, text: [rms, peak].filter((text) => text).join(", ") };
    };
    this.pins.show(this.lines.map(pinned));
  }

  /** The button that pins a line on the drawing, or takes it off. */
  private pinner({ name, label }: Line): HTMLElement {
    const title = say("Pin {name} on the drawing", { name: label });
    const button = h("button", { type: "button", class: "pin", title, "aria-label": title }, icon(PIN));
    const mark = () => set(button, { "aria-pressed": String(this.pins.has(name)) });
    button.addEventListener("click", () => {
      this.pins.turn(name);
      mark();
      this.pin();
    });
    mark();
    return button;
  }

  private build(lines: Line[], state: State, shape: string): void {
    this.shape = shape;
    this.cells.clear();
    this.root.classList.toggle("compared", state.compared);
    if (!lines.length) {
      return this.root.replaceChildren(h("p", { class: "quiet" }, say("Motion only, no forces.")));
    }
    const cell = (figure: Figure | undefined) => {
      if (!figure) return h("td");
      const value = h("span", { class: "value" });
      const before = state.compared ? h("span", { class: "was" }) : null;
      this.cells.set(figure.name, { value, before });
      return h("td", {}, value, before);
    };
    const head = h(
      "tr",
      {},
      ...["", say("RMS"), say("peak"), ""].map((t, i) => h(i ? "th" : "td", i ? { scope: "col" } : {}, t)),
    );
    head.lastElementChild?.replaceWith(h("td"));
    const rows = lines.map((line) =>
      h(
        "tr",
        {},
        h("th", { scope: "row" }, line.label),
        cell(line.rms),
        cell(line.peak),
        h("td", { class: "unit" }, unbroken(line.unit), this.pinner(line)),
      ),
    );
    const caption = h(
      "caption",
      { class: "unseen" },
      state.compared ? say("Figures, and what they were before") : say("Figures"),
    );
    this.root.replaceChildren(h("table", {}, caption, h("thead", {}, head), h("tbody", {}, ...rows)));
  }
}

/** Figures of a planting finger, of gauges, or of sliders and rockers; they come a little after the machine. */
export class FigureTable {
  readonly root = h("div", { class: "readings planted", hidden: true });

  constructor(private readonly caption: string) {}

  show(planted: Planted | Strokes): void {
    this.root.classList.toggle("compared", planted.compared);
    const rows = planted.figures.map(({ label, unit, text, was }) =>
      h(
        "tr",
        {},
        h("th", { scope: "row" }, capital(label)),
        h("td", {}, h("span", { class: "value" }, text), planted.compared && h("span", { class: "was" }, was ?? "")),
        h("td", { class: "unit" }, unbroken(unit)),
      ),
    );
    const words = planted.compared ? `${this.caption}, ${say("and what they were before")}` : this.caption;
    const caption = h("caption", { class: "unseen" }, words);
    this.root.replaceChildren(h("table", {}, caption, h("tbody", {}, ...rows)));
    this.root.hidden = !rows.length;
  }

  hide(): void {
    show(this.root, false);
  }
}

function byLine(figures: Figure[]): Map<string, Line> {
  const lines = new Map<string, Line>();
  for (const figure of figures) {
    const { signal, unit } = figure;
    const line = lines.get(signal) ?? { name: figure.name.replace(/\.[^.]*$/, ""), label: capital(signal), unit };
    line[figure.measure] = figure;
    lines.set(signal, line);
  }
  return lines;
}

export function capital(text: string): string {
  return text.slice(0, 1).toUpperCase() + text.slice(1);
}

/** What balancing found: before and after, what was changed, and whether it is proven. */
export class BalancePanel {
  readonly root = h("section", {
    class: "panel balance",
    "aria-label": say("Balancing"),
    hidden: true,
    tabindex: -1,
  });

  constructor(
    private readonly keep: () => void,
    private readonly takeBack: () => void,
    private readonly hold: () => void,
  ) {}

  show(balanced: Balanced): void {
    const whole = balanced.figures.filter(({ main }) => main);
    const changed = whole.filter(({ way }) => way !== "same");
    const rest = (changed.length ? changed : whole).filter(
      ({ label }) => !balanced.aims.some((aim) => aim.label === label),
    );
    const main = [...balanced.aims, ...rest];
    const others = balanced.figures.filter(({ label }) => !main.some((aim) => aim.label === label));
    this.root.replaceChildren(
      h("h2", {}, say("Balanced")),
      h("ul", {}, ...balanced.changes.map((change) => h("li", {}, unbroken(change)))),
      h(
        "div",
        { class: "buttons" },
        h("button", { type: "button", class: "strong", onclick: () => this.keep() }, say("Keep")),
        h("button", { type: "button", onclick: () => this.takeBack() }, say("Take back")),
        balanced.gauges_worse &&
          h("button", { type: "button", onclick: () => this.hold() }, say("Balance so that no gauge reads more")),
      ),
      comparison(main),
      ...(others.length ? [h("details", {}, h("summary", {}, say("All other figures")), comparison(others))] : []),
      ...balanced.worse.map((text) => h("p", { class: "worse" }, unbroken(text))),
      ...[balanced.proof, ...balanced.notes].map((text) => h("p", { class: "quiet" }, unbroken(text))),
    );
    this.root.hidden = false;
    this.root.focus({ preventScroll: true });
    this.root.scrollIntoView({ block: "nearest" });
  }

  hide(): void {
    show(this.root, false);
  }
}

/** The figure that a balance was for, before and after. */
export function headline({ aims, figures }: Balanced): string {
  const first = aims[0] ?? figures.find(({ main }) => main);
  if (!first) return "";
  const [before, after] = first.texts;
  return say("{what}: {before} → {after} {unit}", { what: capital(first.label), before, after, unit: first.unit });
}

/** Figures before and after, and by how much they have changed. */
export function comparison(figures: Change[], heads = [say("before"), say("after"), say("change")]): HTMLTableElement {
  const rows = figures.map(({ label, unit, texts: [before, after, change], way }) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, capital(label), h("span", { class: "unit" }, `\u00a0${unbroken(unit)}`)),
      h("td", {}, before),
      h("td", { class: "after" }, after),
      h("td", { class: way }, unbroken(change)),
    ),
  );
  const head = heads.map((text) => h("th", { scope: "col" }, text));
  return h("table", {}, h("thead", {}, h("tr", {}, h("td"), ...head)), h("tbody", {}, ...rows));
}
