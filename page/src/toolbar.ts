/** The bar at the top: what to look at, undo and redo, balancing, downloads, help. */

import type { Computation } from "./conversation";
import { h, icon, put, set } from "./dom";
import type { DownloadKind, Example, State } from "./protocol";
import { languages, say, language as spoken } from "./words";

const ICONS = {
  undo: "M5.5 3 2.5 6l3 3M3 6h6.5a3.5 3.5 0 0 1 0 7H6",
  redo: "M10.5 3l3 3-3 3M13 6H6.5a3.5 3.5 0 0 0 0 7H10",
  balance: "M8 2.5v11M4.5 13.5h7M2.5 5h11M4 5 2 9.5h4zM12 5l-2 4.5h4z",
  run: "M2.500 2.500v11h11M2.500 13.500c3 0 3-8 6-8h4.500",
  disk: "M2.5 2.5h9l2 2v9h-11zM5 2.500v4h5.500v-4M5 13.500v-4.500h6v4.500",
  save: "M8 2v7.5M4.800 6.7 8 9.900l3.200-3.200M2.5 13.5h11",
  keys: "M1.5 4h13v8.5h-13zM4 6.5h.01M6.7 6.5h.01M9.400 6.5h.01M12 6.5h.01M4.5 10h7",
  open: "M2 12.5v-9h4l1.5 2H14v7z",
};

/** What the toolbar needs of whatever is open. */
export type Opened = Pick<State, "name" | "undo" | "redo" | "lacking" | "file"> & {
  /** Downloads that there are; all where it is left out. */
  downloads?: DownloadKind[];
};

export interface Commands {
  example(name: string): void;
  gallery(): void;
  undo(): void;
  save(): void;
  link(): void;
  /** Record the drawing and its charts; null where the browser cannot. */
  film: (() => void) | null;
  redo(): void;
  balance(): void;
  /** Let the machine run under its motor, weight, springs and loads. */
  run(): void;
  download(kind: DownloadKind, language?: string, format?: "svg" | "png"): void;
  help(): void;
  /** Speak a language from now on. */
  speak(language: string): void;
}

export class Toolbar {
  readonly root: HTMLElement;
  private readonly examples: HTMLSelectElement;
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly balance: HTMLButtonElement;
  private readonly run: HTMLButtonElement;
  private readonly save: HTMLButtonElement;
  private readonly cancel = h("button", { type: "button", hidden: true }, say("Cancel"));
  private readonly own = h("option", { value: "" }, "");
  private readonly menu: HTMLDetailsElement;

  constructor(commands: Commands) {
    this.examples = h("select", {
      "aria-label": say("Example"),
      "data-machines": true,
      onchange: () => commands.example(this.examples.value),
    });
    const open = button(say("Open"), "open", () => commands.gallery());
    this.undo = button("", "undo", () => commands.undo(), say("Undo"));
    this.redo = button("", "redo", () => commands.redo(), say("Redo"));
    this.balance = button(say("Balance"), "balance", () => commands.balance());
    set(this.balance, { "data-do": "balance" });
    this.run = button(say("Run"), "run", () => commands.run());
    set(this.run, { "data-do": "run" });
    this.save = button("", "disk", () => commands.save(), say("Save"));
    this.save.hidden = true;
    this.menu = downloads(commands);
    set(this.menu, { "data-do": "download" });
    const closed = say("nothing is open yet");
    able(this.undo, say("Undo"), null, closed);
    able(this.redo, say("Redo"), null, closed);
    able(this.balance, say("Balance"), null, closed);
    able(this.run, say("Run"), null, closed);
    this.menu.inert = true;
    const help = button("", "keys", () => commands.help(), say("Keys"));
    this.root = h(
      "header",
      { class: "bar" },
      h("span", { class: "mark" }, "equipoise"),
      this.examples,
      open,
      h("span", { class: "gap" }),
      h("span", { class: "together" }, this.undo, this.redo, this.save),
      this.balance,
      this.run,
      this.cancel,
      this.menu,
      choiceOfLanguage(commands),
      help,
    );
  }

  offer(examples: Example[], tools: Example[]): void {
    const options = (some: Example[]) => some.map(({ name, title }) => h("option", { value: name, title }, name));
    const group = h("optgroup", { label: say("Hand-held tools") }, ...options(tools));
    this.examples.replaceChildren(...options(examples), group);
  }

