/** How the values of a model file are asked for, each kind in its way. */

import { fresh, h, icon, set } from "./dom";
import { asTyped, decimals } from "./format";
import type { Asking, Pair, Plain, Values } from "./protocol";
import { say } from "./words";

/** What is asked for; without a value nothing was given. */
export interface Input {
  element: HTMLElement;
  value(): Plain | undefined;
  set(value: Plain | undefined): void;
  /** Tell what there is to choose from now. */
  refresh?(): void;
}

/** What inputs know of the form around them. */
export interface Around {
  /** Points of the frame and of links, in their own axes. */
  bodies: Record<string, Record<string, Pair>>;
  /** What outputs that balancing can take are called, by name. */
  outputs: Record<string, string>;
  /** The link in whose table the form is, or the frame. */
  body: string;
  beside(key: string): Plain | undefined;
  put(key: string, value: Plain): void;
  /** Let a place be shown on the drawing: a point's name, or x and y in the axes of a body, m. */
  pick(body: string, named: boolean, taken: (picked: Picked) => void): void;
  /** Keep the text of a file that was chosen. */
  file(name: string, text: string): void;
}

export interface Picked {
  point: string | null;
  link: string | null;
  /** As they are written in a file. */
  place: [string, string];
}

const FRAME = "frame";
/** In place of a key that names a body: any link, and the link in whose table the form is. */
const [LINKS, OWN] = ["links", "own"];
const TARGET = "M8 1.5v4M8 10.5v4M1.5 8h4M10.5 8h4M8 8h.01";
const ANGLE = /(deg|rad|turn)$/;

/** `name` is read to those who do not see it. */
export function input(asking: Asking, name: string, around: Around, hint = ""): Input {
  return MAKERS[asking.kind](asking, name, around, hint);
}

type Maker = (asking: Asking, name: string, around: Around, hint: string) => Input;

function typed(element: HTMLInputElement): string {
  return asTyped(element.value);
}

function box(name: string, hint: string): HTMLInputElement {
  const attributes = { autocomplete: "off", autocapitalize: "off", spellcheck: "false" };
  return h("input", {
    type: "text",
    class: "value",
    "aria-label": name,
    placeholder: hint,
    ...attributes,
  });
}

/** A bare number is one of the unit that stands beside it. */
function withUnit(text: string, unit: string | undefined): string {
  return text !== "" && unit && Number.isFinite(Number(text)) ? `${text} ${unit}` : text;
}

const quantity: Maker = ({ unit }, name, _, hint) => {
  const element = box(name, hint || (unit ?? ""));
  return {
    element,
    value: () => withUnit(typed(element), unit) || undefined,
    set: (value) => (element.value = value === undefined ? "" : decimals(String(value))),
  };
};

const number: Maker = (_, name, __, hint) => {
  const element = box(name, hint);
  const value = () => {
    const text = typed(element);
    return text === "" ? undefined : Number.isFinite(Number(text)) ? Number(text) : text;
  };
  return { element, value, set: (value) => (element.value = decimals(String(value ?? ""))) };
};

const text: Maker = ({ options = [], of }, name, around, hint) => {
  const field = box(name, hint);
  const value = () => field.value.trim() || undefined;
  const put = (value: Plain | undefined) => (field.value = String(value ?? ""));
  const offered = of === "output" ? Object.entries(around.outputs) : options.map((option) => [String(option), ""]);
  if (!offered.length) return { element: field, value, set: put };
  const id = fresh("options");
  set(field, { list: id });
  const list = h("datalist", { id }, ...offered.map(([value, label]) => h("option", { value, label: label || null })));
  return { element: h("span", { class: "several" }, field, list), value, set: put };
};

/** A text, or one for each of some languages. */
const wording: Maker = (asking, name, around, hint) => {
  const container = h("span", { class: "several" });
  let inner = text(asking, name, around, hint);
  const put = (value: Plain | undefined) => {
    const spoken = typeof value === "object";
    const item: Asking = { kind: "text" };
    inner = spoken ? names({ kind: "names", item }, name, around, "") : text(asking, name, around, hint);
    inner.set(value);
    container.replaceChildren(inner.element);
  };
  put(undefined);
  return { element: container, value: () => inner.value(), set: put };
};

/** The first option stands for nothing given. */
function offer(select: HTMLSelectElement, options: (string | number)[], none: string): void {
  const chosen = select.value;
  const all = chosen && !options.map(String).includes(chosen) ? [...options, chosen] : options;
  select.replaceChildren(
    h("option", { value: "" }, none),
    ...all.map((option) => h("option", { value: String(option) }, String(option))),
  );
  select.value = chosen;
}

