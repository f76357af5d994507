/** Scales of charts: round ends, and at least three numbers on each. */

import { limits, multiples, plain, round, signed } from "./format";
import type { Pair } from "./protocol";

/** Numbers on a scale, at least. */
export const FEWEST = 3;
/** Largest over least value of a curve from which its scale is logarithmic. */
const WIDE = 1000;
/** Of the largest value, below which a logarithmic scale shows nothing. */
const DEEP = 1e-6;
/** Largest over least value on a logarithmic scale, at least. */
const SPREAD = 10;
/** Steps of crank angles, degrees; and how many of them there are at most. */
const STEPS = [90, 180, 360, 720, 1800, 3600, 7200, 18000];
const MOST_STEPS = 6;
/** Beyond, numbers on a scale are powers of ten. */
const MOST_WHOLE = 1e6;

export interface Scale {
  ends: Pair;
  log: boolean;
}

/** The least and the largest of some values, without those that are none. */
export function extremes(every: Iterable<ArrayLike<number>>): Pair {
  let [low, high] = [Infinity, -Infinity];
  for (const values of every) {
    for (let i = 0; i < values.length; i++) {
      const value = values[i] as number;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return [low, high];
}

/** Place of the last of rising values that is not beyond another; 0 where all are. */
export function indexAtOrBelow(values: ArrayLike<number>, value: number): number {
  let [low, high] = [0, values.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((values[middle] as number) <= value) low = middle;
    else high = middle;
  }
  return low;
}

/** Whether values are all above zero, and too different for a linear scale. */
export function wide(values: ArrayLike<number>): boolean {
  const [low, high] = extremes([values]);
  return low > 0 && high >= WIDE * low && Number.isFinite(high);
}

/**
 * The scale of some values; what is smaller than `least` is nothing; `log` where that is asked for;
 * `zero` where lengths from zero are compared.
 */
export function scaleOf(every: ArrayLike<number>[], least: number, log: boolean, zero = false): Scale {
  const [low, high] = extremes(every);
  if (Math.max(-low, high) < least) return { ends: [-1, 1], log: false };
  if (!log || !(high > 0) || !Number.isFinite(high)) return { ends: limits(low, high, zero), log: false };
  let lowest = high;
  for (const values of every)
    for (let i = 0; i < values.length; i++) {
      const value = values[i] as number;
      if (value > 0 && value < lowest) lowest = value;
    }
  lowest = Math.max(lowest, high * DEEP);
  const more = Math.max(Math.sqrt((SPREAD * lowest) / high), 1);
  return { ends: [below(lowest / more), round(high * more)], log: true };
}

/** The round number (1, 2 or 5 times a power of ten) that is not more. */
function below(most: number): number {
  const up = round(most);
  if (up <= most * 1.0001) return up;
  return round(up / 2.5001);
}

/** Numbers on a scale: three or more; `room` is how many of them there is room for. */
export function levels({ ends, log }: Scale, room: number): number[] {
  return log ? powers(ends, room) : multiples(spacing(...ends, Infinity, room), ...ends);
}

/**
 * The widest round step, no wider than `most`, three multiples of which are within the ends.
 *
 * Where those of 1, 2 and 5 are too few or more than there is room for, others do.
 */
export function spacing(low: number, high: number, most = Infinity, room = Infinity): number {
  let fallback = 0;
  for (const kinds of [
    [5, 2, 1],
    [4, 3, 2.5],
  ]) {
    const first = Math.floor(Math.log10(Math.max(high - low, 1e-300)));
    for (let power = first; power > first - 3; power--) {
      for (const part of kinds) {
        const step = part * 10 ** power;
        const count = multiples(step, low, high).length;
        if (count < FEWEST || step > most * 1.0001) continue;
        if (count <= room) return step;
        fallback ||= step;
      }
    }
  }
  return fallback || (high - low) / 2;
}

/** Powers of ten, every one or every so many; 1, 2 and 5 times them where they are few. */
function powers([low, high]: Pair, room: number): number[] {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const count = last - first + 1;
  if (count >= FEWEST) {
    let every = Math.max(Math.ceil(count / Math.max(room, FEWEST)), 1);
    if (Math.ceil(count / every) < FEWEST) every = Math.max(every - 1, 1);
    return range(first, last, every).map((power) => 10 ** power);
  }
  const fine = range(first - 1, last, 1).flatMap((power) => [1, 2, 5].map((part) => part * 10 ** power));
  const all = fine.filter((value) => value >= low * 0.9999 && value <= high * 1.0001);
  // Where there is no room for all, each is as many times the one before.
  const some = [1, 2, 3].map((every) => all.filter((_, i) => i % every === 0));
  const enough = some.filter(({ length }) => length >= FEWEST);
  return enough.find(({ length }) => length <= room) ?? enough.pop() ?? all;
}

function range(first: number, last: number, step: number): number[] {
  return Array.from({ length: Math.floor((last - first) / step) + 1 }, (_, i) => first + i * step);
}

/** Where a value is on a scale, from 0 at its lower end to 1 at its upper one. */
export function share(value: number, { ends: [low, high], log }: Scale): number {
  if (!log) return (value - low) / (high - low);
  return Math.log(Math.max(value, low) / low) / Math.log(high / low);
}

/** Distance of numbers over crank angles that span so much, degrees. */
export function turning(span: number): number {
  return STEPS.find((step) => span / step <= MOST_STEPS) ?? span / MOST_STEPS;
}

/** A number on a scale, with as many decimals as its neighbours. */
export function marked(value: number, { log }: Scale, all: number[]): string {
  const step = (all[1] ?? 1) - (all[0] ?? 0);
  const whole = (digits: number) => Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits));
  const digits = [0, 1, 2, 3, 4, 5, 6, 7, 8].find((count) => whole(count) < 1e-6 && step * 10 ** count > 0.5);
  const large = Math.abs(value) >= MOST_WHOLE;
  return log || large || digits === undefined ? plain(value) : signed(value.toFixed(digits));
}
