/**
 * Numbers as people read and type them, with the decimal sign of the language, and round numbers for
 * scales.
 */

import type { NumberRules, Unit } from "./protocol";

const POINT = ".";
/** One that stands alone: not of a name or a version. */
const NUMBER = /(^|[^\w.])(\d+)\.(\d+)(?=e[+-]?\d+(?!\w)|(?!\w|\.\w))/g;
/** A number, and what may be its unit. */
const TYPED = /^([-+]?\d*),(\d+(?:e[-+]?\d+)?(?:\s*[^\d\s,][^,]*)?)$/i;

let sign = POINT;

/** Follow the language that is spoken. */
export function point(decimal: string): void {
  sign = decimal;
}

/** Numbers of a text with the sign of the language; files and commands have a point. */
export function decimals(text: string): string {
  return sign === POINT ? text : text.replace(NUMBER, `$1$2${sign}$3`);
}

/**
 * What was typed into a field, as files have it: a minus as they write it, and a point.  A comma is
 * a decimal one where the language has such, and there is one number with one comma.
 */
export function asTyped(text: string): string {
  const plain = text.trim().replace(/−/g, "-");
  return sign === "," ? plain.replace(TYPED, "$1.$2") : plain;
}

const MINUS = "\u2212";
const FIXED = "\u00a0";

/** Those of the server, received before anything is drawn. */
let rules: NumberRules = {
  least: 0,
  most: Infinity,
  units: [],
  lengths: {},
};
let drawing: Unit = { unit: "m", factor: 1 };
let quantity = /$^/g;

export function follow(next: NumberRules): void {
  rules = next;
  const units = next.units.map((unit) => unit.replace(/[/^]/g, "\\$&")).join("|");
  quantity = new RegExp(`([\\d)]) (${units})(?![\\w/^])`, "g");
}

/** The unit of the machine that is open. */
export function measure(length: Unit): void {
  drawing = length;
}

/** Some significant digits, a true minus, no power of ten where it can be helped. */
export function shown(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size >= rules.most || size < rules.least) return signed(value.toExponential(digits - 1));
  return signed(value.toFixed(Math.max(digits - 1 - Math.floor(Math.log10(size)), 0)));
}

/** A sentence in which units stay with their numbers. */
export function unbroken(sentence: string): string {
  return sentence.replace(quantity, (_, last, unit) => `${last}${FIXED}${unit.replace(/ /g, FIXED)}`);
}

/** A name with underscores, that may go on in a new line after each. */
export function breakable(name: string): string {
  return name.replace(/_/g, "_\u200b");
}

/** A number whose last digit stays where it is while the value changes. */
export function steady(value: number, largest: number, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  if (largest >= rules.most) return shown(value, digits);
  const size = largest > 0 ? Math.floor(Math.log10(largest)) : 0;
  return signed(value.toFixed(Math.min(Math.max(digits - 1 - size, 0), 8)));
}

export function signed(text: string): string {
  const plain = text.replace(/^-(0(\.0*)?)$/, "$1");
  return decimals(plain.replace(/-/g, MINUS));
}

/** A round number as it is: for marks of scales. */
export function plain(value: number): string {
  if (Math.abs(value) >= rules.most) return signed(String(Number(value.toPrecision(6)).toExponential()));
  return signed(String(Number(value.toPrecision(6))));
}

/** m in a unit of length; NaN where it is none. */
export function metres(unit: string): number {
  return rules.lengths[unit] ?? NaN;
}

/** Unit of the drawing's lengths. */
export function lengths(): Unit {
  return drawing;
}

/** Lengths (m) as the drawing shows them, without their unit. */
export function length(metres: number): string {
  return signed((metres * drawing.factor).toFixed(2));
}

export function degrees(angle: number): number {
  return (angle * 180) / Math.PI;
}

/** The round number (1, 2 or 5 times a power of ten) that is not less. */
export function round(least: number): number {
  if (!(least > 0) || !Number.isFinite(least)) return 1;
  const power = 10 ** Math.floor(Math.log10(least));
  const part = least / power;
  return power * (part <= 1.0001 ? 1 : part <= 2.0001 ? 2 : part <= 5.0001 ? 5 : 10);
}

/** Multiples of a step within limits. */
export function multiples(step: number, low: number, high: number): number[] {
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(last - first + 1, 0) }, (_, i) => (first + i) * step);
}

/** Share of the way from zero that values take up at least, or zero is left out; or are one value. */
const [FAR, SAME] = [0.4, 1e-6];

/**
 * Limits of a scale: round, the same for values that differ a little, with zero inside, unless that
 * would leave little of the scale to values that are far from it, such as the angle of a dwell.
 */
export function limits(low: number, high: number, zero = false): Pair {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const [span, reach] = [high - low, Math.max(Math.abs(low), Math.abs(high))];
  const without = !zero && low * high > 0 && span < FAR * reach && span > SAME * reach;
  const [from, to] = without ? [low, high] : [Math.min(low, 0), Math.max(high, 0)];
  if (to - from <= 0) return [-1, 1];
  const step = round((to - from) / 8);
  return [Math.floor(from / step - 1e-6) * step, Math.ceil(to / step + 1e-6) * step];
}

type Pair = [number, number];
