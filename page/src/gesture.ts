/** A drag, a held key, a slider: many attempts, one step of undo. */

import type { Edit } from "./protocol";

/** Who tries edits while something is held, and carries them out: a server, or what computes here. */
export interface Attempts {
  readonly open: Set<{ end(): void; ending: boolean }>;
  /** End what is held. */
  release(): void;
  /** Try edits; `done` gets the reason of a refusal, or null. */
  attempt(label: string, edits: Edit[], stamp: number, done: (refusal: string | null) => void): void;
  ask(request: { type: "edit"; commit: boolean; label: string; edits: Edit[] }): void;
  /** Nothing is tried any more. */
  rest(): void;
}

export class Gesture {
  private tried: Edit[] | null = null;
  private good: Edit[] | null = null;
  private timer = 0;
  private done = false;

  constructor(
    private readonly talk: Attempts,
    private readonly label: string,
    private readonly ended: () => void = () => undefined,
  ) {
    talk.open.add(this);
  }

  /** Whether it ends by itself, and will be a step of undo then. */
  get ending(): boolean {
    return this.timer !== 0;
  }

  move(edits: Edit[], stamp: number): void {
    if (this.done) return;
    this.stay();
    this.tried = edits;
    this.talk.attempt(this.label, edits, stamp, (refusal) => {
      if (refusal === null) this.good = edits;
      if (refusal !== null && this.tried === edits) this.tried = null;
    });
  }

  /** End soon, unless it goes on: for keys, which have no clear end. */
  endSoon(after: number): void {
    this.stay();
    this.timer = window.setTimeout(() => this.end(), after);
  }

  /** Keep the last place: the newest where it stands or is not answered yet, else the last good. */
  end(): void {
    if (this.done) return;
    this.done = true;
    this.talk.open.delete(this);
    this.stay();
    const edits = this.tried ?? this.good;
    if (edits) this.talk.ask({ type: "edit", commit: true, label: this.label, edits });
    else this.talk.rest();
    this.ended();
  }

  /** It does not end by itself, or not yet. */
  private stay(): void {
    clearTimeout(this.timer);
    this.timer = 0;
  }
}
