/** The way from a message to the page of its error. */

import { h } from "./dom";
import type { Refused } from "./protocol";
import { say } from "./words";

/** The documentation, where it lies beside the page. */
export function documentation(): string | null {
  return document.querySelector<HTMLLinkElement>('link[rel="help"]')?.href ?? null;
}

/**
 * What leads from a refusal to its page: a link where the documentation lies beside the page; elsewhere, as in
 * notebooks, a button that opens the text of the page.
 */
export function cureOf(refused: Refused | null): HTMLElement | null {
  const { topic, cure } = refused ?? {};
  const [docs, name] = [documentation(), say("What to do about it")];
  if (topic && docs) {
    const href = new URL(`explain/${topic}.html`, docs).href;
    return h("a", { class: "cure", href, target: "_blank", rel: "noopener" }, name);
  }
  if (!cure) return null;
  const button = h("button", { type: "button", class: "cure", onclick: () => open(cure, button) }, name);
  return button;
}

function open([title, text]: [string, string], from: HTMLElement): void {
  const close = h("form", { method: "dialog", class: "buttons" }, h("button", { class: "strong" }, say("Close")));
  // Its text is English, whatever the page speaks.
  const dialog = h("dialog", { class: "help", "aria-label": title }, h("h2", { lang: "en" }, title));
  dialog.append(h("div", { class: "page-of-error", lang: "en" }, text), close);
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  dialog.addEventListener("close", () => dialog.remove());
  (from.closest(".equipoise") ?? document.body).append(dialog);
  dialog.showModal();
}

/** A message, and behind it the way to its page. */
export function withCure(line: HTMLElement, cure: HTMLElement | null): void {
  if (cure) line.append(" ", cure);
}
