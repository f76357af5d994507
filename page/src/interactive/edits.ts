/** What a drag or a typed number does to the numbers of a machine. */

import type { Pair } from "../protocol";
import { say } from "../words";
import type { Machine, Solution } from "./machine";
import type { Field, Measure } from "./told";
import { dot, minus, mirrored, plus, scaled, size, times, towards } from "./vectors";

/** Digits of a dragged number over the size of the machine. */
const DIGITS = 7;

/** Points that can be dragged: those whose places are numbers in each body that has them. */
export function movable(machine: Machine): string[] {
  return machine.told.scene.movable.filter((name) => isMovable(machine, name));
}

function isMovable({ told, numbers }: Machine, name: string): boolean {
  const at = (path: string) => numbers.has(`${path}.x`) && numbers.has(`${path}.y`);
  if (told.scene.frame.includes(name) && !at(`frame.points.${name}`)) return false;
  return Object.entries(told.links).every(([link, { points, sized }]) => {
    if (!points.includes(name) || points.length < 2) return true;
    if (sized === "points") return at(`links.${link}.points.${name}`);
    return points.every((other) => other === name || lengthPath({ told, numbers }, link, name, other));
  });
}

/** Links whose centre of mass can be dragged. */
export function massesMovable({ told, numbers }: Machine): string[] {
  const there = (link: string) => ["x", "y"].every((axis) => numbers.has(`links.${link}.center_of_mass.${axis}`));
  return told.scene.mass_centers.filter(there);
}

function lengthPath(
  { told, numbers }: Pick<Machine, "told" | "numbers">,
  link: string,
  one: string,
  other: string,
): string | null {
  if (told.links[link]?.sized === "length") return numbers.has(`links.${link}.length`) ? `links.${link}.length` : null;
  const paths = [`${one}-${other}`, `${other}-${one}`].map((side) => `links.${link}.sides.${side}`);
  return paths.find((path) => numbers.has(path)) ?? null;
}

/**
 * Numbers with which a point is at a place at a crank angle, and all other points stay where they are there.
 *
 * Each link keeps its pose: the point gets new coordinates in the axes of each that has it, or lengths to its
 * other points. On a guide, or at the end of a driven link of a given length, it goes as near as these let it.
 */
export function moved(found: Solution, name: string, to: Pair, at: number): Float64Array {
  const { machine, design } = found;
  const { told } = machine;
  const target = reachable(found, name, to, at);
  const next = design.slice();
  const put = (path: string, value: number) => {
    const place = machine.numbers.get(path);
    if (place !== undefined) next[place] = rounded(value, extent(told.scene.box));
  };
  if (told.scene.frame.includes(name)) putPoint(put, `frame.points.${name}`, target);
  for (const [link, { points, sized }] of Object.entries(told.links)) {
    if (!points.includes(name) || points.length < 2) continue;
    const others = points.filter((point) => point !== name);
    if (sized === "points") putPoint(put, `links.${link}.points.${name}`, local(found, link, others[0] as string, target, at));
    else
      for (const other of others) {
        const path = lengthPath(machine, link, name, other);
        if (path) put(path, size(minus(target, found.point(other, at))));
      }
  }
  return next;
}

/** Numbers with which the centre of mass of a link is at a place at a crank angle. */
export function massMoved(found: Solution, link: string, to: Pair, at: number): Float64Array {
  const next = found.design.slice();
  const { machine } = found;
  const [first] = machine.told.links[link]?.points ?? [];
  putPoint(
    (path, value) => {
      const place = machine.numbers.get(path);
      if (place !== undefined) next[place] = rounded(value, extent(machine.told.scene.box));
    },
    `links.${link}.center_of_mass`,
    local(found, link, first as string, to, at),
  );
  return next;
}

function putPoint(put: (path: string, value: number) => void, path: string, [x, y]: Pair): void {
  put(`${path}.x`, x);
  put(`${path}.y`, y);
}

/** A place of the frame in the axes of a link, by another point of that. */
function local(found: Solution, link: string, by: string, place: Pair, at: number): Pair {
  const arm = times(minus(place, found.point(by, at)), mirrored(found.rotation(link, at)));
  return plus(own(found, link, by), arm);
}

