/** Keys that hold on the whole page, those that hold on the drawing, and the list of all in a dialog. */

import { documentation } from "./cure";
import { h } from "./dom";
import { tools } from "./palette";
import { ZOOMS } from "./view";
import { say, toSay } from "./words";

interface Shortcuts {
  board: HTMLElement;
  undo(): void;
  redo(): void;
  save(): void;
  help(): void;
  toggle(): void;
  /** Turn the crank by some degrees. */
  turn(by: number): void;
  zoom(factor: number): void;
  fit(): void;
  /** Take the tool of a key; returns whether there is one. */
  tool(key: string): boolean;
}

export function pressed(event: KeyboardEvent, page: Shortcuts): void {
  const target = event.target as HTMLElement;
  const typing = target instanceof HTMLInputElement && target.type === "text";
  if (event.ctrlKey || event.metaKey) {
    // A text that is being typed has its own undo.
    const own = typing && target.dataset.typed !== undefined;
    if (!own || event.key.toLowerCase() === "s") step(event, page);
  } else if (!typing && event.key === "?") page.help();
  else if (event.altKey) return;
  else if (drawn(target, page.board)) draw(event, page);
  else if (target instanceof HTMLButtonElement && !target.closest("dialog") && page.tool(event.key))
    event.preventDefault(); // letters mean nothing to a button
}

/** Whether a key is meant for the drawing: it has the focus, or nothing has. */
function drawn(target: HTMLElement, board: HTMLElement): boolean {
  return target === document.body || (board.contains(target) && !(target instanceof HTMLButtonElement));
}

function step(event: KeyboardEvent, page: Shortcuts): void {
  const key = event.key.toLowerCase();
  if (key === "s" && !event.shiftKey) {
    event.preventDefault();
    page.save();
  }
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  if (event.shiftKey || key === "y") page.redo();
  else page.undo();
}

function draw(event: KeyboardEvent, page: Shortcuts): void {
  const { key } = event;
  if (key === " ") page.toggle();
  else if (key === ",") page.turn(-1);
  else if (key === ".") page.turn(1);
  else if (ZOOMS[key]) page.zoom(ZOOMS[key]);
  else if (key === "0") page.fit();
  else if (!page.tool(key)) return;
  event.preventDefault();
}

const lettered = () => tools().filter(({ key }) => key.length === 1);

/** Keys as they are labelled, or in words, and what they do. */
const KEYS: [keys: string | (() => string), what: string | (() => string)][] = [
  ["Tab", toSay("next joint, centre of mass, number or button")],
  ["← → ↑ ↓", toSay("move the chosen joint or centre of mass by one step")],
  [() => say("Shift + arrow"), toSay("ten steps")],
  [() => say("Alt + arrow"), toSay("a tenth of a step")],
  ["Space", toSay("play and pause, while the drawing has the focus")],
  [() => say(", and ."), toSay("crank back and on by one degree, while the drawing has the focus")],
  ["+ − 0", toSay("zoom in, zoom out, show all, while the drawing has the focus")],
  ["Enter, Escape", toSay("in a number: take it, or give back the old one")],
  ["↑ ↓", toSay("in a number: a little more, a little less (Shift: ten times)")],
  ["Ctrl + Z", toSay("undo")],
  ["Ctrl + Shift + Z", toSay("redo")],
  ["Ctrl + S", toSay("save the file that was opened, or download the model")],
  [
    () =>
      lettered()
        .map(({ key }) => key.toUpperCase())
        .join(" "),
    () =>
      say("tools: {tools}", {
        tools: lettered()
          .map(({ name }) => name)
          .join(", "),
      }),
  ],
  ["Delete", toSay("delete the joint or link that is chosen")],
  [() => say("menu key"), toSay("what can be done with the chosen joint or link (also: right button, long press)")],
  ["?", toSay("this list")],
];

export function helpDialog(version: () => string, tour: () => void): HTMLDialogElement {
  const rows = KEYS.map(([keys, what]) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, h("kbd", {}, typeof keys === "string" ? keys : keys())),
      h("td", {}, typeof what === "string" ? say(what) : what()),
    ),
  );
  const uses = tools().map(({ name, first, then }) =>
    h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, [first, then].filter((text) => text).join(" → "))),
  );
  const versionLine = h("p", { class: "quiet" });
  const dialog = h(
    "dialog",
    { class: "help", "aria-label": say("Keys") },
    h("h2", {}, say("Keys")),
    h("table", {}, h("tbody", {}, ...rows)),
    h(
      "p",
      {},
      say("With a mouse or a finger: drag joints and centres of mass; drag the sheet to move it."),
      " ",
      say("Numbers take any unit: 71.5 mm, 7.15 cm, 0.2 kg, 200 rpm, 30 deg."),
    ),
    h("h3", {}, say("Tools")),
    h("table", {}, h("tbody", {}, ...uses)),
    documented(),
    versionLine,
    h(
      "form",
      { method: "dialog", class: "buttons" },
      h("button", { value: "tour" }, say("Take the tour")),
      h("button", { class: "strong" }, say("Close")),
    ),
  );
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  // Only then the focus is back on the page.
  dialog.addEventListener("close", () => {
    if (dialog.returnValue === "tour") tour();
    dialog.returnValue = "";
  });
  dialog.addEventListener("toggle", () => versionLine.replaceChildren(`Equipoise ${version()}`));
  return dialog;
}

/** The way to the documentation, where it lies beside the page. */
function documented(): HTMLElement | null {
  const href = documentation();
  return href === null ? null : h("p", {}, h("a", { href, target: "_blank", rel: "noopener" }, say("Documentation")));
}
