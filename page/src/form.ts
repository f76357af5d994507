/**
 * The form of one table of a model file: a control for each key, as the server sends them, and which
 * keys go together.
 */

import { cureOf, withCure } from "./cure";
import { fresh, h, set, write } from "./dom";
import { type Around, type Input, input, type Picked } from "./inputs";
import { type Control, type Plain, type Refused, type Rule, stepsOf, type Tables, type Values } from "./protocol";
import { say } from "./words";

interface Demands {
  /** Keys that have to be given, and keys that have no place. */
  needed: Set<string>;
  out: Set<string>;
}

function demandsOf(rule: Rule, values: Values): Demands {
  const demands: Demands = { needed: new Set(), out: new Set() };
  collect(rule, values, demands);
  return demands;
}

function collect(rule: Rule, values: Values, demands: Demands): void {
  for (const key of rule.required ?? []) demands.needed.add(key);
  for (const key of barred(rule)) demands.out.add(key);
  for (const inner of rule.allOf ?? []) collect(inner, values, demands);
  if (rule.if) collect((matches(rule.if, values) ? rule.then : rule.else) ?? {}, values, demands);
  for (const needed of present(rule.dependentRequired, values)) for (const key of needed) demands.needed.add(key);
  for (const inner of present(rule.dependentSchemas, values)) collect(inner, values, demands);
  if (rule.oneOf) choose(rule.oneOf, values, demands);
}

/** What depends on the keys that are given. */
function present<Dependent>(dependents: Record<string, Dependent> | undefined, values: Values): Dependent[] {
  return Object.entries(dependents ?? {}).flatMap(([key, dependent]) => (key in values ? [dependent] : []));
}

/** Of several ways one is taken once the others contradict what is given. */
function choose(ways: Rule[], values: Values, demands: Demands): void {
  const left = ways.filter((way) => !barred(way).some((key) => key in values));
  const [only] = left;
  if (only && left.length === 1) return collect(only, values, demands);
  const whole = left.filter((way) => way.required?.every((key) => key in values));
  const [taken] = whole;
  if (!taken || whole.length !== 1) return;
  for (const way of left)
    for (const key of way.required ?? []) if (!taken.required?.includes(key)) demands.out.add(key);
}

function barred(rule: Rule): string[] {
  const properties = Object.entries(rule.properties ?? {});
  return properties.filter(([, wanted]) => wanted === false).map(([key]) => key);
}

function matches(rule: Rule, values: Values): boolean {
  const { required = [], properties = {}, anyOf, allOf, not } = rule;
  return (
    required.every((key) => key in values) &&
    Object.entries(properties).every(([key, wanted]) => {
      const value = values[key];
      return value === undefined || (wanted !== false && suits(wanted, value));
    }) &&
    (!anyOf || anyOf.some((inner) => matches(inner, values))) &&
    (!allOf || allOf.every((inner) => matches(inner, values))) &&
    (!not || !matches(not, values))
  );
}

function suits(wanted: { const?: Plain; enum?: Plain[] }, value: Plain): boolean {
  if (wanted.const !== undefined) return wanted.const === value;
  return !wanted.enum || wanted.enum.includes(value);
}

/** What is edited: a table that there is, or a new one. */
export interface Subject {
  heading: string;
  text: string;
  form: string;
  /** Path of the key below which it stands. */
  group: string;
  /** Its path in the file; of a new one with a name that of what it goes into. */
  place: string;
  /** Its path, as in refusals. */
  where: string;
  /** Of one that has a name: that name, empty where it is new. */
  name: string | null;
  values: Values;
  /** Keys of the tables below it. */
  below: string[];
  /** Whether it is there already, and whether it may be deleted. */
  known: boolean;
  deletable: boolean;
}

interface FormEvents {
  saved(place: string, values: Values, name: string | null, files: Record<string, string>): void;
  deleted(place: string): void;
  closed(): void;
  pick(body: string, named: boolean, taken: (picked: Picked) => void): void;
}

/** What a value is given in. */
const GIVEN = "input, select";
/** In place of a key, the name of what is edited. */
const NAME = "";

