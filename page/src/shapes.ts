/** Paths in pixels, and where names stand. */

import type { Pair } from "./protocol";

export function at([x, y]: Pair): string {
  return `${x.toFixed(1)} ${y.toFixed(1)}`;
}

/** The sign of a centre of mass: two of the quarters of a circle. */
export function quarters(radius: number): string {
  const r = radius;
  return `M0 0V${-r}A${r} ${r} 0 0 1 ${r} 0ZM0 0V${r}A${r} ${r} 0 0 1 ${-r} 0Z`;
}

/** Samples of a curve nearer than this to the last one that is drawn are left out, pixels. */
const NEAR = 1;

/** A curve through x and y in turn; every so many samples suffice. */
export function curve(
  points: Float32Array,
  px: (x: number, y: number) => Pair,
  closed: boolean,
): string {
  const step = Math.max(Math.round(points.length / 720), 1) * 2;
  let [d, x0, y0] = ["", 0, 0];
  for (let i = 0; i + 1 < points.length; i += step) {
    const [x, y] = px(points[i] as number, points[i + 1] as number);
    if (!Number.isFinite(x + y)) continue; // more than a number of 32 bits holds
    const ends = !i || i + step + 1 >= points.length;
    if (!ends && (x - x0) ** 2 + (y - y0) ** 2 < NEAR ** 2) continue;
    d += (d ? "L" : "M") + at([x, y]);
    [x0, y0] = [x, y];
  }
  return d && closed ? `${d}Z` : d;
}

/** The direction away from the other points of the links that meet at a point, of size 1. */
export function outside([x, y]: Pair, near: Pair[], footed: boolean): Pair {
  let [dx, dy] = [0, 0];
  for (const [ox, oy] of near) {
    const away = Math.hypot(x - ox, y - oy) || 1;
    dx += (x - ox) / away;
    dy += (y - oy) / away;
  }
  // The foot of a pivot on the frame hangs below it: the name goes beside or above.
  if (footed) return [Math.abs(dx) > 1e-3 ? Math.sign(dx) * 0.85 : 0.85, -0.5];
  const size = Math.hypot(dx, dy);
  return size > 1e-3 ? [dx / size, dy / size] : [0.7, -0.7];
}
