/** From the arrays of a state to columns that charts draw. */

import type { State } from "./protocol";

/** Crank angle from the first sample, degrees, with the first sample again at the end. */
export class Abscissa {
  private made = new Map<string, Float64Array>();

  of(count: number, turns: number): Float64Array {
    const key = `${count}/${turns}`;
    let x = this.made.get(key);
    if (!x) {
      x = Float64Array.from({ length: count + 1 }, (_, k) => (k / count) * 360 * turns);
      this.made.set(key, x);
    }
    return x;
  }
}

/** A periodic signal with its first value again at the end; `stride` 2 takes x (0) or y (1). */
export function closed(values: Float32Array, stride = 1, part = 0): Float64Array {
  const count = values.length / stride;
  const column = new Float64Array(count + 1);
  for (let k = 0; k < count; k++) column[k] = values[stride * k + part] as number;
  column[count] = column[0] as number;
  return column;
}

/** A signal of a state and the same before, as columns. */
export function both(
  state: State,
  name: string,
  stride = 1,
  part = 0,
): { values: Float64Array; before?: Float64Array } | null {
  const now = state.numbers.get(name);
  if (!now) return null;
  const values = closed(now, stride, part);
  const was = state.before ? state.numbers.get(`before.${name}`) : undefined;
  return was && was.length === now.length
    ? { values, before: closed(was, stride, part) }
    : { values };
}

/** Forces that are nothing beside those in the joints, N (and N m: machines are about as large as 1 m). */
export function rounding(state: State): number {
  let largest = 0;
  for (const name of [...state.numbers.names("joint."), "shaking_force", "drive_torque"]) {
    for (const value of state.numbers.get(name) ?? [])
      if (Math.abs(value) > largest) largest = Math.abs(value);
  }
  return largest * 1e-6 || 1;
}
