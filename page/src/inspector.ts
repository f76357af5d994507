/**
 * The machine's numbers: typed with their units, stepped by keys, or moved by sliders, with lengths
 * that are locked.
 */

import type { Conversation } from "./conversation";
import { cureOf, withCure } from "./cure";
import { fresh, h, icon, put, set, show, write } from "./dom";
import { asTyped, breakable, decimals } from "./format";
import { Gesture } from "./gesture";
import { type Field, keyPath, type Refused, type State } from "./protocol";
import { say } from "./words";

const OPEN = "M4 7.500h8v6H4zM5.500 7.500V5a2.500 2.500 0 0 1 4.800-1";
const SHUT = "M4 7.500h8v6H4zM5.500 7.500V5a2.500 2.500 0 0 1 5 0v2.500";

export type Ends = [string, string];

export class Locks {
  private readonly pairs = new Map<string, Ends>();

  /** Another machine has locks of its own. */
  forget(): void {
    this.pairs.clear();
  }

  /** Points from which a point keeps its distance. */
  keep(point: string): string[] {
    const pairs = [...this.pairs.values()].filter((ends) => ends.includes(point));
    return [...new Set(pairs.map(([first, second]) => (first === point ? second : first)))];
  }

  /** A button that locks a length and unlocks it. */
  button(ends: Ends, name: string): HTMLButtonElement {
    const key = JSON.stringify([...ends].sort());
    const button = h("button", { type: "button", class: "lock", "aria-label": say("Lock {name}", { name }) });
    const show = () => {
      const on = this.pairs.has(key);
      set(button, { "aria-pressed": String(on) });
      button.replaceChildren(icon(on ? SHUT : OPEN));
    };
    button.addEventListener("click", () => {
      if (!this.pairs.delete(key)) this.pairs.set(key, ends);
      show();
    });
    show();
    return button;
  }
}

const STEPS = 1000;
/** Of a number that is dragged. */
const DIGITS = 5;
/** A held key pauses no longer than this between two of its events, ms. */
const PAUSE = 600;

export class Row {
  readonly root: HTMLElement;
  private readonly input: HTMLInputElement;
  private readonly slider: HTMLInputElement | null = null;
  private readonly error = h("p", {
    class: "error",
    id: fresh("error"),
    role: "alert",
    hidden: true,
  });
  private gesture: Gesture | null = null;
  private exact = "";
  private typing = false;
  /** What has been asked for and is not answered yet: leaving the field does not ask again. */
  private pending: string | null = null;

  constructor(
    private field: Field,
    slider: boolean,
    private readonly talk: Conversation,
    private readonly holding: (on: boolean) => void,
    /** Points from which a point is to keep its distance. */
    private readonly kept: (point: string) => string[],
  ) {
    const name = `${field.heading} ${field.label}`;
    this.input = h("input", {
      type: "text",
      class: "number",
      "aria-label": name,
      "data-path": field.path,
      autocomplete: "off",
      autocapitalize: "off",
      spellcheck: "false",
      inputmode: "text",
    });
    this.input.addEventListener("focus", () => this.focus());
    this.input.addEventListener("input", () => {
      this.typing = true;
      this.pending = null;
      this.input.dataset.typed = "";
    });
    this.input.addEventListener("blur", () => this.commit());
    this.input.addEventListener("keydown", (event) => this.key(event));
    if (slider) this.slider = this.makeSlider(say("{name} slider", { name }));
    const axis = field.path.slice(-1);
    const label = slider
      ? h("span", { class: "name", "aria-hidden": "true" }, breakable(field.label))
      : h("span", { class: "axis", "aria-hidden": "true" }, axis);
    this.root = h("div", { class: slider ? "row" : "half" }, label, this.slider, this.input, this.error);
  }

  show(field: Field): void {
    const follows = this.field.shown !== field.shown; // as an expression does, whose text stays
    this.field = field;
    if (this.exact !== field.text || follows) {
      this.exact = field.text;
      this.input.title = decimals(field.text);
      if (!this.typing) this.input.value = decimals(this.focused ? field.text : field.shown);
      if (!this.typing) this.complain(null);
    }
    if (this.slider && !this.gesture) this.place(this.slider);
  }

  forget(): void {
    if (this.typing) this.revert();
  }

  private get focused(): boolean {
    return (this.input.getRootNode() as Document | ShadowRoot).activeElement === this.input;
  }

