/** Files that are dropped on the page, and files that it hands out. */

import { h } from "./dom";
import type { HandedOut } from "./protocol";
import { say } from "./words";

/** Let files be dropped on an element; returns the veil that is over it meanwhile. */
export function dropZone(root: HTMLElement, dropped: (files: File[]) => void): HTMLElement {
  const veil = h(
    "div",
    { class: "veil", hidden: true },
    h(
      "span",
      {},
      say(
        "Drop a model file (.toml) with its tables (.csv), a record (.csv), or a picture or DXF drawing to trace over",
      ),
    ),
  );
  for (const name of ["dragenter", "dragover", "dragleave", "drop"] as const) {
    root.addEventListener(name, (event) => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault();
      const leaves = name === "dragleave" && !root.contains(event.relatedTarget as Node | null);
      veil.hidden = name === "drop" || leaves;
      const { files } = event.dataTransfer;
      if (name === "drop" && files.length) dropped([...files]);
    });
  }
  return veil;
}

/** Let a file be picked; gives the element that has to be on the page. */
export function picker(picked: (files: File[]) => void): HTMLInputElement {
  const input = h("input", {
    type: "file",
    hidden: true,
    multiple: true,
    accept: ".toml,.csv",
    "aria-label": say("Model file"),
    tabindex: -1,
  });
  input.addEventListener("change", () => {
    const chosen = [...(input.files ?? [])];
    input.value = "";
    if (chosen.length) picked(chosen);
  });
  return input;
}

/** Why a file is not read, or null. */
export function tooLarge(file: File, largest: number): string | null {
  if (file.size <= largest) return null;
  const [size, most] = [(file.size / 1e6).toFixed(1), (largest / 1e6).toFixed(0)];
  const values = { name: file.name, size, most };
  return say("{name} has {size} MB; at most {most} MB are read: give a model file.", values);
}

/** Hand a file, and the tables that it names, to the browser's own downloads. */
export function save({ name, mime, files = {} }: HandedOut, bytes: DataView | undefined): void {
  const part = bytes ? new Uint8Array(bytes.buffer as ArrayBuffer, bytes.byteOffset, bytes.byteLength) : "";
  handOut(name, mime, part);
  for (const [table, text] of Object.entries(files)) handOut(table, "text/csv", text);
}

/** Hand out a file that was made here. */
export function handOut(name: string, mime: string, part: BlobPart): void {
  const address = URL.createObjectURL(new Blob([part], { type: mime }));
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
