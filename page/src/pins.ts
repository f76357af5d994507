/** Figures that are pinned on the drawing: which, and what they are. */

import { h, write } from "./dom";
import { say } from "./words";

const KEPT = "equipoise-pinned";

/** A figure in words: of what it is, and its values. */
export interface Reading {
  name: string;
  label: string;
  text: string;
}

export class Pins {
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
    pinned.forEach(({ text }, i) => write(this.root.children[i]?.lastElementChild as Element, text));
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
