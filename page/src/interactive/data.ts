/** What an interactive file holds of its machine. Lengths in m, angles in rad, all else in SI units. */

import type { NumberRules, Scene, Unit } from "../protocol";

/** Computes signals (rows of `out`) at all crank angles from the numbers of a machine. */
export type States = (design: Float64Array, grid: Float64Array, angles: number, out: Float64Array) => void;

/**
 * Highest and lowest sample of a signal; its highest value with the crank angle of that, and its
 * lowest, of the curve through the samples. Where these resolve jumps, first come those shown, at
 * crank angles `at`, then those of the panels between `edges`.
 */
export type Extremes = (
  values: Float64Array,
  period: number,
  at: Float64Array | null,
  edges: Float64Array | null,
) => Float64Array;

export interface Output extends Unit {
  name: string;
  label: string;
  /** Heading under which it is offered. */
  group: string;
  kind: string;
  /** Whether figures of it are reported, and whether it is of frame or drive. */
  summed: boolean;
  first: boolean;
}

/** A number of the model file. */
export interface Field extends Unit {
  path: string;
  /** Keys on the way to it, and numbers in lists from 0. */
  steps: (string | number)[];
  label: string;
  heading: string;
  value: number;
  /** Its unit as a file has it, and SI units in each in which it may be typed. */
  written: string;
  units: Record<string, number>;
  least: number | null;
  above: number | null;
  below: number | null;
}

/** A length between two points of a body, of which the second moves. */
export interface Measure extends Unit {
  label: string;
  heading: string;
  start: string;
  moves: string;
  /** Paths of the points, without x and y; the first may have no numbers. */
  from: string;
  path: string;
  /** From the origin of the body to the first, where that has no numbers. */
  fixed: [number, number];
  units: Record<string, number>;
}

export type Corner = string | [guide: string, share: number] | null;

/** What a shape of a sign is tied to: see `equipoise/web/drawing.py`. */
export interface Tie {
  corners?: Corner[];
  hull?: boolean;
  turned?: { about: string; between?: [string, string]; of?: string };
  made_of?: string[];
  strand?: { side: number; between: [string, string]; radii: [number, number] };
}

export interface Slider {
  name: string;
  point: string;
  on: string;
  link: string;
  direction: number;
}

/** A link: its points, their places in its axes, and how these are given. */
export interface Link {
  points: string[];
  places: Record<string, [number, number]>;
  sized: "points" | "length" | "sides";
}

/** A row of several on one shaft: grid of its crank angles, and where it is, m. */
export interface MachineRow {
  grid: string;
  offset: [number, number];
  lateral: number;
}

export interface Soil {
  /** Of the height of its surface among the numbers of a design. */
  place: number;
  /** Signals of the heights of all tips. */
  heights: string[];
  /** Of the lowest of them below the surface, m. */
  depth: number;
}

export interface MachineData {
  language: string;
  words: Record<string, string>;
  /** The sign before the decimals of a number that is shown. */
  decimal: string;
  title: string;
  description: string;
  /** What is left out, and what is assumed. */
  notes: string[];
  rules: NumberRules;
  length: Unit;
  turns: number;
  speed: number;
  /** Crank angle at which it is shown first, degrees. */
  begin: number;
  angles: number;
  /** Arrays of 64-bit floats in base 64. */
  theta: string;
  grid: string;
  /** Of each crank angle in a mean; where null, all have the same. */
  shares: string | null;
  /** Ends of the panels between jumps; null where there are none. */
  edges: string | null;
  /** Crank angles that curves go through, and those that are equally spaced; null for all. */
  shown: number[] | null;
  frames: number[] | null;
  rows: MachineRow[];
  /** Moment of inertia of the flywheel that rows share, kg m2, and the acceleration of the crank, rad/s2. */
  flywheel: number;
  acceleration: number;
  design: number[];
  /** By what the height of the soil's surface is found; null where the file gives it, or there is no soil. */
  soil: Soil | null;
  names: string[];
  outputs: Output[];
  fields: Field[];
  measures: Measure[];
  /** Of each margin, the links that it joins. */
  margins: string[][];
  /** Margin below which a dyad counts as stretched out or folded. */
  least: number;
  links: Record<string, Link>;
  sliders: Slider[];
  driven: string[];
  crank: string | null;
  scene: Scene;
  ties: (Tie | null)[][];
}