/** A point of a link in that link's axes, m. */
function own(found: Solution, link: string, point: string): Pair {
  const [x, y] = [".x", ".y"].map((axis) => found.number(`links.${link}.points.${point}${axis}`));
  if (x !== undefined && y !== undefined) return [x, y];
  return found.machine.told.links[link]?.places[point] ?? [0, 0];
}

/** As near to a place as guides and the direction of driven links let a point come. */
function reachable(found: Solution, name: string, to: Pair, at: number): Pair {
  const { told } = found.machine;
  const from = found.point(name, at);
  const ways = told.sliders.filter(({ point }) => point === name).map((one) => guideWay(found, one, at));
  for (const link of told.driven) {
    const { points = [], sized } = told.links[link] ?? {};
    const other = points.find((point) => point !== name);
    if (sized === "length" && points.includes(name) && other) ways.push(minus(from, found.point(other, at)));
  }
  return ways.reduce((place, way) => plus(from, scaled(way, dot(minus(place, from), way) / (dot(way, way) || 1))), to);
}

/** Direction of a guide at a crank angle. */
export function guideWay(found: Solution, slider: { name: string; on: string; direction: number }, at: number): Pair {
  const number = found.machine.told.sliders.findIndex(({ name }) => name === slider.name) + 1;
  const direction = found.number(`sliders[${number}].direction`) ?? slider.direction;
  return times(found.rotation(slider.on, at), towards(direction));
}

/** Whether a point is where it was put. */
export function reaches(found: Solution, name: string, to: Pair, at: number): boolean {
  return size(minus(found.point(name, at), to)) <= 1e-5 * extent(found.machine.told.scene.box);
}

/** The length that a measure has in a design. */
export function lengthOf(found: Solution, { from, path, fixed }: Measure): number {
  return size(minus(pointOf(found, path, [0, 0]), pointOf(found, from, fixed)));
}

/** Numbers with which it has another. */
export function withLength(found: Solution, measure: Measure, value: number): Float64Array {
  const start = pointOf(found, measure.from, measure.fixed);
  const way = minus(pointOf(found, measure.path, [0, 0]), start);
  const [x, y] = plus(start, scaled(way, value / (size(way) || 1)));
  const next = found.design.slice();
  for (const [axis, one] of [["x", x], ["y", y]] as const)
    next[found.machine.numbers.get(`${measure.path}.${axis}`) as number] = one;
  return next;
}

function pointOf(found: Solution, path: string, fixed: Pair): Pair {
  return [found.number(`${path}.x`) ?? fixed[0], found.number(`${path}.y`) ?? fixed[1]];
}

/** A value in SI units from what was typed; a sentence where it is none. */
export function typed(text: string, one: Pick<Field, "units" | "unit" | "factor" | "label">): number | string {
  const match = /^([-+−]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(.*)$/i.exec(text.trim());
  const unit = match?.[2]?.trim() ?? "";
  const factor = unit === "" || unit === one.unit ? 1 / one.factor : one.units[unit];
  if (!match || factor === undefined) {
    const example = `12.5 ${Object.keys(one.units).find((other) => one.units[other] === 1 / one.factor) ?? one.unit}`.trim();
    return say("{label}: got {text}; give a number, such as {example}", { label: one.label, text: text.trim() || "–", example });
  }
  const value = Number((match[1] as string).replace("−", "-"));
  // 1 / factor of 1000 is exact, but 0.001 times a number is not always the number nearest to it
  return unit === "" || unit === one.unit ? value / one.factor : value * factor;
}

/** Why a number cannot be this, by the limits of its key; null where it can. */
export function outside(field: Field, value: number): string | null {
  const limit = (si: number) => `${Number((si * field.factor).toPrecision(12))} ${field.unit}`.trim();
  const given = limit(value);
  const { label, least, above, below } = field;
  if (!Number.isFinite(value)) return say("{label}: got {given}; give a number", { label, given });
  if (least !== null && value < least)
    return say("{label}: got {given}; give {limit} or more", { label, given, limit: limit(least) });
  if (above !== null && value <= above)
    return say("{label}: got {given}; give more than {limit}", { label, given, limit: limit(above) });
  if (below !== null && value >= below)
    return say("{label}: got {given}; give less than {limit}", { label, given, limit: limit(below) });
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
