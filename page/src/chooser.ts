/** A choice that is the heading of a chart at the same time. */

import { h, put } from "./dom";

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
      put(select, value);
    },
    has,
    offer(options) {
      select.replaceChildren(...options.map(([value, label]) => h("option", { value }, label)));
    },
  };
}
