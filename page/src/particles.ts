/** Korean particles by the word before them: the rules come with the language. */

import type { Particles } from "./messages";

/** The function that gives every particle of a text one form. */
export function particles({ forms, endings, closing, reach }: Particles): (text: string) => string {
  const escaped = (text: string) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  const both = new RegExp(Object.keys(forms).map(escaped).join("|"), "g");
  const rules = endings.map(([pattern, sound]) => [new RegExp(pattern), sound] as const);
  return (text) =>
    text.replace(both, (found, at: number) => {
      let end = at;
      const begin = Math.max(at - reach, 0);
      while (end > begin && closing.includes(text[end - 1] ?? "")) end--;
      const word = text.slice(begin, end).normalize("NFD");
      const sound = rules.find(([pattern]) => pattern.test(word))?.[1];
      return sound === undefined ? found : (forms[found]?.[sound] ?? found);
    });
}
