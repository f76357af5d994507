/** Numbers as people read them, and round numbers for scales. */

const MINUS = "\u2212";

/** Some significant digits, a true minus, no exponent where it can be helped. */
export function shown(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size >= 1e6 || size < 1e-4) return signed(value.toExponential(Math.max(digits - 2, 0)));
  const places = Math.min(Math.max(digits - 1 - Math.floor(Math.log10(size)), 0), 8);
  return signed(value.toFixed(places));
}

/** A number whose last digit stays where it is while the value changes. */
export function steady(value: number, largest: number, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  const size = largest > 0 ? Math.floor(Math.log10(largest)) : 0;
  return signed(value.toFixed(Math.min(Math.max(digits - 1 - size, 0), 8)));
}

export function signed(text: string): string {
  const plain = text.replace(/^-(0(\.0*)?)$/, "$1");
  return plain.replace(/-/g, MINUS);
}

/** A round number as it is: for marks of scales. */
export function plain(value: number): string {
  return signed(String(Number(value.toPrecision(6))));
}

export function millimetres(metres: number): string {
  return signed((metres * 1000).toFixed(2));
}

export function percent(before: number, after: number): string {
  if (!before) return "–";
  const change = (after / before - 1) * 100;
  const text = change.toFixed(Math.abs(change) < 9.95 ? 1 : 0);
  return `${Number(text) > 0 ? "+" : ""}${signed(text)}\u00a0%`;
}

export function degrees(angle: number): number {
  return (angle * 180) / Math.PI;
}

/** The round number (1, 2 or 5 times a power of ten) that is not less. */
export function round(least: number): number {
  if (!(least > 0) || !Number.isFinite(least)) return 1;
  const power = 10 ** Math.floor(Math.log10(least));
  const part = least / power;
  return power * (part <= 1.0001 ? 1 : part <= 2.0001 ? 2 : part <= 5.0001 ? 5 : 10);
}

/** Multiples of a step within limits. */
export function multiples(step: number, low: number, high: number): number[] {
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(last - first + 1, 0) }, (_, i) => (first + i) * step);
}

/** Limits of a scale: round, with zero inside, the same for values that differ a little. */
export function limits(low: number, high: number): Pair {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const [from, to] = [Math.min(low, 0), Math.max(high, 0)];
  if (to - from <= 0) return [-1, 1];
  const step = round((to - from) / 8);
  return [Math.floor(from / step - 1e-6) * step, Math.ceil(to / step + 1e-6) * step];
}

type Pair = [number, number];
