/** The bar of tools above the drawing: what a click there does, and what is missing. */

import { h, icon, set, write } from "./dom";
import type { PartTool, Status } from "./protocol";
import { partTools, say } from "./words";

/** How a tool is offered, and what to do with it first, and then. */
type Tool = Pick<PartTool, "tool" | "key" | "name" | "first" | "then" | "picture">;

/** Every tool; those of parts as their kinds declare them. */
export const tools = (): Tool[] => [
  {
    tool: "select",
    key: "v",
    name: say("Select"),
    first: say("click a link or a joint to choose it, drag it to move it"),
    then: "",
    picture: "M4 2.5v10l2.7-2.600 1.800 3.600 1.600-.8-1.800-3.500h3.600z",
  },
  {
    tool: "point",
    key: "p",
    name: say("Point"),
    first: say("click the sheet for a point of the frame, or a link for a point of that"),
    then: "",
    picture: "M8 2.5v4M8 9.500v4M2.500 8h4M9.500 8h4",
  },
  {
    tool: "link",
    key: "l",
    name: say("Link"),
    first: say("click where the link begins: a joint, a link, or a free place"),
    then: say("click where the link ends; Shift keeps it level, upright or in steps of 15°"),
    picture:
      "M4.500 11.500l7-7M2.500 13.500a1.600 1.600 0 1 0 2-2 1.600 1.600 0 0 0-2 2M11.500 4.500a1.600 1.600 0 1 0 2-2 1.600 1.600 0 0 0-2 2",
  },
  {
    tool: "pin",
    key: "j",
    name: say("Pin"),
    first: say("click the point that is to be pinned"),
    then: say("click the point that it is pinned to, or itself again for the frame, on or off"),
    picture: "M8 2.500a2.500 2.500 0 1 0 .01 0M8 7.500l-3.500 5h7zM3 13.500h10",
  },
  {
    tool: "separate",
    key: "x",
    name: say("Separate"),
    first: say("click a pin: the last link at it gets a point of its own"),
    then: "",
    picture: "M2.500 8h3M10.500 8h3M5.500 8a1 1 0 1 0 .01 0M10.500 8a1 1 0 1 0 .01 0M8 3v10",
  },
  {
    tool: "slider",
    key: "s",
    name: say("Slider"),
    first: say("click where the block is: a joint, or a free place"),
    then: say("click another place of its line: on the sheet, or on the link that guides it"),
    picture: "M2.500 12.500h11M4.500 6h7v4h-7zM2.500 3.500h11",
  },
  ...partTools(),
  {
    tool: "drive",
    key: "d",
    name: say("Drive"),
    first: say("click the link that is the crank"),
    then: "",
    picture: "M12.500 5.500a5.200 5.200 0 1 0 .7 3.500M13.200 2.500v3.500H9.700",
  },
  {
    tool: "delete",
    key: "Delete",
    name: say("Delete"),
    first: say("click the joint, the link, the slider or the part that is to go"),
    then: "",
    picture: "M3 4.500h10M6.500 4.500v-2h3v2M4.500 4.500l.7 9h5.600l.7-9",
  },
];

interface Palettes {
  chosen(tool: string): void;
  made(): void;
  renamed(name: string): void;
}

export class Palette {
  readonly root: HTMLElement;
  private readonly buttons = new Map<string, HTMLButtonElement>();
  private readonly status = h("p", { class: "status", role: "status", "aria-live": "polite" });
  private readonly next = h("p", { class: "next", "aria-hidden": "true" });
  private readonly name = h("input", {
    type: "text",
    class: "rename",
    hidden: true,
    autocomplete: "off",
    spellcheck: "false",
  });
  private readonly tools = tools();
  /** What is asked of a part before it is added, by the word in front of it. */
  private readonly inputs = new Map<string, HTMLElement>();

  constructor(private readonly page: Palettes) {
    const buttons = this.tools.map((item) => {
      const title = `${item.name} (${item.key.toUpperCase()}): ${item.first}`;
      const attributes = { type: "button", title, "aria-label": item.name, "aria-pressed": "false" };
      const name = h("span", { class: "name", "aria-hidden": "true" }, item.name);
      const button = h("button", { ...attributes, "aria-keyshortcuts": item.key }, icon(item.picture), name);
      button.addEventListener("click", () => page.chosen(item.tool));
      this.buttons.set(item.tool, button);
      return button;
    });
    const make = h("button", { type: "button", onclick: () => page.made() }, say("New"));
    for (const { options } of partTools())
      if (options && !this.inputs.has(options.word)) this.inputs.set(options.word, inputsOf(options));
    this.name.addEventListener("change", () => this.rename());
    this.root = h(
      "div",
      { class: "making" },
      h("div", { class: "tools", role: "toolbar", "aria-label": say("Tools") }, make, ...buttons),
      // A room of its own: sentences that come, go or wrap reach over the sheet, and never move it.
      h("div", { class: "telling" }, h("div", {}, this.status, this.name, this.next, ...this.inputs.values())),
    );
  }

  /** What a part that a tool adds is to have beside its links. */
  optionsOf({ options }: PartTool): Record<string, string | number> {
    const inputs = this.inputs
      .get(options?.word ?? "")
      ?.querySelectorAll<HTMLInputElement | HTMLSelectElement>("[name]");
    return Object.fromEntries(
      [...(inputs ?? [])].map(({ name, value, type }) => [
        name,
        type === "text" && !Number.isNaN(Number(value)) ? Number(value) : value,
      ]),
    );
  }

  /** Which tool is used, and what to do next with it. */
  show(tool: string, pending: boolean): void {
    for (const [name, button] of this.buttons) set(button, { "aria-pressed": String(name === tool) });
    const shown = this.tools.find((item) => item.tool === tool);
    write(this.next, tool === "select" || !shown ? "" : pending ? shown.then : shown.first);
    const word = partTool(tool)?.options?.word;
    for (const [key, inputs] of this.inputs) inputs.hidden = key !== word;
  }

  tell(status: Status): void {
    write(this.status, status.text);
    this.status.classList.toggle("lacking", !status.finished);
  }

  /** Offer to rename what is chosen. */
  choose(name: string | null): void {
    this.name.hidden = name === null;
    this.name.value = name ?? "";
    set(this.name, { "aria-label": name === null ? null : say("Name of {name}", { name }) });
  }

  private rename(): void {
    if (this.name.value.trim()) this.page.renamed(this.name.value.trim());
  }
}

/** The tool of this name, if it adds a part. */
export function partTool(name: string): PartTool | undefined {
  return partTools().find(({ tool }) => tool === name);
}

function inputsOf({ word, labels, choices, value }: NonNullable<PartTool["options"]>): HTMLElement {
  const offered = Object.entries(choices);
  const inputs = Object.entries(labels).map(([name, label]) =>
    offered.length
      ? h("select", { name, "aria-label": label }, ...offered.map(([value, text]) => h("option", { value }, text)))
      : h("input", { name, type: "text", inputmode: "numeric", class: "teeth", "aria-label": label, value }),
  );
  return h("span", { class: "meshing", hidden: true }, word, ...inputs);
}
