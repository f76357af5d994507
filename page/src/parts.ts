/** Everything that a model file can hold: listed, added, changed and deleted. */

import type { Aim } from "./aim";
import type { Conversation } from "./conversation";
import { h } from "./dom";
import { Form, type Subject } from "./form";
import { lengths, round } from "./format";
import type { Picked } from "./inputs";
import { question } from "./keeping";
import {
  type Group,
  keyPath,
  type Pair,
  type State,
  stepsOf,
  type TableEntry,
  type Tables,
  type Values,
} from "./protocol";
import { say } from "./words";

/** What of the page it needs. */
export interface Page {
  talk: Conversation;
  aim: Aim;
  state(): State | null;
  sample(): number;
  /** Pixels a metre. */
  scale(): number;
}

export class Parts {
  readonly root: HTMLDetailsElement;
  private readonly select = h("select", { "aria-label": say("Add to the model") });
  private readonly list = h("div", { class: "groups" });
  private readonly slot = h("div", {});
  private tables: Tables | null = null;
  private form: Form | null = null;
  private subject: Subject | null = null;
  private seen = -1;
  /** What is to be opened as soon as the tables are there. */
  private wanted: ((tables: Tables) => void) | null = null;
  /** Values of what is edited as they are in the file. */
  private original: Values = {};

  constructor(private readonly page: Page) {
    this.select.addEventListener("change", () => this.choose());
    this.root = h(
      "details",
      { class: "group parts" },
      h("summary", {}, say("Parts of the model")),
      this.slot,
      this.select,
      this.list,
    );
    this.root.addEventListener("toggle", () => this.follow());
  }

  /** The machine is another, or may be. */
  follow(): void {
    const state = this.page.state();
    if (!state || !this.root.open || state.seq === this.seen) return;
    this.seen = state.seq;
    this.page.talk.ask({ type: "tables" }, (refusal) => {
      this.select.hidden = refusal !== null; // nothing can be added yet
      if (refusal === null) return;
      this.list.replaceChildren(h("p", { class: "quiet" }, refusal));
    });
  }

  /** Another file is open: what was being typed belongs to the old one. */
  forget(): void {
    this.close();
  }

  show(tables: Tables): void {
    this.tables = tables;
    this.select.replaceChildren(
      h("option", { value: "" }, say("Add …")),
      ...tables.groups.map((group, i) => this.offer(group, i)).filter((offer) => offer !== null),
    );
    this.list.replaceChildren(
      ...tables.groups.filter(({ entries }) => entries.length).map((group) => this.listed(group)),
    );
    this.check();
    this.wanted?.(tables);
    this.wanted = null;
  }

  /**
   * Open the form of a table with some of its values: of a new one, of the only one where it is there,
   * or of what has to be there first.
   */
  add(place: string, values: Values): void {
    this.want(({ groups }) => {
      const group = groups.find((group) => group.place === place);
      if (group?.needs)
        this.begin(
          groups.find((group) => group.place === place.split(".")[0]),
          {},
        );
      else this.begin(group, values);
    });
  }

  /** Open the form of a table at a key. */
  change(place: string, key: string): void {
    this.want(({ groups }) => {
      for (const group of groups)
        for (const entry of group.entries) if (entry.place === place) this.edit(group, entry, {}, key);
    });
  }

  private want(then: (tables: Tables) => void): void {
    this.wanted = then;
    this.root.open = true;
    this.page.talk.release();
    this.page.talk.ask({ type: "tables" }, (refusal) => {
      if (refusal !== null) this.wanted = null;
    });
  }

  /** What is being edited may be another by now, or gone, as after undo. */
  private check(): void {
    const { subject, tables } = this;
    if (!subject || !tables) return;
    const group = tables.groups.find(({ where }) => where === subject.group);
    if (!group || group.needs) return this.close();
    if (!subject.known) {
      if (group.many === "list") subject.place = `${group.place}[${group.entries.length + 1}]`;
    } else {
      const entry = group.entries.find(({ where }) => where === subject.where);
      if (!entry) this.close();
      else if (!same(entry.values, this.original)) this.edit(group, entry);
    }
  }

  /** What can be added: a single one only while it is not there. */
  private offer(group: Group, i: number): HTMLOptionElement | null {
    if (group.many === "one" && group.entries.length) return null;
    const { word, of, text, needs } = group;
    const what = needs ? say("{what} (first add: {needs})", { what: word, needs }) : `${titleOf(group)}: ${text}`;
    return h("option", { value: i, disabled: !!needs, title: of ? `${of}: ${text}` : text }, what);
  }

  private listed(group: Group): HTMLElement {
    const lines = group.entries.map((entry) => {
      const name = nameOf(group, entry);
      const edit = () => void this.leave(() => this.edit(group, entry));
      return h(
        "li",
        {},
        h(
          "button",
          { type: "button", class: "plain", title: say("Change {name}", { name }), onclick: edit },
          h("b", {}, name),
          ` ${entry.words}`,
        ),
        !group.required &&
          h(
            "button",
            {
              type: "button",
              class: "step",
              "aria-label": say("Delete {name}", { name }),
              title: say("Delete {name}", { name }),
              onclick: () => this.put(entry.place, null, say("delete {name}", { name })),
            },
            "×",
          ),
      );
    });
    const result = group.result ? h("p", { class: "quiet" }, group.result) : null;
    const heading = group.many !== "one" && h("h3", { title: group.text }, titleOf(group));
    return h("section", { "aria-label": titleOf(group) }, heading, h("ul", {}, ...lines), result);
  }

