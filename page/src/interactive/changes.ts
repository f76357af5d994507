/** Numbers that were changed, as lines of a model file. */

import type { Field } from "./data";
import type { Machine } from "./machine";

/** Fields whose number is another than in the model. */
export function changed(machine: Machine, design: Float64Array): number[] {
  return machine.data.fields.flatMap((_, k) => (design[k] === machine.base[k] ? [] : [k]));
}

/** Tables and keys of the model file with the numbers that were changed. */
export function toml(machine: Machine, design: Float64Array): string {
  const { fields } = machine.data;
  const tables = new Map<string, Map<string, string>>();
  for (const k of changed(machine, design)) {
    const field = fields[k] as Field;
    const last = field.steps[field.steps.length - 1];
    const isPart = last === "x" || last === "y";
    const keys = isPart ? field.steps.slice(0, -1) : field.steps;
    const [head, key] = placed(keys);
    const lines = tables.get(head) ?? new Map<string, string>();
    lines.set(key, isPart ? pair(machine, design, field) : quantity(field, design[k] as number));
    tables.set(head, lines);
  }
  return [...tables]
    .map(([head, lines]) =>
      [head, ...[...lines].map(([key, value]) => `${key} = ${value}`), ""].filter((line, i) => i || line).join("\n"),
    )
    .join("\n");
}

/** Header of the table, and the key in it; entries of lists have their number beside. */
function placed(steps: (string | number)[]): [string, string] {
  const number = steps.findIndex((step) => typeof step === "number");
  const names = steps.map(String);
  if (number > 0) {
    const list = names.slice(0, number).map(bare).join(".");
    const rest = steps.slice(number + 1);
    return [`[[${list}]]  # ${Number(steps[number]) + 1}`, rest.map((step) => bare(String(step))).join(".")];
  }
  const table = names.slice(0, -1).map(bare).join(".");
  return [table && `[${table}]`, bare(names[names.length - 1] as string)];
}

function pair(machine: Machine, design: Float64Array, field: Field): string {
  const stem = field.path.slice(0, -1);
  const parts = ["x", "y"].map((axis) => machine.numbers.get(stem + axis));
  const texts = parts.map((k) => (k === undefined ? "?" : quantity(field, design[k] as number)));
  return `[${texts.join(", ")}]`;
}

/** A number as a model file has it. */
export function quantity({ factor, written }: Field, value: number): string {
  const number = String(Number((value * factor).toPrecision(15)));
  return written ? `"${number} ${written}"` : number;
}

function bare(key: string): string {
  return /^[\w-]+$/.test(key) ? key : JSON.stringify(key);
}
