/** Vectors in the plane as complex numbers. */

import type { Pair } from "../protocol";

export const plus = (a: Pair, b: Pair): Pair => [a[0] + b[0], a[1] + b[1]];
export const minus = (a: Pair, b: Pair): Pair => [a[0] - b[0], a[1] - b[1]];
export const times = (a: Pair, b: Pair): Pair => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
export const scaled = (a: Pair, by: number): Pair => [a[0] * by, a[1] * by];
export const mirrored = (a: Pair): Pair => [a[0], -a[1]];
export const size = (a: Pair): number => Math.hypot(a[0], a[1]);
export const dot = (a: Pair, b: Pair): number => a[0] * b[0] + a[1] * b[1];
export const towards = (angle: number): Pair => [Math.cos(angle), Math.sin(angle)];

/** The number by which one vector is another. */
export function ratio(a: Pair, b: Pair): Pair {
  return scaled(times(a, mirrored(b)), 1 / (dot(b, b) || 1));
}
