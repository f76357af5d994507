/** From the arrays of a message to columns that charts draw. */

import type { Numbers } from "./protocol";

/** Values, and those before. */
export interface Columns {
  values: Float64Array;
  before?: Float64Array | undefined;
}

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

/** How far an angle may have turned when it is where it was, rad. */
const TURN = 2 * Math.PI;

/**
 * Every `stride`th number from the `part`th on; a periodic one ends with its first value again, an
 * angle that winds as many turns further as it has made.
 */
function taken(values: Float32Array, stride: number, part: number, periodic: boolean, winds = false) {
  const count = values.length / stride;
  const column = new Float64Array(periodic ? count + 1 : count);
  for (let k = 0; k < count; k++) column[k] = values[stride * k + part] as number;
  if (!periodic) return column;
  const [first, last] = [column[0] as number, column[count - 1] as number];
  column[count] = first + (winds ? TURN * Math.round((last - first) / TURN) : 0);
  return column;
}

/** A signal of a message, and the same before. */
export function column(
  { numbers, before }: { numbers: Numbers; before: boolean },
  name: string,
  stride = 1,
  part = 0,
  periodic = true,
  winds = false,
): Columns | null {
  const now = numbers.get(name);
  if (!now) return null;
  const values = taken(now, stride, part, periodic, winds);
  const was = before ? numbers.get(`before.${name}`) : undefined;
  return was && was.length === now.length
    ? { values, before: taken(was, stride, part, periodic, winds) }
    : { values };
}

/** What was measured of what a chart's array shows, over the same crank angles; null where nothing was. */
export function measured(
  numbers: Numbers,
  array: string,
  stride: number,
  part: number,
  count: number,
  winds = false,
): Float64Array | null {
  const renamed = array.replace(/^joint\./, "joints.").replace(/^response\./, "gauges.");
  const name = renamed.replace(/^output\./, "") + (stride > 1 ? [".x", ".y"][part] : "");
  const found = numbers.get(`measured.${name}`);
  if (!found || found.length + 1 !== count) return null;
  return taken(found, 1, 0, true, winds);
}
