/** What is seen besides the machine: arrows at a point, a pale design, a support that moves. */

import { Arrows } from "./arrows";
import { h, put, show } from "./dom";
import { unbroken } from "./format";
import { Ghost } from "./ghost";
import { type ArrowOf, type Asked, Numbers, type ResponseMessage, type State } from "./protocol";
import type { Stage } from "./stage";
import { Support } from "./support";
import { Variants } from "./variants";
import { say } from "./words";

export class Seeing {
  readonly root: HTMLElement;
  readonly variants: Variants;
  private readonly arrows = new Arrows();
  private readonly ghost = new Ghost();
  private readonly support = new Support(() => this.again());
  private readonly at: HTMLSelectElement;
  private readonly kinds: HTMLElement;
  private readonly record = h("p", { class: "quiet", role: "status", hidden: true });
  private readonly told = h("p", { class: "quiet", role: "status" });
  private state: State | null = null;
  private offered = "";
  private recorded = "";

  constructor(
    private readonly stage: Stage,
    private readonly ask: (asked: Asked) => void,
    private readonly changed: () => void,
  ) {
    this.variants = new Variants(ask);
    this.at = h("select", {
      "aria-label": say("Arrows at"),
      onchange: () => this.ask({ type: "arrows", point: this.at.value }),
    });
    const kind = (name: ArrowOf["kind"], text: string) => {
      const box = h("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => {
        if (box.checked) this.arrows.kinds.add(name);
        else this.arrows.kinds.delete(name);
        this.again();
      });
      return h("label", { class: name }, box, text);
    };
    this.kinds = h(
      "span",
      { class: "kinds", role: "group", "aria-label": say("Arrows"), hidden: true },
      kind("velocity", say("velocity")),
      kind("acceleration", say("acceleration")),
      kind("force", say("force")),
    );
    this.root = h(
      "div",
      { class: "seeing" },
      h("label", { class: "arrowed" }, h("span", {}, say("Arrows at")), this.at),
      this.kinds,
      this.support.root,
      this.variants.choice,
      this.arrows.legend,
      this.told,
      this.record,
    );
    stage.overlay(this.ghost, "signs");
    stage.overlay(this.arrows, "ghost");
  }

  /** Take a state, before the drawing shows it. */
  show(state: State, other: boolean): void {
    this.state = state;
    this.support.show(state, other);
    show(this.kinds, !!state.arrows_at);
    this.offer(state);
    this.tell();
    this.beside(state.record);
  }

  /** What was measured, and a button that takes it away. */
  private beside(record: State["record"]): void {
    const left = record?.left_out.join(", ") ?? "";
    const parts = record ? [say("Record {name}", { name: record.name }), ...record.told] : [];
    if (left) parts.push(say("no outputs of this machine: {names}", { names: left }));
    const text = unbroken(parts.join("; "));
    if (this.recorded === text) return;
    this.recorded = text;
    this.record.hidden = !text;
    const remove = () => this.ask({ type: "record", name: "", text: "" });
    this.record.replaceChildren(
      `${text} `,
      h("button", { type: "button", onclick: remove }, say("Remove the record")),
    );
  }

  answered(message: ResponseMessage, numbers: Numbers): void {
    this.support.take(message, numbers);
    // While something is held the support stands still, and nothing is to be drawn anew.
    if (this.support.held) this.tell();
    else this.again();
  }

  /** Take the drawing of a pale design. */
  pale(scene: State["scene"] | null, numbers: Numbers): void {
    this.ghost.take(scene, numbers);
    this.again();
  }

  hold(on: boolean): void {
    this.support.held = on;
  }

  /** The crank's sample that is to be drawn, while the clock is at `k`. */
  crank(k: number): number {
    const sample = this.support.crank(k, this.state?.angles ?? 1);
    this.stage.swing = this.support.swing;
    return sample;
  }

  /** Arrows go to what is chosen, where there are any. */
  choose(point: string): void {
    const { state } = this;
    if (state?.arrows_at && state.arrows_at !== point && state.points.includes(point))
      this.ask({ type: "arrows", point });
  }

  private again(): void {
    if (this.state) this.arrows.show(this.state);
    this.tell();
    this.changed();
  }

  private tell(): void {
    const lines = this.support.told;
    const text = lines.join("; ");
    if (this.told.textContent !== text) this.told.textContent = text;
    show(this.told, !!text);
    show(this.arrows.legend, !!this.state?.arrows_at);
  }

  private offer(state: State): void {
    const shape = state.points.join("\n");
    if (shape !== this.offered) {
      this.offered = shape;
      const options = state.points.map((name) => h("option", { value: name }, name));
      this.at.replaceChildren(h("option", { value: "" }, say("no point")), ...options);
    }
    put(this.at, state.arrows_at ?? "");
  }
}
