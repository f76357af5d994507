/** A store of a study on the page: its designs in two pictures that are brushed together. */

import { Parallel, type PointerEvents, Scatter } from "./cloud";
import { Designs } from "./designs";
import { h, write } from "./dom";
import { shown, unbroken } from "./format";
import type { Numbers, PageRequest, Pair, StudyMessage } from "./protocol";
import { capital } from "./readings";
import { render, v } from "./render";
import type { Theme } from "./theme";
import { say } from "./words";

/** Designs that are listed. */
const LISTED = 12;

export class StudyView {
  readonly root = h("div", { class: "body study", hidden: true });
  private readonly heading = h("h1");
  private readonly counts = h("p", { role: "status" });
  private readonly refused = h("ul", { class: "quiet" });
  private readonly reading = h("p", { class: "quiet reading-line" }, "");
  private readonly keys = h("ul", { class: "scales" });
  private readonly list = h("div", { class: "scrolled", tabindex: 0 });
  private readonly ranges = h("div", { class: "ranges" });
  private readonly wrong = h("p", { class: "said bad", role: "status", hidden: true });
  private readonly across: HTMLSelectElement;
  private readonly up: HTMLSelectElement;
  private readonly parallel: Parallel;
  private readonly scatter: Scatter;
  private readonly watcher = new ResizeObserver(() => this.measure());
  private designs: Designs | null = null;
  private frame = 0;

  constructor(
    private readonly ask: (request: PageRequest) => void,
    theme: Theme,
  ) {
    const events: PointerEvents = {
      ranged: () => this.later(),
      opened: (i) => this.open(i),
      hovered: (i) => this.hover(i),
    };
    [this.parallel, this.scatter] = [new Parallel(theme, events), new Scatter(theme, events)];
    const axis = (name: string) => h("select", { "aria-label": name, onchange: () => this.turn() });
    [this.across, this.up] = [axis(say("Across")), axis(say("Upward"))];
    const clear = h("button", { type: "button", onclick: () => this.clear() }, say("All designs"));
    const pictures = h("section", { class: "pictures", "aria-label": say("Designs") });
    const bar = h("div", { class: "seeing" }, this.up, h("span", {}, say("over")), this.across, clear);
    pictures.append(this.heading, this.counts, this.refused, this.wrong, this.parallel.root);
    pictures.append(this.keys, bar, this.scatter.root, this.reading);
    const aside = h("section", { class: "inspector", "aria-label": say("Ranges and designs") });
    aside.append(h("h2", {}, say("Ranges")), this.ranges, h("h2", {}, say("Designs")), this.list);
    this.root.append(pictures, aside);
    this.watcher.observe(pictures);
  }

  close(): void {
    cancelAnimationFrame(this.frame);
    this.watcher.disconnect();
  }

  hide(): void {
    this.root.hidden = true;
  }

  /** A sentence about what cannot be. */
  say(message: string): void {
    write(this.wrong, message);
    this.wrong.hidden = !message;
  }

  show(study: StudyMessage, numbers: Numbers): void {
    this.root.hidden = false;
    this.say("");
    if (this.designs?.study.name !== study.name || this.designs.count !== study.drawn) {
      this.designs = new Designs(study, numbers);
      this.offer(study);
      this.range();
    }
    write(this.heading, study.title);
    const keys: [string, string, boolean][] = [
      ["kept", study.limited ? say("designs that keep every limit") : say("all designs"), true],
      ["beyond", say("others"), study.limited],
      ["failed", say("cannot be computed"), study.refused.length > 0],
      ["itself", say("the model itself"), study.own !== null],
    ];
    const visible = keys.filter(([, , there]) => there);
    render(this.keys, ...visible.map(([kind, text]) => v("li", {}, v("i", { class: `key-${kind}` }), text)));
    render(this.refused, ...study.refused.map(({ why, count }) => v("li", {}, `${count} × ${why}`)));
    this.measure();
    this.again();
  }

  repaint(): void {
    this.parallel.draw();
    this.scatter.draw();
  }

  private measure(): void {
    const width = this.parallel.root.clientWidth;
    this.parallel.resize(width);
    this.scatter.resize(width);
  }

  private offer({ columns }: StudyMessage): void {
    for (const select of [this.across, this.up])
      render(select, ...columns.map(({ label }, k) => v("option", { value: k }, label)));
    const outputs = columns.flatMap(({ kind }, k) => (kind === "output" ? [k] : []));
    // Two aims against each other where there are two; else the aim over the first number.
    const aims = columns.flatMap(({ make }, k) => (make ? [k] : []));
    const [up = outputs[0] ?? 1, across = 0] = aims;
    [this.up.value, this.across.value] = [String(up), String(across)];
    this.turn();
  }

