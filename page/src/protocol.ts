/**
 * What the page does with messages, and the paths of numbers in them; their types are written from
 * those of the server.
 */

import type { Arrays, Sent, StateMessage } from "./messages";

export type * from "./messages";

/** What is heard: from a server, or of the page's own transport. */
export type Incoming = Sent | { type: "lost" | "back" };

/** Numbers over the samples, by name. */
export interface Rows {
  get(name: string): Float32Array | undefined;
  names(prefix: string): string[];
}

/** Numbers of a message, by name. */
export class Numbers implements Rows {
  private readonly floats: Float32Array;

  constructor(
    private readonly arrays: Arrays,
    buffer: DataView | undefined,
  ) {
    this.floats = buffer ? floats(buffer) : new Float32Array(0);
  }

  has(name: string): boolean {
    return name in this.arrays;
  }

  get(name: string): Float32Array | undefined {
    const array = this.arrays[name];
    return array && this.floats.subarray(array[0], array[0] + array[1]);
  }

  names(prefix: string): string[] {
    return Object.keys(this.arrays).filter((name) => name.startsWith(prefix));
  }
}

/** A machine as the page shows it: the message, and its arrays. */
export interface State extends StateMessage {
  numbers: Numbers;
  open?: boolean;
}

/** What a drawing of a machine needs of its state; `open` where its poses do not come back to the first. */
export type Drawable = Pick<State, "scene" | "angles" | "status"> & { numbers: Rows; open?: boolean };

/** Notebooks may hand over bytes that start anywhere; arrays of floats need multiples of four. */
function floats(view: DataView): Float32Array {
  const length = view.byteLength >> 2;
  if (view.byteOffset % 4 === 0) return new Float32Array(view.buffer as ArrayBuffer, view.byteOffset, length);
  const bytes = new Uint8Array(view.buffer as ArrayBuffer, view.byteOffset, length * 4);
  return new Float32Array(bytes.slice().buffer);
}

/** The part of anywidget's model that the page uses; `connect` gives one over a WebSocket. */
export interface Wire {
  send(content: object): void;
  on(event: "msg:custom", heard: Heard): void;
  off(event: "msg:custom", heard: Heard): void;
  /** Give up what takes long; only where that can be done. */
  cancel?(): void;
  /** Let other tabs know where the server is; only where there is one. */
  announce?(): void;
}

export type Heard = (content: Incoming, buffers: DataView[]) => void;

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
