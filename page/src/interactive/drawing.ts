/** The drawing of a machine with other numbers: its signs tied to points, and where these are. */

import type { Drawable, DrawnShape, Pair, Rows, Scene, Sign, Status } from "../protocol";
import type { Corner, Tie } from "./data";
import { guideWay, massesMovable, movable } from "./edits";
import { dot, type Machine, minus, mirrored, plus, ratio, type Solution, scaled, size, times } from "./machine";

/** Positions and angles at the equally spaced crank angles, as the drawing wants them. */
class Poses implements Rows {
  private readonly rows = new Map<string, Float32Array>();

  constructor(solution: Solution) {
    const { data, frames } = solution.machine;
    const pairs = (name: string, of: (at: number) => Pair) => {
      const row = new Float32Array(2 * frames.length);
      for (const [k, at] of frames.entries()) row.set(of(at), 2 * k);
      this.rows.set(name, row);
    };
    for (const name of pointsOf(data.scene)) pairs(`place.${name}`, (at) => solution.point(name, at));
    for (const link of data.scene.mass_centers)
      pairs(`mass_center.${link}`, (at) => solution.vector(`center(${link})`, at));
    for (const slider of data.sliders) pairs(`guide.${slider.name}`, (at) => guideWay(solution, slider, at));
    for (const { name } of data.scene.bodies) {
      const angle = (at: number) => {
        const [x, y] = solution.rotation(name, at);
        return Math.atan2(y, x);
      };
      this.rows.set(`angle.${name}`, Float32Array.from(frames, angle));
    }
  }

  get(name: string): Float32Array | undefined {
    return this.rows.get(name);
  }

  names(prefix: string): string[] {
    return [...this.rows.keys()].filter((name) => name.startsWith(prefix));
  }
}

function pointsOf({ frame, bodies }: Scene): string[] {
  return [...new Set([...frame, ...bodies.flatMap(({ points }) => points)])];
}

/** Draws a machine again with each of its designs. */
export class Drawing {
  private readonly base: Solution;
  private readonly movable: string[];
  private readonly masses: string[];

  /** `tips` are places besides that are to be in sight, m. */
  constructor(
    private readonly machine: Machine,
    private readonly tips: Pair[] = [],
  ) {
    this.base = machine.solve(machine.base);
    this.movable = movable(machine);
    this.masses = massesMovable(machine);
  }

  /** What the stage shows of a design that moves. */
  of(solution: Solution): Drawable {
    const { scene, ties, crank } = this.machine.data;
    const signs = scene.signs.map((sign, i) => this.sign(sign, ties[i] ?? [], solution));
    const status: Status = { mobility: 1, text: "", finished: true, drive: crank };
    return {
      scene: { ...scene, signs, movable: this.movable, mass_centers: this.masses, box: this.box(solution) },
      angles: this.machine.frames.length,
      status,
      numbers: new Poses(solution),
    };
  }

  /** All that the original shows, and all places that points come to. */
  private box(solution: Solution): [number, number, number, number] {
    let [x0, y0, x1, y1] = this.machine.data.scene.box;
    const joints = pointsOf(this.machine.data.scene).flatMap((name) =>
      this.machine.frames.map((at) => solution.point(name, at)),
    );
    for (const [x, y] of [...joints, ...this.tips])
      [x0, y0, x1, y1] = [Math.min(x0, x), Math.min(y0, y), Math.max(x1, x), Math.max(y1, y)];
    return [x0, y0, x1, y1];
  }

  private sign(sign: Sign, ties: (Tie | null)[], solution: Solution): Sign {
    const body = sign.hold?.link ?? "frame";
    const shapes = sign.shapes.map((shape, j) => {
      const tie = ties[j];
      return tie ? this.shape(shape, tie, body, solution) : shape;
    });
    return { ...sign, shapes };
  }

  private shape(shape: DrawnShape, tie: Tie, body: string, solution: Solution): DrawnShape {
    if (tie.made_of && !this.kept(tie.made_of, solution)) return nothing(shape);
    if (tie.hull) return this.plate(shape, body, solution);
    if (tie.strand) return this.strand(shape, tie.strand, body, solution);
    if (tie.turned) return this.turned(shape, tie.turned, body, solution);
    const [role, closed, radius, grown, corners] = shape;
    const next = corners.slice();
    tie.corners?.forEach((corner, i) => {
      const [at, turn] = this.corner(corner, body, solution);
      if (!at) return;
      const offset = times(corners.slice(4 * i + 2, 4 * i + 4) as Pair, turn);
      next.splice(4 * i, 4, ...at, ...offset);
    });
    return [role, closed, radius, grown, next];
  }

  /** Whether all numbers whose paths begin so are those of the original. */
  private kept(beginnings: string[], solution: Solution): boolean {
    const { machine } = this;
    return machine.data.fields.every(
      ({ path }, k) => solution.design[k] === machine.base[k] || !beginnings.some((start) => path.startsWith(start)),
    );
  }

