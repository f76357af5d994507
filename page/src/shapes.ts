/** How the parts of a linkage look: paths in pixels. */

import type { Pair } from "./protocol";

export function at([x, y]: Pair): string {
  return `${x.toFixed(1)} ${y.toFixed(1)}`;
}

/** A link: a stroke with round ends gives it its width. */
export function outline(corners: Pair[]): string {
  const [first, ...rest] = corners;
  if (!first) return "";
  if (!rest.length) return `M${at(first)}h0.01`;
  return `M${at(first)}${rest.map((p) => `L${at(p)}`).join("")}${rest.length > 1 ? "Z" : ""}`;
}

/** The sign of a pivot on the frame: a foot on hatched ground. */
export function foot([x, y]: Pair): string {
  const feet = `M${at([x, y])}L${at([x - 8, y + 13])}H${(x + 8).toFixed(1)}Z`;
  let hatch = `M${at([x - 13, y + 13])}h26`;
  for (let i = -10; i <= 13; i += 5.75) hatch += `M${at([x + i, y + 13])}l-4.5 5`;
  return feet + hatch;
}

/** The sign of a centre of mass: a circle with two quarters filled. */
export function quarters(radius: number): string {
  const r = radius;
  return `M0 0V${-r}A${r} ${r} 0 0 1 ${r} 0ZM0 0V${r}A${r} ${r} 0 0 1 ${-r} 0Z`;
}

/** A spring between two places. */
export function zigzag(from: Pair, to: Pair, coils = 7, half = 5): string {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(dx, dy);
  if (length < 1) return "";
  const [ex, ey] = [dx / length, dy / length];
  const lead = Math.min(12, length * 0.15);
  const along = (t: number, side: number): Pair => [
    from[0] + ex * t - ey * side,
    from[1] + ey * t + ex * side,
  ];
  let d = `M${at(from)}L${at(along(lead, 0))}`;
  const pitch = (length - 2 * lead) / coils;
  for (let i = 0; i < coils; i++)
    d += `L${at(along(lead + (i + 0.5) * pitch, i % 2 ? -half : half))}`;
  return `${d}L${at(along(length - lead, 0))}L${at(to)}`;
}

/** A curve through x and y in turn; every so many samples suffice. */
export function curve(
  points: Float32Array,
  px: (x: number, y: number) => Pair,
  closed: boolean,
): string {
  const step = Math.max(Math.round(points.length / 720), 1) * 2;
  let d = "";
  for (let i = 0; i + 1 < points.length; i += step) {
    d += (i ? "L" : "M") + at(px(points[i] as number, points[i + 1] as number));
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

/** How far a guide goes back and on from its block, m, so that it holds the block all the way. */
export function reach(
  way: Float32Array | undefined,
  places: Float32Array | undefined,
  k: number,
  more: number,
): Pair {
  const half = 2 * ((way?.length ?? 0) >> 2);
  const still = way && way[0] === way[half] && way[1] === way[half + 1];
  if (!still || !places) return [-2.4 * more, 2.4 * more];
  const [ux, uy] = [way[0] as number, way[1] as number];
  const along = (i: number) => (places[2 * i] as number) * ux + (places[2 * i + 1] as number) * uy;
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; 2 * i < places.length; i += 4) {
    low = Math.min(low, along(i));
    high = Math.max(high, along(i));
  }
  return [low - along(k) - more, high - along(k) + more];
}
