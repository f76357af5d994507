/**
 * What a message lists: described by `v`, and brought about by Preact, which writes only what differs.
 *
 * What moves with the crank or a pointer is made once, and its attributes are set (`dom.ts`).
 */

import { type ComponentChild, type ComponentChildren, Fragment, render as renderIn, h as v } from "preact";

export { type ComponentChild, v };

/** Let an element contain these children: of those that it contains already, only what differs is written. */
export function render(root: Element, ...children: ComponentChildren[]): void {
  renderIn(v(Fragment, null, ...children), root);
}

/** The drawing of `icon`, described. */
export function pictogram(path: string): ComponentChild {
  const attributes = { class: "icon", viewBox: "0 0 16 16", "aria-hidden": "true", focusable: "false" };
  return v("svg", attributes, v("path", { d: path }));
}