  private focus(): void {
    if (!this.typing) this.input.value = decimals(this.exact);
    this.input.select();
  }

  private key(event: KeyboardEvent): void {
    if (event.key === "Enter") this.commit();
    else if (event.key === "Escape") {
      event.stopPropagation();
      this.revert();
    } else if ((event.key === "ArrowUp" || event.key === "ArrowDown") && !event.altKey) {
      event.preventDefault();
      this.nudge((event.key === "ArrowUp" ? 1 : -1) * (event.shiftKey ? 10 : 1), event.timeStamp);
    }
  }

  private revert(): void {
    this.typing = false;
    delete this.input.dataset.typed;
    this.complain(null);
    this.input.value = decimals(this.focused ? this.exact : this.field.shown);
  }

  private commit(): void {
    this.gesture?.end();
    const text = asTyped(this.input.value);
    if (text === this.pending) return;
    if (!this.typing || text === this.exact || text === "") return this.revert();
    this.pending = text;
    this.talk.release();
    const { path, unit } = this.field;
    const bare = Number.isFinite(Number(text));
    const edits = [{ set: path, text: bare ? `${text} ${unit}` : text, ...this.keep }];
    this.talk.ask({ type: "edit", commit: true, label: this.label, edits }, (refusal, refused) => {
      this.pending = null;
      if (refusal === null) this.typing = false;
      this.complain(refusal, refused);
      if (refusal === null) this.revert();
    });
  }

  /** The last digit that is shown, up or down. */
  private nudge(by: number, stamp: number): void {
    this.typing = false;
    const { min, max, step, value } = this.field;
    const size = step ?? (typeof min === "number" && typeof max === "number" ? (max - min) / STEPS : 0);
    if (size) this.attempt(value + by * size, stamp);
    this.gesture?.endSoon(PAUSE);
  }

  private attempt(value: number, stamp: number): void {
    if (!this.gesture) {
      this.talk.release();
      this.holding(true);
      this.gesture = new Gesture(this.talk, this.label, () => {
        this.gesture = null;
        this.holding(false);
      });
    }
    const { path, factor, unit } = this.field;
    const text = `${Number((value * factor).toPrecision(DIGITS))} ${unit}`;
    this.gesture.move([{ set: path, text, ...this.keep }], stamp);
  }

  /** What stays as it is locked, whatever the number becomes. */
  private get keep(): { keep?: string[] } {
    const { moves } = this.field;
    return moves ? { keep: this.kept(moves) } : {};
  }

  private get label(): string {
    return `${this.field.heading} ${this.field.label}`;
  }

  private makeSlider(name: string): HTMLInputElement {
    const slider = h("input", { type: "range", min: 0, max: STEPS, step: 1, "aria-label": name });
    slider.addEventListener("input", (event) => {
      const { min, max } = this.field;
      const part = Number(slider.value) / STEPS;
      this.attempt((min ?? 0) + part * ((max ?? 1) - (min ?? 0)), event.timeStamp);
      slider.style.setProperty("--part", String(part));
    });
    // Each step by a key ends with a change event; a pointer causes one when it is released.
    slider.addEventListener("change", () => this.gesture?.endSoon(PAUSE));
    for (const name of ["pointerup", "blur"]) slider.addEventListener(name, () => this.gesture?.end());
    return slider;
  }

  private place(slider: HTMLInputElement): void {
    const { min, max, value } = this.field;
    const [low, high] = [min ?? 0, max ?? 1];
    const part = high > low ? (value - low) / (high - low) : 0;
    const [step, text] = [String(Math.round(part * STEPS)), part.toFixed(3)];
    // Most numbers stay while one is dragged, and what is written is laid out again.
    put(slider, step);
    if (slider.style.getPropertyValue("--part") !== text) slider.style.setProperty("--part", text);
    set(slider, { "aria-valuetext": decimals(this.field.shown) });
  }

  private complain(message: string | null, refused: Refused | null = null): void {
    show(this.error, message !== null);
    write(this.error, message ?? "");
    withCure(this.error, cureOf(refused));
    set(this.input, {
      "aria-invalid": message !== null && "true",
      "aria-describedby": message !== null && this.error.id,
    });
  }
}

/** The group of a body's counterweight stands below the body's own. */
const WEIGHT = "counterweight on ";

