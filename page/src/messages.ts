/** Written by page/messages.py from src/equipoise/web/protocol.py; do not edit. */

/** A value as it stands in a model file. */
export type Plain = string | number | boolean | Plain[] | { [key: string]: Plain };
export type Values = Record<string, Plain>;

/** A bundled model. */
export interface Example {
  name: string;
  title: string;
}

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

/** The first message of a server. */
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
  machine: boolean;
  /** Sign of the file that it can save, else name of what is open; empty where nothing is. */
  base: string;
  numbers: NumberRules;
}

/** What is asked beside the links of a part before it is added. */
export interface ToolOptions {
  word: string;
  /** What each is called, by its key in the request. */
  labels: PluralForms;
  /** Values with their names; none where numbers are asked. */
  choices: PluralForms;
  /** Of each at first. */
  value: string;
}

/** A tool that adds a part which joins two links. */
export interface PartTool {
  tool: string;
  /** By which it is taken. */
  key: string;
  name: string;
  /** What to click first. */
  first: string;
  then: string;
  /** Path of its icon, in a square of 16. */
  picture: string;
  /** Whether a click on the block of a slider means its link. */
  slides: boolean;
  options: ToolOptions | null;
}

/** A table that menus of the drawing offer to add, as it declares. */
export interface MenuItem {
  name: string;
  /** Path of the table or of its list in the file. */
  place: string;
  /** What its keys begin with, of what the menu is opened at; the first that can be had. */
  values: Record<string, MenuSource>[];
}

/** Korean particles by the word before them. */
export interface Particles {
  /** Both forms, as they stand in texts -> after a consonant, after rieul, after a vowel. */
  forms: Record<string, [string, string, string]>;
  /** What a word ends in, in NFD, and which of the three that is; the first match counts. */
  endings: [string, number][];
  /** Signs that may stand between a word and its particle. */
  closing: string;
  /** How many signs before a particle are looked at. */
  reach: number;
}

/** The language that is spoken from now on. */
export interface Spoken {
  type: "spoken";
  seq: number;
  language: string;
  /** Code of each language there is, and its own name. */
  languages: PluralForms;
  /** English text of the page -> text in the language. */
  words: PluralForms;
  /** Chart -> what it shows, and what to look for. */
  explained: PluralForms;
  /** As kinds of parts declare them. */
  part_tools: PartTool[];
  /** As tables of the file declare them. */
  menu_items: MenuItem[];
  particles: Particles | null;
  /** The sign before the decimals of a number that is shown. */
  decimal: string;
  /** English text of the page -> its forms by a count. */
  forms: Record<string, PluralForms>;
}

/** A link, with its points. */
export interface Body {
  name: string;
  points: string[];
}

/** A guide, with the point that slides on it. */
export interface Guide {
  name: string;
  point: string;
}

/** A circle that can be dragged, opposite to a point. */
export interface Circle {
  name: string;
  /** List of the file that has its part. */
  table: string;
  path: string;
  /** m */
  radius: number;
  axis: string;
  point: string;
}

/** Origin of a sign's axes, and what its x axis follows: a link, a guide, or a second point. */
export interface Hold {
  point?: string;
  link?: string;
  guide?: string;
  to?: string;
  length?: number;
  /** Whether the length between two points is constant. */
  rigid?: boolean;
  mount?: string;
  /** Place of a mount on the support at rest, m. */
  at?: Pair;
  /** From there to its ground, pixels. */
  ground?: Pair;
}

/** A part of the drawing, in its own axes; without a hold it does not move. */
export interface Sign {
  /** Whether it is around the linkage, and paths are drawn on it. */
  ground: boolean;
  /** Whether a pale design beside another is drawn by it. */
  compared: boolean;
  /** The link that it draws, if any. */
  link: string;
  hold: Hold | null;
  /** The slider or coupling that it draws, if any: `slider`, or its list, and its name. */
  part: [string, string] | null;
  /** Whether it is fixed to the ground, and not to the support. */
  still: boolean;
  shapes: DrawnShape[];
}

