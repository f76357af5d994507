/** Fields for the numbers of a machine, and figures of what these give. */

import { h, set, show, write } from "../dom";
import { shown, signed } from "../format";
import { say } from "../words";
import type { Field, Measure, Output } from "./data";
import { lengthOf, outside, typed, withLength } from "./edits";
import type { Machine, Solution } from "./machine";
import { capital } from "./plot";

/** Digits of a number that was not typed. */
const DIGITS = 7;
/** Of a number: the step of the keys up and down. */
const STEP = 0.01;
/** Share of the largest figure in the same unit, below which a figure is rounding. */
const ROUNDING = 1e-10;
/** Share of a change that is none to a reader. */
const SAME = 5e-4;

/** Tries a design; returns why it is refused, or null. */
export type Try = (design: Float64Array, label: string) => string | null;

interface Row {
  input: HTMLInputElement;
  reset: HTMLButtonElement;
  value(solution: Solution): number;
  label: string;
  factor: number;
}

export class Inputs {
  readonly root = h("div", { class: "inputs" });
  private readonly rows: Row[] = [];
  private solution: Solution;

  constructor(
    machine: Machine,
    private readonly original: Solution,
    private readonly attempt: Try,
    private readonly tell: (sentence: string) => void,
  ) {
    this.solution = original;
    const { fields, measures } = machine.data;
    const headings = [...new Set([...fields, ...measures].map(({ heading }) => heading))];
    headings.forEach((heading, i) => {
      const rows = [
        ...measures.filter((measure) => measure.heading === heading).map((measure) => this.measure(measure)),
        ...fields.flatMap((field, k) => (field.heading === heading ? [this.field(field, k)] : [])),
      ];
      this.root.append(h("details", { open: i < 2 }, h("summary", {}, capital(heading)), ...rows));
    });
  }

  private field(field: Field, place: number): HTMLElement {
    const put = (value: number) => {
      const why = outside(field, value);
      if (why) return why;
      const next = this.solution.design.slice();
      next[place] = value;
      return this.attempt(next, field.label);
    };
    return this.row(field, (solution) => solution.design[place] as number, put);
  }

  private measure(measure: Measure): HTMLElement {
    const field = { ...measure, least: null, above: 0, below: null };
    const put = (value: number) =>
      outside(field as unknown as Field, value) ??
      this.attempt(withLength(this.solution, measure, value), measure.label);
    return this.row(measure, (solution) => lengthOf(solution, measure), put);
  }

  private row(
    quantity: Pick<Field, "label" | "unit" | "factor" | "units">,
    value: (solution: Solution) => number,
    put: (value: number) => string | null,
  ): HTMLElement {
    const input = h("input", {
      type: "text",
      inputmode: "decimal",
      spellcheck: false,
      autocomplete: "off",
      "aria-label": quantity.label,
    });
    const reset = h(
      "button",
      {
        type: "button",
        class: "reset",
        hidden: true,
        title: say("Reset"),
        "aria-label": say("reset {what}", { what: quantity.label }),
      },
      "↺",
    );
    const row: Row = { input, reset, value, label: quantity.label, factor: quantity.factor };
    const take = (to: number) => {
      const why = put(to);
      set(input, { "aria-invalid": why ? "true" : null });
      this.tell(why ?? "");
      if (!why) this.write(row);
    };
    const commit = () => {
      if (input.value === this.text(row)) return set(input, { "aria-invalid": null });
      const number = typed(input.value, quantity);
      if (typeof number === "number") return take(number);
      set(input, { "aria-invalid": "true" });
      this.tell(number);
    };
    input.addEventListener("change", commit);
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") commit();
      if (event.key === "Escape") {
        this.write(row);
        set(input, { "aria-invalid": null });
        this.tell("");
      }
      const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (!way) return;
      event.preventDefault();
      const size = Math.abs(value(this.original)) || 1 / quantity.factor;
      take(
        Number(
          ((value(this.solution) + way * STEP * size * (event.shiftKey ? 10 : 1)) * quantity.factor).toPrecision(
            DIGITS,
          ),
        ) / quantity.factor,
      );
    });
    reset.addEventListener("click", () => {
      take(value(this.original));
      input.focus();
    });
    this.rows.push(row);
    this.write(row);
    return h(
      "div",
      { class: "number" },
      h("span", { class: "name", "aria-hidden": "true" }, capital(quantity.label)),
      input,
      h("span", { class: "unit" }, quantity.unit),
      reset,
    );
  }

  private text({ value, factor }: Row): string {
    return signed(String(Number((value(this.solution) * factor).toPrecision(DIGITS))));
  }

  private write(row: Row): void {
    row.input.value = this.text(row);
    const [now, before] = [row.value(this.solution), row.value(this.original)];
    const same = Math.abs(now - before) <= 1e-12 * Math.abs(before);
    show(row.reset, !same);
    row.input.classList.toggle("changed", !same);
  }

  /** Show the numbers of a design, but not in the field that is typed in. */
  show(solution: Solution): void {
    this.solution = solution;
    for (const row of this.rows) {
      const typing = row.input === document.activeElement && row.input.value !== this.text(row);
      if (!typing || row.input.getAttribute("aria-invalid") === null) this.write(row);
      if (!typing) set(row.input, { "aria-invalid": null });
    }
  }
}

