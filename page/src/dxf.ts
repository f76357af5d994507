/** Lines of a DXF drawing, read by dxf-parser: what can be traced, and where a trace may snap. */

import DxfParser from "dxf-parser/dist/dxf-parser.js";
import type { Pair } from "./protocol";
import { say } from "./words";

/** Lengths in m, y upward; the origin is that of the file. */
export interface Drawing {
  lines: Pair[][];
  /** Ends and corners of lines, and centres of circles and arcs. */
  snaps: Pair[];
  /** Whether the file states its unit; if not, it is read in mm. */
  hasUnit: boolean;
}

/** m in a unit of $INSUNITS. */
const UNITS: Record<number, number> = {
  1: 0.0254,
  2: 0.3048,
  4: 1e-3,
  5: 1e-2,
  6: 1,
  8: 2.54e-8,
  9: 2.54e-5,
  10: 0.9144,
  13: 1e-6,
  14: 0.1,
};
const MILLIMETRES = 4;
/** Pieces of a whole circle, and of a span of a spline. */
const ROUND = 72;
const SPAN = 8;
/** Blocks in blocks, and points in all. */
const DEEPEST = 6;
const MOST = 200_000;

/** What the parser gives of an entity; which keys there are depends on its type. */
interface Entity {
  type: string;
  visible?: boolean;
  inPaperSpace?: boolean;
  vertices?: (Point & { bulge?: number })[];
  shape?: boolean;
  center?: Point;
  radius?: number;
  startAngle?: number;
  endAngle?: number;
  majorAxisEndPoint?: Point;
  axisRatio?: number;
  controlPoints?: Point[];
  fitPoints?: Point[];
  knotValues?: number[];
  degreeOfSplineCurve?: number;
  name?: string;
  position?: Point;
  xScale?: number;
  yScale?: number;
  rotation?: number;
}
interface Point {
  x: number;
  y: number;
}
type Place = (point: Pair) => Pair;
type Traced = Pick<Drawing, "lines" | "snaps">;

/** Throws an `Error` whose message is one sentence. */
export function drawingOf(text: string, name: string): Drawing {
  const wrong = say("{name} is no DXF drawing that can be read; save it as ASCII DXF.", { name });
  let file: ReturnType<DxfParser["parseSync"]>;
  try {
    file = new DxfParser().parseSync(text);
  } catch {
    throw new Error(wrong);
  }
  if (!file?.entities) throw new Error(wrong);
  const unit = Number(file.header?.$INSUNITS ?? 0);
  const size = UNITS[unit] ?? (UNITS[MILLIMETRES] as number);
  const drawing: Traced = { lines: [], snaps: [] };
  const blocks = (file.blocks ?? {}) as unknown as Record<string, { entities?: Entity[]; position?: Point }>;
  const add = (entities: Entity[], at: Place, deep: number): void => {
    for (const entity of entities) {
      if (entity.visible === false || entity.inPaperSpace || drawing.snaps.length > MOST) continue;
      const block = entity.type === "INSERT" ? blocks[entity.name ?? ""] : undefined;
      if (block && deep < DEEPEST) add(block.entities ?? [], inserted(entity, block.position, at), deep + 1);
      else trace(entity, at, drawing);
    }
  };
  add(file.entities as unknown as Entity[], ([x, y]) => [x * size, y * size], 0);
  if (!drawing.lines.length)
    throw new Error(say("{name} has no line, polyline, circle, arc or spline to trace.", { name }));
  return { ...drawing, hasUnit: unit in UNITS };
}

/** From the axes of a block to those around it. */
function inserted(entity: Entity, base: Point | undefined, at: Place): Place {
  const { position, xScale = 1, yScale = 1, rotation = 0 } = entity;
  const turn = (rotation * Math.PI) / 180;
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  return ([x, y]) => {
    const [u, v] = [(x - (base?.x ?? 0)) * xScale, (y - (base?.y ?? 0)) * yScale];
    return at([(position?.x ?? 0) + u * c - v * s, (position?.y ?? 0) + u * s + v * c]);
  };
}

