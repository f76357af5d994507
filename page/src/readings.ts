/** Figures of what shakes, and what balancing made of them; those that are pinned on the drawing. */

import { h, show } from "./dom";
import { decimals, unbroken } from "./format";
import type { Balanced, Change, Figure, Planted, State, Strokes } from "./protocol";
import { type ComponentChild, pictogram, render, v } from "./render";
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
    render(this.root, ...pinned.map(({ label, text }) => v("li", {}, v("span", {}, label), v("b", {}, text))));
    show(this.root, pinned.length > 0);
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

  show(state: State): void {
    const lines = [...byLine(state.figures).values()];
    this.root.classList.toggle("compared", state.compared);
    render(
      this.root,
      lines.length ? this.table(lines, state) : v("p", { class: "quiet" }, say("Motion only, no forces.")),
    );
    this.pins.show(lines.map(reading));
  }

  private table(lines: Line[], state: State): ComponentChild {
    const caption = state.compared ? say("Figures, and what they were before") : say("Figures");
    const column = (text: string) => v("th", { scope: "col" }, text);
    const row = (line: Line) => [
      v("th", { scope: "row" }, line.label),
      ...[line.rms, line.peak].map((figure) => valueCell(figure?.text ?? "", state.compared && (figure?.was ?? ""))),
      v("td", { class: "unit" }, unbroken(line.unit), this.pinner(line, state)),
    ];
    return v(
      "table",
      {},
      v("caption", { class: "unseen" }, caption),
      v("thead", {}, v("tr", {}, v("td", {}), column(say("RMS")), column(say("peak")), v("td", {}))),
      v("tbody", {}, ...lines.map((line) => v("tr", {}, ...row(line)))),
    );
  }

  /** The button that pins a line on the drawing, or takes it off. */
  private pinner({ name, label }: Line, state: State): ComponentChild {
    const title = say("Pin {name} on the drawing", { name: label });
    const onclick = () => {
      this.pins.turn(name);
      this.show(state);
    };
    const attributes = { type: "button", class: "pin", title, "aria-label": title } as const;
    return v("button", { ...attributes, "aria-pressed": this.pins.has(name), onclick }, pictogram(PIN));
  }
}

/** What is pinned of a line. */
function reading({ name, label, unit, rms, peak }: Line): Reading {
  const texts = [
    rms && say("RMS {value} {unit}", { value: rms.text, unit }),
    peak && say("peak {value} {unit}", { value: peak.text, unit }),
  ];
  return { name, label, text: texts.filter((text) => text).join(", ") };
}

/** A value, and what it was before; false where nothing is compared. */
function valueCell(value: string, before: string | false): ComponentChild {
  const was = before !== false && v("span", { class: "was" }, decimals(before));
  return v("td", {}, v("span", { class: "value" }, decimals(value)), was);
}

/** Figures of a planting finger, of gauges, or of sliders and rockers; they come a little after the machine. */
export class FigureTable {
  readonly root = h("div", { class: "readings planted", hidden: true });

  constructor(private readonly caption: string) {}

  show({ figures, compared }: Planted | Strokes): void {
    this.root.classList.toggle("compared", compared);
    const rows = figures.map(({ label, unit, text, was }) =>
      v(
        "tr",
        {},
        v("th", { scope: "row" }, capital(label)),
        valueCell(text, compared && (was ?? "")),
        v("td", { class: "unit" }, unbroken(unit)),
      ),
    );
    const caption = compared ? `${this.caption}, ${say("and what they were before")}` : this.caption;
    render(this.root, v("table", {}, v("caption", { class: "unseen" }, caption), v("tbody", {}, ...rows)));
    show(this.root, rows.length > 0);
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
    render(
      this.root,
      v("h2", {}, say("Balanced")),
      v("ul", {}, ...balanced.changes.map((change) => v("li", {}, unbroken(change)))),
      v(
        "div",
        { class: "buttons" },
        v("button", { type: "button", class: "strong", onclick: this.keep }, say("Keep")),
        v("button", { type: "button", onclick: this.takeBack }, say("Take back")),
        balanced.gauges_worse &&
          v("button", { type: "button", onclick: this.hold }, say("Balance so that no gauge reads more")),
      ),
      comparison(main),
      others.length > 0 && v("details", {}, v("summary", {}, say("All other figures")), comparison(others)),
      ...balanced.worse.map((text) => v("p", { class: "worse" }, unbroken(text))),
      ...[balanced.proof, ...balanced.notes].map((text) => v("p", { class: "quiet" }, unbroken(text))),
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
export function comparison(figures: Change[], heads = [say("before"), say("after"), say("change")]): ComponentChild {
  const rows = figures.map(({ label, unit, texts: [before, after, change], way }) =>
    v(
      "tr",
      {},
      v("th", { scope: "row" }, capital(label), v("span", { class: "unit" }, `\u00a0${unbroken(unit)}`)),
      v("td", {}, before),
      v("td", { class: "after" }, after),
      v("td", { class: way }, unbroken(change)),
    ),
  );
  const head = heads.map((text) => v("th", { scope: "col" }, text));
  return v("table", {}, v("thead", {}, v("tr", {}, v("td", {}), ...head)), v("tbody", {}, ...rows));
}
