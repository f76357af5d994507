/** What a drag or a typed number does to the numbers of a machine. */

import { asTyped } from "../format";
import { keyPath, type Pair } from "../protocol";
import { say } from "../words";
import type { Field, Measure } from "./data";
import { dot, type Machine, minus, mirrored, plus, type Solution, scaled, size, times, towards } from "./machine";

/** Digits of a dragged number over the size of the machine. */
const DIGITS = 7;

/** Points that can be dragged: those whose places are numbers in each body that has them. */
export function movable(machine: Machine): string[] {
  return machine.data.scene.movable.filter((name) => isMovable(machine, name));
}

function isMovable({ data, numbers }: Machine, name: string): boolean {
  const at = (path: string) => numbers.has(`${path}.x`) && numbers.has(`${path}.y`);
  if (data.scene.frame.includes(name) && !at(keyPath("frame", "points", name))) return false;
  return Object.entries(data.links).every(([link, { points, sized }]) => {
    if (!points.includes(name) || points.length < 2) return true;
    if (sized === "points") return at(keyPath("links", link, "points", name));
    return points.every((other) => other === name || lengthPath({ data, numbers }, link, name, other));
  });
}

/** Links whose centre of mass can be dragged. */
export function massesMovable({ data, numbers }: Machine): string[] {
  const there = (link: string) =>
    ["x", "y"].every((axis) => numbers.has(keyPath("links", link, "center_of_mass", axis)));
  return data.scene.mass_centers.filter(there);
}

function lengthPath(
  { data, numbers }: Pick<Machine, "data" | "numbers">,
  link: string,
  point: string,
  other: string,
): string | null {
  const whole = keyPath("links", link, "length");
  if (data.links[link]?.sized === "length") return numbers.has(whole) ? whole : null;
  const paths = [`${point}-${other}`, `${other}-${point}`].map((side) => keyPath("links", link, "sides", side));
  return paths.find((path) => numbers.has(path)) ?? null;
}

/**
 * Numbers with which a point is at a place at a crank angle, and all other points stay where they are there.
 *
 * Each link keeps its pose: the point gets new coordinates in the axes of each that has it, or lengths to its
 * other points. On a guide, or at the end of a driven link of a given length, it goes as near as these let it.
 */
export function moved(solution: Solution, name: string, to: Pair, at: number): Float64Array {
  const { machine, design } = solution;
  const { data } = machine;
  const target = reachable(solution, name, to, at);
  const next = design.slice();
  const put = (path: string, value: number) => {
    const place = machine.numbers.get(path);
    if (place !== undefined) next[place] = rounded(value, extent(data.scene.box));
  };
  if (data.scene.frame.includes(name)) putPoint(put, keyPath("frame", "points", name), target);
  for (const [link, { points, sized }] of Object.entries(data.links)) {
    if (!points.includes(name) || points.length < 2) continue;
    const others = points.filter((point) => point !== name);
    if (sized === "points")
      putPoint(put, keyPath("links", link, "points", name), local(solution, link, others[0] as string, target, at));
    else
      for (const other of others) {
        const path = lengthPath(machine, link, name, other);
        if (path) put(path, size(minus(target, solution.point(other, at))));
      }
  }
  return next;
}

/** Numbers with which the centre of mass of a link is at a place at a crank angle. */
export function massMoved(solution: Solution, link: string, to: Pair, at: number): Float64Array {
  const next = solution.design.slice();
  const { machine } = solution;
  const [first] = machine.data.links[link]?.points ?? [];
  putPoint(
    (path, value) => {
      const place = machine.numbers.get(path);
      if (place !== undefined) next[place] = rounded(value, extent(machine.data.scene.box));
    },
    keyPath("links", link, "center_of_mass"),
    local(solution, link, first as string, to, at),
  );
  return next;
}

function putPoint(put: (path: string, value: number) => void, path: string, [x, y]: Pair): void {
  put(`${path}.x`, x);
  put(`${path}.y`, y);
}

/** A place of the frame in the axes of a link, by another point of that. */
function local(solution: Solution, link: string, by: string, place: Pair, at: number): Pair {
  const arm = times(minus(place, solution.point(by, at)), mirrored(solution.rotation(link, at)));
  return plus(own(solution, link, by), arm);
}

/** A point of a link in that link's axes, m. */
function own(solution: Solution, link: string, point: string): Pair {
  const [x, y] = ["x", "y"].map((axis) => solution.number(keyPath("links", link, "points", point, axis)));
  if (x !== undefined && y !== undefined) return [x, y];
  return solution.machine.data.links[link]?.places[point] ?? [0, 0];
}

