/** Designs that are kept: named, gone back to, compared in a table of their figures. */

import { h, icon } from "./dom";
import { unbroken } from "./format";
import type { PageRequest, VariantsMessage } from "./protocol";
import { capital } from "./readings";
import { say } from "./words";

const VARIANT = "variant:";

export class Variants {
  readonly root = h("section", {
    class: "variants",
    "aria-label": say("Variants"),
    hidden: true,
  });
  /** What figures and curves are compared with. */
  readonly choice: HTMLElement;
  private readonly select: HTMLSelectElement;
  private shape = "";

  constructor(private readonly ask: (request: PageRequest) => void) {
    this.select = h("select", {
      "aria-label": say("Compare with"),
      onchange: () => ask({ type: "variant", do: "against", to: this.select.value }),
    });
    const pin = h(
      "button",
      { type: "button", onclick: () => ask({ type: "variant", do: "pin" }) },
      icon("M5.5 2.5h5L10 7l2 2.5H4L6 7zM8 9.500V14"),
      h("span", {}, say("Keep as variant")),
    );
    this.choice = h(
      "span",
      { class: "comparing" },
      h("label", {}, h("span", {}, say("Compare with")), this.select),
      pin,
    );
    this.offer([], "step");
  }

  show(message: VariantsMessage): void {
    this.offer(message.kept, message.against);
    this.root.hidden = !message.kept.length;
    const typing = this.root.contains(document.activeElement) && this.shape === message.kept.join();
    this.shape = message.kept.join("\n");
    if (!typing || !message.kept.length) this.fill(message);
  }

  private offer(kept: string[], against: string): void {
    const options: [string, string][] = [
      ["step", say("before the last change")],
      ["opened", say("as it was opened")],
      ...kept.map((name): [string, string] => [VARIANT + name, name]),
      ["nothing", say("nothing")],
    ];
    this.select.replaceChildren(...options.map(([value, text]) => h("option", { value }, text)));
    this.select.value = against;
  }

  private fill({ kept, against, rows }: VariantsMessage): void {
    const heads = kept.map((name) =>
      h(
        "th",
        { scope: "col", class: against === VARIANT + name && "chosen" },
        this.naming(name),
        h(
          "span",
          { class: "doing" },
          this.button(say("Go to {name}", { name }), "M3 8h9M8.500 4.500 12 8l-3.500 3.500", () =>
            this.ask({ type: "variant", do: "go", name }),
          ),
          this.button(say("Delete {name}", { name }), "M4 4l8 8M12 4l-8 8", () =>
            this.ask({ type: "variant", do: "drop", name }),
          ),
        ),
      ),
    );
    const head = h("tr", {}, h("td"), ...heads, h("th", { scope: "col" }, say("now")));
    const lines = rows.map(({ label, unit, texts, best }) =>
      h(
        "tr",
        {},
        h("th", { scope: "row" }, capital(label), h("span", { class: "unit" }, ` ${unbroken(unit)}`)),
        ...texts.map((text, i) => {
          const first = best.includes(i);
          const said = first && h("span", { class: "unseen" }, ` (${say("best")})`);
          return h("td", { class: first && "best", title: first && say("best") }, text, said);
        }),
      ),
    );
    const caption = h("caption", {}, say("Variants"));
    this.root.replaceChildren(
      h(
        "div",
        { class: "scrolled", tabindex: 0 },
        h("table", {}, caption, h("thead", {}, head), h("tbody", {}, ...lines)),
      ),
    );
  }

  private naming(name: string): HTMLInputElement {
    const input = h("input", {
      type: "text",
      "aria-label": say("Name of variant {name}", { name }),
      size: Math.max(name.length, 3),
      maxlength: 40,
      value: name,
    });
    const give = () => {
      const to = input.value.trim();
      if (to && to !== name) this.ask({ type: "variant", do: "rename", name, to });
      else input.value = name;
    };
    input.addEventListener("change", give);
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") input.blur();
      if (event.key !== "Escape") return;
      event.stopPropagation();
      input.value = name;
    });
    return input;
  }

  private button(name: string, path: string, onclick: () => void): HTMLButtonElement {
    return h("button", { type: "button", "aria-label": name, title: name, onclick }, icon(path));
  }
}
