/** Written by page/messages.py from src/equipoise/web/protocol.py; do not edit. */

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
export interface Field {
  unit: string;
  /** How many of the unit an SI unit is. */
  factor: number;
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
  /** The point that a length or direction moves. */
  moves?: string;
  /** Ends of a length between points. */
  between?: [string, string];
}

/** Texts of this machine that replace those of others, by English text and by chart. */
export interface Wording {
  words: Record<string, string>;
  explained: Record<string, string>;
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

/** A base circle that can be dragged, opposite to the point of its follower. */
export interface BaseCircle {
  name: string;
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
  at?: [number, number];
  /** From there to its ground, pixels. */
  ground?: [number, number];
}

/** A part of the drawing, in its own axes; without a hold it does not move. */
export interface Sign {
  layer: string;
  /** The link that it draws, if any. */
  link: string;
  hold: Hold | null;
  /** The slider or coupling that it draws, if any: its kind and name. */
  part: ["slider" | "gears" | "belts" | "racks" | "cams", string] | null;
  /** Whether it is fixed to the ground, and not to the support. */
  still: boolean;
  shapes: [string, boolean, number, number, number[]][];
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
  cams: BaseCircle[];
  /** From the back to the front. */
  signs: Sign[];
  /** Centre of a support's rotation, m. */
  reference: [number, number] | null;
  /** Role of a shape -> its style. */
  looks: Record<string, string>;
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
export interface Output {
  unit: string;
  /** How many of the unit an SI unit is. */
  factor: number;
  name: string;
  label: string;
  /** Heading under which it is offered. */
  group: string;
  /** Whether it is an angle, which may turn fully. */
  winds: boolean;
}

/** An array as the x axis of a chart, and the machine's place on it. */
export interface Axis {
  unit: string;
  /** How many of the unit an SI unit is. */
  factor: number;
  array: string;
  at: number;
}

/** A curve of a chart: every `stride`th number of an array, beginning with `part`. */
export interface CurveOf {
  array: string;
  stride: number;
  part: number;
  label: string;
}

/** A signal that a chart can show. */
export interface Choice {
  unit: string;
  /** How many of the unit an SI unit is. */
  factor: number;
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
  told: string[];
  left_out: string[];
}

/** A vector at a point over the crank angle. */
export interface ArrowOf {
  unit: string;
  /** How many of the unit an SI unit is. */
  factor: number;
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
  steps: [number, number];
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
  arrays: Record<string, [number, number]>;
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

/** A bundled model. */
export interface Example {
  name: string;
  title: string;
}
