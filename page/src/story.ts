/** What was done to a machine, kept in the browser: a reload, or another server, does it again. */

import type { PageRequest, State } from "./protocol";

/** Most signs that are kept of one story, and most stories. */
const LONGEST = 4_000_000;
const MOST = 5;
/** Signs of a record that is kept: of a longer one the story would not be. */
const RECORD = 1_000_000;
const PREFIX = "equipoise story ";
const TAB = "equipoise tab";

/** What was asked, and what followed it that was no step of its own. */
type Step = PageRequest[];

export interface StoryData {
  /** Sign of the file that it began with; empty where the page has opened something. */
  base: string;
  /** Sign of that file as it was saved last, and what it held at first. */
  saved?: string;
  text?: string;
  /** Of the machine that it ends with. */
  name: string;
  when: number;
  start: Step;
  past: Step[];
  future: Step[];
  /** What was measured, which no step takes back. */
  record?: PageRequest | undefined;
  /** What waits for a server that does not answer; there while none does. */
  lost?: PageRequest[];
}

/** Where stories outlive the page; a widget in a notebook has none. */
export interface Shelf {
  readonly tab: string;
  read(tab: string): StoryData | null;
  write(data: StoryData): void;
  /** Stories of tabs that are closed, or whose server is gone, the newest first. */
  left(): Promise<StoryData[]>;
}

/** Steps that a server keeps; beyond, it forgets the oldest. */
const DEEPEST = 500;
/** What begins anew, and a story with it. */
export const OPENS = new Set(["open", "design"]);
/** What a step is made by. */
const STEPS = new Set(["edit", "make", "balance", "entry"]);
/** Of these the last one is enough. */
const SETTINGS = new Set(["compare", "outputs", "arrows"]);

/** State of the machine or tool that is open, as far as a story needs it. */
export type Shown = Pick<State, "seq" | "name" | "steps">;

export class Story {
  private data: StoryData = empty("");
  /** Steps that the server could undo when it was heard last. */
  private depth = 0;

  constructor(private readonly shelf: Shelf | null) {}

  /** What to ask so that a server which has `base` open comes to where this tab was. */
  begin(base: string): PageRequest[] {
    const kept = this.shelf?.read(this.shelf.tab) ?? null;
    this.data = kept && fits(kept, base) ? kept : empty(base);
    return requests(this.data, base);
  }

  /** What was kept cannot be done again. */
  forget(): void {
    this.data = empty(this.data.base);
    this.write();
  }

  /** The same of a tab that is closed, whose story goes on in this one. */
  resume(data: StoryData, base: string): PageRequest[] {
    this.data = data;
    this.write();
    return requests(data, base);
  }

  /** Stories of closed tabs that began with what the server has open. */
  async offered(base: string): Promise<StoryData[]> {
    const left = (await this.shelf?.left()) ?? [];
    return left.filter((data) => stepCount(data) && fits(data, base));
  }

  /** Whether it can be repeated on a server that has the file open. */
  fits(base: string): boolean {
    return fits(this.data, base);
  }

  /** Everything, to be asked of a server that knows nothing but what it was started with. */
  all(base: string): PageRequest[] {
    return requests(this.data, base);
  }

  /** What waits for a server. */
  get waiting(): PageRequest[] {
    return this.data.lost ?? [];
  }

  /** Nothing waits any more where it is null. */
  waits(lost: PageRequest[] | null): void {
    if (lost) this.data.lost = lost;
    else if (this.data.lost) delete this.data.lost;
    else return;
    this.write();
  }

  /** Whether an answer has one step more. */
  private deeper(question: PageRequest, { steps: [past, future] }: Shown): boolean {
    if (past !== this.depth || past < DEEPEST) return past > this.depth;
    return future === 0 && STEPS.has(question.type);
  }

  /** A state has come. */
  heard(state: Shown): void {
    [this.depth] = state.steps;
  }