const choice: Maker = ({ options = [] }, name, _, hint) => {
  const element = h("select", { "aria-label": name });
  offer(element, options, hint ? `(${hint})` : "");
  return {
    element,
    value: () => options.find((option) => String(option) === element.value),
    set: (value) => (element.value = String(value ?? "")),
  };
};

const flag: Maker = (_, name) => {
  const element = h("input", { type: "checkbox", "aria-label": name });
  return {
    element,
    value: () => element.checked || undefined,
    set: (value) => (element.checked = value === true),
  };
};

/** The name of a link, a body or a point. */
const called: Maker = ({ of, on }, name, around, hint) => {
  const element = h("select", { "aria-label": name });
  const refresh = () => offer(element, namesOf(of, on ?? undefined, around), hint ? `(${hint})` : "");
  refresh();
  const put = (value: Plain | undefined) => {
    if (value !== undefined && ![...element.options].some((option) => option.value === value))
      element.append(h("option", { value: String(value) }, String(value)));
    element.value = String(value ?? "");
  };
  const picked = ({ point, link }: Picked) => {
    const picked = of === "point" ? point : link;
    if (!picked) return;
    if (of === "point" && on && ![FRAME, LINKS, OWN].includes(on)) {
      const has = Object.hasOwn(around.bodies[String(around.beside(on) ?? "")] ?? {}, picked);
      if (!has && link) around.put(on, link);
      refresh();
    }
    put(picked);
    element.dispatchEvent(new Event("change", { bubbles: true }));
  };
  const button = pickButton(name, () => around.pick(FRAME, true, picked));
  const several = h("span", { class: "several" }, element, button);
  return { element: several, value: () => element.value || undefined, set: put, refresh };
};

function namesOf(of: Asking["of"], on: string | undefined, around: Around): string[] {
  const { bodies } = around;
  const links = Object.keys(bodies).filter((body) => body !== FRAME);
  if (of === "link") return links;
  if (of === "body") return [FRAME, ...links];
  if (on === LINKS) return [...new Set(links.flatMap((link) => Object.keys(bodies[link] ?? {})))];
  const body = on === FRAME ? FRAME : on === OWN ? around.body : on ? String(around.beside(on) ?? "") : "";
  const whole = body ? [body] : on ? [FRAME, ...links] : [...links, FRAME];
  return [...new Set(whole.flatMap((body) => Object.keys(bodies[body] ?? {})))];
}

function pickButton(name: string, onclick: () => void): HTMLButtonElement {
  const title = say("Show {name} on the drawing", { name });
  return h("button", { type: "button", class: "pick", "aria-label": title, title, onclick }, icon(TARGET));
}

/** A place by x and y, or distance and direction, or the name of a point. */
const place: Maker = (asking, name, around) => {
  const { unit, named, space, axes } = asking;
  const parts = ["x", "y", ...(space ? ["z"] : [])];
  const boxes = parts.map((axis) => box(`${name} ${axis}`, axis));
  const body = () => (axes ? String(around.beside(axes) ?? FRAME) : around.body);
  const names = named ? h("select", { "aria-label": say("{name}, point", { name }) }) : null;
  const refresh = () => names && offer(names, Object.keys(around.bodies[body()] ?? {}), "x, y:");
  refresh();
  const put = (value: Plain | undefined) => {
    const isName = typeof value === "string";
    if (names) names.value = isName ? value : "";
    const texts = isName || value === undefined ? [] : componentsOf(value);
    for (const [i, box] of boxes.entries()) box.value = decimals(texts[i] ?? "");
  };
  const picked = (picked: Picked) => put(named && picked.point ? picked.point : [...picked.place]);
  const button = pickButton(name, () => around.pick(body(), !!named, picked));
  return {
    element: h("span", { class: "several" }, names, ...boxes, button),
    set: put,
    refresh,
    value: () => {
      if (names?.value) return names.value;
      const texts = boxes.map(typed);
      const last = space && texts[2] === "" ? 2 : texts.length;
      if (texts.every((text) => text === "")) return undefined;
      const [distance, direction] = texts;
      if (!space && direction && ANGLE.test(direction)) return { distance: withUnit(distance ?? "", unit), direction };
      return texts.slice(0, last).map((text) => withUnit(text, unit));
    },
  };
};

function componentsOf(value: Plain): string[] {
  if (Array.isArray(value)) return value.map(String);
  const { distance, direction } = value as Values;
  return [String(distance ?? ""), String(direction ?? "")];
}

/** An angle, or three plain numbers. */
const direction: Maker = ({ unit }, name, _, hint) => {
  const element = box(name, hint || "90 deg / 0, 1, 0");
  return {
    element,
    value: () => {
      const text = typed(element);
      if (text.includes(",")) return text.split(",").map(Number);
      return withUnit(text, unit) || undefined;
    },
    set: (value) => (element.value = Array.isArray(value) ? value.join(", ") : decimals(String(value ?? ""))),
  };
};