/** The drawing of a machine. */
export interface Scene {
  frame: string[];
  /** Points of the frame that hold something. */
  standing: string[];
  bodies: Body[];
  guides: Guide[];
  mass_centers: string[];
  box: [number, number, number, number];
  movable: string[];
  circles: Circle[];
  /** From the back to the front. */
  signs: Sign[];
  /** Centre of a support's rotation, m. */
  reference: Pair | null;
  /** Role of a shape -> its style. */
  looks: PluralForms;
}

/** A bundled machine, with its drawing. */
export interface Pictured {
  type: "pictured";
  seq: number;
  name: string;
  title: string;
  line: string;
  /** The part of the gallery that it stands in. */
  kind: string;
  /** By which it is found. */
  words: string;
  /** Sample at which it is drawn where it stands still. */
  at: number;
  scene: Scene;
  arrays: Arrays;
}

/** All pictures of the gallery have come. */
export interface Gallery {
  type: "gallery";
  seq: number;
}

/** The file that can be saved, and whether it holds the present model. */
export interface ModelFile {
  name: string;
  saved: boolean;
  comments: boolean;
}

/** The unit in which a number is shown. */
export interface Unit {
  unit: string;
  /** How many of the unit an SI unit is. */
  factor: number;
}

/** A number of the machine that can be edited. */
export interface Field extends Unit {
  path: string;
  group: string;
  /** Title of the group. */
  heading: string;
  label: string;
  value: number;
  /** With all digits that are kept, as it is typed. */
  text: string;
  /** Rounded, for display. */
  shown: string;
  kind: "number";
  min?: number | null;
  max?: number | null;
  step?: number | null;
  /** Label of the place whose x or y it is, both shown together. */
  pair?: string;
  /** The point that a length or direction moves. */
  moves?: string;
  /** Ends of a length between points. */
  between?: [string, string];
}

/** Texts of this machine that replace those of others, by English text and by chart. */
export interface Wording {
  words: PluralForms;
  explained: PluralForms;
}

/** RMS or peak of a signal, and that of the design it is compared with. */
export interface Figure {
  name: string;
  signal: string;
  measure: "rms" | "peak";
  label: string;
  unit: string;
  /** Null if it is not finite. */
  value: number | null;
  before?: number | null;
  text: string;
  /** Previous value and change; empty if it is the same. */
  was?: string;
}

/** An output that can be plotted over the crank angle; its samples are sent on request. */
export interface Output extends Unit {
  name: string;
  label: string;
  /** Heading under which it is offered. */
  group: string;
  /** Whether it is an angle, which may turn fully. */
  winds: boolean;
}

/** An array as the x axis of a chart, and the machine's place on it. */
export interface Axis extends Unit {
  array: string;
  /** Null where it follows what is played. */
  at: number | null;
}

/** A curve of a chart: every `stride`th number of an array, beginning with `part`. */
export interface CurveOf {
  array: string;
  stride: number;
  part: number;
  label: string;
  /** Whether it is points alone, without a line. */
  points?: boolean;
}

/** A signal that a chart can show. */
export interface Choice extends Unit {
  name: string;
  label: string;
  /** Whose forces have to be shown for it: "rows." of all rows, "" of one row; null for any. */
  of: string | null;
  /** Whether the scale is logarithmic. */
  log: boolean;
  curves: CurveOf[];
}

/** A chart: its x axis and the signals that it can show. */
export interface ChartData {
  name: string;
  x: "angle" | "order" | Axis;
  /** Label of its selection; null if it follows another chart's. */
  chooser: string | null;
  choices: Choice[];
}

/** Whether a machine can be computed, and what it lacks otherwise. */
export interface Status {
  /** Degrees of freedom; the drive commands one. */
  mobility: number;
  /** What moves, or what is missing. */
  text: string;
  finished: boolean;
  drive: string | null;
  /** Crank angle at which it was drawn, degrees. */
  stand?: number | null;
}

/** A measured record, and how the machine compares with it. */
export interface MeasuredRecord {
  name: string;
  lines: string[];
  left_out: string[];
}