  /** Where a corner is in the axes of its body, and how its offset is turned. */
  private corner(corner: Corner, body: string, solution: Solution): [Pair | null, Pair] {
    if (corner === null) return [null, [1, 0]];
    if (typeof corner === "string") return [this.local(corner, body, solution), [1, 0]];
    const [low, high, way] = this.guide(corner[0], solution);
    const [, , before] = this.guide(corner[0], this.base);
    return [plus(low, scaled(minus(high, low), corner[1])), ratio(way, before)];
  }

  /** A point, or the centre of mass of a link, from a body's first point and in its axes. */
  private local(name: string, body: string, solution: Solution): Pair {
    const [first] = this.machine.frames as [number];
    const center = name.startsWith("@");
    const place = center ? solution.vector(`center(${name.slice(1)})`, first) : solution.point(name, first);
    return this.inside(place, body, solution, first);
  }

  private inside(place: Pair, body: string, solution: Solution, at: number): Pair {
    if (body === "frame") return place;
    const [origin] = this.machine.data.links[body]?.points ?? [];
    return times(minus(place, solution.point(origin as string, at)), mirrored(solution.rotation(body, at)));
  }

  /** Both ends of a block's path on its guide, in the axes of the body that has that, and its direction there. */
  private guide(name: string, solution: Solution): [Pair, Pair, Pair] {
    const slider = this.machine.data.sliders.find((slider) => slider.name === name);
    if (!slider)
      return [
        [0, 0],
        [0, 0],
        [1, 0],
      ];
    const [first] = this.machine.frames as [number];
    const way = times(guideWay(solution, slider, first), mirrored(solution.rotation(slider.on, first)));
    const places = this.machine.frames.map((at) =>
      this.inside(solution.point(slider.point, at), slider.on, solution, at),
    );
    const along = places.map((place) => dot(place, way));
    const [start] = places as [Pair];
    const end = (value: number) => plus(start, scaled(way, value - dot(start, way)));
    return [end(Math.min(...along)), end(Math.max(...along)), way];
  }

  /** A bar or plate around all points of a link. */
  private plate([role, closed, radius, grown]: DrawnShape, body: string, solution: Solution): DrawnShape {
    const points = this.machine.data.links[body]?.points ?? [];
    const around = hull(points.map((name) => this.local(name, body, solution)));
    return [role, closed && around.length > 2, radius, grown, around.flatMap(([x, y]) => [x, y, 0, 0])];
  }

  private turned(
    [role, closed, radius, grown, corners]: DrawnShape,
    { about, between, of }: NonNullable<Tie["turned"]>,
    body: string,
    solution: Solution,
  ): DrawnShape {
    const vector = (design: Solution): Pair =>
      between && of ? minus(this.local(between[1], of, design), this.local(between[0], of, design)) : [1, 0];
    const by = ratio(vector(solution), vector(this.base));
    const [from, to] = [this.local(about, body, this.base), this.local(about, body, solution)];
    const next: number[] = [];
    for (let i = 0; i < corners.length; i += 4) {
      const at = plus(to, times(minus(corners.slice(i, i + 2) as Pair, from), by));
      const turn = scaled(by, 1 / (size(by) || 1));
      next.push(...at, ...times(corners.slice(i + 2, i + 4) as Pair, turn));
    }
    return [role, closed, radius * size(by), grown, next];
  }

  /** A strand of a belt, as `mechanism/formulas/rolling.py` has it. */
  private strand(
    [role, closed, radius, grown]: DrawnShape,
    { side, between, radii }: NonNullable<Tie["strand"]>,
    body: string,
    solution: Solution,
  ): DrawnShape {
    const [start, end] = between.map((pin) => this.local(pin, body, solution)) as [Pair, Pair];
    const apart = minus(end, start);
    const far = size(apart) || 1;
    const sine = (radii[0] - radii[1]) / far;
    const cosine = Math.sqrt(Math.max(1 - sine * sine, 0));
    const out = times([0, side], scaled(times(apart, [cosine, -side * sine]), 1 / far));
    const ends = [plus(start, scaled(out, radii[0])), plus(end, scaled(out, radii[1]))];
    return [role, closed, radius, grown, ends.flatMap(([x, y]) => [x, y, 0, 0])];
  }
}

/** A shape of which nothing is seen, but that is still a circle or a line. */
function nothing([role, , radius, grown]: DrawnShape): DrawnShape {
  const round = radius + grown > 0;
  return [role, false, round ? 1e-12 : 0, 0, round ? [0, 0, 0, 0] : []];
}

/** Corners of the smallest convex outline around places, counterclockwise. */
export function hull(places: Pair[]): Pair[] {
  const ordered = [...new Map(places.map((place) => [place.join(), place])).values()];
  ordered.sort(([ax, ay], [bx, by]) => ax - bx || ay - by);
  if (ordered.length < 3) return ordered;
  const chain = (points: Pair[]) => {
    const outline: Pair[] = [];
    for (const point of points) {
      const left = () => {
        const [a, b] = outline.slice(-2) as [Pair, Pair];
        return (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
      };
      while (outline.length > 1 && left() <= 0) outline.pop();
      outline.push(point);
    }
    return outline.slice(0, -1);
  };
  return [...chain(ordered), ...chain(ordered.reverse())];
}