/** As near to a place as guides and the direction of driven links let a point come. */
function reachable(solution: Solution, name: string, to: Pair, at: number): Pair {
  const { data } = solution.machine;
  const from = solution.point(name, at);
  const ways = data.sliders.filter(({ point }) => point === name).map((slider) => guideWay(solution, slider, at));
  for (const link of data.driven) {
    const { points = [], sized } = data.links[link] ?? {};
    const other = points.find((point) => point !== name);
    if (sized === "length" && points.includes(name) && other) ways.push(minus(from, solution.point(other, at)));
  }
  return ways.reduce((place, way) => plus(from, scaled(way, dot(minus(place, from), way) / (dot(way, way) || 1))), to);
}

/** Direction of a guide at a crank angle. */
export function guideWay(
  solution: Solution,
  slider: { name: string; on: string; direction: number },
  at: number,
): Pair {
  const number = solution.machine.data.sliders.findIndex(({ name }) => name === slider.name);
  const direction = solution.number(keyPath("sliders", number, "direction")) ?? slider.direction;
  return times(solution.rotation(slider.on, at), towards(direction));
}

/** Whether a point is where it was put. */
export function reaches(solution: Solution, name: string, to: Pair, at: number): boolean {
  return size(minus(solution.point(name, at), to)) <= 1e-5 * extent(solution.machine.data.scene.box);
}

/** The length that a measure has in a design. */
export function lengthOf(solution: Solution, { from, path, fixed }: Measure): number {
  return size(minus(pointOf(solution, path, [0, 0]), pointOf(solution, from, fixed)));
}

/** Numbers with which it has another. */
export function withLength(solution: Solution, measure: Measure, value: number): Float64Array {
  const start = pointOf(solution, measure.from, measure.fixed);
  const way = minus(pointOf(solution, measure.path, [0, 0]), start);
  const [x, y] = plus(start, scaled(way, value / (size(way) || 1)));
  const next = solution.design.slice();
  for (const [axis, coordinate] of [
    ["x", x],
    ["y", y],
  ] as const)
    next[solution.machine.numbers.get(`${measure.path}.${axis}`) as number] = coordinate;
  return next;
}

function pointOf(solution: Solution, path: string, fixed: Pair): Pair {
  return [solution.number(`${path}.x`) ?? fixed[0], solution.number(`${path}.y`) ?? fixed[1]];
}

/** A value in SI units from what was typed; a sentence where it is none. */
export function typed(text: string, field: Pick<Field, "units" | "unit" | "factor" | "label">): number | string {
  const match = /^([-+−]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(.*)$/i.exec(asTyped(text));
  const unit = match?.[2]?.trim() ?? "";
  const factor = unit === "" || unit === field.unit ? 1 / field.factor : field.units[unit];
  if (!match || factor === undefined) {
    const example =
      `12.5 ${Object.keys(field.units).find((other) => field.units[other] === 1 / field.factor) ?? field.unit}`.trim();
    return say("{label}: got {text}; give a number, such as {example}", {
      label: field.label,
      text: text.trim() || "–",
      example,
    });
  }
  const value = Number((match[1] as string).replace("−", "-"));
  // 1 / factor of 1000 is exact, but 0.001 times a number is not always the number nearest to it
  return unit === "" || unit === field.unit ? value / field.factor : value * factor;
}

/** Why a number cannot be this, by the limits of its key; null where it can. */
export function outside(field: Field, value: number): string | null {
  const limit = (si: number) => `${Number((si * field.factor).toPrecision(12))} ${field.unit}`.trim();
  const limited = limit(value);
  const { label, least, above, below } = field;
  if (!Number.isFinite(value)) return say("{label}: got {given}; give a number", { label, given: limited });
  if (least !== null && value < least)
    return say("{label}: got {given}; give {limit} or more", { label, given: limited, limit: limit(least) });
  if (above !== null && value <= above)
    return say("{label}: got {given}; give more than {limit}", { label, given: limited, limit: limit(above) });
  if (below !== null && value >= below)
    return say("{label}: got {given}; give less than {limit}", { label, given: limited, limit: limit(below) });
  return null;
}

function extent([x0, y0, x1, y1]: readonly [number, number, number, number]): number {
  return Math.max(x1 - x0, y1 - y0);
}

/** So many digits over the size of the machine, as a decimal fraction. */
function rounded(value: number, whole: number): number {
  const digits = DIGITS - 1 - Math.floor(Math.log10(whole || 1));
  return digits >= 0 && digits <= 20 ? Number(value.toFixed(digits)) : value;
}