  private choose(): void {
    const group = this.tables?.groups[Number(this.select.value)];
    if (!this.select.value || !group) return;
    this.select.value = "";
    void this.leave(() => this.begin(group, {}));
  }

  /** Go on from a form, if what was typed there may be lost. */
  private async leave(then: () => void): Promise<void> {
    if (this.form?.changed && this.subject) {
      const text = say("What was typed at “{heading}” is not saved.", { heading: this.subject.heading });
      if (!(await question(this.root, text, say("Discard")))) return;
    }
    then();
  }

  private begin(group: Group | undefined, values: Values): void {
    if (!group) return;
    const [entry] = group.entries;
    if (group.many === "one" && entry) return this.edit(group, entry, values, Object.keys(values).at(-1));
    const { many, entries, place, where } = group;
    const number = many === "list" ? `[${entries.length + 1}]` : "";
    this.open({
      heading: say("New: {what}", { what: titleOf(group) }),
      text: group.text,
      form: group.form,
      group: where,
      place: place + number,
      where: where + number,
      name: many === "named" ? "" : null,
      values,
      below: [],
      known: false,
      deletable: false,
    });
  }

  private edit(group: Group, entry: TableEntry, values: Values = {}, key = ""): void {
    this.open({
      heading: nameOf(group, entry),
      text: group.text,
      form: group.form,
      group: group.where,
      place: entry.place,
      where: entry.where,
      name: group.many === "named" ? lastOf(entry) : null,
      values: { ...entry.values, ...values },
      below: entry.below,
      known: true,
      deletable: !group.required,
    });
    this.original = entry.values;
    if (key) this.slot.querySelector<HTMLElement>(`[data-key="${key}"] :is(input, select)`)?.focus();
  }

  private open(subject: Subject): void {
    if (!this.tables) return;
    this.close();
    const form = new Form(subject, this.tables, {
      saved: (place, values, name, files) => this.save(subject, place, values, name, files),
      deleted: (place) => this.put(place, null, say("delete {name}", { name: subject.heading })),
      closed: () => this.close(),
      pick: (body, named, taken) => void this.pick(body, named, taken),
    });
    this.form = form;
    this.subject = subject;
    this.slot.replaceChildren(form.root);
    form.root.scrollIntoView({ block: "nearest" });
    form.focus();
  }

  private close(): void {
    this.page.aim.end();
    this.form = this.subject = null;
    this.slot.replaceChildren();
  }

  private save(
    subject: Subject,
    place: string,
    values: Values,
    name: string | null,
    files: Record<string, string>,
  ): void {
    // What is as it was is no step.
    if (subject.known && name === subject.name && same(values, this.original)) return this.close();
    const at = subject.name === "" ? `${place}.${keyPath(name ?? "")}` : place;
    const more = { ...(name && { name }), ...(Object.keys(files).length && { files }) };
    this.put(at, values, subject.heading, more);
  }

  private put(place: string, values: Values | null, label: string, more: object = {}): void {
    const { talk } = this.page;
    const form = this.form;
    talk.release();
    talk.ask({ type: "entry", label, place, values, ...more }, (refusal, refused) => {
      if (refusal !== null && form && form === this.form) form.refused(refusal, refused);
      else if (form === this.form) this.close();
    });
  }

  /** Let a place be picked on the drawing, in the axes of a body. */
  private async pick(body: string, named: boolean, taken: (picked: Picked) => void): Promise<void> {
    const prompt = named
      ? say("Click a point or a link on the drawing, or go there with the arrow keys and press Enter.")
      : say("Click the place on the drawing, or go there with the arrow keys and press Enter.");
    const spot = await this.page.aim.ask(prompt);
    if (!spot) return;
    const [x, y] = this.inAxesOf(body, spot.at).map((value) => this.written(value)) as [string, string];
    taken({ point: spot.point, link: spot.link, place: [x, y] });
  }

  /** A place of the frame in the axes of a link, m. */
  private inAxesOf(body: string, [x, y]: Pair): Pair {
    const numbers = this.page.state()?.numbers;
    const angle = numbers?.get(`angle.${body}`);
    const [point, own] = Object.entries(this.tables?.bodies[body] ?? {})[0] ?? [];
    const there = point === undefined ? undefined : numbers?.get(`place.${point}`);
    if (!angle || !there || !own) return [x, y];
    const k = this.page.sample();
    const turn = -(angle[k] as number);
    const [dx, dy] = [x - (there[2 * k] as number), y - (there[2 * k + 1] as number)];
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    return [own[0] + dx * c - dy * s, own[1] + dx * s + dy * c];
  }

  /** As finely as a pixel resolves. */
  written(metres: number): string {
    const { unit, factor } = lengths();
    const digits = Math.max(0, -Math.floor(Math.log10(round(factor / this.page.scale()) / 4)));
    const text = (metres * factor).toFixed(Math.min(digits, 9));
    return `${Number(text)} ${unit}`;
  }
}

/** What the tables of a group are called: "bodies of crank". */
function titleOf({ word, of }: Group): string {
  return of ? say("{what} of {name}", { what: word, name: of }) : word;
}

function nameOf(group: Group, entry: TableEntry): string {
  if (group.many === "named") return lastOf(entry);
  return group.many === "list" ? `${group.word} ${Number(lastOf(entry)) + 1}` : titleOf(group);
}

/** The name of an entry, or its number in a list from 0. */
function lastOf({ place }: TableEntry): string {
  return String(stepsOf(place).pop());
}

function same(first: Values, second: Values): boolean {
  const keys = new Set([...Object.keys(first), ...Object.keys(second)]);
  return [...keys].every((key) => JSON.stringify(first[key]) === JSON.stringify(second[key]));
}