  show(state: Opened): void {
    const known = [...this.examples.options].some((option) => option !== this.own && option.value === state.name);
    if (known) this.own.remove();
    else {
      this.own.textContent = state.name;
      this.own.value = state.name;
      this.examples.prepend(this.own);
    }
    put(this.examples, state.name);
    able(this.undo, say("Undo"), state.undo, say("nothing has been done yet"));
    able(this.redo, say("Redo"), state.redo, say("nothing has been taken back"));
    able(this.balance, say("Balance"), state.lacking ? null : "", state.lacking);
    able(this.run, say("Run"), state.lacking ? null : "", state.lacking);
    const { downloads } = state;
    this.menu.inert = downloads?.length === 0;
    for (const item of this.menu.querySelectorAll<HTMLButtonElement>("[data-kind]"))
      item.hidden = !!downloads && !downloads.includes(item.dataset.kind as DownloadKind);
    this.save.hidden = !state.file;
    able(
      this.save,
      say("Save"),
      state.file?.saved === false ? state.file.name : null,
      say("the file holds what is shown"),
    );
  }

  /** Put something beside what is open. */
  beside(element: HTMLElement): void {
    this.examples.after(element);
  }

  /** Let keys go on at the button that runs the machine. */
  focusRun(): void {
    this.run.focus({ preventScroll: true });
  }

  /** What takes long is computed, and can be given up by `cancel`, if that is possible. */
  busy(computed: Computation[], cancel?: () => void): void {
    set(this.root, { "data-busy": computed.at(-1)?.what ?? null });
    for (const [kind, element] of [
      ["balance", this.balance],
      ["run", this.run],
    ] as const)
      element.classList.toggle(
        "working",
        computed.some((work) => work.kind === kind),
      );
    this.cancel.hidden = !cancel || computed.every(({ repeated }) => repeated);
    this.cancel.onclick = () => cancel?.();
  }
}

function choiceOfLanguage(commands: Commands): HTMLSelectElement {
  const select = named(say("Language"));
  select.addEventListener("change", () => commands.speak(select.value));
  return select;
}

/** A choice of languages, of which the one that is spoken is chosen. */
function named(label: string): HTMLSelectElement {
  return h(
    "select",
    { class: "language", "aria-label": label, title: label },
    ...Object.entries(languages()).map(([code, name]) =>
      h("option", { value: code, lang: code, selected: code === spoken() }, name),
    ),
  );
}

function downloads(commands: Commands): HTMLDetailsElement {
  const language = named(say("Language of the report"));
  const menu: HTMLDetailsElement = h("details", { class: "menu" });
  const { film } = commands;
  const close = (then: () => void) => {
    menu.open = false;
    then();
  };
  const item = (text: string, kind: DownloadKind, format?: "svg" | "png") =>
    h(
      "button",
      {
        type: "button",
        "data-kind": kind,
        onclick: () => close(() => commands.download(kind, language.value, format)),
      },
      text,
    );
  menu.append(
    h(
      "summary",
      { "aria-label": say("Download"), title: say("Download") },
      icon(ICONS.save),
      h("span", { class: "word" }, say("Download")),
    ),
    h(
      "div",
      { class: "sheet" },
      item(say("Download model"), "model"),
      item(say("Download CSV"), "csv"),
      h("div", { class: "line" }, item(say("Download report"), "report"), language),
      item(say("Drawing as SVG"), "drawing", "svg"),
      item(say("Drawing as PNG"), "drawing", "png"),
      item(say("Motion as GIF"), "film"),
      film &&
        h(
          "button",
          { type: "button", "data-kind": "film", onclick: () => close(film) },
          say("Drawing and charts as video"),
        ),
      item(say("Page that plays without a server"), "played"),
      item(say("Page that computes without a server"), "interactive"),
      h("button", { type: "button", onclick: () => close(commands.link) }, say("Copy link")),
    ),
  );
  menu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !menu.open) return;
    event.stopPropagation();
    menu.open = false;
    menu.querySelector("summary")?.focus();
  });
  menu.addEventListener("focusout", (event) => {
    if (!menu.contains(event.relatedTarget as Node | null) && event.relatedTarget) menu.open = false;
  });
  return menu;
}

function button(text: string, picture: keyof typeof ICONS, onclick: () => void, name = text): HTMLButtonElement {
  const word = text ? h("span", { class: "word" }, text) : null;
  return h("button", { type: "button", "aria-label": name, title: name, onclick }, icon(ICONS[picture]), word);
}

/** What a command would do, and why it cannot (where `what` is null), as a tooltip and for screen readers. */
function able(element: HTMLButtonElement, name: string, what: string | null, why: string): void {
  element.disabled = what === null;
  const text = what ?? why;
  set(element, { title: text ? `${name}: ${text}` : name, "aria-description": text || null });
}
