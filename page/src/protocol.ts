/** What the page and the server say to each other. Lengths in m, angles in rad, all else in SI. */

import type {
  ChartData,
  Example,
  Field,
  Figure,
  Scene,
  Sign,
  StateMessage,
  Unit,
} from "./messages";
import type { Particles } from "./particles";

export type * from "./messages";

export type Pair = [number, number];

export type Edit =
  /** `keep`: points whose distance from the one that is moved is locked. */
  | { set: string; text: string; keep?: string[] }
  | { set: string; value: number }
  | { move: string; to: Pair; at: number; keep?: string[] }
  | { move_mass: string; to: Pair; at: number };

export type FileKind = "model" | "csv" | "report" | "drawing" | "film" | "played" | "interactive";

/** An operation on a machine that is made, with what it needs. */
export interface Made {
  do: string;
  [key: string]: unknown;
}

export type Asked =
  | { type: "ready" }
  /** Codes of languages, the one that is liked best first. */
  | { type: "speak"; languages: string[] }
  | { type: "open"; example: string }
  | { type: "open"; new: true }
  /** `file`: it is what the file held that the server was started with. `files`: its tables. */
  | { type: "open"; name: string; text: string; file?: true; files?: Record<string, string> }
  | { type: "edit"; commit: boolean; label: string; edits: Edit[] }
  | ({ type: "make"; at: number } & Made)
  | { type: "undo" | "redo" | "save" | "gallery" }
  | { type: "balance"; hold?: boolean }
  | { type: "compare"; on: false }
  | { type: "tables" }
  | EntryAsked
  | { type: "outputs"; names: string[] }
  | { type: "download"; kind: FileKind; language?: string; at?: number; format?: "svg" | "png" }
  | { type: "download"; kind: "chart"; chart: string; choice: string; format: "svg" | "png" }
  | { type: "arrows"; point: string }
  | { type: "variant"; do: "pin" }
  | { type: "variant"; do: "rename"; name: string; to: string }
  | { type: "variant"; do: "go" | "drop"; name: string }
  | { type: "variant"; do: "against"; to: string }
  | { type: "record"; name: string; text: string }
  | { type: "stores" }
  /** Of the store that is open, or of another one of the server's folder. */
  | { type: "study"; store?: string }
  | { type: "design"; number: number; store: string };

export interface Hello {
  type: "hello";
  version: string;
  examples: Example[];
  tools: Example[];
  /** Name of the store that is open. */
  study?: string | null;
  /** Most bytes of a model file. */
  largest: number;
  /** Whether the server holds a machine already. */
  machine?: boolean;
  /** Sign of the file that it can save, else name of what is open; empty where nothing is. */
  base: string;
  numbers: NumberRules;
}

/** A bundled machine, with its drawing. */
export interface Pictured {
  type: "pictured";
  seq: number;
  name: string;
  title: string;
  line: string;
  /** The part of the gallery that it stands in, and words that it is found by. */
  kind: string;
  words: string;
  /** Sample at which it is drawn where it stands still. */
  at: number;
  scene: Scene;
  arrays: Arrays;
}

/** The language that is spoken from now on. */
export interface Spoken {
  type: "spoken";
  language: string;
  /** Code of each language there is, and its own name. */
  languages: Record<string, string>;
  /** English text of the page -> text in the language. */
  words: Record<string, string>;
  /** Chart -> what it shows, and what to look for. */
  explained: Record<string, string>;
  /** How particles go by the word before them, in Korean. */
  particles?: Particles | null;
  /** The sign before the decimals of a number that is shown. */
  decimal: string;
  /** English text of the page -> its forms by a count. */
  forms: Record<string, Forms>;
}

/** Category of a count, such as `one` -> the text; `by` is the placeholder of the count. */
export type Forms = Record<string, string>;

/** How numbers are written everywhere in the product. */
export interface NumberRules {
  /** Sizes between which there is no power of ten. */
  least: number;
  most: number;
  /** What may follow a number in a sentence; longer ones first. */
  units: string[];
  /** m in each unit in which a length may be typed. */
  lengths: Record<string, number>;
}

/** A line through corners, or a circle about its only corner. */
export type Shape = Sign["shapes"][number];

/** Offset and length of each array. */
export type Arrays = StateMessage["arrays"];

export interface ResponseMessage {
  type: "response";
  seq: number;
  charts: ChartData[];
  arrays: Arrays;
  notes: string[];
  /** What is to be said of how the support moves at work; its arrays are `support.place` and `.angle`. */
  swing: string[] | null;
  /** Real and imaginary parts along x, along y (m) and of the rotation, as large as they are drawn. */
  modes: { told: string[]; seen: boolean; shape: number[] }[];
}

