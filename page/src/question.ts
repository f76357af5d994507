/** A question that has to be answered before something goes on. */

import { h } from "./dom";
import { say } from "./words";

/** Ask in a dialog; true where it is to be done, false where not, or where it is closed. */
export function question(root: HTMLElement, text: string, yes: string): Promise<boolean> {
  return new Promise((done) => {
    const dialog = h(
      "dialog",
      { class: "help question", "aria-label": say("Question") },
      h("p", {}, text),
      h(
        "form",
        { method: "dialog", class: "buttons" },
        h("button", { class: "strong", value: "yes" }, yes),
        h("button", { value: "no" }, say("Cancel")),
      ),
    );
    dialog.addEventListener("close", () => {
      dialog.remove();
      done(dialog.returnValue === "yes");
    });
    root.append(dialog);
    dialog.showModal();
  });
}
