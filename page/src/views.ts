/** What the page shows: a machine, a hand-held tool, or the designs of a study. */

import type { Conversation } from "./conversation";
import { h } from "./dom";
import type { Numbers, PageRequest, StudyMessage, ToolMessage } from "./protocol";
import { StudyView } from "./study";
import type { Theme } from "./theme";
import { ToolView } from "./tool";
import { say } from "./words";

export class Views {
  /** Of a machine; filled by who makes it, and of no use before there is one. */
  readonly body = h("div", { class: "body", inert: true });
  /** The way back to the designs, while one of them is open. */
  readonly back: HTMLButtonElement;
  private readonly tool: ToolView;
  private readonly study: StudyView;
  private store: string | null = null;
  private at: HTMLElement | null | undefined;

  constructor(talk: Conversation, theme: Theme, ask: (request: PageRequest) => void) {
    this.tool = new ToolView(talk, theme);
    this.study = new StudyView(ask, theme);
    this.back = h(
      "button",
      { type: "button", hidden: true, onclick: () => ask({ type: "study" }) },
      say("Designs of the study"),
    );
  }

  get roots(): HTMLElement[] {
    return [this.body, this.tool.root, this.study.root];
  }

  close(): void {
    this.tool.close();
    this.study.close();
  }

  /** The store that is open, if any. */
  stored(name: string | null | undefined): void {
    this.store = name ?? null;
    this.offer();
  }

  machine(): void {
    this.body.inert = false;
    this.turn(null);
  }

  showTool(message: ToolMessage, numbers: Numbers): void {
    this.turn(this.tool.root);
    this.tool.show(message, numbers);
  }

  showStudy(message: StudyMessage, numbers: Numbers): void {
    this.store = message.name;
    this.turn(this.study.root);
    this.study.show(message, numbers);
  }

  /** A sentence about what cannot be, where a machine's own drawing is not seen. */
  say(message: string, bad: boolean): void {
    this.tool.say(message, bad);
    this.study.say(message);
  }

  repaint(): void {
    this.study.repaint();
  }

  private turn(to: HTMLElement | null): void {
    if (to === this.at) return; // as at every move of a drag
    this.at = to;
    this.body.hidden = to !== null;
    if (to !== this.tool.root) this.tool.hide();
    if (to !== this.study.root) this.study.hide();
    this.offer();
  }

  private offer(): void {
    this.back.hidden = !this.store || this.at === this.study.root;
  }
}
