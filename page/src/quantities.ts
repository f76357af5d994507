/** Numbers with their units, as texts. */

import { degrees, signed } from "./format";

const ENTRY = /^\s*([-+−]?[\d.]+(?:e[-+]?\d+)?)\s*(.*)$/i;
/** How many of a unit make one in SI, for numbers that are zero. */
const FACTORS: Record<string, number> = {
  deg: 180 / Math.PI,
  rpm: 30 / Math.PI,
  mm: 1e3,
  g: 1e3,
  "kg mm^2": 1e6,
};

/** A name with underscores, that may go on in a new line after each. */
export function breakable(name: string): string {
  return name.replace(/_/g, "_\u200b");
}

/** A sentence in which units stay with their numbers. */
export function unbroken(sentence: string): string {
  return sentence
    .replace(/([\d)]) (?=(?:k?g|[cm]?m|N|J|W|deg|m?rad|rpm|s|Hz|%)(?![\w]))/g, "$1\u00a0")
    .replace(/\b(k?g|N) (?=m)/g, "$1\u00a0");
}

/** A number with five digits and its unit: enough to read; the field in use shows it all. */
export function compact(text: string): string {
  const found = ENTRY.exec(text);
  if (!found) return text;
  let value = Number((found[1] as string).replace("−", "-"));
  if (!Number.isFinite(value)) return text;
  let unit = (found[2] ?? "").replace("^2", "²").replace("^3", "³");
  if (unit === "m" && Math.abs(value) < 1) [value, unit] = [value * 1000, "mm"];
  if (unit === "rad") [value, unit] = [degrees(value), "deg"];
  return `${signed(String(Number(value.toPrecision(5))))} ${unit}`.trim();
}

/** Whether a text is a number without a unit. */
export function bare(text: string): boolean {
  return ENTRY.exec(text)?.[2] === "";
}

export function unitOf(text: string): string {
  return ENTRY.exec(text)?.[2] ?? "";
}

/** A value in SI as somebody would type it: a few digits, in the unit of another text of it. */
export function written(value: number, text: string, same: number): string {
  const found = ENTRY.exec(text);
  const [number, unit] = [Number(found?.[1]), found?.[2] ?? ""];
  const factor = number && same ? number / same : (FACTORS[unit] ?? 1);
  return `${Number((value * factor).toPrecision(5))} ${unit}`;
}
