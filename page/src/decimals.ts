/** Numbers with the decimal sign of the reader's language: shown so, and typed so. */

const POINT = ".";
/** One that stands alone: not of a name or a version. */
const NUMBER = /(^|[^\w.])(\d+)\.(\d+)(?=e[+-]?\d+(?!\w)|(?!\w|\.\w))/g;
/** A number, and what may be its unit. */
const TYPED = /^([-+]?\d*),(\d+(?:e[-+]?\d+)?(?:\s*[^\d\s,][^,]*)?)$/i;

let sign = POINT;

/** Follow the language that is spoken. */
export function point(decimal: string): void {
  sign = decimal;
}

/** Numbers of a text with the sign of the language; files and commands have a point. */
export function decimals(text: string): string {
  return sign === POINT ? text : text.replace(NUMBER, `$1$2${sign}$3`);
}

/**
 * What was typed into a field, as files have it: a minus as they write it, and a point.  A comma is
 * a decimal one where the language has such, and there is one number with one comma.
 */
export function asTyped(text: string): string {
  const plain = text.trim().replace(/−/g, "-");
  return sign === "," ? plain.replace(TYPED, "$1.$2") : plain;
}
