/** Elements in one call each: made once, and changed by their attributes.  What a message lists is rendered (`render.ts`). */

type Value = string | number | boolean | null | undefined | ((event: never) => void);
type Child = Node | string | null | undefined | false;
export type Attributes = Record<string, Value>;

const SVG = "http://www.w3.org/2000/svg";

/** An HTML element; attributes named `onclick` and the like are listeners. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  return fill(document.createElement(tag), attributes, children);
}

/** An SVG element. */
export function s<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

function fill<E extends Element>(element: E, attributes: Attributes, children: Child[]): E {
  set(element, attributes);
  element.append(...children.filter((child): child is Node | string => !!child || child === ""));
  return element;
}

/** Set attributes; `false`, `null` and `undefined` take them away. */
export function set(element: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") {
      element.addEventListener(name.slice(2), value as EventListener);
    } else if (value === false || value === null || value === undefined) {
      element.removeAttribute(name);
    } else {
      const text = value === true ? "" : String(value);
      if (element.getAttribute(name) !== text) element.setAttribute(name, text);
    }
  }
}

/** Change a text only where it differs, so that nothing is read out or laid out again. */
export function write(element: Element, text: string): void {
  if (element.textContent === text) return;
  const [only, more] = element.childNodes;
  if (only instanceof Text && !more) only.data = text;
  else element.textContent = text;
}

/** Show or hide only what is otherwise: an attribute that is written again is looked at again. */
export function show(element: HTMLElement, on: boolean): void {
  if (element.hidden === on) element.hidden = !on;
}

/** Choose or put in only what is otherwise: after a choice browsers look through all forms of a page. */
export function put(element: HTMLSelectElement | HTMLInputElement, value: string): void {
  if (element.value !== value) element.value = value;
}

/** A small drawing for a button, 16 by 16, in the colour of the text. */
export function icon(path: string): SVGSVGElement {
  return s(
    "svg",
    { class: "icon", viewBox: "0 0 16 16", "aria-hidden": "true", focusable: "false" },
    s("path", { d: path }),
  );
}

/** Whether things may begin to move by themselves: the reader's system has not asked for less motion. */
export function letsMove(): boolean {
  return !matchMedia("(prefers-reduced-motion: reduce)").matches;
}

let counted = 0;

/** An id that no other view on the same document has. */
export function fresh(what: string): string {
  counted += 1;
  return `equipoise-${what}-${counted}`;
}
