/** A choice that is the heading of a chart at the same time. */

import { h } from "./dom";
import type { Output } from "./protocol";

export interface Chooser {
  label: HTMLElement;
  value: string;
  has(name: string): boolean;
  offer(options: [name: string, label: string][]): void;
}

export function chooser(name: string, changed: () => void): Chooser {
  const select = h("select", { "aria-label": name, onchange: changed });
  const has = (value: string) => [...select.options].some((option) => option.value === value);
  return {
    label: h("span", { class: "heading" }, select),
    get value() {
      return select.value;
    },
    set value(value: string) {
      select.value = value;
    },
    has,
    offer(options) {
      select.replaceChildren(...options.map(([value, label]) => h("option", { value }, label)));
    },
  };
}

export interface Finder {
  label: HTMLElement;
  offer(outputs: Output[]): void;
  /** Tell what is drawn, but to whom is typing. */
  tell(label: string): void;
}

/** A heading to type in, that offers what it finds among many names. */
export function finder(name: string, chosen: (name: string) => void): Finder {
  const id = `equipoise-${++finders}`;
  const list = h("datalist", { id });
  let offered = "";
  let byLabel = new Map<string, string>();
  const input = h("input", {
    type: "search",
    "aria-label": name,
    placeholder: `${name} …`,
    onchange: () => chosen(byLabel.get(input.value) ?? input.value),
  });
  input.setAttribute("list", id);
  return {
    label: h("span", { class: "heading finder" }, input, list),
    tell(label) {
      if (!input.matches(":focus")) input.value = label;
    },
    offer(outputs) {
      const shape = outputs.map((one) => one.name).join();
      if (shape === offered) return;
      offered = shape;
      byLabel = new Map(outputs.map((one) => [one.label, one.name]));
      list.replaceChildren(
        ...outputs.map((one) => h("option", { value: one.label }, `${one.group}: ${one.name}`)),
      );
    },
  };
}

let finders = 0;
