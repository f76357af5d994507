/** A tour of five steps, each of which lets one do something: offered once, by mouse or keys. */

import { h } from "./dom";
import { say, toSay } from "./words";

const SEEN = "equipoise tour";

/** What somebody does on the page that ends a step. */
type Done = "dragged" | "turned" | "balanced" | "decided" | "linked";

interface Step {
  /** What of the page it is about. */
  where: string;
  what: string;
  text: string;
  /** What is to be done, after which the next step comes by itself. */
  until: Done;
}

const STEPS: Step[] = [
  {
    where: ".board",
    what: toSay("Drag a joint"),
    text: toSay(
      "Drag a joint or a centre of mass, with the mouse, a finger or the arrow keys: forces and charts follow at once. Two fingers or the wheel zoom.",
    ),
    until: "dragged",
  },
  {
    where: ".transport",
    what: toSay("Turn the crank"),
    text: toSay(
      "Play it in slow motion, stop it, or turn the crank with the slider; a click in a chart turns it to that angle. Each ? explains its chart and what to look for.",
    ),
    until: "turned",
  },
  {
    where: ".bar [data-do=balance]",
    what: toSay("Press Balance"),
    text: toSay(
      "It computes the masses that minimize the shaking of this machine, with a proof that no others are better.",
    ),
    until: "balanced",
  },
  {
    where: ".balance",
    what: toSay("See the reduction"),
    text: toSay(
      "{figure}. Keep the change or take it back; undo works on whole steps, also after the page is reloaded.",
    ),
    until: "decided",
  },
  {
    where: ".bar [data-do=download]",
    what: toSay("Share it"),
    text: toSay(
      "Copy link, under Download, copies an address that holds this machine; whoever opens it sees what you see. Model, pictures and a report are there too.",
    ),
    until: "linked",
  },
];

export class Tour {
  /** The offer, above the page; hidden once it has been answered. */
  readonly offer = h("div", { class: "lost offer", role: "status", hidden: true });
  private box: HTMLElement | null = null;
  private before: Element | null = null;
  private at = -1;
  private figure = "";

  constructor(private readonly root: HTMLElement) {}

  /** Offer it to who has not seen it. */
  propose(): void {
    if (seen()) return;
    const button = (text: string, act: () => void) =>
      h(
        "button",
        {
          type: "button",
          onclick: () => {
            this.offer.hidden = true;
            remember();
            act();
          },
        },
        text,
      );
    this.offer.replaceChildren(
      say("New here? A tour of five steps lets you drag, balance and share this machine."),
      " ",
      button(say("Take the tour"), () => this.begin()),
      button(say("No, thanks"), () => undefined),
    );
    this.offer.hidden = false;
  }

  begin(): void {
    this.end();
    this.offer.hidden = true;
    remember();
    this.before = document.activeElement;
    this.show(0);
  }

  /** Somebody did something: if the step asks for that, the next one comes.
   *  figure : what became of it, for the text of the step after it. */
  did(what: Done, figure = ""): void {
    if (STEPS[this.at]?.until !== what) return;
    this.figure = figure;
    this.show(this.at + 1, false);
  }

  /** focus : whether it goes to the tour; where something was just done it stays there. */
  private show(number: number, focus = true): void {
    const step = STEPS[number];
    if (!step) return this.end();
    this.clear();
    this.at = number;
    const targets = [...this.root.querySelectorAll(step.where)];
    const target = targets.find((target) => target.checkVisibility());
    target?.classList.add("toured");
    target?.scrollIntoView({ block: "nearest" });
    const last = number === STEPS.length - 1;
    const next = h(
      "button",
      { type: "button", class: "strong", onclick: () => this.show(number + 1) },
      last ? say("Done") : say("Next step"),
    );
    const back = h("button", { type: "button", onclick: () => this.show(number - 1) }, say("Back"));
    const end = h("button", { type: "button", onclick: () => this.end() }, say("End tour"));
    const values = { number: number + 1, count: STEPS.length };
    const figure = this.figure || say("Figures before and after stand beside the drawing");
    const text = h("p", { id: "equipoise-tour", role: "status" }, say(step.text, { figure }));
    this.box = h(
      "div",
      { class: "tour", role: "dialog", "aria-label": say("Tour"), "aria-describedby": text.id },
      h("h2", {}, `${say(step.what)} · ${say("{number} of {count}", values)}`),
      text,
      h("div", { class: "buttons" }, last ? null : end, number ? back : null, next),
    );
    this.box.addEventListener("keydown", (event) => this.key(event, number));
    this.root.append(this.box);
    if (focus) next.focus({ preventScroll: true });
  }

  private key(event: KeyboardEvent, number: number): void {
    event.stopPropagation();
    if (event.key === "Escape") this.end();
    else if (event.key === "ArrowRight") this.show(number + 1);
    else if (event.key === "ArrowLeft" && number) this.show(number - 1);
  }

  private clear(): void {
    this.box?.remove();
    this.box = null;
    this.at = -1;
    for (const element of this.root.querySelectorAll(".toured")) element.classList.remove("toured");
  }

  private end(): void {
    if (!this.box) return;
    const inside = this.box.contains(document.activeElement);
    this.clear();
    if (!inside) return;
    const back = this.before instanceof HTMLElement && this.before.isConnected ? this.before : null;
    (back ?? this.root.querySelector<HTMLElement>(".grip"))?.focus({ preventScroll: true });
  }
}

function seen(): boolean {
  try {
    return localStorage.getItem(SEEN) !== null;
  } catch {
    return true; // it could not be remembered that it was seen
  }
}

function remember(): void {
  try {
    localStorage.setItem(SEEN, "seen");
  } catch {
    // then it is offered again
  }
}
