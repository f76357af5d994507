/** The path of a number in a model file, as files, studies and messages write it. */
export function keyPath(...steps: (string | number)[]): string {
  return steps
    .map((step) => (typeof step === "number" ? `[${step + 1}]` : `.${written(step)}`))
    .join("")
    .replace(/^\./, "");
}

/** Keys of such a path, and numbers in lists from 0. */
export function stepsOf(path: string): (string | number)[] {
  const steps = path.matchAll(/"(?:[^"\\]|\\.)*"|\[(\d+)\]|[^."[\]]+/g);
  return [...steps].map(([text, number]) => {
    if (number !== undefined) return Number(number) - 1;
    return text.startsWith('"') ? (JSON.parse(text) as string) : text;
  });
}

/** A key as it stands in TOML. */
function written(key: string): string {
  return /^[A-Za-z0-9_-]+$/.test(key) ? key : JSON.stringify(key);
}
