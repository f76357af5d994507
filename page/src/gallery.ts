/** The bundled machines, each drawn small; what there is to open, and what the page is for. */

import { h, s } from "./dom";
import type { Numbers, Pictured, Stores } from "./protocol";
import { Piece } from "./signs";
import { View } from "./view";
import { say } from "./words";

/** Of the drawing, pixels; it is shown half as large, so that its signs are small too. */
const [WIDTH, HEIGHT] = [320, 224];
/** A turn that is shown of a machine that is pointed at, ms. */
const TURN = 2400;

interface Wishes {
  /** Ask for the pictures, once. */
  wanted(): void;
  /** Ask for the stores of studies. */
  stores(): void;
  store(name: string): void;
  example(name: string): void;
  begin(): void;
  file(): void;
}

export class Gallery {
  readonly root: HTMLDialogElement;
  private readonly kinds = h("div", { class: "kinds" });
  private readonly none = h("p", { class: "quiet", role: "status", hidden: true }, say("No machine has these words."));
  private readonly stores = h("section", { class: "stores", hidden: true });
  private readonly still = h("p", { class: "quiet", role: "status" }, say("Drawing the examples …"));
  private requested = false;

  constructor(private readonly wishes: Wishes) {
    const begin = () => this.take(() => wishes.begin());
    const search = h("input", {
      type: "search",
      "aria-label": say("Search examples"),
      placeholder: say("Search examples"),
      oninput: () => this.filter(search.value),
    });
    const close = h("button", { type: "button", onclick: () => this.root.close() }, say("Close"));
    const file = h(
      "button",
      { type: "button", class: "strong", onclick: () => this.take(() => wishes.file()) },
      say("Choose file"),
    );
    this.root = h(
      "dialog",
      { class: "help gallery", "aria-label": say("Open a machine") },
      h("h2", {}, say("Open a machine")),
      h(
        "p",
        {},
        say(
          "This page shows how a linkage moves and what it does to its frame: drag it, change its numbers, balance it.",
        ),
      ),
      h(
        "div",
        { class: "line" },
        file,
        h("button", { type: "button", onclick: begin }, say("New machine")),
        search,
        close,
      ),
      this.stores,
      this.still,
      this.none,
      this.kinds,
    );
    this.root.addEventListener("click", (event) => event.target === this.root && this.root.close());
  }

  show(): void {
    if (!this.requested) this.wishes.wanted();
    this.requested = true;
    this.wishes.stores();
    this.root.showModal();
  }

  /** Studies that lie beside what is open, or where the server was started. */
  stored({ folder, names }: Stores): void {
    this.stores.hidden = folder === null;
    const open = (name: string) =>
      h("button", { type: "button", onclick: () => this.take(() => this.wishes.store(name)) }, name);
    const none = say("The folder “{folder}” has no store of a study; the command equipoise sweep makes one.", {
      folder: folder ?? "",
    });
    this.stores.replaceChildren(
      h("h3", {}, say("Designs of a study")),
      names.length ? h("div", { class: "line" }, ...names.map(open)) : h("p", { class: "quiet" }, none),
    );
  }

  /** All pictures have come. */
  done(): void {
    this.still.remove();
  }

  /** They do not come: they are asked for again when it is shown again. */
  forget(): void {
    this.requested = false;
    this.kinds.replaceChildren();
  }

  add(pictured: Pictured, numbers: Numbers): void {
    const card = h(
      "button",
      {
        type: "button",
        class: "card",
        "data-name": pictured.name,
        "data-words": pictured.words,
        onclick: () => this.take(() => this.wishes.example(pictured.name)),
      },
      h("b", {}, pictured.title),
      h("span", { class: "quiet" }, pictured.line),
    );
    card.prepend(picture(card, pictured, numbers));
    this.cardsOf(pictured.kind).append(card);
  }

  /** The cards of a part of the gallery. */
  private cardsOf(kind: string): Element {
    const last = this.kinds.lastElementChild;
    if (last?.getAttribute("aria-label") === kind) return last.lastElementChild as Element;
    const cards = h("div", { class: "cards" });
    this.kinds.append(h("section", { "aria-label": kind }, h("h3", {}, kind), cards));
    return cards;
  }

  private take(then: () => void): void {
    this.root.close();
    then();
  }

  private filter(text: string): void {
    const words = text.toLowerCase().split(/\s+/);
    for (const card of this.kinds.querySelectorAll<HTMLElement>(".card")) {
      const all = `${card.dataset.name} ${card.textContent} ${card.dataset.words}`.toLowerCase();
      card.hidden = !words.every((word) => begins(all, word));
    }
    for (const kind of this.kinds.children as HTMLCollectionOf<HTMLElement>)
      kind.hidden = !kind.querySelector(".card:not([hidden])");
    this.none.hidden = this.still.isConnected || !!this.kinds.querySelector(".card:not([hidden])");
  }
}

/** Whether a word of a text begins so; scripts without spaces have no words to begin. */
function begins(text: string, start: string): boolean {
  const plain = /^[\x20-\x7e]*$/.test(start);
  const escaped = start.replace(/[.*+?^${}()|[\]\\/]/g, "\\$&");
  return plain ? new RegExp(`(^|[^\\p{L}\\p{N}])${escaped}`, "u").test(text) : text.includes(start);
}

/** A machine, that turns while it is pointed at or has the focus. */
function picture(card: HTMLElement, pictured: Pictured, numbers: Numbers): SVGSVGElement {
  const view = new View();
  [view.width, view.height] = [WIDTH, HEIGHT];
  view.fit(pictured.scene.box); // with room for the feet of pivots
  const pieces = pictured.scene.signs.map((sign) => new Piece(sign, pictured.scene));
  const size = { viewBox: `0 0 ${WIDTH} ${HEIGHT}` };
  const svg = s("svg", { class: "linkage small", "aria-hidden": "true", ...size });
  for (const piece of pieces) {
    piece.redraw(view.scale);
    svg.append(piece.element);
  }
  const pose = (k: number) => {
    for (const piece of pieces) piece.pose(numbers, view, k, null);
  };
  pose(pictured.at);
  const count = numbers.get("crank_angle")?.length ?? 1;
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  let [frame, since] = [0, 0];
  const tick = (now: number) => {
    since ||= now;
    pose((pictured.at + Math.floor(((now - since) / TURN) * 36)) % count);
    frame = requestAnimationFrame(tick);
  };
  const stop = () => {
    cancelAnimationFrame(frame);
    [frame, since] = [0, 0];
  };
  const start = () => {
    if (!frame && !still.matches) frame = requestAnimationFrame(tick);
  };
  card.addEventListener("pointerenter", start);
  card.addEventListener("focus", start);
  card.addEventListener("pointerleave", stop);
  card.addEventListener("blur", stop);
  return svg;
}