/** A tool from the side at rest: lengths in m. */
export interface ToolScene {
  tubes: [start: number, stop: number, diameter: number][];
  stations: { name: string; place: number; told: string }[];
  /** Signs about a place of the shaft; `turns` where they turn with it. */
  pieces: { layer: "below" | "above"; place: number; turns: boolean; shapes: Shape[] }[];
  looks: Record<string, string>;
  box: [number, number, number, number];
}

/** A hand-held tool. */
export interface ToolMessage {
  type: "tool";
  seq: number;
  name: string;
  title: string;
  description: string;
  undo: string | null;
  redo: string | null;
  steps: [past: number, future: number];
  file: State["file"];
  length: Unit;
  fields: Field[];
  scene: ToolScene;
  /** As it was opened, where it is another now. */
  before: ToolScene | null;
  /** Places along the shaft, and how it is seen to move: deflections there as complex numbers. */
  along: number[];
  views: { name: string; told: string[]; shape: number[] }[];
  figures: Change[];
  charts: ChartData[];
  arrays: Arrays;
  notes: string[];
}

/** What varies in a study, or what came of it. */
export interface ColumnOf extends Unit {
  name: string;
  label: string;
  kind: "number" | "output";
  /** At least and at most, SI units. */
  limits: [number | null, number | null];
  make: "smallest" | "largest" | null;
}

/** A store of a study. */
export interface StudyMessage {
  type: "study";
  seq: number;
  name: string;
  title: string;
  columns: ColumnOf[];
  /** Of the model itself, column by column, SI units. */
  own: number[] | null;
  size: number;
  drawn: number;
  computed: number;
  kept: number;
  limited: boolean;
  refused: { why: string; code: number; count: number }[];
  best: number[];
  arrays: Arrays;
}

/** Stores that can be opened, and the folder that they lie in; null where there is no server. */
export interface Stores {
  type: "stores";
  seq: number;
  folder: string | null;
  names: string[];
}

/** A design that is drawn pale, or none. */
export interface GhostMessage {
  type: "ghost";
  scene: Scene | null;
  arrays: Arrays;
}

/** Figures of designs that are kept, by column, and of the one that is. */
export interface VariantsMessage {
  type: "variants";
  kept: string[];
  /** What figures are told against: a word, or a variant. */
  against: string;
  rows: { label: string; unit: string; texts: string[]; best: number[] }[];
}

/** Links beside each other, drawn from the side. */
export interface Side {
  type: "side";
  svg: string;
}

/** Figures of a planting finger, of gauges, or of sliders and rockers; null where they are not finite. */
export interface Planted {
  type: "planting" | "gauges" | "strokes";
  figures: (Pick<Figure, "name" | "label" | "unit" | "value" | "text" | "was">)[];
  /** Whether figures of another design are told beside them. */
  compared: boolean;
  notes: string[];
}

export interface Change {
  label: string;
  unit: string;
  before: number;
  after: number;
  /** Before, after, and the change. */
  texts: [string, string, string];
  way: "same" | "better" | "worse";
  /** Whether it comes first: of a whole signal on the frame, or the mass that it takes. */
  main?: boolean;
}

export interface Balanced {
  type: "balanced";
  seq: number;
  changes: string[];
  /** What was to become small. */
  aims: Change[];
  figures: Change[];
  /** What got worse, a sentence for each kind of figure. */
  worse: string[];
  /** Whether a gauge reads more; then balancing can be asked for that holds them. */
  gauges_worse: boolean;
  proof: string;
  notes: string[];
}

export interface Refused {
  type: "refused";
  seq: number;
  message: string;
  /** Key of the model file that is wrong. */
  path?: string;
  /** What is wrong, without its place, and keys by the words of forms. */
  what?: string;
  /** What `equipoise explain` knows about it. */
  topic?: string;
  /** Title and text of its page, where it is a page of errors. */
  cure?: [string, string];
}

/** A file to be kept; `files` are texts of the tables that it names. */
export interface HandedOut {
  type: "file";
  seq: number;
  name: string;
  mime: string;
  files?: Record<string, string>;
}

/** Keys, names and numbers from 0 on the way to a table of a model file. */
export type Steps = (string | number)[];

/** A value as it stands in a model file. */
export type Plain = string | number | boolean | Plain[] | { [key: string]: Plain };
export type Values = Record<string, Plain>;

/** A table is put, or deleted where it has no values. */
export interface EntryAsked {
  type: "entry";
  label: string;
  place: Steps;
  values: Values | null;
  name?: string;
  /** Texts of CSV files that it names. */
  files?: Record<string, string>;
}