  /** A question was answered by a state. */
  remember(question: PageRequest, state: Shown): void {
    const { data } = this;
    if (OPENS.has(question.type)) this.data = { ...empty(data.base), start: [question] };
    else if (question.type === "record") {
      const { length } = question.text;
      data.record = length && length <= RECORD ? question : undefined;
    } else if (question.type === "undo") move(data.past, data.future, "start");
    else if (question.type === "redo") move(data.future, data.past, "end");
    else if (this.deeper(question, state)) {
      data.past.push([question]);
      data.future = [];
    } else follow(data.past[data.past.length - 1] ?? data.start, question);
    this.data.name = state.name;
    this.write();
  }

  /** The file on disk holds what was done. */
  saved(base: string, text: string): void {
    this.data.saved = base;
    this.data.text = text;
    this.write();
  }

  private write(): void {
    this.data.when = Date.now();
    this.shelf?.write(this.data);
  }
}

/** How many steps there are, with those that wait. */
export function stepCount({ past, lost = [] }: StoryData): number {
  return past.length + lost.length;
}

function empty(base: string): StoryData {
  return { base, name: "", when: 0, start: [], past: [], future: [] };
}

/** Whether it can be repeated on a server that has that open: nothing, or the same file. */
function fits(data: StoryData, base: string): boolean {
  if (data.start.some(({ type }) => OPENS.has(type))) return true;
  return data.base === base || (data.saved === base && data.text !== undefined);
}

function requests(data: StoryData, base: string): PageRequest[] {
  const { start, past, future, text, name, record } = data;
  const again = data.base !== base && text !== undefined && !start.some((a) => OPENS.has(a.type));
  const open: PageRequest[] = again ? [{ type: "open", name, text, file: true }] : [];
  const back = future.map((): PageRequest => ({ type: "undo" }));
  const measured = record ? [record] : [];
  return [...open, ...start, ...past.flat(), ...future.flat(), ...back, ...measured];
}

/** One step from the end or the start of what was done to what can be done again, or back. */
function move(from: Step[], to: Step[], end: "start" | "end"): void {
  const step = end === "start" ? from.pop() : from.shift();
  if (!step) return;
  if (end === "start") to.unshift(step);
  else to.push(step);
}

/** Of what is no step the last of its kind is enough. */
function follow(step: Step, question: PageRequest): void {
  const last = step.findIndex(({ type }) => type === question.type);
  if (last >= 0 && SETTINGS.has(question.type)) step.splice(last, 1);
  step.push(question);
}

/** The browser's storage; `tab` outlives a reload, but not the tab. */
export function shelf(): Shelf | null {
  try {
    const tab = (sessionStorage[TAB] as string | undefined) ?? Math.random().toString(36).slice(2);
    sessionStorage[TAB] = tab;
    // While it is held others know that this tab is open.
    void navigator.locks.request(PREFIX + tab, () => new Promise(() => undefined));
    return { tab, read, write: (data) => write(tab, data), left: () => left(tab) };
  } catch {
    return null; // a browser that keeps nothing
  }
}

function read(tab: string): StoryData | null {
  try {
    return JSON.parse(localStorage.getItem(PREFIX + tab) ?? "null") as StoryData | null;
  } catch {
    return null;
  }
}

function write(tab: string, data: StoryData): void {
  const text = JSON.stringify(data);
  const others = stories().filter((story) => story.tab !== tab);
  for (const { tab: old } of others.slice(MOST - 1)) localStorage.removeItem(PREFIX + old);
  try {
    if (text.length > LONGEST) throw new RangeError();
    localStorage.setItem(PREFIX + tab, text);
  } catch {
    localStorage.removeItem(PREFIX + tab); // more than is kept
  }
}

/** All that are kept, the newest first. */
function stories(): { tab: string; data: StoryData }[] {
  const tabs = Object.keys(localStorage)
    .filter((key) => key.startsWith(PREFIX))
    .map((key) => key.slice(PREFIX.length));
  return tabs
    .flatMap((tab) => {
      const data = read(tab);
      return data ? [{ tab, data }] : [];
    })
    .sort((story, other) => other.data.when - story.data.when);
}

async function left(own: string): Promise<StoryData[]> {
  const { held } = await navigator.locks.query();
  const open = new Set((held ?? []).map(({ name }) => name));
  return stories()
    .filter(({ tab, data }) => tab !== own && (data.lost || !open.has(PREFIX + tab)))
    .map(({ data }) => data);
}
