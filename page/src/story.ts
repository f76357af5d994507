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

export interface Told {
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
  read(tab: string): Told | null;
  write(told: Told): void;
  /** Stories of tabs that are closed, or whose server is gone, the newest first. */
  left(): Promise<Told[]>;
}

/** Steps that a server keeps; beyond, it forgets the oldest. */
const DEEPEST = 500;
/** What begins anew, and a story with it. */
export const OPENS = new Set(["open", "design"]);
/** What a step is made by. */
const STEPS = new Set(["edit", "make", "balance", "entry"]);
/** Of these the last one is enough. */
const SETTINGS = new Set(["compare", "outputs", "arrows"]);

/** What is told of a machine, or a tool, that is open. */
export type Shown = Pick<State, "seq" | "name" | "steps">;

export class Story {
  private told: Told = empty("");
  /** Steps that the server could undo when it was heard last. */
  private depth = 0;

  constructor(private readonly shelf: Shelf | null) {}

  /** What to ask so that a server which has `base` open comes to where this tab was. */
  begin(base: string): PageRequest[] {
    const kept = this.shelf?.read(this.shelf.tab) ?? null;
    this.told = kept && fits(kept, base) ? kept : empty(base);
    return asked(this.told, base);
  }

  /** What was kept cannot be done again. */
  forget(): void {
    this.told = empty(this.told.base);
    this.write();
  }

  /** The same of a tab that is closed, whose story goes on in this one. */
  resume(told: Told, base: string): PageRequest[] {
    this.told = told;
    this.write();
    return asked(told, base);
  }

  /** Stories of closed tabs that began with what the server has open. */
  async offered(base: string): Promise<Told[]> {
    const left = (await this.shelf?.left()) ?? [];
    return left.filter((one) => stepCount(one) && fits(one, base));
  }

  /** Whether a server which has that open can be told it. */
  fits(base: string): boolean {
    return fits(this.told, base);
  }

  /** Everything, to be asked of a server that knows nothing but what it was started with. */
  all(base: string): PageRequest[] {
    return asked(this.told, base);
  }

  /** What waits for a server. */
  get waiting(): PageRequest[] {
    return this.told.lost ?? [];
  }

  /** Nothing waits any more where it is null. */
  waits(lost: PageRequest[] | null): void {
    if (lost) this.told.lost = lost;
    else if (this.told.lost) delete this.told.lost;
    else return;
    this.write();
  }

  /** Whether an answer tells of a step more. */
  private deeper(question: PageRequest, { steps: [past, future] }: Shown): boolean {
    if (past !== this.depth || past < DEEPEST) return past > this.depth;
    return future === 0 && STEPS.has(question.type);
  }

  /** A state was told. */
  heard(state: Shown): void {
    [this.depth] = state.steps;
  }

  /** A question was answered by a state. */
  remember(question: PageRequest, state: Shown): void {
    const { told } = this;
    if (OPENS.has(question.type)) this.told = { ...empty(told.base), start: [question] };
    else if (question.type === "record") {
      const { length } = question.text;
      told.record = length && length <= RECORD ? question : undefined;
    } else if (question.type === "undo") move(told.past, told.future, "start");
    else if (question.type === "redo") move(told.future, told.past, "end");
    else if (this.deeper(question, state)) {
      told.past.push([question]);
      told.future = [];
    } else follow(told.past[told.past.length - 1] ?? told.start, question);
    this.told.name = state.name;
    this.write();
  }

  /** The file on disk holds what was done. */
  saved(base: string, text: string): void {
    this.told.saved = base;
    this.told.text = text;
    this.write();
  }

  private write(): void {
    this.told.when = Date.now();
    this.shelf?.write(this.told);
  }
}

/** How many steps there are, with those that wait. */
export function stepCount({ past, lost = [] }: Told): number {
  return past.length + lost.length;
}

function empty(base: string): Told {
  return { base, name: "", when: 0, start: [], past: [], future: [] };
}

/** Whether it can be told to a server which has that open: nothing, or the same file. */
function fits(told: Told, base: string): boolean {
  if (told.start.some(({ type }) => OPENS.has(type))) return true;
  return told.base === base || (told.saved === base && told.text !== undefined);
}

function asked(told: Told, base: string): PageRequest[] {
  const { start, past, future, text, name, record } = told;
  const again = told.base !== base && text !== undefined && !start.some((a) => OPENS.has(a.type));
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
    return { tab, read, write: (told) => write(tab, told), left: () => left(tab) };
  } catch {
    return null; // a browser that keeps nothing
  }
}

function read(tab: string): Told | null {
  try {
    return JSON.parse(localStorage.getItem(PREFIX + tab) ?? "null") as Told | null;
  } catch {
    return null;
  }
}

function write(tab: string, told: Told): void {
  const text = JSON.stringify(told);
  const others = stories().filter((one) => one.tab !== tab);
  for (const { tab: old } of others.slice(MOST - 1)) localStorage.removeItem(PREFIX + old);
  try {
    if (text.length > LONGEST) throw new RangeError();
    localStorage.setItem(PREFIX + tab, text);
  } catch {
    localStorage.removeItem(PREFIX + tab); // more than is kept
  }
}

/** All that are kept, the newest first. */
function stories(): { tab: string; told: Told }[] {
  const tabs = Object.keys(localStorage)
    .filter((key) => key.startsWith(PREFIX))
    .map((key) => key.slice(PREFIX.length));
  return tabs
    .flatMap((tab) => {
      const told = read(tab);
      return told ? [{ tab, told }] : [];
    })
    .sort((one, other) => other.told.when - one.told.when);
}

async function left(own: string): Promise<Told[]> {
  const { held } = await navigator.locks.query();
  const open = new Set((held ?? []).map(({ name }) => name));
  return stories()
    .filter(({ tab, told }) => tab !== own && (told.lost || !open.has(PREFIX + tab)))
    .map(({ told }) => told);
}