export class Form {
  readonly root: HTMLFormElement;
  private readonly inputs = new Map<string, Input>();
  private readonly errors = new Map<string, HTMLElement>();
  private readonly rows = new Map<string, HTMLElement>();
  private readonly controls: Control[];
  /** Keys that have to be given. */
  private readonly needed = new Set<string>();
  private readonly name: HTMLInputElement | null;
  private readonly problem = h("p", { class: "error", role: "alert", hidden: true });
  private readonly files: Record<string, string> = {};
  /** What was given when it was opened. */
  private readonly before: string;

  constructor(
    private readonly subject: Subject,
    private readonly tables: Tables,
    private readonly events: FormEvents,
  ) {
    const { heading, text, deletable } = subject;
    this.root = h("form", { class: "part-form", "aria-label": heading, novalidate: true });
    this.name = subject.name === null ? null : h("input", { type: "text", class: "value" });
    this.root.append(h("h2", {}, heading), h("p", { class: "quiet" }, text));
    if (this.name) this.root.append(this.named(this.name, subject.name ?? ""));
    const around = this.around(tables);
    this.controls = tables.forms[subject.form]?.controls ?? [];
    for (const control of this.controls) this.root.append(this.row(control, around));
    this.root.append(
      this.problem,
      h(
        "div",
        { class: "buttons" },
        h("button", { type: "submit", class: "strong" }, say("Save")),
        h("button", { type: "button", onclick: () => events.closed() }, say("Cancel")),
        deletable && h("button", { type: "button", onclick: () => this.delete() }, say("Delete")),
      ),
    );
    this.listen();
    this.follow();
    this.before = this.content();
  }

  /** Whether anything was typed or chosen that is not saved. */
  get changed(): boolean {
    return this.content() !== this.before;
  }

  private content(): string {
    return JSON.stringify([this.name?.value, this.entered(), this.files]);
  }

  focus(): void {
    this.root.querySelector<HTMLElement>("input, select")?.focus();
  }

  /** Say at its key why it is not taken. */
  refused(message: string, refused: Refused | null): void {
    const { path, what } = refused ?? {};
    const key = path === undefined ? null : keyOf(path, this.subject.where);
    const here = key !== null || path === this.subject.where;
    const text = path === undefined || here ? (what ?? message) : message;
    if (key !== null && this.errors.has(key)) this.wrong(key, text, cureOf(refused))?.focus();
    else this.say(this.problem, text, cureOf(refused));
  }

  /** Say at a key what is wrong, and give back what it is typed into. */
  private wrong(key: string, text: string, cure: HTMLElement | null = null): HTMLElement | null {
    const line = this.errors.get(key) as HTMLElement;
    this.say(line, text, cure);
    const row = line.parentElement as HTMLElement;
    const first = row.querySelector<HTMLElement>(GIVEN);
    set(first ?? row, { "aria-invalid": "true", "aria-errormessage": line.id });
    return first;
  }

  /** Ask at its field for each thing that has to be given, and is not; whether any is. */
  private asks(values: Values, name: string | null): boolean {
    const lacking = this.controls.filter(({ key }) => this.needed.has(key) && !(key in values));
    const fields = lacking.map((control) => this.wrong(control.key, wantOf(control)));
    if (name === "") fields.unshift(this.wrong(NAME, say("Give it a name.")));
    fields[0]?.focus();
    return fields.length > 0;
  }

  /** Show the keys that go with what is given, and mark those that have to be. */
  private follow(): void {
    const { form, below } = this.subject;
    const beside = Object.fromEntries(below.map((key) => [key, true]));
    const { needed, out } = demandsOf(this.tables.forms[form]?.rule ?? {}, { ...this.entered(), ...beside });
    this.needed.clear();
    for (const { key, required } of this.controls) {
      const row = this.rows.get(key) as HTMLElement;
      row.hidden = out.has(key);
      if (!row.hidden && (required || needed.has(key))) this.needed.add(key);
      row.querySelector(".needed")?.toggleAttribute("hidden", !this.needed.has(key));
    }
    for (const input of this.inputs.values()) input.refresh?.();
  }

  /** What is given of the keys that are shown. */
  private entered(): Values {
    const values: Values = {};
    for (const [key, input] of this.inputs) {
      const value = this.rows.get(key)?.hidden ? undefined : input.value();
      if (value !== undefined) values[key] = value;
    }
    return values;
  }

