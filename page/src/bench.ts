/** What stands beside the machine's numbers: the parts of its file, the underlay and the ruler. */

import { Aids } from "./aids";
import { Aim } from "./aim";
import type { Board } from "./board";
import type { Conversation } from "./conversation";
import { Parts } from "./parts";
import type { Pair, State, Tables } from "./protocol";
import type { Stage } from "./stage";
import { traceable } from "./underlay";

export interface Room {
  /** Pasted pictures are taken from anywhere in it. */
  root: HTMLElement | Document;
  talk: Conversation;
  stage: Stage;
  board: Board;
  state(): State | null;
  sample(): number;
}

export class Bench {
  readonly roots: HTMLElement[];
  readonly parts: Parts;
  private readonly aids: Aids;
  private readonly aim: Aim;

  constructor(private readonly room: Room) {
    const { stage, board, talk, state, sample } = room;
    this.aids = new Aids(stage, () => this.aim);
    this.aim = new Aim(stage, board, () => this.snaps());
    this.parts = new Parts({ talk, state, sample, aim: this.aim, scale: () => stage.view.scale });
    this.roots = [this.parts.root, this.aids.root];
    room.root.addEventListener("paste", this.paste);
  }

  close(): void {
    this.room.root.removeEventListener("paste", this.paste);
  }

  /** Ends and centres of the underlay, to which places snap, m. */
  snaps(): Pair[] {
    return this.aids.underlay.snaps();
  }

  /** Whether an underlay is seen, to be traced over. */
  tracing(): boolean {
    return this.aids.underlay.shown?.hidden === false;
  }

  /** The machine is another, or may be. */
  follow(): void {
    this.parts.follow();
  }

  /** Another file is open. */
  forget(): void {
    this.parts.forget();
  }

  show(tables: Tables): void {
    this.parts.show(tables);
  }

  /** Lay a file below the linkage, where it is a picture or drawing. */
  take(file: File): boolean {
    if (!traceable(file)) return false;
    void this.aids.take(file);
    return true;
  }

  private readonly paste = (event: Event): void => {
    const { files } = (event as ClipboardEvent).clipboardData ?? {};
    if ([...(files ?? [])].some((file) => this.take(file))) event.preventDefault();
  };
}
