/**
 * Charts of outputs that were looked for, in a box that lists what it finds: each over the crank
 * angle, until it is closed.
 */

import { Abscissa, besides, column, measured, scaled, times } from "./chart";
import { fresh, h, icon, set } from "./dom";
import type { Output, State } from "./protocol";
import { capital } from "./readings";
import { turning, wide } from "./scale";
import { Strip } from "./strip";
import type { Role, Theme } from "./theme";
import { say } from "./words";

/** An output to search for, by any word of its label. */
interface Entry {
  name: string;
  label: string;
  group: string;
}

/** Entries that are listed at most. */
const MOST = 60;
/** Height of the list at most, and at least where it opens downward, pixels. */
const [TALL, LEAST] = [260, 160];

class Finder {
  readonly root: HTMLElement;
  private readonly input: HTMLInputElement;
  private readonly list: HTMLElement;
  private entries: Entry[] = [];
  private offered = "";
  private matches: Entry[] = [];
  private at = -1;

  constructor(
    name: string,
    private readonly none: string,
    private readonly chosen: (name: string) => void,
  ) {
    const id = fresh("found");
    // What scrolls would be a stop of the Tab key of its own.
    const list = { class: "found", role: "listbox", id, tabindex: -1, "aria-label": name, hidden: true };
    this.list = h("div", list);
    this.input = h("input", {
      type: "search",
      role: "combobox",
      "aria-label": name,
      "aria-autocomplete": "list",
      "aria-controls": id,
      "aria-expanded": "false",
      autocomplete: "off",
      spellcheck: "false",
      placeholder: `${name} …`,
    });
    this.input.addEventListener("input", () => this.open());
    this.input.addEventListener("focus", () => this.open());
    this.input.addEventListener("pointerdown", () => this.list.hidden && this.open());
    this.input.addEventListener("blur", () => this.close());
    this.input.addEventListener("keydown", (event) => this.key(event));
    // A press must not take the focus away before it is known what was pressed.
    this.list.addEventListener("pointerdown", (event) => event.preventDefault());
    this.list.addEventListener("click", (event) => {
      const option = (event.target as Element).closest<HTMLElement>("[role=option]");
      if (option?.dataset.name) this.take(option.dataset.name);
    });
    this.root = h("div", { class: "finder" }, this.input, this.list);
  }

  /** Say what is looked for. */
  call(name: string): void {
    set(this.input, { "aria-label": name, placeholder: `${name} …` });
    set(this.list, { "aria-label": name });
  }

  offer(entries: Entry[]): void {
    const shape = entries.map(({ name, label }) => `${name} ${label}`).join();
    if (shape === this.offered) return;
    this.offered = shape;
    this.entries = entries;
    if (!this.list.hidden) this.open();
  }

  private open(): void {
    const words = this.input.value.toLowerCase().split(/\s+/).filter(Boolean);
    const hit = ({ name, label, group }: Entry) => {
      const text = `${label} ${group} ${name}`.toLowerCase();
      return words.every((word) => text.includes(word));
    };
    // Names of points are short: a word that stands there as a whole means more than a part of one.
    const meant = ({ label }: Entry) => {
      const there = new Set(label.toLowerCase().split(/[\s,]+/));
      return words.filter((word) => there.has(word)).length;
    };
    const whole = this.input.value.trim().toLowerCase();
    const begins = ({ label }: Entry) => Number(label.toLowerCase().startsWith(whole));
    const order = (a: Entry, b: Entry) =>
      whole ? begins(b) - begins(a) || meant(b) - meant(a) || a.label.length - b.label.length : 0;
    this.matches = this.entries.filter(hit).sort(order).slice(0, MOST);
    this.fill();
    this.show(true);
    this.go(words.length && this.matches.length ? 0 : -1);
  }

  private fill(): void {
    const options = this.matches.map(({ name, label, group }) =>
      h(
        "div",
        { role: "option", id: fresh("option"), "data-name": name, "aria-selected": "false" },
        h("span", {}, label),
        h("small", {}, group),
      ),
    );
    const empty = h("div", { class: "quiet", role: "option", "aria-disabled": "true" }, this.none);
    this.list.replaceChildren(...(options.length ? options : [empty]));
  }

  private close(): void {
    this.show(false);
  }

  private show(open: boolean): void {
    this.list.hidden = !open;
    if (open) this.fit();
    set(this.input, { "aria-expanded": String(open) });
    if (!open) this.go(-1);
  }

  /** Where there is room in the window, and in what scrolls: below the box, else above it. */
  private fit(): void {
    const box = this.input.getBoundingClientRect();
    const within = this.root.closest(".side")?.getBoundingClientRect();
    const below = Math.min(innerHeight, within?.bottom ?? Infinity) - box.bottom;
    const above = box.top - Math.max(0, within?.top ?? 0);
    const up = below < LEAST && above > below;
    this.list.classList.toggle("up", up);
    this.list.style.maxHeight = `${Math.max(Math.min(TALL, (up ? above : below) - 8), 60)}px`;
  }

