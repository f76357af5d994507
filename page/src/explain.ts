/** What a chart shows, said on demand, and the chart as a picture to keep. */

import { fresh, h, set, write } from "./dom";
import type { Asked } from "./protocol";
import { explained, say } from "./words";

export type Ask = (asked: Asked) => void;

/** Put a "?" at the end of the heading of a chart of that title; `choice` tells what of it is shown. */
export function explain(figure: HTMLElement, title: string, name: string, ask: Ask, choice: () => string): void {
  const heading = figure.querySelector("figcaption");
  if (!heading || heading.querySelector(".why")) return;
  const id = fresh("why");
  const keep = (format: "svg" | "png") =>
    h(
      "button",
      {
        type: "button",
        class: "keeps",
        onclick: () => ask({ type: "download", kind: "chart", chart: name, choice: choice(), format }),
      },
      format.toUpperCase(),
    );
  const shows = h("p", {});
  const told = h(
    "div",
    { class: "explained", id, hidden: true },
    shows,
    h("p", { class: "keeping" }, say("Keep this chart as"), " ", keep("svg"), keep("png")),
  );
  const button = h(
    "button",
    {
      type: "button",
      class: "why",
      "aria-label": say("{chart}: what does it show?", { chart: title }),
      title: say("What does this chart show?"),
      "aria-expanded": "false",
      "aria-controls": id,
      onclick: () => {
        told.hidden = !told.hidden;
        write(shows, explained(name)); // which goes by the machine that is open
        set(button, { "aria-expanded": String(!told.hidden) });
      },
    },
    "?",
  );
  heading.append(button);
  heading.after(told);
}
