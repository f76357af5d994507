/** One question at a time: of edits that wait, the newest is enough. */

import { mark } from "./frames";
import type {
  Edit,
  GhostMessage,
  HandedOut,
  Incoming,
  PageRequest,
  Refused,
  RunMessage,
  Stores,
  StudyMessage,
  Tables,
  ToolMessage,
  VariantsMessage,
  Wire,
} from "./protocol";
import {
  Numbers,
  type Pictured,
  type Planted,
  type ResponseMessage,
  type Side,
  type State,
  type Strokes,
} from "./protocol";
import { OPENS, type Shelf, type Shown, Story, type StoryData } from "./story";
import { language, say } from "./words";

/** What takes long: the kind of its question, and what is done, in words. */
export interface Computation {
  kind: PageRequest["type"];
  what: string;
  /** Whether it repeats a step of a story: without it the steps after it would go wrong. */
  repeated: boolean;
}

export interface Events {
  hello(message: Extract<Incoming, { type: "hello" }>): void;
  state(state: State): void;
  response(message: ResponseMessage, numbers: Numbers): void;
  strokes(message: Strokes, numbers: Numbers): void;
  planting(message: Planted): void;
  side(message: Side): void;
  ghost(message: GhostMessage, numbers: Numbers): void;
  variants(message: VariantsMessage): void;
  tool(message: ToolMessage, numbers: Numbers): void;
  study(message: StudyMessage, numbers: Numbers): void;
  stores(message: Stores): void;
  /** Something could not be done; `edit`: the number of the edit that was tried, if it was one. */
  refused(message: string, edit: number | null, refused: Refused | null): void;
  balanced(message: Extract<Incoming, { type: "balanced" }>): void;
  ran(message: RunMessage, numbers: Numbers): void;
  /** What takes long is computed now, in the order in which it began. */
  busy(computed: Computation[]): void;
  tables(message: Tables): void;
  saved(name: string): void;
  pictured(message: Pictured | null, numbers: Numbers): void;
  file(file: HandedOut, bytes: DataView | undefined): void;
  /** Whether the server answers; else whether it has another file open, and how much waits for it. */
  line(up: boolean, other: boolean, waiting: number): void;
  /** An answer takes longer than a reader waits without a sign. */
  waiting(on: boolean): void;
  /** Something was asked, or all that was asked is answered. */
  calm(on: boolean): void;
}

/** Hears that something was done, or why not. */
type Answered = (refusal: string | null, refused: Refused | null) => void;

interface Question {
  seq: number;
  request: PageRequest;
  answered?: Answered | undefined;
  /** Takes the file that is asked for, instead of the browser's downloads. */
  got?: ((file: HandedOut, bytes: DataView | undefined) => void) | undefined;
}

/** Number of no question: they begin with 1. */
const NONE = 0;

/** What takes long: other questions do not wait for it. */
const SLOW = new Set(["balance", "run", "download", "gallery"]);

/** Without a sign nobody waits longer than this, ms. */
const PATIENCE = 100;
/** For a move of a drag, which is seen itself: a bar that comes and goes with every move is no sign. */
const OF_A_MOVE = 500;

/** What leaves the machine on the server as it was; all else is said again after a broken line. */
const IDLE = new Set(["ready", "speak", "save", "download", "tables", "study", "stores"]);

/** What is kept until a server answers that does not: what changes the machine, or how it is shown. */
const kept = ({ type }: PageRequest) => !(IDLE.has(type) || SLOW.has(type) || OPENS.has(type));

/** Whether it only tries an edit, while something is held. */
const isMove = (request: PageRequest) => request.type === "edit" && !request.commit;

/** Who asks these says himself why not. */
const ASIDE = new Set(["entry", "tables"]);

export class Conversation {
  /** Drags and held keys under way; each ends before something else is asked. */
  readonly open = new Set<{ end(): void; ending: boolean }>();
  private seq = Math.floor(Math.random() * 1e6) * 1000;
  private flight: Question | null = null;
  private readonly queue: Question[] = [];
  private waiting: Question | null = null;
  private readonly aside = new Map<number, Question>();
  /** What the server computes, by the numbers of the questions. */
  private readonly computed = new Map<number, Computation>();
  private readonly story: Story;
  /** The last request that is answered completely. */
  private whole = 0;
  private late = 0;
  /** The last question of a story that is done again. */
  private repeats = 0;
  /** Whether the server does not answer, and whether a new line waits for its first word. */
  private down = false;
  private returning = false;