/** What is asked for: how, and in which unit. */
export interface Asking {
  kind: "quantity" | "number" | "text" | "choice" | "flag" | "name" | "place" | "direction"
    | "list" | "names" | "file" | "wording";
  unit?: string;
  options?: (string | number)[];
  /** Of what it is the name, and the key beside it that names the body of a point. */
  of?: "link" | "body" | "point" | "output";
  on?: string;
  /** Of places: or a point's name; with z; the key that names the link whose axes they are in. */
  named?: boolean;
  space?: boolean;
  axes?: string;
  item?: Asking;
  /** How many there can be; none for one and more. */
  sizes?: number[];
  /** One stands without brackets. */
  bare?: boolean;
  /** What names are of, and whether names alone may do. */
  by?: Asking;
  listed?: boolean;
}

/** The part of a JSON Schema that tells which keys go together. */
export interface Rule {
  required?: string[];
  properties?: Record<string, false | { const?: Plain; enum?: Plain[] }>;
  allOf?: Rule[];
  anyOf?: Rule[];
  oneOf?: Rule[];
  not?: Rule;
  if?: Rule;
  then?: Rule;
  else?: Rule;
  dependentRequired?: Record<string, string[]>;
  dependentSchemas?: Record<string, Rule>;
}

/** A key of a table. */
export interface Control extends Asking {
  key: string;
  word: string;
  text: string;
  required: boolean;
  default: Plain | null;
  example: Plain | null;
}

export interface EntryTold {
  place: Steps;
  /** Its path, as refusals tell it. */
  where: string;
  words: string;
  values: Values;
  /** Keys of the tables below it. */
  below: string[];
}

/** Tables of one sort that a machine has, or can have. */
export interface Group {
  place: Steps;
  where: string;
  form: string;
  many: "one" | "list" | "named";
  word: string;
  text: string;
  /** The entry that it belongs to, and what has to be there first. */
  of: string;
  needs: string;
  required: boolean;
  entries: EntryTold[];
  /** What its entries are together. */
  result?: string;
}

export interface Tables {
  type: "tables";
  seq: number;
  groups: Group[];
  forms: Record<string, { controls: Control[]; rule: Rule }>;
  /** Points of the frame and of links, in their own axes, m. */
  bodies: Record<string, Record<string, Pair>>;
  /** What outputs that balancing can take are called, by name. */
  outputs: Record<string, string>;
}

export type Told =
  | Hello
  | Spoken
  | Pictured
  /** All of them have come. */
  | { type: "gallery"; seq: number }
  | StateMessage
  | ResponseMessage
  | GhostMessage
  | ToolMessage
  | StudyMessage
  | Stores
  | VariantsMessage
  | Planted
  | Side
  | Balanced
  | Refused
  | Tables
  /** Sign of the file as it is now, and the model that its steps began with. */
  | { type: "saved"; seq: number; name: string; base: string; text: string }
  | { type: "busy"; seq?: number; what: string }
  | HandedOut
  /** All answers to a question have come, those too that take longer. */
  | { type: "told"; seq: number }
  /** Said by the page's own transport, never by a server. */
  | { type: "lost" | "back" };

/** Numbers over the samples, by name. */
export interface Rows {
  get(name: string): Float32Array | undefined;
  names(prefix: string): string[];
}

/** Numbers of a message, by name. */
export class Numbers implements Rows {
  private readonly floats: Float32Array;

  constructor(
    private readonly arrays: Arrays,
    buffer: DataView | undefined,
  ) {
    this.floats = buffer ? floats(buffer) : new Float32Array(0);
  }

  has(name: string): boolean {
    return name in this.arrays;
  }

  get(name: string): Float32Array | undefined {
    const found = this.arrays[name];
    return found && this.floats.subarray(found[0], found[0] + found[1]);
  }

  names(prefix: string): string[] {
    return Object.keys(this.arrays).filter((name) => name.startsWith(prefix));
  }
}

/** A machine as the page shows it: the message, and its arrays. */
export interface State extends StateMessage {
  numbers: Numbers;
}

/** What a drawing of a machine needs of its state. */
export type Drawable = Pick<State, "scene" | "angles" | "status"> & { numbers: Rows };

/** Notebooks may hand over bytes that start anywhere; arrays of floats need multiples of four. */
function floats(view: DataView): Float32Array {
  const length = view.byteLength >> 2;
  if (view.byteOffset % 4 === 0)
    return new Float32Array(view.buffer as ArrayBuffer, view.byteOffset, length);
  const bytes = new Uint8Array(view.buffer as ArrayBuffer, view.byteOffset, length * 4);
  return new Float32Array(bytes.slice().buffer);
}

/** The part of anywidget's model that the page uses; `connect` gives one over a WebSocket. */
export interface Wire {
  send(content: object): void;
  on(event: "msg:custom", heard: Heard): void;
  off(event: "msg:custom", heard: Heard): void;
  /** Give up what takes long; only where that can be done. */
  cancel?(): void;
  /** Let other tabs know where the server is; only where there is one. */
  announce?(): void;
}

export type Heard = (content: Told, buffers: DataView[]) => void;
