/** A wire without a server: it answers from the messages that a file holds. */

import type { Heard, Incoming, PageRequest, StateMessage, Wire } from "./protocol";
import { say } from "./words";

type Reply = [content: Incoming, bytes: string];

const OUTPUT = /^(before\.)?output\./;

/** Plays the replies of `played.py`: nothing can be changed, since nothing computes. */
export class Played implements Wire {
  private readonly listeners = new Set<Heard>();
  private readonly replies: [Incoming, DataView[]][];
  private wanted: string[];

  constructor(text: string) {
    const { replies, wanted } = JSON.parse(text) as { replies: Reply[]; wanted: string[] };
    this.replies = replies.map(([content, bytes]) => [content, decoded(bytes)]);
    this.wanted = wanted;
  }

  send(content: object): void {
    const request = content as PageRequest & { seq?: number };
    queueMicrotask(() => this.answer(request, request.seq ?? 0));
  }

  on(_event: "msg:custom", heard: Heard): void {
    this.listeners.add(heard);
  }

  off(_event: "msg:custom", heard: Heard): void {
    this.listeners.delete(heard);
  }

  private answer(request: PageRequest, seq: number): void {
    if (request.type === "outputs") this.wanted = request.names;
    this.reply(request, seq);
    this.say({ type: "answered", seq }, []);
  }

  private reply(request: PageRequest, seq: number): void {
    if (request.type === "speak") this.tell(["spoken"], seq);
    else if (request.type === "outputs") this.tell(["state"], seq);
    else if (request.type === "ready") this.tell(["hello", "state", "response", "planting", "strokes", "side"], seq);
    else {
      const message = say("this file plays what was computed; to change the machine, open its model in Equipoise");
      this.say({ type: "refused", seq, message, what: message }, []);
    }
  }

  private tell(types: string[], seq: number): void {
    for (const [content, buffers] of this.replies) {
      if (!types.includes(content.type)) continue;
      const state = content.type === "state" ? this.shown(content) : content;
      this.say("seq" in state ? ({ ...state, seq } as Incoming) : state, buffers);
    }
  }

  /** A state with the outputs that are drawn, and no others. */
  private shown(state: StateMessage): StateMessage {
    const kept = Object.entries(state.arrays).filter(
      ([name]) => !OUTPUT.test(name) || this.wanted.includes(name.replace(OUTPUT, "")),
    );
    return { ...state, arrays: Object.fromEntries(kept) };
  }

  private say(content: Incoming, buffers: DataView[]): void {
    for (const heard of [...this.listeners]) heard(content, buffers);
  }
}

function decoded(text: string): DataView[] {
  if (!text) return [];
  const bytes = Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
  return [new DataView(bytes.buffer)];
}
