/** How uPlot draws curves and bars; numbers on the scales are not its own. */

import uPlot from "uplot";
import type { Scale } from "./scale";
import type { Role, Theme } from "./theme";

export interface Curve {
  label: string;
  role: Role;
  values: Float64Array;
  before?: Float64Array | undefined;
  /** Whether it is points alone, without a line. */
  points?: boolean | undefined;
}

export interface Content {
  title: string;
  /** Values of x; the same array as long as nothing about it changed. */
  x: Float64Array;
  unit: string;
  curves: Curve[];
  /** What is smaller than this is rounding, and shown as zero. */
  least?: number;
  /** Whether the scale of the values is logarithmic. */
  log?: boolean;
}

export interface Look {
  height: number;
  xAxis: boolean;
  xLabel?: string;
  /** Distance of marks on x: 90 for degrees. */
  xStep?: (span: number) => number;
  bars?: boolean;
  /** No values at the cursor in the heading. */
  quiet?: boolean;
  /** Told where on x was pressed. */
  picked?: (x: number) => void;
  control?: HTMLElement;
  /** At the end of the heading. */
  button?: HTMLElement;
}

/** Room around the plot, pixels. */
export const LEFT = 46;
export const RIGHT = 16;
export const TOP = 6;
export const BELOW = 22;
export const NARROW = 4;

/** What depends on the values of the moment. */
interface Ways {
  scale(): Scale;
  levels(): number[];
  marks(low: number, high: number): number[];
}

export function optionsOf(
  look: Look,
  theme: Theme,
  curves: Curve[],
  width: number,
  ways: Ways,
): uPlot.Options {
  const none = (_u: uPlot, splits: number[]) => splits.map(() => null);
  const axis = {
    grid: { stroke: () => theme.colours.grid, width: 1 },
    ticks: { show: false },
    border: { show: false },
    values: none,
  };
  const across = { size: look.xAxis ? BELOW : 0, gap: 6 };
  return {
    width,
    height: look.height,
    pxAlign: false,
    legend: { show: false },
    cursor: { show: false },
    padding: [TOP, RIGHT, look.xAxis ? 0 : NARROW, 0],
    scales: {
      x: {
        time: false,
        range: (_u, low, high) => (look.bars ? [low - 0.5, high + 0.5] : [low, high]),
      },
      y: { range: () => ways.scale().ends, distr: ways.scale().log ? 3 : 1 },
    },
    axes: [
      { ...axis, ...across, splits: (_u, _i, low, high) => ways.marks(low, high) },
      { ...axis, size: LEFT, gap: 4, splits: () => ways.levels() },
    ],
    series: [{}, ...curves.flatMap((curve, i) => series(curve, look, theme, i, curves.length))],
    hooks: { drawAxes: [(u) => zero(u, theme.colours.axis, ways.scale())] },
  };
}

/**
 * A curve, behind it what it was before: pale and dotted, or the dashed outline of a bar.
 *
 * The second of two is told from the first without colour too: dashed, or hatched.
 */
function series(curve: Curve, look: Look, theme: Theme, i: number, count: number): uPlot.Series[] {
  const stroke = () => theme.colours[curve.role];
  const base: uPlot.Series = { stroke, width: 1.6, points: { show: false } };
  if (curve.points) return [{ ...base, paths: () => null, points: { show: true, size: 7, fill: stroke } }];
  if (!look.bars) {
    const before: uPlot.Series = { ...base, width: 1.2, dash: [1.5, 2.5], alpha: 0.65 };
    const now =
      curve.role === "quiet" // what was measured: broad, behind nothing
        ? { ...base, width: 3, alpha: 0.7 }
        : i
          ? { ...base, dash: [8, 4] }
          : base;
    return curve.before ? [before, now] : [now];
  }
  const align = count === 1 ? 0 : i ? 1 : -1;
  const paths = uPlot.paths.bars?.({ size: [0.7 / count, 26], align });
  const shape: uPlot.Series = { ...base, width: 1, ...(paths && { paths }) };
  const bars = { ...shape, fill: i ? (u: uPlot) => hatching(u.ctx, stroke()) : stroke };
  const before: uPlot.Series = { ...shape, dash: [2, 2], fill: "transparent", alpha: 0.8 };
  return curve.before ? [before, bars] : [bars];
}

/** What bars have been filled with, by colour and size. */
const tiles = new Map<string, CanvasPattern>();

/** Lines across, that fill a bar. */
function hatching(ctx: CanvasRenderingContext2D, colour: string): CanvasPattern | string {
  const side = Math.round(4 * devicePixelRatio);
  const known = tiles.get(`${colour} ${side}`);
  if (known) return known;
  const tile = document.createElement("canvas");
  tile.width = tile.height = side;
  const pen = tile.getContext("2d");
  if (!pen) return colour;
  pen.strokeStyle = colour;
  pen.lineWidth = side / 3;
  for (const shift of [-side, 0, side]) {
    pen.moveTo(shift - 1, side + 1);
    pen.lineTo(shift + side + 1, -1);
  }
  pen.stroke();
  const pattern = ctx.createPattern(tile, "repeat");
  if (pattern) tiles.set(`${colour} ${side}`, pattern);
  return pattern ?? colour;
}

/** The line of zero, a little stronger than the grid. */
function zero(u: uPlot, colour: string, { ends: [low, high], log }: Scale): void {
  if (log || low > 0 || high < 0) return;
  const y = Math.round(u.valToPos(0, "y", true)) + 0.5;
  u.ctx.save();
  u.ctx.strokeStyle = colour;
  u.ctx.lineWidth = 1;
  u.ctx.beginPath();
  u.ctx.moveTo(u.bbox.left, y);
  u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
  u.ctx.stroke();
  u.ctx.restore();
}
