/** Which keys of a table go together: what a JSON Schema says of it, for what is given by now. */

import type { Plain, Rule, Values } from "./protocol";

export interface Demands {
  /** Keys that have to be given, and keys that have no place. */
  needed: Set<string>;
  out: Set<string>;
}

export function demandsOf(rule: Rule, values: Values): Demands {
  const found: Demands = { needed: new Set(), out: new Set() };
  collect(rule, values, found);
  return found;
}

function collect(rule: Rule, values: Values, found: Demands): void {
  for (const key of rule.required ?? []) found.needed.add(key);
  for (const key of barred(rule)) found.out.add(key);
  for (const one of rule.allOf ?? []) collect(one, values, found);
  if (rule.if) collect((matches(rule.if, values) ? rule.then : rule.else) ?? {}, values, found);
  for (const [key, needed] of Object.entries(rule.dependentRequired ?? {}))
    if (key in values) needed.forEach((one) => found.needed.add(one));
  for (const [key, inner] of Object.entries(rule.dependentSchemas ?? {}))
    if (key in values) collect(inner, values, found);
  if (rule.oneOf) choose(rule.oneOf, values, found);
}

/** Of several ways one is taken once the others contradict what is given. */
function choose(ways: Rule[], values: Values, found: Demands): void {
  const left = ways.filter((way) => !barred(way).some((key) => key in values));
  const [only] = left;
  if (only && left.length === 1) return collect(only, values, found);
  const whole = left.filter((way) => way.required?.every((key) => key in values));
  const [taken] = whole;
  if (!taken || whole.length !== 1) return;
  for (const way of left)
    for (const key of way.required ?? [])
      if (!taken.required?.includes(key)) found.out.add(key);
}

function barred(rule: Rule): string[] {
  const properties = Object.entries(rule.properties ?? {});
  return properties.filter(([, wanted]) => wanted === false).map(([key]) => key);
}

function matches(rule: Rule, values: Values): boolean {
  const { required = [], properties = {}, anyOf, allOf, not } = rule;
  return (
    required.every((key) => key in values) &&
    Object.entries(properties).every(([key, wanted]) => {
      const value = values[key];
      return value === undefined || (wanted !== false && suits(wanted, value));
    }) &&
    (!anyOf || anyOf.some((one) => matches(one, values))) &&
    (!allOf || allOf.every((one) => matches(one, values))) &&
    (!not || !matches(not, values))
  );
}

function suits(wanted: { const?: Plain; enum?: Plain[] }, value: Plain): boolean {
  if (wanted.const !== undefined) return wanted.const === value;
  return !wanted.enum || wanted.enum.includes(value);
}
