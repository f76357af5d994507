/** Designs of a study: columns of numbers, and which of them are within ranges that are chosen. */

import type { ColumnOf, Numbers, Pair, StudyMessage } from "./protocol";
import { extremes, type Scale, share, wide } from "./scale";

/** Free at both ends of a scale, over its length. */
const ROOM = 0.03;

interface Column {
  declared: ColumnOf;
  /** In the declared unit; NaN where a design has no value. */
  values: Float64Array;
  scale: Scale;
  /** Of the model itself. */
  own: number | null;
}

/** Why a design is not drawn as a good one. */
export type Kind = "kept" | "beyond" | "failed";

export class Designs {
  readonly columns: Column[];
  readonly count: number;
  /** Chosen ranges by column. */
  readonly ranges = new Map<number, Pair>();
  private readonly number: Float32Array;
  private readonly reason: Float32Array;
  private readonly kept: Float32Array;

  constructor(
    readonly study: StudyMessage,
    numbers: Numbers,
  ) {
    const read = (name: string) => numbers.get(name) ?? new Float32Array(0);
    [this.number, this.reason, this.kept] = [read("number"), read("reason"), read("kept")];
    this.count = this.number.length;
    this.columns = study.columns.map((column, k) => {
      const values = Float64Array.from(read(`column.${column.name}`), (x) => x * column.factor);
      const own = study.own?.[k];
      return {
        declared: column,
        values,
        scale: scaleFor(values, own),
        own: own === undefined ? null : own * column.factor,
      };
      function scaleFor(all: Float64Array, model: number | undefined): Scale {
        const here = model === undefined ? [] : [model * column.factor];
        const [low, high] = extremes([all, here]);
        if (wide(all) && (here[0] ?? 1) > 0) return { ends: [low / 1.1, high * 1.1], log: true };
        const span = high - low || Math.abs(low) || 1;
        if (!Number.isFinite(span)) return { ends: [0, 1], log: false };
        return { ends: [low - ROOM * span, high + ROOM * span], log: false };
      }
    });
  }

  /** The number of the i-th design that is drawn. */
  numberOf(i: number): number {
    return this.number[i] ?? 0;
  }

  indexOf(number: number): number {
    return this.number.indexOf(number);
  }

  kind(i: number): Kind {
    if (this.reason[i]) return "failed";
    return this.kept[i] ? "kept" : "beyond";
  }

  why(i: number): string {
    const code = this.reason[i];
    return this.study.refused.find((reason) => reason.code === code)?.why ?? "";
  }

  /** Whether the i-th design is within every range. */
  within(i: number): boolean {
    for (const [k, [low, high]] of this.ranges) {
      const value = this.columns[k]?.values[i] ?? NaN;
      if (!(value >= low && value <= high)) return false;
    }
    return true;
  }

  /** How far along its axis a design is, from 0 to 1. */
  share(i: number, k: number): number {
    const column = this.columns[k] as Column;
    return share(column.values[i] ?? NaN, column.scale);
  }

  /** The value so far along an axis. */
  value(k: number, at: number): number {
    const { ends, log } = (this.columns[k] as Column).scale;
    return log ? ends[0] * (ends[1] / ends[0]) ** at : ends[0] + (ends[1] - ends[0]) * at;
  }

  range(k: number, range: Pair | null): void {
    if (range) this.ranges.set(k, [Math.min(...range), Math.max(...range)]);
    else this.ranges.delete(k);
  }

  /** Designs within every range, in the order of their numbers. */
  chosen(): number[] {
    const front: number[] = [];
    for (let i = 0; i < this.count; i++) if (this.within(i)) front.push(i);
    return front;
  }

  /**
   * Some of these, the best first: of those that keep every limit first those that no other beats in
   * every aim, by the sum of what they lack of the best of each aim; then those nearest to the limits.
   */
  best(among: number[], most: number): number[] {
    const aims = this.columns.filter(({ declared }) => declared.make);
    const lack = aims.map(({ declared, values }) => {
      const [low, high] = extremes([among.map((i) => values[i] ?? NaN)]);
      const from = declared.make === "largest" ? high : low;
      return (i: number) => Math.abs((values[i] ?? NaN) - from) / (high - low || 1);
    });
    const sum = (i: number) => lack.reduce((all, lacking) => all + lacking(i), 0);
    const ranked = (kind: Kind, rank: (i: number) => number) => {
      const ranks = among.filter((i) => this.kind(i) === kind).map((i) => [i, rank(i)] as const);
      return ranks.sort(([, a], [, b]) => a - b || 0).map(([i]) => i);
    };
    const kept = ranked("kept", sum);
    const front: number[] = [];
    for (const i of kept) {
      if (front.length >= most) break;
      const beaten = front.some((j) => lack.every((lacking) => lacking(j) <= lacking(i)) && sum(j) < sum(i));
      if (!beaten) front.push(i);
    }
    const others = kept.filter((i) => !front.includes(i));
    return [...front, ...others, ...ranked("beyond", (i) => this.beyond(i))].slice(0, most);
  }

  /** What a design lacks of all limits, each over that limit. */
  private beyond(i: number): number {
    let lacking = 0;
    for (const { declared, values } of this.columns) {
      declared.limits.forEach((limit, end) => {
        if (limit === null) return;
        const over = (values[i] ?? NaN) / declared.factor - limit;
        lacking += Math.max(end ? over : -over, 0) / (Math.abs(limit) || 1);
      });
    }
    return lacking;
  }
}
