/** What the machine is called, what its file says of it, and what is to be known. */

import { h } from "./dom";
import type { State } from "./protocol";

export class Heading {
  readonly about = h("details", { class: "about" });
  readonly notes = h("div", { class: "notes" });
  private shown = "";

  show(state: State): void {
    const told = [state.name, state.title, state.description].join("\n");
    if (told !== this.shown) {
      this.shown = told;
      const text = state.description.trim() || "This file says nothing more in words.";
      this.about.replaceChildren(
        h("summary", {}, h("h1", {}, state.title || state.name)),
        h("p", {}, text),
      );
    }
    if (this.notes.textContent !== state.notes.join("")) {
      this.notes.replaceChildren(...state.notes.map((note) => h("p", {}, note)));
    }
  }
}