  /** `shelf` is where what was done outlives a reload. */
  constructor(
    private readonly wire: Wire,
    private readonly events: Events,
    shelf: Shelf | null,
  ) {
    this.story = new Story(shelf);
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

  /** Whether everything that was asked has all its answers, and nothing more is about to be asked. */
  get calm(): boolean {
    const asks = [...this.open].some(({ ending }) => ending);
    return !asks && !this.busy && !this.waiting && !this.aside.size && this.whole >= this.seq;
  }

  /** Say that all is answered, if it is. */
  rest(): void {
    if (this.calm) this.events.calm(true);
  }

  /** Ask; every question gets its answer, in this order. */
  ask(request: PageRequest, answered?: Answered, got?: Question["got"]): void {
    this.dropWaiting();
    if (this.down && !kept(request)) return this.unheard(answered);
    this.queue.push({ seq: ++this.seq, request, answered, got });
    if (this.down) this.wait(false);
    this.next();
  }

  /** Try an edit of a drag under way; a newer one takes its place while it waits. */
  attempt(label: string, edits: Edit[], stamp: number, answered?: Question["answered"]): void {
    if (this.down) return;
    const seq = ++this.seq;
    mark("equipoise:input", seq, stamp);
    this.dropWaiting();
    this.waiting = { seq, request: { type: "edit", commit: false, label, edits }, answered };
    this.next();
  }

  private dropWaiting(): void {
    this.waiting = null;
  }

  private next(): void {
    if (this.flight || this.down) return;
    const question = this.queue.shift() ?? this.waiting;
    if (!question) return;
    if (question === this.waiting) this.waiting = null;
    // What follows a balance in a story was done to its result.
    if (SLOW.has(question.request.type) && !this.repeated(question.seq)) this.aside.set(question.seq, question);
    else this.flight = question;
    this.events.calm(false);
    const patience = isMove(question.request) ? OF_A_MOVE : PATIENCE;
    if (this.flight) this.late ||= window.setTimeout(() => this.events.waiting(true), patience);
    this.wire.send({ ...question.request, seq: question.seq });
    this.next();
  }

  private readonly hear = (message: Incoming, buffers: DataView[]): void => {
    switch (message.type) {
      case "hello":
        // Without a machine a `hello` is all the answer there is to `ready`.
        if (!message.machine && this.flight?.request.type === "ready") this.land();
        this.events.hello(message);
        return this.returning ? this.back(message.base) : this.next();
      case "state":
        return this.state({ ...message, numbers: new Numbers(message.arrays, buffers[0]) });
      case "pictured":
        return this.events.pictured(message, new Numbers(message.arrays, buffers[0]));
      case "gallery":
        this.events.pictured(null, new Numbers({}, undefined));
        return this.end(message.seq, null);
      case "saved":
        this.story.saved(message.base, message.text);
        return this.events.saved(message.name);
      case "response":
        return this.events.response(message, new Numbers(message.arrays, buffers[0]));
      case "ghost":
        return this.events.ghost(message, new Numbers(message.arrays, buffers[0]));
      case "tool":
        this.events.tool(message, new Numbers(message.arrays, buffers[0]));
        return this.heard(message);
      case "study":
        this.events.study(message, new Numbers(message.arrays, buffers[0]));
        return this.end(message.seq, null);
      case "stores":
        this.events.stores(message);
        return this.end(message.seq, null);
      case "variants":
        return this.events.variants(message);
      case "strokes":
        return this.events.strokes(message, new Numbers(message.arrays, buffers[0]));
      case "planting":
      case "gauges":
        return this.events.planting(message);
      case "side":
        return this.events.side(message);
      case "refused":
        if (!this.repeated(message.seq ?? NONE)) this.refuse(message);
        return this.end(message.seq ?? NONE, message.message, message);
      case "tables":
        this.events.tables(message);
        return this.end(message.seq, null);
      case "balanced":
        return this.events.balanced(message);
      case "run":
        this.end(message.seq, null); // which takes away that it runs
        return this.events.ran(message, new Numbers(message.arrays, buffers[0]));
      case "busy":
        return this.working(message.seq, message.what);
      case "file":
        this.file(message, buffers[0]);
        return this.end(message.seq, null);
      case "answered":
        this.whole = Math.max(this.whole, message.seq);
        return this.events.calm(this.calm);
      case "lost":
      case "back":
        return this.line(message.type === "back");
    }
  };

  private working(seq: number, what: string): void {
    const kind = this.question(seq)?.request.type;
    if (!kind) return; // nobody waits for it any more
    this.computed.set(seq, { kind, what, repeated: this.repeated(seq) });
    this.events.busy([...this.computed.values()]);
  }

  private question(seq: number): Question | undefined {
    return this.flight?.seq === seq ? this.flight : this.aside.get(seq);
  }

  private file(file: HandedOut, bytes: DataView | undefined): void {
    const got = this.aside.get(file.seq)?.got ?? this.flight?.got;
    if (got) got(file, bytes);
    else this.events.file(file, bytes);
  }

  private refuse(refused: Refused): void {
    const { message } = refused;
    const seq = refused.seq ?? NONE;
    const request = this.flight?.seq === seq ? this.flight.request : null;
    if (request && ASIDE.has(request.type) && this.flight?.answered) return;
    if (request?.type !== "edit") return this.events.refused(message, null, refused);
    // Who asks for a number and waits for the answer says it beside that number.
    if (!request.commit || !this.flight?.answered) this.events.refused(message, seq, refused);
  }

  private end(seq: number, refusal: string | null, refused: Refused | null = null): void {
    const question = this.question(seq);
    if (!question) return;
    if (question === this.flight) this.land();
    else this.aside.delete(seq);
    if (this.computed.delete(seq)) this.events.busy([...this.computed.values()]);
    // Without what a story began with, nothing of it can be done.
    if (this.repeated(seq) && refusal !== null && OPENS.has(question.request.type)) {
      this.queue.splice(0, this.repeats - seq);
      this.story.forget();
    }
    question.answered?.(refusal, refused);
    this.next();
    this.rest(); // all other answers may have come before
  }

  private land(): void {
    this.flight = null;
    clearTimeout(this.late);
    this.late = 0;
    this.events.waiting(false);
  }

  private state(state: State): void {
    // What was tried since is computed while this is drawn.
    const ahead = this.waiting !== null && this.flight?.seq === state.seq && !this.queue.length;
    if (ahead) this.heard(state);
    this.events.state(state);
    if (!ahead) this.heard(state);
  }

  /** A question was answered by what is open now. */
  private heard(state: Shown): void {
    const { seq } = state;
    const request = this.question(seq)?.request;
    if (request && !this.repeated(seq) && !isMove(request) && !IDLE.has(request.type))
      this.story.remember(request, state);
    this.story.heard(state);
    this.end(seq, null);
  }

  /** Repeat the steps made in this tab; returns whether there were any. */
  recall(base: string): boolean {
    return this.goOn(this.story.begin(base));
  }

  /** Go on with what was done in a tab that is closed, or whose server is gone. */
  resume(record: StoryData, base: string): void {
    this.goOn(this.story.resume(record, base));
  }

  /** What was done in such tabs. */
  offered(base: string): Promise<StoryData[]> {
    return this.story.offered(base);
  }

  /** Let other tabs know where the server is. */
  announce(): void {
    this.wire.announce?.();
  }

  /** Whether a question is of a story, and not of who sits here now. */
  private repeated(seq: number): boolean {
    return seq <= this.repeats;
  }

  /** Repeat a story, and ask what was left to be asked. */
  private goOn(story: PageRequest[]): boolean {
    const waiting = this.story.waiting;
    this.story.waits(null);
    this.repeat(story);
    for (const request of waiting) this.ask(request);
    return story.length + waiting.length > 0;
  }

  private repeat(story: PageRequest[]): void {
    for (const request of story) this.queue.push({ seq: ++this.seq, request });
    this.repeats = this.seq;
    this.next();
  }

  private line(up: boolean): void {
    this.returning = up;
    if (up) return;
    if (this.down) return this.wait(false);
    this.down = true;
    const open = [...(this.flight ? [this.flight] : []), ...this.queue, ...this.aside.values()];
    this.land();
    this.waiting = null;
    if (this.computed.size) this.events.busy([]);
    this.computed.clear();
    this.aside.clear();
    this.queue.length = 0;
    for (const question of open.filter(({ seq }) => !this.repeated(seq))) {
      if (kept(question.request)) this.queue.push(question);
      else if (question.request.type !== "ready") this.unheard(question.answered);
    }
    this.wait(false);
  }

  /** What is asked is kept, for another tab too. */
  private wait(other: boolean): void {
    this.story.waits(this.queue.map(({ request }) => request));
    this.events.line(false, other, this.queue.length);
  }

  private unheard(answered: Answered | undefined): void {
    const message = say("the server does not answer; ask again when it does");
    if (answered) answered(message, null);
    else this.events.refused(message, null, null);
  }

  /** A new connection knows nothing: repeat all steps on it, and then send what has waited. */
  private back(base: string): void {
    this.returning = false;
    if (!this.story.fits(base)) return this.wait(true);
    this.down = false;
    const waiting = this.queue.splice(0);
    this.story.waits(null);
    this.events.line(true, false, 0);
    this.wire.send({ type: "speak", languages: [language()] });
    const story = this.story.all(base);
    if (story.length) this.repeat(story);
    else this.ask({ type: "ready" });
    for (const question of waiting) this.queue.push({ ...question, seq: ++this.seq });
  }
}
