/** A drag, a held key, a slider: many attempts, one step of undo. */

import type { Conversation } from "./conversation";
import type { Edit } from "./protocol";

export class Gesture {
  private tried: Edit[] | null = null;
  private good: Edit[] | null = null;
  private timer = 0;
  private done = false;

  constructor(
    private readonly talk: Conversation,
    private readonly label: string,
    private readonly ended: () => void = () => undefined,
  ) {
    talk.open.add(this);
  }

  move(edits: Edit[], stamp: number): void {
    if (this.done) return;
    clearTimeout(this.timer);
    this.tried = edits;
    this.talk.attempt(this.label, edits, stamp, (refusal) => {
      if (refusal === null) this.good = edits;
      if (refusal !== null && this.tried === edits) this.tried = null;
    });
  }

  /** End soon, unless it goes on: for keys, which have no clear end. */
  endSoon(after: number): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.end(), after);
  }

  /** Keep the last place: the newest where it stands or is not answered yet, else the last good. */
  end(): void {
    if (this.done) return;
    this.done = true;
    this.talk.open.delete(this);
    clearTimeout(this.timer);
    const edits = this.tried ?? this.good;
    if (edits) this.talk.ask({ type: "edit", commit: true, label: this.label, edits });
    this.ended();
  }
}
