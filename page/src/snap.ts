/** Where a click on the sheet is meant: at a joint, on a link, at a round place. */

import { lengths, round } from "./format";
import type { Pair, State } from "./protocol";
import type { Stage } from "./stage";

/** Pixels within which a joint is meant, and a line of the sheet. */
const NEAR = 15;
const LINE = 3;
/** Pixels between two fine lines, about, and steps between them. */
const APART = 14;
const [PARTS, TRACED] = [10, 200];
/** Degrees between directions that Shift keeps. */
const STEPS = 15;

/** What is meant: a joint by its name, or a place (m) on a link or on the sheet. */
export interface Hit {
  point?: string;
  link?: string;
  /** A slider or a coupling whose sign is there. */
  part?: { what: string; name: string };
  place: Pair;
}

export interface Snapping {
  stage: Stage;
  state(): State | null;
  /** Further places to which others are drawn, m. */
  snaps(): Pair[];
  /** Whether an underlay is traced over, whose lines count and not those of the sheet. */
  tracing(): boolean;
}

/** What is meant at a pixel; `from` : where a line begins that Shift keeps in its direction. */
export function meant(page: Snapping, px: Pair, link: string | undefined, from: Pair | null): Hit {
  const point = joint(page, px);
  if (point) return point;
  const { view } = page.stage;
  if (from) return { place: level(page, px, from) };
  const near = page.snaps().find(([x, y]) => within(view.px(x, y), px, NEAR));
  const place = near ?? rounded(page, view.metres(...px));
  return link ? { place: near ?? fine(page, view.metres(...px)), link } : { place };
}

function joint(page: Snapping, px: Pair): Hit | null {
  let best: Hit | null = null;
  let least = NEAR;
  for (const name of page.state()?.numbers.names("place.") ?? []) {
    const place = page.stage.place({ kind: "point", name: name.slice(6) });
    if (!place) continue;
    const [x, y] = page.stage.view.px(...place);
    const away = Math.hypot(x - px[0], y - px[1]);
    if (away < least) [best, least] = [{ point: name.slice(6), place }, away];
  }
  return best;
}

function within([x, y]: Pair, [px, py]: Pair, most: number): boolean {
  return Math.hypot(x - px, y - py) < most;
}

/** A step of the sheet, m: a round number in the unit of the drawing. */
export function step(page: Snapping): number {
  const { factor } = lengths();
  return round((APART / page.stage.view.scale) * factor) / factor;
}

/** On the fine lines where they are near, else a tenth of what is between them. */
function rounded(page: Snapping, place: Pair): Pair {
  if (page.tracing()) return fine(page, place);
  const apart = step(page);
  const most = LINE / page.stage.view.scale;
  return place.map((value) => {
    const line = Math.round(value / apart) * apart;
    return exact(Math.abs(line - value) < most ? line : near(value, apart / PARTS));
  }) as Pair;
}

/** In tenths of what is between the fine lines, or to a part of a pixel where an underlay is traced. */
function fine(page: Snapping, place: Pair): Pair {
  const parts = page.tracing() ? TRACED : PARTS;
  return place.map((value) => exact(near(value, step(page) / parts))) as Pair;
}

function near(value: number, apart: number): number {
  return Math.round(value / apart) * apart;
}

/** Without what is left of binary fractions. */
function exact(value: number): number {
  return Number(value.toPrecision(12));
}

/** Along one of the directions that are multiples of 15 degrees, in steps of the sheet. */
function level(page: Snapping, px: Pair, from: Pair): Pair {
  const [x, y] = page.stage.view.metres(...px);
  const unit = (STEPS * Math.PI) / 180;
  const way = Math.round(Math.atan2(y - from[1], x - from[0]) / unit) * unit;
  const along = (x - from[0]) * Math.cos(way) + (y - from[1]) * Math.sin(way);
  const size = near(along, step(page) / PARTS);
  return [exact(from[0] + size * Math.cos(way)), exact(from[1] + size * Math.sin(way))];
}
