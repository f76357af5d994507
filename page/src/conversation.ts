/** One question at a time: of edits that wait, the newest is enough. */

import type { Asked, Edit, Told, Wire } from "./protocol";
import { mark } from "./frames";
import type { GhostMessage, VariantsMessage } from "./protocol";
import { Numbers, type Planted, type ResponseMessage, type State } from "./protocol";
import { language } from "./words";

export interface Events {
  hello(message: Extract<Told, { type: "hello" }>): void;
  state(state: State): void;
  response(message: ResponseMessage, numbers: Numbers): void;
  planting(message: Planted): void;
  ghost(message: GhostMessage, numbers: Numbers): void;
  variants(message: VariantsMessage): void;
  refused(message: string, edit: boolean): void;
  balanced(message: Extract<Told, { type: "balanced" }>): void;
  busy(what: string | null): void;
  file(name: string, mime: string, bytes: DataView | undefined): void;
  line(up: boolean): void;
}

export interface Memory {
  read(): string | null;
  write(text: string): void;
}

interface Question {
  seq: number;
  asked: Asked;
  answered?: ((refusal: string | null) => void) | undefined;
}

/** What takes long: other questions do not wait for it. */
const SLOW = new Set(["balance", "download"]);

/** What makes the machine on the server other than it was; said again after a broken line. */
const REMEMBERED = new Set(["edit", "undo", "redo", "balance", "compare", "outputs", "arrows", "variant"]);

export class Conversation {
  /** Drags and held keys under way; each ends before something else is asked. */
  readonly open = new Set<{ end(): void }>();
  private seq = Math.floor(Math.random() * 1e6) * 1000;
  private flight: Question | null = null;
  private readonly queue: Question[] = [];
  private waiting: Question | null = null;
  private readonly aside = new Map<number, Question>();
  private story: Asked[] = [];
  private repeating = false;

  /** `memory` is where what was done outlives a reload. */
  constructor(
    private readonly wire: Wire,
    private readonly events: Events,
    private readonly memory: Memory | null,
  ) {
    wire.on("msg:custom", this.hear);
  }

  close(): void {
    this.wire.off("msg:custom", this.hear);
  }

  /** End what is under way: another command comes. */
  release(): void {
    for (const gesture of [...this.open]) gesture.end();
  }

  /** Whether a question waits for its answer. */
  get busy(): boolean {
    return !!this.flight || this.queue.length > 0;
  }

  /** Ask; every question gets its answer, in this order. */
  ask(asked: Asked, answered?: (refusal: string | null) => void): void {
    this.dropWaiting();
    this.queue.push({ seq: ++this.seq, asked, answered });
    this.next();
  }

  /** Try an edit of a drag under way; a newer one takes its place while it waits. */
  attempt(label: string, edits: Edit[], stamp: number, answered?: Question["answered"]): void {
    const seq = ++this.seq;
    mark("equipoise:input", seq, stamp);
    this.dropWaiting();
    this.waiting = { seq, asked: { type: "edit", commit: false, label, edits }, answered };
    this.next();
  }

  private dropWaiting(): void {
    this.waiting = null;
  }

  private next(): void {
    if (this.flight) return;
    const question = this.queue.shift() ?? this.waiting;
    if (!question) return;
    if (question === this.waiting) this.waiting = null;
    // What follows a balance in a story was done to its result.
    if (SLOW.has(question.asked.type) && !this.repeating) this.aside.set(question.seq, question);
    else this.flight = question;
    this.wire.send({ ...question.asked, seq: question.seq });
    this.next();
  }

  private readonly hear = (told: Told, buffers: DataView[]): void => {
    switch (told.type) {
      case "hello":
        // Without a machine a `hello` is all the answer there is to `ready`.
        if (!told.machine && this.flight?.asked.type === "ready") this.flight = null;
        this.events.hello(told);
        return this.next();
      case "state":
        this.events.state({ ...told, numbers: new Numbers(told.arrays, buffers[0]) });
        return this.end(told.seq, null);
      case "response":
        return this.events.response(told, new Numbers(told.arrays, buffers[0]));
      case "ghost":
        return this.events.ghost(told, new Numbers(told.arrays, buffers[0]));
      case "variants":
        return this.events.variants(told);
      case "planting":
      case "strokes":
        return this.events.planting(told);
      case "refused":
        if (!this.repeating) this.refuse(told.seq, told.message);
        return this.end(told.seq, told.message);
      case "balanced":
        return this.events.balanced(told);
      case "busy":
        return this.events.busy(told.what);
      case "file":
        this.events.file(told.name, told.mime, buffers[0]);
        return this.end(told.seq, null);
      case "lost":
      case "back":
        return this.line(told.type === "back");
    }
  };

  private refuse(seq: number, message: string): void {
    const asked = this.flight?.seq === seq ? this.flight.asked : null;
    if (asked?.type !== "edit") return this.events.refused(message, false);
    // Who asks for a number and waits for the answer says it beside that number.
    if (!asked.commit || !this.flight?.answered) this.events.refused(message, true);
  }

  private end(seq: number, refusal: string | null): void {
    const question = this.flight?.seq === seq ? this.flight : this.aside.get(seq);
    if (!question) return;
    if (question === this.flight) this.flight = null;
    else if (this.aside.delete(seq)) this.events.busy(null);
    if (refusal === null && !this.repeating) this.remember(question.asked);
    if (this.repeating && !this.queue.length) this.repeating = false;
    question.answered?.(refusal);
    this.next();
  }

  private remember(asked: Asked): void {
    if (asked.type === "open") this.story = [asked];
    else if (REMEMBERED.has(asked.type) && !(asked.type === "edit" && !asked.commit)) {
      this.story.push(asked);
    } else return;
    this.memory?.write(JSON.stringify(this.story));
  }

  /** Do again what was done before the page was loaded; tells whether there was anything. */
  recall(): boolean {
    const text = this.memory?.read();
    this.story = text ? (JSON.parse(text) as Asked[]) : [];
    if (this.story.length) this.repeat(this.story);
    return this.story.length > 0;
  }

  private repeat(story: Asked[]): void {
    this.repeating = true;
    for (const asked of story) this.queue.push({ seq: ++this.seq, asked });
    this.next();
  }

  /** A new connection knows nothing: tell it all that was done. */
  private line(up: boolean): void {
    this.events.line(up);
    this.flight = null;
    this.waiting = null;
    this.queue.length = 0;
    if (this.aside.size) this.events.busy(null);
    this.aside.clear();
    if (!up) return;
    this.wire.send({ type: "speak", languages: [language()] });
    if (this.story.length) this.repeat(this.story);
    else this.ask({ type: "ready" });
  }
}
