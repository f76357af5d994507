/** The run of a machine: what came of it, its charts over time, and where it is at each of its instants. */

import { type Ask, Chart, explain } from "./chart";
import { h, show, write } from "./dom";
import { unbroken } from "./format";
import type { Numbers, RunMessage, State, TableBlock } from "./protocol";
import { type ComponentChild, render, v } from "./render";
import { indexAtOrBelow } from "./scale";
import type { Swing } from "./signs";
import { moves } from "./support";
import type { Theme } from "./theme";
import { say } from "./words";

/** Columns that always have room beside each other. */
const NARROW = 4;

/** Elements of some blocks, one below the other. */
function blocksOf(blocks: RunMessage["blocks"]): ComponentChild[] {
  return blocks.flatMap((block) => {
    if (block.kind === "text") return [v("p", block.emphasized ? { class: "worse" } : {}, unbroken(block.text))];
    if (block.kind === "table") return [tableOf(block)];
    const items = block.items.map((item) => v("li", {}, unbroken(item)));
    return [...(block.title ? [v("h3", {}, block.title)] : []), v("ul", {}, ...items)];
  });
}

function tableOf({ title, heads, rows, numbers, emphasized }: TableBlock): ComponentChild {
  const side = (i: number) => (numbers[i] ? {} : { class: "word" });
  const strong = new Set(emphasized.map((place) => place.join()));
  const look = (row: number, i: number) => {
    const classes = [!numbers[i] && i > 0 && "word", strong.has(`${row},${i}`) && "worse"].filter(Boolean);
    return classes.length ? { class: classes.join(" ") } : {};
  };
  const head = heads.map((text, i) => (text ? v("th", { scope: "col", ...side(i) }, unbroken(text)) : v("td", {})));
  const cell = (row: number, text: string, i: number) =>
    i ? v("td", look(row, i), unbroken(text)) : v("th", { ...look(row, i), scope: "row" }, unbroken(text));
  const body = rows.map((row, k) => v("tr", {}, ...row.map((text, i) => cell(k, text, i))));
  const table = v("table", {}, v("caption", {}, title), v("thead", {}, v("tr", {}, ...head)), v("tbody", {}, ...body));
  // Where it may have to be moved from side to side, keys can do so too.
  return heads.length > NARROW
    ? v("div", { class: "wide", tabindex: 0, role: "group", "aria-label": title }, table)
    : table;
}

/** A run that can be played: its instants, s, and the crank angle at each, in cycles. */
interface Run {
  message: RunMessage;
  numbers: Numbers;
  time: Float32Array;
  cycles: Float32Array;
}

export class RunPanel {
  readonly root = h("section", {
    class: "panel run",
    "aria-label": say("Result of the run"),
    hidden: true,
    tabindex: -1,
  });
  readonly charts = h("div", {
    class: "charts timed",
    role: "group",
    "aria-label": say("Run over time"),
    hidden: true,
  });
  private readonly blocks = h("div", { class: "blocks" });
  private readonly turn: HTMLButtonElement;
  private readonly drawn = new Map<string, Chart>();
  private run: Run | null = null;
  private width = 0;

  /** `play` goes from the cycle to the run, or back; `picked` goes to an instant, s. */
  constructor(
    private readonly theme: Theme,
    play: () => void,
    close: () => void,
    private readonly picked: (time: number) => void,
    private readonly ask: Ask,
  ) {
    this.turn = h("button", { type: "button", class: "strong", onclick: play });
    const away = h("button", { type: "button", onclick: close }, say("Close"));
    this.root.append(h("h2", {}, say("Run")), h("div", { class: "buttons" }, this.turn, away), this.blocks);
  }

  /** The design that has run; none where nothing is shown. */
  get design(): number | null {
    return this.run?.message.design ?? null;
  }

  /** How long the run takes, s. */
  get span(): number {
    return this.run?.time.at(-1) ?? 0;
  }

  show(message: RunMessage, numbers: Numbers, state: State): void {
    const [time, cycles] = ["time", "cycles"].map((name) => numbers.get(`run.${name}`) ?? new Float32Array(0));
    this.run = { message, numbers, time: time as Float32Array, cycles: cycles as Float32Array };
    render(this.blocks, ...blocksOf(message.blocks));
    this.clear();
    for (const data of message.charts) {
      const chart = new Chart(data, this.theme, true, { picked: this.picked, chosen: () => undefined });
      this.drawn.set(data.name, chart);
      this.charts.append(chart.strip.root);
      explain(chart.strip.root, data.choices[0]?.label ?? "", data.name, this.ask, () => "");
      chart.strip.resize(this.width);
      chart.show({ state, numbers, before: false }, "", "");
      chart.strip.describe();
    }
    show(this.root, true);
    show(this.charts, true);
    // It stands first in its column; where there is one column alone the drawing stays in sight.
    this.root.focus({ preventScroll: true });
    this.root.parentElement?.scrollTo({ top: 0 });
  }

  /** What came of the run, in a sentence. */
  get verdict(): string {
    const [first] = this.run?.message.blocks ?? [];
    return first?.kind === "text" ? first.text : "";
  }

  /** Forget it: the machine is another one, or nobody looks at it any more. */
  drop(): void {
    this.run = null;
    this.clear();
    show(this.root, false);
    show(this.charts, false);
  }

  /** Take its charts away, and what they hear of the window. */
  clear(): void {
    for (const { strip } of this.drawn.values()) strip.close();
    this.drawn.clear();
  }

  /** Say whether the run is played, or the cycle. */
  playing(on: boolean): void {
    write(this.turn, on ? say("Back to the cycle") : say("Play the run"));
  }

  /** What the drawing shows of a machine that runs: poses of its own, where its drives go their own ways. */
  poses(state: State): State {
    const { message, numbers } = this.run ?? {};
    if (!message?.frames || !numbers) return state;
    return { ...state, numbers, angles: message.frames, open: true, arrows_at: null };
  }

  /** How the support moves in the poses of the run; none on a fixed frame. */
  swing({ scene: { reference } }: State): Swing | null {
    const { numbers } = this.run ?? {};
    return reference && moves(reference, numbers?.get("run.place"), numbers?.get("run.angle"));
  }

  /** Whether the poses are those of the cycle. */
  get cyclic(): boolean {
    return !this.run?.message.frames;
  }

  /** Point at an instant in all charts; gives the pose there, of so many of them. */
  at(now: number, count: number): number {
    for (const chart of this.drawn.values()) chart.play(now);
    const { time, cycles } = this.run ?? { time: [], cycles: [] };
    const k = indexAtOrBelow(time, now);
    const [t0, t1] = [time[k] ?? 0, time[k + 1] ?? Infinity];
    const [c0, c1] = [cycles[k] ?? 0, cycles[k + 1] ?? cycles[k] ?? 0];
    const turned = c0 + (t1 > t0 && t1 < Infinity ? ((now - t0) / (t1 - t0)) * (c1 - c0) : 0);
    const whole = Math.round(turned * count) % count;
    return whole < 0 ? whole + count : whole;
  }

  resize(width: number): void {
    if (width < 40) return;
    this.width = width;
    for (const { strip } of this.drawn.values()) strip.resize(width);
  }

  repaint(): void {
    for (const { strip } of this.drawn.values()) strip.repaint();
  }
}
