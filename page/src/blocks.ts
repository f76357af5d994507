/** Blocks of a result: texts, lists of sentences, tables whose cells are texts. */

import { h } from "./dom";
import { unbroken } from "./format";
import type { RunMessage, TableBlock } from "./protocol";

/** Columns that always have room beside each other. */
const NARROW = 4;

/** Elements of some blocks, one below the other. */
export function blocksOf(blocks: RunMessage["blocks"]): HTMLElement[] {
  return blocks.flatMap((block) => {
    if (block.kind === "text") return [h("p", block.emphasized ? { class: "worse" } : {}, unbroken(block.text))];
    if (block.kind === "table") return [tableOf(block)];
    const items = block.items.map((item) => h("li", {}, unbroken(item)));
    return [...(block.title ? [h("h3", {}, block.title)] : []), h("ul", {}, ...items)];
  });
}

function tableOf({ title, heads, rows, numbers, emphasized }: TableBlock): HTMLElement {
  const side = (i: number) => (numbers[i] ? {} : { class: "word" });
  const strong = new Set(emphasized.map((place) => place.join()));
  const look = (row: number, i: number) => {
    const classes = [!numbers[i] && i > 0 && "word", strong.has(`${row},${i}`) && "worse"].filter(Boolean);
    return classes.length ? { class: classes.join(" ") } : {};
  };
  const head = heads.map((text, i) => (text ? h("th", { scope: "col", ...side(i) }, unbroken(text)) : h("td")));
  const cell = (row: number, text: string, i: number) =>
    h(i ? "td" : "th", { ...look(row, i), scope: i ? null : "row" }, unbroken(text));
  const body = rows.map((row, k) => h("tr", {}, ...row.map((text, i) => cell(k, text, i))));
  const table = h("table", {}, h("caption", {}, title), h("thead", {}, h("tr", {}, ...head)), h("tbody", {}, ...body));
  // Where it may have to be moved from side to side, keys can do so too.
  return heads.length > NARROW ? h("div", { class: "wide", tabindex: 0, role: "group", "aria-label": title }, table) : table;
}
