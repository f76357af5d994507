/** A question that has to be answered before something goes on. */

import { h } from "./dom";
import { say } from "./words";

/** One dialog for every question: browsers keep those that were shown and taken away. */
const dialogs = new WeakMap<HTMLElement, HTMLDialogElement>();

/** Ask in a dialog; true where it is to be done, false where not, or where it is closed. */
export function question(root: HTMLElement, text: string, yes: string): Promise<boolean> {
  const dialog = dialogs.get(root) ?? h("dialog", { class: "help question", "aria-label": say("Question") });
  dialogs.set(root, dialog);
  dialog.returnValue = "";
  dialog.replaceChildren(
    h("p", {}, text),
    h(
      "form",
      { method: "dialog", class: "buttons" },
      h("button", { class: "strong", value: "yes" }, yes),
      h("button", { value: "no" }, say("Cancel")),
    ),
  );
  root.append(dialog);
  dialog.showModal();
  return new Promise((done) => {
    dialog.addEventListener("close", () => done(dialog.returnValue === "yes"), { once: true });
  });
}
