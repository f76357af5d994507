/** The keys, in a dialog. */

import { h } from "./dom";

export const KEYS: [keys: string, what: string][] = [
  ["Tab", "next joint, centre of mass, number or button"],
  ["← → ↑ ↓", "move the chosen joint or centre of mass by one step"],
  ["Shift + arrow", "ten steps"],
  ["Alt + arrow", "a tenth of a step"],
  ["Space", "play and pause, while the drawing has the focus"],
  [", and .", "crank back and on by one degree, while the drawing has the focus"],
  ["+ − 0", "zoom in, zoom out, show all, while the drawing has the focus"],
  ["Enter, Escape", "in a number: take it, or give back the old one"],
  ["↑ ↓", "in a number: a little more, a little less (Shift: ten times)"],
  ["Ctrl + Z", "undo"],
  ["Ctrl + Shift + Z", "redo"],
  ["?", "this list"],
];

export function helpDialog(version: () => string): HTMLDialogElement {
  const rows = KEYS.map(([keys, what]) =>
    h("tr", {}, h("th", { scope: "row" }, h("kbd", {}, keys)), h("td", {}, what)),
  );
  const told = h("p", { class: "quiet" });
  const dialog = h(
    "dialog",
    { class: "help", "aria-label": "Keys" },
    h("h2", {}, "Keys"),
    h("table", {}, h("tbody", {}, ...rows)),
    h(
      "p",
      {},
      "With a mouse or a finger: drag joints and centres of mass; drag the sheet to move it. ",
      "Numbers take any unit: 71.5 mm, 7.15 cm, 0.2 kg, 200 rpm, 30 deg.",
    ),
    told,
    h("form", { method: "dialog" }, h("button", { class: "strong" }, "Close")),
  );
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  dialog.addEventListener("toggle", () => told.replaceChildren(`Equipoise ${version()}`));
  return dialog;
}