  private go(at: number): void {
    this.at = at;
    const options = [...this.list.children];
    for (const [i, option] of options.entries()) set(option, { "aria-selected": String(i === at) });
    const option = options[at];
    set(this.input, { "aria-activedescendant": option?.id ?? null });
    option?.scrollIntoView({ block: "nearest" });
  }

  private key(event: KeyboardEvent): void {
    const count = this.matches.length;
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      if (this.list.hidden) this.open();
      const by = event.key === "ArrowDown" ? 1 : -1;
      if (count) this.go((Math.max(this.at, by > 0 ? -1 : 0) + by + count) % count);
    } else if (event.key === "Enter") {
      const entry = this.matches[this.at];
      if (!this.list.hidden && entry) this.take(entry.name);
    } else if (event.key === "Escape" && !this.list.hidden) {
      event.stopPropagation();
      this.close();
    } else return;
    event.preventDefault();
  }

  private take(name: string): void {
    this.input.value = "";
    this.close();
    this.chosen(name);
  }
}

const THIRD: Role = "third";
const PREFIX = "output.";

interface Drawn {
  strip: Strip;
  button: HTMLButtonElement;
}

export class Outputs {
  readonly root = h("div", { class: "group" });
  private readonly x = new Abscissa();
  private readonly finder: Finder;
  private readonly drawn = new Map<string, Drawn>();
  private names: string[] = [];
  private width = 0;

  constructor(
    private readonly theme: Theme,
    private readonly picked: (degrees: number) => void,
    private readonly wanted: (names: string[]) => void,
    private readonly made: (strip: Strip, output: Output) => void,
  ) {
    this.finder = new Finder(say("Any output over crank angle"), say("No output has such a name"), (name) =>
      this.add(name),
    );
    this.root.append(this.finder.root);
  }

  get strips(): Strip[] {
    return [...this.drawn.values()].map(({ strip }) => strip);
  }

  resize(width: number): void {
    this.width = width;
    for (const { strip } of this.drawn.values()) strip.resize(width);
  }

  point(degrees: number, k: number): void {
    for (const { strip } of this.drawn.values()) strip.point(degrees, k);
  }

  /** Draw the outputs whose numbers came with a state. */
  show(state: State): void {
    this.finder.call(say("Any output over crank angle")); // which goes by the machine that is open
    this.finder.offer(state.outputs);
    const there = state.numbers.names(PREFIX).map((name) => name.slice(PREFIX.length));
    const outputs = there.flatMap((name) => state.outputs.find((output) => output.name === name) ?? []);
    this.names = outputs.map(({ name }) => name);
    for (const [name, { strip }] of this.drawn) {
      if (this.names.includes(name)) continue;
      strip.close();
      this.drawn.delete(name);
    }
    for (const output of outputs) this.draw(state, output);
  }

  private draw(state: State, output: Output): void {
    const columns = column(state, `${PREFIX}${output.name}`, 1, 0, true, output.winds);
    if (!columns) return;
    const { strip, button } = this.drawn.get(output.name) ?? this.make(output);
    const title = capital(output.label);
    button.setAttribute("aria-label", say("Close chart of {output}", { output: output.label }));
    const model = { label: "", role: THIRD, ...scaled(columns, output) };
    const seen = measured(state.numbers, output.name, 1, 0, columns.values.length, output.winds);
    const curves = seen ? besides(model, times(seen, output)) : [model];
    const x = this.x.of(state.angles, state.turns);
    strip.show({ title, x, unit: output.unit, curves, log: wide(columns.values) });
  }

  private make(output: Output): Drawn {
    const { name } = output;
    const button = h(
      "button",
      { type: "button", class: "close", onclick: () => this.remove(name) },
      icon("M4 4l8 8M12 4l-8 8"),
    );
    const strip = new Strip(
      { height: 110, xAxis: true, xLabel: "°", xStep: turning, picked: this.picked, button },
      this.theme,
    );
    const drawn = { strip, button };
    this.drawn.set(name, drawn);
    this.root.append(strip.root);
    strip.resize(this.width);
    this.made(strip, output);
    return drawn;
  }

  /** Ask for the numbers of an output; they come with the state, now and after every change. */
  private add(name: string): void {
    this.wanted([...this.names.filter((other) => other !== name), name]);
  }

  private remove(name: string): void {
    const next = this.finder.root.querySelector("input");
    this.wanted(this.names.filter((other) => other !== name));
    next?.focus({ preventScroll: true });
  }
}
