/** Designs that are kept: named, gone back to, compared in a table of their figures. */

import { h, icon } from "./dom";
import { unbroken } from "./format";
import type { PageRequest, VariantsMessage } from "./protocol";
import { capital } from "./readings";
import { type ComponentChild, pictogram, render, v } from "./render";
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
    this.fill(message);
  }

  private offer(kept: string[], against: string): void {
    const options: [string, string][] = [
      ["step", say("before the last change")],
      ["opened", say("as it was opened")],
      ...kept.map((name): [string, string] => [VARIANT + name, name]),
      ["nothing", say("nothing")],
    ];
    render(this.select, ...options.map(([value, text]) => v("option", { value }, text)));
    this.select.value = against;
  }

  private fill({ kept, against, rows }: VariantsMessage): void {
    const heads = kept.map((name) =>
      v(
        "th",
        { key: name, scope: "col", class: against === VARIANT + name ? "chosen" : "" },
        this.naming(name),
        v(
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
    const head = v("tr", {}, v("td", {}), ...heads, v("th", { scope: "col" }, say("now")));
    const lines = rows.map(({ label, unit, texts, best }) =>
      v(
        "tr",
        {},
        v("th", { scope: "row" }, capital(label), v("span", { class: "unit" }, ` ${unbroken(unit)}`)),
        ...texts.map((text, i) => {
          const first = best.includes(i);
          const said = first && v("span", { class: "unseen" }, ` (${say("best")})`);
          return v("td", first ? { class: "best", title: say("best") } : {}, text, said);
        }),
      ),
    );
    const caption = v("caption", {}, say("Variants"));
    render(
      this.root,
      v(
        "div",
        { class: "scrolled", tabindex: 0 },
        v("table", {}, caption, v("thead", {}, head), v("tbody", {}, ...lines)),
      ),
    );
  }

  private naming(name: string): ComponentChild {
    const give = ({ currentTarget: input }: { currentTarget: HTMLInputElement }) => {
      const to = input.value.trim();
      if (to && to !== name) this.ask({ type: "variant", do: "rename", name, to });
      else input.value = name;
    };
    const key = (event: KeyboardEvent & { currentTarget: HTMLInputElement }) => {
      if (event.key === "Enter") event.currentTarget.blur();
      if (event.key !== "Escape") return;
      event.stopPropagation();
      event.currentTarget.value = name;
    };
    return v("input", {
      key: name,
      type: "text",
      "aria-label": say("Name of variant {name}", { name }),
      size: Math.max(name.length, 3),
      maxlength: 40,
      defaultValue: name, // what is typed stays when a message comes
      onchange: give,
      onkeydown: key,
    });
  }

  private button(name: string, path: string, onclick: () => void): ComponentChild {
    return v("button", { type: "button", "aria-label": name, title: name, onclick }, pictogram(path));
  }
}
