/**
 * The page's texts in the reader's language: English in the code, the rest from the server, with
 * the rules of Korean particles.
 */

import { decimals, point } from "./format";
import type { Particles } from "./messages";
import type { Incoming, MenuItem, PartTool, PluralForms, Spoken, Wire, Wording } from "./protocol";

/** The function that gives every particle of a text one form. */
export function particles({ forms, endings, closing, reach }: Particles): (text: string) => string {
  const escaped = (text: string) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  const both = new RegExp(Object.keys(forms).map(escaped).join("|"), "g");
  const rules = endings.map(([pattern, sound]) => [new RegExp(pattern), sound] as const);
  return (text) =>
    text.replace(both, (written, at: number) => {
      let end = at;
      const begin = Math.max(at - reach, 0);
      while (end > begin && closing.includes(text[end - 1] ?? "")) end--;
      const word = text.slice(begin, end).normalize("NFD");
      const sound = rules.find(([pattern]) => pattern.test(word))?.[1];
      return sound === undefined ? written : (forms[written]?.[sound] ?? written);
    });
}

/** Where a reader's choice of a language is kept. */
const KEPT = "equipoise language";

let spoken: Omit<Spoken, "type" | "seq"> = {
  language: "en",
  languages: { en: "English" },
  words: {},
  explained: {},
  part_tools: [],
  menu_items: [],
  particles: null,
  decimal: ".",
  forms: {},
};
/** What is said of the machine that is open instead, by the text for which it is said. */
let own: Wording = { words: {}, explained: {} };
let joined = (text: string): string => text;

/** A text in the language that is spoken, its `{placeholders}` filled in. */
export function say(text: string, values: Record<string, string | number> = {}): string {
  const said = own.words[text] ?? formOf(spoken.forms[text], values) ?? spoken.words[text] ?? text;
  return joined(said.replace(/\{(\w+)\}/g, (whole, name: string) => filled(values[name] ?? whole)));
}

/** The form of a text that has some by a count. */
function formOf(forms: PluralForms | undefined, values: Record<string, string | number>): string | undefined {
  if (!forms) return undefined;
  const count = Number(values[forms.by ?? ""]);
  const category = Number.isNaN(count) ? "other" : new Intl.PluralRules(spoken.language).select(count);
  return forms[category] ?? forms.other;
}

/** A value as a sentence has it: a number with the decimal sign of the language, a name as it is. */
function filled(value: string | number): string {
  const text = String(value);
  return /^[-+−±(]*\d/.test(text) ? decimals(text) : text;
}

/** Mark a text that is said later, by `say` of a name. */
export function toSay(text: string): string {
  return text;
}

/** The code of the language that is spoken. */
export function language(): string {
  return spoken.language;
}

/** Code of each language there is, and its own name. */
export function languages(): Record<string, string> {
  return spoken.languages;
}

/** Tools that add parts, as the kinds of parts declare them. */
export function partTools(): PartTool[] {
  return spoken.part_tools;
}

/** Tables that menus of the drawing offer to add, as they declare. */
export function menuItems(): MenuItem[] {
  return spoken.menu_items;
}

/** What a chart shows, and what to look for in it. */
export function explained(chart: string): string {
  const [kind = ""] = chart.split(/-|\.\d/);
  const text = (name: string) => own.explained[name] ?? spoken.explained[name];
  return text(chart) ?? text(kind) ?? "";
}

/** Speak of a machine in words that fit it from now on. */
export function word(wording: Wording): void {
  own = wording;
}

/** Speak a language from now on, also when the page is loaded again. */
export function keep(code: string): void {
  try {
    localStorage.setItem(KEPT, code);
  } catch {
    // a browser that keeps nothing: it is spoken until the page is loaded again
  }
}

/** What the reader has chosen, then what the browser asks for. */
export function wished(): string[] {
  let chosen: string | null = null;
  try {
    chosen = localStorage.getItem(KEPT);
  } catch {
    // nothing is kept
  }
  return [...(chosen ? [chosen] : []), ...navigator.languages];
}

/** Speak a language whose texts are at hand, without a server. */
export function speak(language: string, words: Record<string, string>, decimal: string): void {
  spoken = { ...spoken, language, words, decimal };
  point(decimal);
}

/** Agree with the server on a language, by a wire that nobody else hears yet. */
export function agree(wire: Wire, wishes: string[]): Promise<void> {
  return new Promise((done) => {
    const hear = (content: Incoming): void => {
      // Who is turned away, or has lost the server, reads so in English.
      if (content.type !== "spoken" && content.type !== "refused" && content.type !== "lost") return;
      wire.off("msg:custom", hear);
      if (content.type === "spoken") {
        spoken = content;
        point(content.decimal);
        joined = content.particles ? particles(content.particles) : (text) => text;
      }
      done();
    };
    wire.on("msg:custom", hear);
    wire.send({ type: "speak", languages: wishes });
  });
}
