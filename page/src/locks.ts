/** Lengths that are locked: a point that is dragged keeps its distance from the other end. */

import { h, icon, set } from "./dom";
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
    const found = [...this.pairs.values()].filter((ends) => ends.includes(point));
    return [...new Set(found.map(([one, other]) => (one === point ? other : one)))];
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

