/** A hand-held tool on the page: its side view, which moves, its numbers, figures and curves. */

import { Chart } from "./chart";
import type { Conversation } from "./conversation";
import { h, write } from "./dom";
import { measure, unbroken } from "./format";
import { Heading } from "./heading";
import { Inspector } from "./inspector";
import { Locks } from "./locks";
import type { Numbers, State, ToolMessage } from "./protocol";
import { comparison } from "./readings";
import { ToolSide } from "./tool_side";
import type { Theme } from "./theme";
import { say } from "./words";

/** Of a swing, ms. */
const PERIOD = 1600;

export class ToolView {
  readonly root = h("div", { class: "body tool", hidden: true });
  private readonly side = new ToolSide();
  private readonly heading = new Heading();
  private readonly inspector: Inspector;
  private readonly views: HTMLSelectElement;
  private readonly play: HTMLButtonElement;
  private readonly told = h("p", { class: "quiet", role: "status" });
  private readonly wrong = h("p", { class: "said bad", role: "status", hidden: true });
  private readonly figures = h("div", { class: "readings figures" });
  private readonly charts = h("div", { class: "charts" });
  private readonly drawn = new Map<string, Chart>();
  private readonly watcher = new ResizeObserver(() => this.measure());
  private tool: ToolMessage | null = null;
  private numbers: Numbers | null = null;
  private playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  private frame = 0;
  private begun = 0;

  constructor(
    talk: Conversation,
    private readonly theme: Theme,
  ) {
    this.inspector = new Inspector(talk, () => undefined, new Locks());
    this.views = h("select", { "aria-label": say("What is shown"), onchange: () => this.pose() });
    this.play = h("button", { type: "button", onclick: () => this.toggle() }, "");
    const stage = h("section", { class: "stage", "aria-label": say("The tool from the side") });
    const bar = h("div", { class: "seeing" }, this.play, this.views, this.told);
    this.side.root.append(this.wrong);
    stage.append(this.heading.about, this.side.root, bar, this.heading.notes, this.figures);
    const side = h("section", { class: "side", "aria-label": say("Charts") });
    side.append(this.charts);
    const aside = h("section", { class: "inspector", "aria-label": say("Numbers") });
    aside.append(this.inspector.root);
    this.root.append(stage, side, aside);
    this.watcher.observe(this.side.root);
    this.watcher.observe(this.charts);
  }

  /** A sentence, on what cannot be if `bad`; it goes with the next change. */
  say(message: string, bad = false): void {
    write(this.wrong, message);
    this.wrong.classList.toggle("bad", bad);
    this.wrong.hidden = !message;
  }

  close(): void {
    cancelAnimationFrame(this.frame);
    this.watcher.disconnect();
  }

  hide(): void {
    this.root.hidden = true;
    cancelAnimationFrame(this.frame);
    this.tool = null;
  }

  show(tool: ToolMessage, numbers: Numbers): void {
    const other = tool.name !== this.tool?.name;
    [this.tool, this.numbers] = [tool, numbers];
    measure(tool.length);
    this.say("");
    this.root.hidden = false;
    this.offer(tool, other);
    this.side.resize();
    this.side.show(tool, other);
    // What these need of a state a tool has too.
    const state = tool as unknown as State;
    this.heading.show(state);
    this.inspector.show(state);
    this.figures.replaceChildren(
      comparison(tool.figures, [say("as opened"), say("now"), say("change")]),
    );
    this.chart();
    this.pose();
  }

  private offer(tool: ToolMessage, other: boolean): void {
    const names = [say("at rest"), ...tool.views.map(({ name }) => name)];
    const chosen = other ? Math.min(1, tool.views.length) : this.views.selectedIndex;
    this.views.replaceChildren(...names.map((name, i) => h("option", { value: i }, name)));
    this.views.selectedIndex = Math.min(chosen, names.length - 1);
  }

  private chart(): void {
    const { tool, numbers } = this;
    if (!tool || !numbers) return;
    const before = numbers.names("before.").length > 0;
    for (const data of tool.charts) {
      let chart = this.drawn.get(data.name);
      const whole = { picked: () => undefined, chosen: () => this.chart() };
      if (!chart) {
        chart = new Chart(data, this.theme, true, whole);
        this.drawn.set(data.name, chart);
        this.charts.append(chart.strip.root);
        chart.strip.resize(this.charts.clientWidth);
      }
      chart.offer(data, "", false);
      chart.show({ state: tool as unknown as State, numbers, before }, "", "");
      chart.strip.describe();
    }
    const names = tool.charts.map(({ name }) => name);
    for (const [name, { strip }] of this.drawn) if (!names.includes(name)) strip.root.hidden = true;
  }

  private measure(): void {
    this.side.resize();
    for (const { strip } of this.drawn.values()) strip.resize(this.charts.clientWidth);
  }

  private toggle(): void {
    this.playing = !this.playing;
    this.pose();
  }

  /** Show what is chosen, and swing it if that is wanted. */
  private pose(): void {
    const view = this.tool?.views[this.views.selectedIndex - 1];
    const text = (view?.told ?? []).join("; ");
    write(this.told, unbroken(text));
    this.told.hidden = !text;
    write(this.play, this.playing ? say("Pause") : say("Play"));
    this.play.disabled = !view;
    cancelAnimationFrame(this.frame);
    this.side.pose(view?.shape ?? [], 0);
    if (!view || !this.playing) return;
    this.begun ||= performance.now();
    const swing = (now: number) => {
      this.side.pose(view.shape, ((now - this.begun) % PERIOD) / PERIOD);
      this.frame = requestAnimationFrame(swing);
    };
    this.frame = requestAnimationFrame(swing);
  }
}