  private say(line: HTMLElement, text: string, cure: HTMLElement | null = null): void {
    write(line, text);
    withCure(line, cure);
    line.hidden = !text;
  }

  private delete(): void {
    this.hush();
    this.events.deleted(this.subject.place);
  }

  private hush(): void {
    for (const line of [this.problem, ...this.errors.values()]) this.say(line, "");
    for (const invalid of this.root.querySelectorAll("[aria-invalid]"))
      set(invalid, { "aria-invalid": null, "aria-errormessage": null });
  }

  private listen(): void {
    this.root.addEventListener("submit", (event) => {
      event.preventDefault();
      this.hush();
      const values = this.entered();
      const name = this.name ? this.name.value.trim() : null;
      if (!this.asks(values, name)) this.events.saved(this.subject.place, values, name, this.files);
    });
    this.root.addEventListener("change", () => this.follow());
    this.root.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.stopPropagation();
      this.events.closed();
    });
    this.root.addEventListener("input", ({ target }) => {
      // What is typed here has its own undo.
      if (target instanceof HTMLInputElement) target.dataset.typed = "";
      // At once: a row that went only when the mouse is pressed would take its click from the button below.
      this.follow();
    });
  }

  private around(tables: Tables): Around {
    const [table, name] = stepsOf(this.subject.place);
    const body = table === "links" && typeof name === "string" ? name : "frame";
    return {
      bodies: tables.bodies,
      outputs: tables.outputs,
      body,
      beside: (key) => this.inputs.get(key)?.value(),
      put: (key, value) => this.inputs.get(key)?.set(value),
      pick: (of, named, taken) => this.events.pick(of, named, taken),
      file: (name, text) => (this.files[name] = text),
    };
  }

  private named(field: HTMLInputElement, name: string): HTMLElement {
    field.value = name;
    set(field, { "aria-label": say("name"), autocomplete: "off", spellcheck: "false" });
    const word = h("span", { class: "word" }, say("name"));
    return h("div", { class: "key" }, word, field, this.lineOf(NAME));
  }

  private row(control: Control, around: Around): HTMLElement {
    const { key, word, text, required, unit } = control;
    const id = fresh("help");
    const entry = input(control, word, around, hintOf(control));
    entry.set(this.subject.values[key]);
    this.inputs.set(key, entry);
    const first = entry.element.matches(GIVEN) ? entry.element : entry.element.querySelector(GIVEN);
    if (first) set(first, { "aria-describedby": id });
    const needed = { class: "needed", title: say("required"), hidden: !required };
    const marked = h("span", needed, " *");
    const row = h(
      "div",
      { class: "key", "data-key": key },
      h("span", { class: "word" }, word, marked, unit ? h("span", { class: "unit" }, ` ${unit}`) : null),
      entry.element,
      h("p", { class: "quiet", id: id }, text),
      this.lineOf(key),
    );
    this.rows.set(key, row);
    return row;
  }

  /** The line for what is wrong at a key. */
  private lineOf(key: string): HTMLElement {
    const line = h("p", { class: "error", id: fresh("error"), role: "alert", hidden: true });
    this.errors.set(key, line);
    return line;
  }
}

/** What a key that is left out stands for, or how it could look. */
function hintOf({ default: usual, example, required, kind }: Control): string {
  const hint = usual ?? (required || kind === "choice" || kind === "name" ? null : example);
  if (hint === null || kind === "list" || kind === "names" || kind === "place") return "";
  return usual === null ? say("such as {example}", { example: brief(hint) }) : brief(hint);
}

/** What to do at a key that has to be given. */
function wantOf({ example, kind }: Control): string {
  if (kind === "choice" || kind === "name") return say("Choose one.");
  const plain = example !== null && typeof example !== "object";
  return plain ? say("Give it, such as {example}.", { example: brief(example) }) : say("Give it.");
}

function brief(value: Plain): string {
  return Array.isArray(value) ? value.map(brief).join(", ") : String(value);
}

/** The key of a table in the path of a refusal. */
function keyOf(path: string, where: string): string | null {
  if (!path.startsWith(where)) return null;
  return /^\.?([^.[\]]+)/.exec(path.slice(where.length))?.[1] ?? null;
}
