/** The machine's numbers: typed with their units, or moved by sliders. */

import type { Conversation } from "./conversation";
import { h } from "./dom";
import type { Field, State } from "./protocol";
import { breakable } from "./format";
import type { Locks } from "./locks";
import { keyPath } from "./paths";
import { Row } from "./row";
import { say } from "./words";

/** x or y of a place. */
const AXIS = /^(.*)\.([xy])$/;

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
    const found = group === null ? undefined : this.groups.get(group);
    if (!found) return;
    found.open = true;
    // Only the list itself scrolls, never the page around it.
    const list = this.root.parentElement;
    if (list && list.scrollHeight > list.clientHeight + 1) {
      const above = found.offsetTop - list.offsetTop;
      const inside =
        above >= list.scrollTop && above + found.offsetHeight <= list.scrollTop + list.clientHeight;
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
    const [one, other] = [this.row(x, false), this.row(y, false)];
    const name = x.label.replace(/, x$/, "");
    return h(
      "div",
      { class: "pair" },
      h("span", { class: "name", "aria-hidden": "true" }, breakable(name)),
      one.root,
      other.root,
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
  const [first, second] = [x && AXIS.exec(x.path), y && AXIS.exec(y.path)];
  return first && second && y && first[1] === second[1] && first[2] === "x" && second[2] === "y"
    ? y
    : null;
}