  private turn(): void {
    this.scatter.columns = [Number(this.across.value), Number(this.up.value)];
    this.scatter.draw();
  }

  private clear(): void {
    this.designs?.ranges.clear();
    this.again();
  }

  /** While a range is dragged the pictures follow once a frame. */
  private later(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.again();
    });
  }

  private again(): void {
    const { designs } = this;
    if (!designs) return;
    this.parallel.show(designs);
    this.scatter.show(designs);
    this.range();
    const chosen = designs.chosen();
    const { size, drawn, kept, computed, limited } = designs.study;
    const lines = [say("{count} of {size} designs are drawn", { count: drawn, size })];
    lines.push(say("{count} have figures", { count: computed }));
    if (limited) lines.push(say("{count} keep every limit", { count: kept }));
    if (designs.ranges.size) lines.push(say("{count} within the ranges", { count: chosen.length }));
    write(this.counts, lines.join("; "));
    this.fill(designs, chosen);
  }

  /** Some designs by their numbers: the best within the ranges, else any of them. */
  private fill(designs: Designs, chosen: number[]): void {
    const best = designs.study.best.map((number) => designs.indexOf(number));
    const inside = new Set(chosen);
    const good = designs.ranges.size ? [] : best.filter((i) => i >= 0 && inside.has(i));
    const others = designs.best(
      chosen.filter((i) => !good.includes(i) && designs.kind(i) !== "failed"),
      LISTED,
    );
    const rows = [...good, ...others].slice(0, LISTED);
    const { columns } = designs;
    const head = ["", ...columns.map(({ declared }) => `${capital(declared.label)} ${declared.unit}`)];
    const line = (i: number) => {
      const number = designs.numberOf(i);
      const words = say("Open design {number}", { number });
      const open = v("button", { type: "button", onclick: () => this.open(i) }, words);
      const cells = columns.map(({ values }) => v("td", {}, shown(values[i] ?? NaN)));
      return v("tr", { key: number, class: designs.kind(i) }, v("td", {}, open), ...cells);
    };
    render(
      this.list,
      v(
        "table",
        {},
        v("thead", {}, v("tr", {}, ...head.map((text) => v("th", { scope: "col" }, unbroken(text))))),
        v("tbody", {}, ...rows.map(line)),
      ),
    );
  }

  /** Ranges as numbers: for keys, and to be exact. */
  private range(): void {
    const { designs } = this;
    if (!designs || this.ranges.contains(document.activeElement)) return;
    const rows = designs.columns.map(({ declared }, k) => {
      const [low, high] = designs.ranges.get(k) ?? [null, null];
      const name = { label: declared.label, unit: declared.unit };
      const end = (words: string, value: number | null, at: 0 | 1) => {
        const input = h("input", {
          type: "text",
          inputmode: "decimal",
          "aria-label": words,
          value: value === null ? "" : shown(value).replace("−", "-"),
        });
        input.addEventListener("change", () => this.typed(k, at, input));
        return input;
      };
      const ends = [end(say("{label}, from, {unit}", name), low, 0), end(say("{label}, to, {unit}", name), high, 1)];
      const words = unbroken(`${capital(declared.label)} ${declared.unit}`.trim());
      return h("div", { class: "range-row" }, h("span", {}, words), ...ends);
    });
    this.ranges.replaceChildren(...rows);
  }

  private typed(k: number, at: 0 | 1, input: HTMLInputElement): void {
    const { designs } = this;
    if (!designs) return;
    const text = input.value.trim().replace("−", "-").replace(",", ".");
    const value = text === "" ? (at ? Infinity : -Infinity) : Number(text);
    const wrong = Number.isNaN(value);
    input.setAttribute("aria-invalid", String(wrong));
    this.say(wrong ? say("got {text}; give a number", { text: `“${text}”` }) : "");
    if (wrong) return;
    const range: Pair = [...(designs.ranges.get(k) ?? [-Infinity, Infinity])];
    range[at] = value;
    designs.range(k, range.every((end) => !Number.isFinite(end)) ? null : range);
    this.again();
  }

  private hover(i: number | null): void {
    this.parallel.mark(i);
    this.scatter.mark(i);
    const { designs } = this;
    if (!designs || i === null) return write(this.reading, "");
    const values = designs.columns.map(
      ({ declared, values: all }) => `${declared.label} ${shown(all[i] ?? NaN)} ${declared.unit}`,
    );
    const name = say("design {number}", { number: designs.numberOf(i) });
    const why = designs.why(i);
    write(this.reading, unbroken([name, ...(why ? [why] : []), ...values].join(" · ")));
  }

  private open(i: number): void {
    const { designs } = this;
    if (designs) this.ask({ type: "design", number: designs.numberOf(i), store: designs.study.name });
  }
}