function trace(entity: Entity, at: Place, drawing: Traced): void {
  const put = (line: Pair[], snaps: Pair[]): void => {
    const whole = [...line, ...snaps].every(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
    if (line.length < 2 || !whole) return;
    drawing.lines.push(line.map(at));
    drawing.snaps.push(...snaps.map(at));
  };
  const traced = CURVES[entity.type]?.(entity);
  if (traced) put(...traced);
}

/** Of each kind of entity: the line to draw, and its points that are snapped to. */
const CURVES: Record<string, (entity: Entity) => [line: Pair[], snaps: Pair[]] | null> = {
  LINE: ({ vertices }) => [corners(vertices), corners(vertices)],
  LWPOLYLINE: polyline,
  POLYLINE: polyline,
  CIRCLE: ({ center, radius = 0 }) =>
    center ? [arc([center.x, center.y], [radius, 0], 1, 0, 2 * Math.PI), [[center.x, center.y]]] : null,
  ARC: ({ center, radius = 0, startAngle = 0, endAngle = 0 }) => {
    if (!center) return null;
    const line = arc([center.x, center.y], [radius, 0], 1, startAngle, after(startAngle, endAngle));
    return [line, [[center.x, center.y], ...ends(line)]];
  },
  ELLIPSE: ({ center, majorAxisEndPoint: end, axisRatio = 1, startAngle = 0, endAngle = 2 * Math.PI }) =>
    center && end
      ? [
          arc([center.x, center.y], [end.x, end.y], axisRatio, startAngle, after(startAngle, endAngle)),
          [[center.x, center.y]],
        ]
      : null,
  SPLINE: (entity) => {
    const line = spline(entity);
    return [line, ends(line)];
  },
};

function polyline({ vertices = [], shape }: Entity): [Pair[], Pair[]] {
  return [bulged(vertices, !!shape), corners(vertices)];
}

function corners(vertices: Point[] = []): Pair[] {
  return vertices.map(({ x, y }): Pair => [x, y]);
}

/** The end of an arc that goes on counterclockwise from its start. */
function after(start: number, end: number): number {
  return end > start ? end : end + 2 * Math.PI;
}

function ends(line: Pair[]): Pair[] {
  return line.length ? [line[0] as Pair, line[line.length - 1] as Pair] : [];
}

/** About a centre; the half axis at angle 0, and the share of it that the other has. */
function arc([x, y]: Pair, [ax, ay]: Pair, ratio: number, from: number, to: number): Pair[] {
  const count = Math.max(2, Math.ceil((Math.abs(to - from) / (2 * Math.PI)) * ROUND));
  return Array.from({ length: count + 1 }, (_, i): Pair => {
    const angle = from + ((to - from) * i) / count;
    const [c, s] = [Math.cos(angle), Math.sin(angle) * ratio];
    return [x + ax * c - ay * s, y + ay * c + ax * s];
  });
}

/** A polyline, of which a side with a bulge is an arc: that is the tangent of a quarter of it. */
function bulged(vertices: (Point & { bulge?: number })[], closed: boolean): Pair[] {
  const line: Pair[] = [];
  const count = vertices.length;
  vertices.forEach((vertex, i) => {
    line.push([vertex.x, vertex.y]);
    const next = vertices[(i + 1) % count];
    if (!next || !vertex.bulge || (i === count - 1 && !closed)) return;
    const turn = 4 * Math.atan(vertex.bulge);
    const [dx, dy] = [next.x - vertex.x, next.y - vertex.y];
    const off = (1 - vertex.bulge ** 2) / (4 * vertex.bulge);
    const [cx, cy] = [(vertex.x + next.x) / 2 - dy * off, (vertex.y + next.y) / 2 + dx * off];
    const from = Math.atan2(vertex.y - cy, vertex.x - cx);
    const radius = Math.hypot(vertex.x - cx, vertex.y - cy);
    line.push(...arc([cx, cy], [radius, 0], 1, from, from + turn).slice(1, -1));
  });
  if (closed && count) line.push(line[0] as Pair);
  return line;
}

/** A B-spline by de Boor's recursion; through its fit points where it has no more. */
function spline({
  controlPoints = [],
  fitPoints = [],
  knotValues: knots = [],
  degreeOfSplineCurve: degree = 3,
}: Entity): Pair[] {
  const points = controlPoints.map(({ x, y }): Pair => [x, y]);
  if (points.length <= degree || knots.length < points.length + degree + 1)
    return (fitPoints.length ? fitPoints : controlPoints).map(({ x, y }): Pair => [x, y]);
  const line: Pair[] = [];
  for (let span = degree; span < points.length; span++) {
    const [low, high] = [knots[span] as number, knots[span + 1] as number];
    if (high <= low) continue;
    for (let i = line.length ? 1 : 0; i <= SPAN; i++) {
      line.push(deBoor(points, knots, degree, span, low + ((high - low) * i) / SPAN));
    }
  }
  return line;
}

function deBoor(points: Pair[], knots: number[], degree: number, span: number, t: number): Pair {
  const active = Array.from({ length: degree + 1 }, (_, j) => points[j + span - degree] as Pair);
  for (let r = 1; r <= degree; r++) {
    for (let j = degree; j >= r; j--) {
      const from = knots[j + span - degree] as number;
      const part = (t - from) / ((knots[j + 1 + span - r] as number) - from);
      const [a, b] = [active[j - 1] as Pair, active[j] as Pair];
      active[j] = [a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part];
    }
  }
  return active[degree] as Pair;
}
