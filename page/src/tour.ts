/** A tour of five steps: offered once, taken by mouse or keys, remembered. */

import { h } from "./dom";
import { say, toSay } from "./words";

const SEEN = "equipoise tour";

interface Step {
  /** What of the page it is about. */
  where: string;
  what: string;
  text: string;
}

const STEPS: Step[] = [
  {
    where: ".board",
    what: toSay("The linkage"),
    text: toSay(
      "Drag a joint or a centre of mass, with the mouse, a finger or the arrow keys: forces and charts follow at once. Two fingers or the wheel zoom.",
    ),
  },
  {
    where: ".transport",
    what: toSay("The motion"),
    text: toSay("Play it slower than it is, stop it, or turn the crank by the slider."),
  },
  {
    where: ".side",
    what: toSay("The charts"),
    text: toSay(
      "What shakes the frame and what the drive needs. Each ? says what its chart shows and what to look for; a click in a chart turns the crank there.",
    ),
  },
  {
    where: ".inspector",
    what: toSay("The numbers"),
    text: toSay(
      "Type any number with its unit, such as 71.5 mm or 2.8 in, or move its slider. Undo takes back whole steps, also after the page was loaded again.",
    ),
  },
  {
    where: ".bar",
    what: toSay("Open, balance, keep"),
    text: toSay(
      "Open other machines, let the page find what balances this one, and take along the model, pictures, a report or a link.",
    ),
  },
];

export class Tour {
  /** The offer, above the page; hidden once it has been answered. */
  readonly offer = h("div", { class: "lost offer", role: "status", hidden: true });
  private box: HTMLElement | null = null;
  private before: Element | null = null;

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
      say("New here? A tour of five steps shows the page."),
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

  private show(number: number): void {
    const step = STEPS[number];
    if (!step) return this.end();
    this.clear();
    const targets = [...this.root.querySelectorAll(step.where)];
    const target = targets.find((one) => one.checkVisibility());
    target?.classList.add("toured");
    target?.scrollIntoView({ block: "nearest" });
    const last = number === STEPS.length - 1;
    const next = h(
      "button",
      { type: "button", class: "strong", onclick: () => this.show(number + 1) },
      last ? say("Done") : say("Next"),
    );
    const back = h("button", { type: "button", onclick: () => this.show(number - 1) }, say("Back"));
    const end = h("button", { type: "button", onclick: () => this.end() }, say("End tour"));
    const values = { number: number + 1, count: STEPS.length };
    const text = h("p", { id: "equipoise-tour" }, say(step.text));
    this.box = h(
      "div",
      { class: "tour", role: "dialog", "aria-label": say("Tour"), "aria-describedby": text.id },
      h("h2", {}, `${say(step.what)} · ${say("{number} of {count}", values)}`),
      text,
      h("div", { class: "buttons" }, last ? null : end, number ? back : null, next),
    );
    this.box.addEventListener("keydown", (event) => this.key(event, number));
    this.root.append(this.box);
    next.focus({ preventScroll: true });
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
    for (const one of this.root.querySelectorAll(".toured")) one.classList.remove("toured");
  }

  private end(): void {
    if (!this.box) return;
    this.clear();
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