/** A vector at a point over the crank angle. */
export interface ArrowOf extends Unit {
  kind: "velocity" | "acceleration" | "force";
  array: string;
  label: string;
}

/** Tips of planting fingers, and the height of the soil's surface. */
export interface Planting {
  tips: string[];
  surface: number;
}

/** A machine, finished or not, with everything that is drawn of it. */
export interface StateMessage {
  type: "state";
  /** Number of the question that it answers. */
  seq: number;
  name: string;
  title: string;
  description: string;
  undo: string | null;
  redo: string | null;
  /** How many steps can be undone and redone. */
  steps: Pair;
  /** The same as long as the same design is shown. */
  design: number;
  file: ModelFile | null;
  angles: number;
  turns: number;
  speed: number;
  /** Unit of the drawing's lengths. */
  length: Unit;
  /** Why there are no forces, and nothing to balance; empty if there are. */
  lacking: string;
  /** Whether the gauges of a support have readings. */
  shaken?: boolean;
  fields: Field[];
  wording: Wording;
  scene: Scene;
  arrays: Arrays;
  figures: Figure[];
  outputs: Output[];
  charts: ChartData[];
  /** The charts that show the purpose of the machine. */
  first: "squares" | "output" | "answers";
  /** Points whose paths are drawn, the most important first. */
  traced: string[];
  /** Size below which a force or moment is drawn as 0, N and N m. */
  least: number;
  orders: number[];
  notes: string[];
  /** Why a point is not where it was dragged to. */
  held?: string | null;
  /** Whether curves of another design are drawn behind. */
  before: boolean;
  status: Status;
  /** Whether figures of another design are shown. */
  compared: boolean;
  /** Points at which arrows can be drawn. */
  points: string[];
  /** The point at which they are drawn. */
  arrows_at: string | null;
  /** Its signals are `measured.` and an output. */
  record: MeasuredRecord | null;
  arrows: ArrowOf[];
  planting?: Planting | null;
  /** Whether links lie in different planes. */
  beside?: boolean;
}

/** A natural mode of the support. */
export interface SupportMode {
  lines: string[];
  seen: boolean;
  /** Real and imaginary parts along x, along y (m) and of the rotation, as large as drawn. */
  shape: number[];
}

/** The response of the support over speed. */
export interface ResponseMessage {
  type: "response";
  /** Number of the question that it answers; null for what comes later. */
  seq: number | null;
  charts: ChartData[];
  arrays: Arrays;
  notes: string[];
  /** What is to be said of the motion at work; its arrays are `support.place` and `.angle`. */
  swing: string[] | null;
  modes: SupportMode[];
}

/** A design that is drawn pale, or none. */
export interface GhostMessage {
  type: "ghost";
  /** Number of the question that it answers; null for what comes later. */
  seq: number | null;
  scene: Scene | null;
  arrays: Arrays;
}

/** A station on the shaft of a tool. */
export interface StationOnShaft {
  name: string;
  place: number;
  text: string;
}

/** Signs about a place of the shaft. */
export interface ShaftPiece {
  layer: "below" | "above";
  place: number;
  /** Whether they turn with the shaft. */
  turns: boolean;
  shapes: DrawnShape[];
}

/** A tool from the side at rest: lengths in m. */
export interface ToolScene {
  /** Start, stop, diameter. */
  tubes: [number, number, number][];
  stations: StationOnShaft[];
  pieces: ShaftPiece[];
  looks: PluralForms;
  box: [number, number, number, number];
}

/** How the shaft may be seen to move. */
export interface ShaftView {
  name: string;
  lines: string[];
  /** Real and imaginary parts along the shaft or support, as large as they are drawn. */
  shape: number[];
}

