/** What the machine is called, what its file says of it, and what is to be known. */

import { h } from "./dom";
import type { State } from "./protocol";
import { render, v } from "./render";
import { say } from "./words";

export class Heading {
  readonly about = h("details", { class: "about" });
  readonly notes = h("div", { class: "notes", role: "status" });
  private later = new Map<string, string[]>();

  /** Notes that come after a state, by their source: they stay until that sends others. */
  also(of: string, notes: string[]): void {
    this.later.set(of, notes);
  }

  /** Another machine has no such notes yet. */
  forget(): void {
    this.later.clear();
  }

  show(state: State): void {
    const text = state.description.trim() || say("This file has no description.");
    render(this.about, v("summary", {}, v("h1", {}, state.title || state.name)), v("p", {}, text));
    const notes = [...new Set([state.notes, ...this.later.values()].flat())];
    render(this.notes, ...notes.map((note) => v("p", {}, note)));
  }
}
