/** What is done is kept: in the file, in an address, in the browser; nothing is lost unasked. */

import type { Conversation } from "./conversation";
import { h } from "./dom";
import type { Hello, PageRequest } from "./protocol";
import { type StoryData, stepCount } from "./story";
import type { Opened } from "./toolbar";
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

/** Most signs of an address that messengers and browsers pass on whole. */
export const LONGEST = 30_000;

interface Shared {
  name: string;
  text: string;
  /** Texts of the tables that it names. */
  files?: Record<string, string>;
}

/** The part behind the `#`, without it. */
async function fragment({ name, text, files = {} }: Shared): Promise<string> {
  const tables = Object.keys(files).length > 0 && { tables: await packed(JSON.stringify(files)) };
  return new URLSearchParams({ name, model: await packed(text), ...tables }).toString();
}

async function packed(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let signs = "";
  for (const byte of bytes) signs += String.fromCharCode(byte);
  return btoa(signs).replace(/\+/g, "-").replace(/\//g, "_").replace(/=/g, "");
}

/** What a fragment holds, and an error where that is no whole model. */
export async function read(hash: string, largest: number): Promise<Shared> {
  const parameters = new URLSearchParams(hash.replace(/^#/, ""));
  const [model, tables] = [parameters.get("model"), parameters.get("tables")];
  if (!model) throw new RangeError();
  const name = parameters.get("name") ?? "machine.toml";
  const files = tables && (JSON.parse(await unpacked(tables, largest)) as Record<string, string>);
  return { name, text: await unpacked(model, largest), ...(files && { files }) };
}

async function unpacked(packed: string, largest: number): Promise<string> {
  const signs = atob(packed.replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(signs, (sign) => sign.charCodeAt(0));
  return text(slowly(bytes).pipeThrough(new DecompressionStream("deflate")), largest);
}

/** Signs that are unpacked at a time: browsers unpack all that they are given, up to a thousandfold. */
const PIECE = 1024;

/** Bytes of which no more are handed on than are asked for. */
function slowly(bytes: Uint8Array<ArrayBuffer>): ReadableStream<Uint8Array<ArrayBuffer>> {
  let at = 0;
  const pull = (to: ReadableStreamDefaultController<Uint8Array<ArrayBuffer>>) => {
    to.enqueue(bytes.slice(at, at + PIECE));
    at += PIECE;
    if (at >= bytes.length) to.close();
  };
  return new ReadableStream({ pull }, { highWaterMark: 0 });
}

/** A few bytes can swell to any size: nothing is read beyond what a model may have. */
async function text(stream: ReadableStream<Uint8Array>, largest: number): Promise<string> {
  const reader = stream.getReader();
  const decoder = new TextDecoder("utf-8", { fatal: true });
  let [content, size] = ["", 0];
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return content + decoder.decode();
    size += value.length;
    if (size > largest) {
      await reader.cancel();
      throw new RangeError();
    }
    content += decoder.decode(value, { stream: true });
  }
}

interface Page {
  root: HTMLElement;
  talk: Conversation;
  /** Whether the page is all there is in its window. */
  full: boolean;
  shown(): Opened | null;
  say(text: string, bad: boolean): void;
  open(request: PageRequest, name: string): void;
}

export class Keeping {
  /** What was done in another tab is offered here. */
  readonly offer = h("div", { class: "lost offer", role: "status", hidden: true });
  private readonly undone: (() => void)[] = [];
  private largest = Infinity;
  private asking = false;

  constructor(private readonly page: Page) {
    if (!page.full) return;
    const leave = (event: BeforeUnloadEvent) => this.unsaved && event.preventDefault();
    const other = () => void this.shared();
    window.addEventListener("beforeunload", leave);
    window.addEventListener("hashchange", other);
    this.undone.push(() => window.removeEventListener("beforeunload", leave));
    this.undone.push(() => window.removeEventListener("hashchange", other));
  }

  close(): void {
    for (const undo of this.undone) undo();
  }

  /** Whether there is a file that does not hold what is shown. */
  private get unsaved(): boolean {
    return this.page.shown()?.file?.saved === false;
  }

  /** Restore what the address holds, or the steps made here; returns whether there was any. */
  async begin(hello: Hello): Promise<boolean> {
    this.largest = hello.largest;
    const resumed = await this.goOn(hello);
    this.page.talk.announce(); // once it is known what tabs without a server have left
    return resumed;
  }

  private async goOn(hello: Hello): Promise<boolean> {
    if (await this.shared()) return true;
    if (this.page.talk.recall(hello.base)) return true;
    const [record] = await this.page.talk.offered(hello.base);
    if (record && this.offer.hidden) this.show(record, hello.base);
    return false;
  }

  /** Whether another machine may take the place of this one. */
  async mayLeave(name: string): Promise<boolean> {
    const state = this.page.shown();
    if (!state?.undo || this.asking) return !this.asking;
    this.asking = true;
    const text = this.unsaved
      ? say("{file} is not saved. Opening {name} discards the changes and everything that can be undone.", {
          file: state.file?.name ?? "",
          name,
        })
      : say("Opening {name} discards the changes to {machine} and everything that can be undone.", {
          machine: state.name,
          name,
        });
    const may = await question(this.page.root, text, say("Open"));
    this.asking = false;
    return may;
  }

  /** Write the file; where there is none, the model is downloaded. */
  async save(): Promise<void> {
    const { page } = this;
    const shown = page.shown();
    if (!shown) return;
    const { file } = shown;
    page.talk.release();
    if (!file) return page.talk.ask({ type: "download", kind: "model" });
    if (file.saved) return page.say(say("{name} is saved", { name: file.name }), false);
    const text = say("{name} has comments, which are lost when the model is saved.", {
      name: file.name,
    });
    if (file.comments && !(await question(page.root, text, say("Save")))) return;
    page.talk.ask({ type: "save" });
  }

  saved(name: string): void {
    this.page.say(say("{name} is saved", { name }), false);
  }

  /** Copy an address that holds the model. */
  link(): void {
    const { page } = this;
    page.talk.release();
    page.talk.ask({ type: "download", kind: "model" }, undefined, ({ name, files }, bytes) => {
      const text = new TextDecoder().decode(bytes);
      void this.copy({ name, text, ...(files && { files }) });
    });
  }

  private async copy(shared: Shared): Promise<void> {
    const address = `${location.href.replace(/#.*/, "")}#${await fragment(shared)}`;
    if (address.length > LONGEST) {
      const values = { length: address.length, most: LONGEST };
      return this.page.say(
        say("the link would have {length} characters; at most {most} are reliable: download the model", values),
        true,
      );
    }
    try {
      await navigator.clipboard.writeText(address);
      this.page.say(say("The link is copied"), false);
    } catch {
      const field = h("input", { class: "address", readonly: true, value: address });
      field.setAttribute("aria-label", say("Link to this model"));
      this.offer.replaceChildren(
        field,
        this.button(say("Close"), () => undefined),
      );
      this.offer.hidden = false;
      field.select();
    }
  }

  /** Open what the address holds, which from then on is a machine like others. */
  private async shared(): Promise<boolean> {
    const { hash, pathname, search } = location;
    const example = new URLSearchParams(hash.slice(1)).get("example");
    if (!this.page.full || !(example || hash.includes("model="))) return false;
    history.replaceState(null, "", pathname + search);
    if (example) {
      this.page.open({ type: "open", example }, example);
      return true;
    }
    try {
      const model = await read(hash, this.largest);
      this.page.open({ type: "open", ...model }, model.name);
      return true;
    } catch {
      // Above the page, where no machine that opens takes it away.
      this.offer.replaceChildren(
        say("the address holds only a part of a model: copy the complete link"),
        " ",
        this.button(say("Close"), () => undefined),
      );
      this.offer.hidden = false;
      return false;
    }
  }

  private show(record: StoryData, base: string): void {
    const count = stepCount(record);
    this.offer.replaceChildren(
      say("{name} was changed here before, in {count} steps.", { name: record.name, count }),
      " ",
      this.button(say("Go on"), () => this.page.talk.resume(record, base)),
      this.button(say("Begin anew"), () => undefined),
    );
    this.offer.hidden = false;
  }

  private button(text: string, act: () => void): HTMLButtonElement {
    const onclick = () => {
      this.offer.hidden = true;
      act();
    };
    return h("button", { type: "button", onclick }, text);
  }
}