/** A figure before and after. */
export interface Change {
  name?: string;
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

/** A hand-held tool. */
export interface ToolMessage {
  type: "tool";
  seq: number;
  name: string;
  title: string;
  description: string;
  undo: string | null;
  redo: string | null;
  /** How many steps can be undone and redone. */
  steps: Pair;
  file: ModelFile | null;
  length: Unit;
  fields: Field[];
  scene: ToolScene;
  /** As it was opened, where it is another now. */
  before: ToolScene | null;
  /** Places along the shaft. */
  along: number[];
  views: ShaftView[];
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

/** Designs of a study that failed for one reason. */
export interface RefusedDesigns {
  why: string;
  code: number;
  count: number;
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
  refused: RefusedDesigns[];
  best: number[];
  arrays: Arrays;
}

/** Stores that can be opened. */
export interface Stores {
  type: "stores";
  seq: number;
  /** That they lie in; null where there is no server. */
  folder: string | null;
  names: string[];
}

/** A figure of every variant. */
export interface VariantRow {
  label: string;
  unit: string;
  texts: string[];
  best: number[];
}

/** Figures of designs that are kept, by column, and of the one that is. */
export interface VariantsMessage {
  type: "variants";
  /** Number of the question that it answers; null for what comes later. */
  seq: number | null;
  kept: string[];
  /** With what figures are compared: a word, or a variant. */
  against: string;
  rows: VariantRow[];
}

/** A figure that comes after the state. */
export interface Reading {
  name: string;
  label: string;
  unit: string;
  /** Null if it is not finite. */
  value: number | null;
  text: string;
  /** Previous value and change; empty if it is the same. */
  was?: string;
}

/** Figures of sliders, rockers and parts, and charts of loads along links with a section. */
export interface Strokes {
  type: "strokes";
  /** Number of the question that it answers; null for what comes later. */
  seq: number | null;
  figures: Reading[];
  /** Whether figures of another design are shown beside them. */
  compared: boolean;
  notes: string[];
  charts: ChartData[];
  arrays: Arrays;
}

/** Figures of a planting finger or of gauges. */
export interface Planted {
  type: "planting" | "gauges";
  /** Number of the question that it answers; null for what comes later. */
  seq: number | null;
  figures: Reading[];
  /** Whether figures of another design are shown beside them. */
  compared: boolean;
  notes: string[];
}

/** Links in different planes, drawn from the side. */
export interface Side {
  type: "side";
  /** Number of the question that it answers; null for what comes later. */
  seq: number | null;
  svg: string;
}

/** A balanced machine, beside the one that it comes from. */
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

/** Running text of a result. */
export interface TextBlock {
  kind: "text";
  text: string;
  /** Whether it stands out, as of a limit that is broken. */
  emphasized: boolean;
}

/** Sentences of a kind. */
export interface FactsBlock {
  kind: "facts";
  /** Empty where there is none. */
  title: string;
  items: string[];
}

/** A table whose cells are texts. */
export interface TableBlock {
  kind: "table";
  title: string;
  heads: string[];
  rows: string[][];
  /** Whether each column is set to the right. */
  numbers: boolean[];
  /** Row and column of each cell that stands out. */
  emphasized: [number, number][];
}

/** How the machine runs, and what came of it. */
export interface RunMessage {
  type: "run";
  seq: number;
  /** That of the state whose machine has run; 0 if it is shown no more. */
  design: number;
  blocks: (TextBlock | FactsBlock | TableBlock)[];
  charts: ChartData[];
  /** Poses that come along; 0 where those of the cycle are played. */
  frames: number;
  /** `run.time`, and `run.cycles`, the crank angle in cycles; poses, and `run.place` and `run.angle` of a support that moves; curves. */
  arrays: Arrays;
}

/** Why something cannot be done. */
export interface Refused {
  type: "refused";
  /** Number of the question that it answers; null for what comes later. */
  seq: number | null;
  message: string;
  /** Key of the model file that is wrong. */
  path?: string;
  /** What is wrong, without its place, and keys by the words of forms. */
  what: string;
  /** What `equipoise explain` knows about it. */
  topic?: string;
  /** Title and text of its page of errors. */
  cure?: [string, string];
}

/** A table of the file. */
export interface TableEntry {
  /** Its path in the file; empty of the whole file. */
  place: string;
  /** Its path, as refusals have it. */
  where: string;
  words: string;
  values: Record<string, Plain>;
  /** Keys of the tables below it. */
  below: string[];
}

/** Tables of one sort that a machine has, or can have. */
export interface Group {
  /** Its path in the file; empty of the whole file. */
  place: string;
  where: string;
  form: string;
  many: "one" | "list" | "named";
  word: string;
  text: string;
  /** The entry that it belongs to. */
  of: string;
  /** What has to be there first. */
  needs: string;
  required: boolean;
  entries: TableEntry[];
  /** What its entries are together. */
  result?: string;
}

/** What is asked for: how, and in which unit. */
export interface Asking {
  kind: "quantity" | "number" | "text" | "choice" | "flag" | "name" | "place" | "direction" | "list" | "names" | "file" | "wording";
  unit?: string;
  options?: (string | number)[];
  /** Of what it is the name. */
  of?: "link" | "body" | "point" | "output";
  /** The key of the same table that names the body of a point. */
  on?: string | null;
  /** Of places: or a point's name. */
  named?: boolean;
  /** Of places: with z. */
  space?: boolean;
  /** Of places: the key that names the link whose axes they are in. */
  axes?: string | null;
  item?: Asking;
  /** How many there can be; none for one and more. */
  sizes?: number[];
  /** Whether one stands without brackets. */
  bare?: boolean;
  /** What names are of. */
  by?: Asking;
  /** Whether names alone may do. */
  listed?: boolean;
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

/** The values that a key has to have where a rule looks at it. */
export interface Constant {
  const?: Plain;
  enum?: Plain[];
  type?: string;
  not?: Constant;
}

/** The part of a JSON Schema that states which keys go together. */
export interface Rule {
  required?: string[];
  properties?: Record<string, false | Constant>;
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

/** The keys of a table, and which of them go together. */
export interface Form {
  controls: Control[];
  rule: Rule;
}

/** The tables of the model file, and the forms in which they are asked for. */
export interface Tables {
  type: "tables";
  seq: number;
  groups: Group[];
  forms: Record<string, Form>;
  /** Points of the frame and of links, in their own axes, m. */
  bodies: Record<string, Record<string, Pair>>;
  /** What outputs that balancing can take are called, by name. */
  outputs: PluralForms;
}

/** The file is saved. */
export interface Saved {
  type: "saved";
  seq: number;
  name: string;
  /** Sign of the file as it is now. */
  base: string;
  /** The model that the page's steps began with. */
  text: string;
}

/** Something that takes longer has begun. */
export interface Busy {
  type: "busy";
  seq: number;
  what: string;
}

/** A file to be kept. */
export interface HandedOut {
  type: "file";
  seq: number;
  name: string;
  mime: string;
  /** Texts of the tables that it names. */
  files?: PluralForms;
}

/** All answers to a question have come, those too that take longer. */
export interface Answered {
  type: "answered";
  seq: number;
}

/** The page is there. */
export interface ReadyRequest {
  type: "ready";
}

/** The languages of the reader. */
export interface LanguageRequest {
  type: "speak";
  /** Codes, the one that is liked best first. */
  languages: string[];
}

/** A bundled model is opened. */
export interface ExampleRequest {
  type: "open";
  example: string;
}

/** A machine is begun. */
export interface NewRequest {
  type: "open";
  new: true;
}

/** A model file is opened. */
export interface FileRequest {
  type: "open";
  name: string;
  text: string;
  /** It is what the file held that the server was started with. */
  file?: true;
  /** Texts of its tables. */
  files?: PluralForms;
}

/** A number is set to the text that was typed. */
export interface TypedEdit {
  set: string;
  text: string;
  /** Points whose distance from the one that is moved is locked. */
  keep?: string[];
}

/** A number is set to a value in SI units. */
export interface NumberEdit {
  set: string;
  value: number;
}

/** A point is dragged. */
export interface DragEdit {
  move: string;
  to: Pair;
  /** Sample of the crank angle at which it is there. */
  at: number;
  keep?: string[];
}

/** The centre of mass of a link is dragged. */
export interface MassDragEdit {
  move_mass: string;
  to: Pair;
  at: number;
}

/** Numbers and places are changed. */
export interface EditRequest {
  type: "edit";
  commit: boolean;
  label: string;
  edits: Edit[];
}

/** An operation on the parts of a machine, with what it needs. */
export interface Made {
  do: string;
  [key: string]: unknown;
}

/** Parts of a machine are added, changed or taken away. */
export interface MakeRequest extends Made {
  type: "make";
  at: number;
}

/** What needs to be said by its name alone. */
export interface PlainRequest {
  type: "undo" | "redo" | "save" | "gallery" | "tables" | "stores";
}

/** The machine is to be balanced. */
export interface BalanceRequest {
  type: "balance";
  /** Whether gauges may not read more. */
  hold?: boolean;
}

/** The machine is to run, driven by its motor, weight, springs and loads. */
export interface RunRequest {
  type: "run";
}

/** Comparison with the machine as it was before balancing ends. */
export interface CompareRequest {
  type: "compare";
  on: false;
}

/** A table is put, or deleted where it has no values. */
export interface EntryRequest {
  type: "entry";
  label: string;
  /** Its path in the file, such as `springs[1]`; empty of the whole file. */
  place: string;
  values: Record<string, Plain> | null;
  name?: string;
  /** Texts of CSV files that it names. */
  files?: PluralForms;
}

/** Outputs whose samples are wanted. */
export interface OutputsRequest {
  type: "outputs";
  names: string[];
}

/** A file of the machine. */
export interface DownloadRequest {
  type: "download";
  kind: DownloadKind;
  language?: string;
  at?: number;
  format?: "svg" | "png";
}

/** The picture of a chart. */
export interface ChartRequest {
  type: "download";
  kind: "chart";
  chart: string;
  choice: string;
  format: "svg" | "png";
}

/** The point at which arrows are drawn. */
export interface ArrowsRequest {
  type: "arrows";
  point: string;
}

/** The design is kept as a variant. */
export interface PinRequest {
  type: "variant";
  do: "pin";
}

/** A variant is called something else. */
export interface RenameRequest {
  type: "variant";
  do: "rename";
  name: string;
  to: string;
}

/** A variant is taken up, or dropped. */
export interface VariantRequest {
  type: "variant";
  do: "go" | "drop";
  name: string;
}

/** With what figures are compared. */
export interface AgainstRequest {
  type: "variant";
  do: "against";
  to: string;
}

/** A measured record is laid over the curves. */
export interface RecordRequest {
  type: "record";
  name: string;
  text: string;
}

/** A store of a study is opened. */
export interface StudyRequest {
  type: "study";
  /** Another one of the server's folder. */
  store?: string;
}

/** A design of a study is opened. */
export interface DesignRequest {
  type: "design";
  number: number;
  store: string;
}

/** Questions that take long are given up. */
export interface CancelRequest {
  type: "cancel";
}

export type Pair = [number, number];

export type Arrays = Record<string, [number, number]>;

export type DrawnShape = [string, boolean, number, number, number[]];

export type PluralForms = Record<string, string>;

export type Edit = TypedEdit | NumberEdit | DragEdit | MassDragEdit;

export type MenuSource = "link" | "point" | "moving_point" | "ends" | "line" | "place";

export type DownloadKind = "model" | "csv" | "report" | "drawing" | "film" | "played" | "interactive";

export type Sent = Hello | Spoken | Pictured | Gallery | StateMessage | ResponseMessage | GhostMessage | ToolMessage | StudyMessage | Stores | VariantsMessage | Strokes | Planted | Side | Balanced | RunMessage | Refused | Tables | Saved | Busy | HandedOut | Answered;

export type PageRequest = ReadyRequest | LanguageRequest | ExampleRequest | NewRequest | FileRequest | EditRequest | MakeRequest | PlainRequest | BalanceRequest | RunRequest | CompareRequest | EntryRequest | OutputsRequest | DownloadRequest | ChartRequest | ArrowsRequest | PinRequest | RenameRequest | VariantRequest | AgainstRequest | RecordRequest | StudyRequest | DesignRequest | CancelRequest;