/** Some of a kind: as many as there have to be, or with buttons for one more and one less. */
const list: Maker = (asking, name, around, hint) => {
  const { item, sizes = [], bare } = asking;
  const [least, most] = sizes.length ? [Math.min(...sizes), Math.max(...sizes)] : [1, 100];
  const container = h("span", { class: "items" });
  const items: Input[] = [];
  const grow = (value?: Plain) => {
    const entry = input(item as Asking, `${name} ${items.length + 1}`, around, hint);
    entry.set(value);
    items.push(entry);
    container.append(entry.element);
    limit();
  };
  const more = step("+", say("One more"), () => grow());
  const less = step("−", say("One less"), () => {
    items.pop()?.element.remove();
    limit();
  });
  const limit = () => {
    more.hidden = least === most || items.length >= most;
    less.hidden = least === most || items.length <= least;
  };
  const put = (value: Plain | undefined) => {
    items.splice(0);
    container.replaceChildren();
    const values = value === undefined ? [] : Array.isArray(value) ? value : [value];
    for (let i = 0; i < Math.max(least, values.length); i++) grow(values[i]);
  };
  put(undefined);
  return {
    element: h("span", { class: "several list" }, container, more, less),
    set: put,
    refresh: () => {
      for (const item of items) item.refresh?.();
    },
    value: () => {
      const values = items.map((entry) => entry.value());
      if (values.every((value) => value === undefined)) return undefined;
      const filled = values.map((value) => value ?? "");
      return bare && filled.length === 1 ? filled[0] : filled;
    },
  };
};

function step(sign: string, name: string, onclick: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: "step", "aria-label": name, title: name, onclick }, sign);
}

/** Some of a kind by names: of the user's, or of what is there. */
const names: Maker = (asking, name, around, hint) => {
  const { item, by = { kind: "text" }, listed } = asking;
  const container = h("span", { class: "items named" });
  const rows: { line: HTMLElement; called: Input; item: Input }[] = [];
  const grow = (key = "", value?: Plain) => {
    const number = rows.length + 1;
    const own = input(by, say("{name} {number}, name", { name, number }), around, say("name"));
    own.set(key);
    own.element.classList.add("name-of");
    const entry = input(item as Asking, `${name} ${key || number}`, around, hint);
    entry.set(value);
    const remove = () => {
      rows.splice(rows.indexOf(row), 1);
      row.line.remove();
    };
    const line = h("span", { class: "several" }, own.element, entry.element, step("−", say("One less"), remove));
    const row = { line, called: own, item: entry };
    rows.push(row);
    container.append(line);
  };
  const put = (value: Plain | undefined) => {
    rows.splice(0);
    container.replaceChildren();
    if (Array.isArray(value)) for (const key of value) grow(String(key));
    else for (const [key, inner] of Object.entries((value ?? {}) as Values)) grow(key, inner);
  };
  return {
    element: h(
      "span",
      { class: "several list" },
      container,
      step("+", say("One more"), () => grow()),
    ),
    set: put,
    refresh: () => {
      for (const { called, item } of rows) for (const input of [called, item]) input.refresh?.();
    },
    value: () => {
      const filled = rows.filter((row) => (row.called.value() ?? row.item.value()) !== undefined);
      if (!filled.length) return undefined;
      const keys = filled.map((row) => String(row.called.value() ?? ""));
      const values = filled.map((row) => row.item.value());
      if (listed && values.every((value) => value === undefined)) return keys;
      return Object.fromEntries(keys.map((key, i) => [key, values[i] ?? ""]));
    },
  };
};

/** A CSV file, which is read here. */
const file: Maker = (_, name, around) => {
  const shown = box(name, "");
  const chosen = h("input", { type: "file", accept: ".csv", hidden: true, tabindex: -1 });
  chosen.addEventListener("change", async () => {
    const [table] = chosen.files ?? [];
    if (!table) return;
    around.file(table.name, await table.text());
    shown.value = table.name;
  });
  const button = h("button", { type: "button", class: "pick", onclick: () => chosen.click() }, say("Choose file"));
  return {
    element: h("span", { class: "several" }, shown, chosen, button),
    value: () => shown.value.trim() || undefined,
    set: (value) => (shown.value = String(value ?? "")),
  };
};

const MAKERS: Record<Asking["kind"], Maker> = {
  quantity,
  number,
  text,
  choice,
  flag,
  name: called,
  place,
  direction,
  list,
  names,
  file,
  wording,
};
