/** One number of the machine: typed, stepped by keys, or moved by its slider. */

import { asTyped, decimals } from "./decimals";
import type { Conversation } from "./conversation";
import { cureOf, withCure } from "./cure";
import { fresh, h, put, set, show, write } from "./dom";
import { Gesture } from "./gesture";
import type { Field, Refused } from "./protocol";
import { breakable } from "./format";
import { say } from "./words";

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
  private asked: string | null = null;

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
      this.asked = null;
      this.input.dataset.typed = "";
    });
    this.input.addEventListener("blur", () => this.commit());
    this.input.addEventListener("keydown", (event) => this.key(event));
    if (slider) this.slider = this.makeSlider(say("{name} slider", { name }));
    const axis = field.path.slice(-1);
    const label = slider
      ? h("span", { class: "name", "aria-hidden": "true" }, breakable(field.label))
      : h("span", { class: "axis", "aria-hidden": "true" }, axis);
    this.root = h(
      "div",
      { class: slider ? "row" : "half" },
      label,
      this.slider,
      this.input,
      this.error,
    );
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
    if (text === this.asked) return;
    if (!this.typing || text === this.exact || text === "") return this.revert();
    this.asked = text;
    this.talk.release();
    const { path, unit } = this.field;
    const bare = Number.isFinite(Number(text));
    const edits = [{ set: path, text: bare ? `${text} ${unit}` : text, ...this.keep }];
    this.talk.ask({ type: "edit", commit: true, label: this.label, edits }, (refusal, told) => {
      this.asked = null;
      if (refusal === null) this.typing = false;
      this.complain(refusal, told);
      if (refusal === null) this.revert();
    });
  }

  /** The last digit that is shown, up or down. */
  private nudge(by: number, stamp: number): void {
    this.typing = false;
    const { min, max, step, value } = this.field;
    const size =
      step ?? (typeof min === "number" && typeof max === "number" ? (max - min) / STEPS : 0);
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
    // Keys tell of each step that it is the last one; a pointer tells when it lets go.
    slider.addEventListener("change", () => this.gesture?.endSoon(PAUSE));
    for (const name of ["pointerup", "blur"])
      slider.addEventListener(name, () => this.gesture?.end());
    return slider;
  }

  private place(slider: HTMLInputElement): void {
    const { min, max, value } = this.field;
    const [low, high] = [min ?? 0, max ?? 1];
    const part = high > low ? (value - low) / (high - low) : 0;
    const [step, shown] = [String(Math.round(part * STEPS)), part.toFixed(3)];
    // Most numbers stay while one is dragged, and what is written is laid out again.
    put(slider, step);
    if (slider.style.getPropertyValue("--part") !== shown)
      slider.style.setProperty("--part", shown);
    set(slider, { "aria-valuetext": decimals(this.field.shown) });
  }

  private complain(message: string | null, told: Refused | null = null): void {
    show(this.error, message !== null);
    write(this.error, message ?? "");
    withCure(this.error, cureOf(told));
    set(this.input, {
      "aria-invalid": message !== null && "true",
      "aria-describedby": message !== null && this.error.id,
    });
  }
}
