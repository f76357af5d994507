/** How the support is seen: at rest, as it moves at work, or in one of its modes. */

import { h, set, show } from "./dom";
import type { Numbers, Pair, ResponseMessage, State } from "./protocol";
import { render, v } from "./render";
import type { Swing } from "./signs";
import { say } from "./words";

const REST = "rest";
const WORK = "work";

export class Support {
  readonly root = h("label", { class: "support", hidden: true });
  private readonly select: HTMLSelectElement;
  private message: ResponseMessage | null = null;
  private place: Float32Array | undefined;
  private angle: Float32Array | undefined;
  private reference: Pair | null = null;
  private offered = "";
  /** Of the swing of a mode, from 0 to 1; and where the crank stands meanwhile. */
  private phase = 0;
  private stands = 0;
  /** While something is held, nothing else moves. */
  held = false;

  constructor(private readonly changed: () => void) {
    this.select = h("select", { "aria-label": say("Support"), onchange: () => this.choose() });
    this.root.append(h("span", {}, say("Support")), this.select);
  }

  /** Which is chosen: a mode by its number from 0, or none. */
  get mode(): number | null {
    const number = Number(this.select.value);
    return this.select.value !== "" && Number.isInteger(number) ? number : null;
  }

  show(state: State, other: boolean): void {
    this.reference = state.scene.reference;
    if (other || !this.reference) this.take(null, null);
  }

  take(message: ResponseMessage | null, numbers: Numbers | null): void {
    this.message = message;
    this.place = numbers?.get("support.place");
    this.angle = numbers?.get("support.angle");
    const modes = message?.modes ?? [];
    const named = modes.map((mode, i): [string, string] => [String(i), mode.lines[0] ?? ""]);
    const options: [string, string][] = [
      ...(this.place ? [[WORK, say("moves as at work")] as [string, string]] : []),
      [REST, say("at rest")],
      ...named,
    ];
    this.offer(options);
    show(this.root, !!this.reference && options.length > 1);
  }

  private offer(options: [string, string][]): void {
    const shape = JSON.stringify(options);
    if (shape === this.offered) return;
    const { value } = this.select;
    const first = this.offered === "" || this.offered === JSON.stringify([[REST, say("at rest")]]);
    this.offered = shape;
    render(this.select, ...options.map(([name, text]) => v("option", { value: name }, text)));
    const kept = options.some(([name]) => name === value) && !first;
    this.select.value = kept ? value : (options[0]?.[0] ?? REST);
  }

  /** What is to be said of the movement that is drawn. */
  get lines(): string[] {
    if (!this.message || this.root.hidden) return [];
    const { mode } = this;
    if (mode === null) return this.select.value === WORK ? (this.message.swing ?? []) : [];
    const drawn = this.message.modes[mode];
    const still = say("the crank stands still; playing swings the support");
    return drawn ? [...drawn.lines, ...(drawn.seen ? [still] : [])] : [];
  }

  /** The crank's sample that is drawn where it would be at `k` of `count`. */
  crank(k: number, count: number): number {
    if (this.mode === null) {
      this.stands = k;
      return k;
    }
    this.phase = (k - this.stands) / count;
    return Math.min(this.stands, count - 1);
  }

  /** How it moves now; null at rest. */
  get swing(): Swing | null {
    const { reference, mode, place, angle } = this;
    if (!reference || this.held || this.root.hidden) return null;
    if (mode !== null) {
      const shape = this.message?.modes[mode]?.shape;
      return shape ? { reference, at: () => swinging(shape, this.phase) } : null;
    }
    return this.select.value === WORK ? moves(reference, place, angle) : null;
  }

  private choose(): void {
    set(this.select, { title: this.select.selectedOptions[0]?.text ?? null });
    this.changed();
  }
}

/** Displacements (m, x and y of each sample) and rotations (rad) of a support as it is drawn; none where it stands still. */
export function moves(reference: Pair, place?: Float32Array, angle?: Float32Array): Swing | null {
  if (!place || !angle) return null;
  const at = (k: number) => ({
    place: [place[2 * k] ?? 0, place[2 * k + 1] ?? 0] as Pair,
    angle: angle[k] ?? 0,
  });
  return { reference, at };
}

function swinging(shape: number[], phase: number): { place: Pair; angle: number } {
  const [cos, sin] = [Math.cos(2 * Math.PI * phase), Math.sin(2 * Math.PI * phase)];
  const now = (i: number) => (shape[i] ?? 0) * cos - (shape[i + 1] ?? 0) * sin;
  return { place: [now(0), now(2)], angle: now(4) };
}