export class Inspector {
  readonly root = h("div", { class: "fields" });
  private shape: string | null = null;
  private rows = new Map<string, Row>();
  private groups = new Map<string, HTMLDetailsElement>();

  constructor(
    private readonly talk: Conversation,
    private readonly holding: (on: boolean) => void,
    private readonly locks: Locks,
  ) {}

  show(state: State): void {
    const shape = state.fields.map((field) => field.path).join();
    if (shape !== this.shape) this.build(state.fields, shape);
    for (const field of state.fields) this.rows.get(field.path)?.show(field);
  }

  /** Another machine has numbers and locks of its own. */
  anew(): void {
    this.locks.forget();
    this.shape = null;
  }

  /** Give back every number that was typed but not taken. */
  forget(): void {
    for (const row of this.rows.values()) row.forget();
  }

  /** Open the group of a link or of the frame, and bring it into sight. */
  choose(group: string | null, point: string | null): void {
    for (const [name, details] of this.groups) details.classList.toggle("chosen", name === group);
    for (const [path, row] of this.rows) {
      row.root.classList.toggle("chosen", !!point && path.includes(`.${keyPath("points", point)}.`));
    }
    const opened = group === null ? undefined : this.groups.get(group);
    if (!opened) return;
    opened.open = true;
    // Only the list itself scrolls, never the page around it.
    const list = this.root.parentElement;
    if (list && list.scrollHeight > list.clientHeight + 1) {
      const above = opened.offsetTop - list.offsetTop;
      const inside = above >= list.scrollTop && above + opened.offsetHeight <= list.scrollTop + list.clientHeight;
      if (!inside) list.scrollTo({ top: above, behavior: "smooth" });
    }
  }

  /** Show a group, and go to its first number. */
  enter(group: string): void {
    this.choose(group, null);
    this.groups.get(group)?.querySelector<HTMLElement>("input")?.focus();
  }

  private build(fields: Field[], shape: string): void {
    this.shape = shape;
    this.rows.clear();
    const closed = new Set([...this.groups].filter(([, d]) => !d.open).map(([name]) => name));
    this.groups.clear();
    for (const [group, members] of ordered(fields)) {
      const list = h("div", { class: "rows" });
      members.forEach((field, i) => {
        const twin = partner(field, members[i + 1]);
        if (partner(members[i - 1], field)) return;
        list.append(twin ? this.pair(field, twin) : this.row(field, true).root);
      });
      const details = h("details", { class: "group" }, h("summary", {}, members[0]?.heading ?? group), list);
      details.open = !closed.has(group);
      this.groups.set(group, details);
    }
    const words = say(
      "Lengths and masses appear here as soon as there is a link: choose Link above the drawing, then click where it begins and where it ends.",
    );
    this.root.replaceChildren(...this.groups.values(), ...(fields.length ? [] : [h("p", { class: "quiet" }, words)]));
  }

  private row(field: Field, slider: boolean): Row {
    const row = new Row(field, slider, this.talk, this.holding, (point) => this.locks.keep(point));
    if (field.between) {
      const name = `${field.heading} ${field.label}`;
      row.root.insertBefore(this.locks.button(field.between, name), row.root.lastChild);
      row.root.classList.add("locked");
    }
    this.rows.set(field.path, row);
    return row;
  }

  /** x and y beside each other. */
  private pair(x: Field, y: Field): HTMLElement {
    const [first, second] = [this.row(x, false), this.row(y, false)];
    return h(
      "div",
      { class: "pair" },
      h("span", { class: "name", "aria-hidden": "true" }, breakable(x.pair ?? x.label)),
      first.root,
      second.root,
    );
  }
}

function ordered(fields: Field[]): Map<string, Field[]> {
  const groups = new Map<string, Field[]>();
  for (const field of fields) {
    const members = groups.get(field.group);
    if (members) members.push(field);
    else groups.set(field.group, [field]);
  }
  const sorted = new Map<string, Field[]>();
  for (const [name, members] of groups) {
    if (name.startsWith(WEIGHT)) continue;
    sorted.set(name, members);
    const weight = groups.get(WEIGHT + name);
    if (weight) sorted.set(WEIGHT + name, weight);
  }
  return sorted;
}

function partner(x: Field | undefined, y: Field | undefined): Field | null {
  return x?.pair !== undefined && y?.pair === x.pair && x.path.endsWith(".x") ? y : null;
}