/** The size of a vector before its components. */
function wholeFirst(outputs: Output[]): Output[] {
  const whole = ({ name }: Output) => name.replace(/\.[xy]$/, "");
  const names = [...new Set(outputs.map(whole))];
  const rank = (output: Output) => 2 * names.indexOf(whole(output)) + Number(output.name !== whole(output));
  return [...outputs].sort((a, b) => rank(a) - rank(b));
}

/** RMS and peak of what reaches frame and drive, and of the forces in joints. */
export class Readout {
  readonly root = h("div", { class: "readings" });
  private readonly cells: { output: Output; measure: "rms" | "peak"; value: HTMLElement; was: HTMLElement }[] = [];

  constructor(machine: Machine) {
    const summed = machine.data.outputs.filter(({ summed }) => summed);
    const parts = summed.filter(({ first, name }) => first || !/\.(x|y|force_x|force_y)$/.test(name));
    if (!parts.length) {
      this.root.append(h("p", { class: "quiet" }, say("Motion only, no forces.")));
      return;
    }
    const head = h(
      "tr",
      {},
      h("td"),
      h("th", { scope: "col" }, say("RMS")),
      h("th", { scope: "col" }, say("peak")),
      h("td"),
    );
    const groups = [...new Set(parts.map(({ group }) => group))];
    const bodies = groups.map((group) => {
      const own = wholeFirst(parts.filter((output) => output.group === group));
      const title = h("tr", { class: "heading" }, h("th", { scope: "rowgroup", colspan: 4 }, capital(group)));
      return h("tbody", {}, title, ...own.map((output) => this.line(output)));
    });
    this.root.append(
      h("table", {}, h("caption", { class: "unseen" }, say("Figures")), h("thead", {}, head), ...bodies),
    );
  }

  private line(output: Output): HTMLElement {
    const cell = (measure: "rms" | "peak") => {
      const [value, was] = [
        h("span", { class: "value", "data-figure": `${output.name}.${measure}` }),
        h("span", { class: "was" }),
      ];
      this.cells.push({ output, measure, value, was });
      return h("td", {}, value, was);
    };
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, capital(output.label)),
      cell("rms"),
      cell("peak"),
      h("td", { class: "unit" }, output.unit),
    );
  }

  show(solution: Solution, original: Solution | null): void {
    const largest = new Map<string, number>();
    for (const { output, measure } of this.cells)
      if (measure === "peak")
        largest.set(output.unit, Math.max(largest.get(output.unit) ?? 0, solution.figures(output.name)?.peak ?? 0));
    for (const { output, measure, value, was } of this.cells) {
      const of = (design: Solution) => design.figures(output.name)?.[measure] ?? NaN;
      const [now, before] = [of(solution), original ? of(original) : NaN];
      const rounding = now <= ROUNDING * (largest.get(output.unit) ?? 0);
      write(value, rounding ? "0" : shown(now * output.factor));
      set(value, { "data-value": String(now) });
      const differs = original && !rounding && Math.abs(now - before) > SAME * Math.abs(before);
      write(was, differs ? shown(before * output.factor) : "");
    }
  }
}
