/** The path of a number in a model file, as files, studies and messages write it. */
export function keyPath(...steps: (string | number)[]): string {
  return steps
    .map((step) => (typeof step === "number" ? `[${step + 1}]` : `.${written(step)}`))
    .join("")
    .replace(/^\./, "");
}

/** A key as it stands in TOML. */
function written(key: string): string {
  return /^[A-Za-z0-9_-]+$/.test(key) ? key : JSON.stringify(key);
}
