/** The clock of the crank: which sample is shown now; and the bar that plays, pauses and turns it by hand. */

import { h, icon, put, set, write } from "./dom";
import { decimals, signed, unbroken } from "./format";
import type { State } from "./protocol";
import { say } from "./words";

/** Parts of the true speed at which the linkage may be seen to turn. */
const RATES = [1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01] as const;

/** A turn that takes at least this long can be followed by eye, s. */
const SLOW = 2.4;
/** A run is played for at least this long, s. */
const LONG = 6;
/** Steps of the slider over a run. */
const STEPS_OF_RUN = 1000;

export class Player {
  playing = false;
  rate = 0.1;
  /** Crank angle since the first sample, as a part of the whole cycle. */
  private part = 0;
  private count = 1;
  private turns = 1;
  private speed = 0;
  private last: number | null = null;
  /** Instant of the run that is played, s; null where the cycle is. */
  time: number | null = null;
  private span = 0;
  private ofCycle = this.rate;

  /** Take the machine's samples and speed; the crank stays where it is. */
  take(state: Pick<State, "angles" | "turns" | "speed">): void {
    [this.count, this.turns, this.speed] = [state.angles, state.turns, state.speed];
  }

  /** The fastest rate at which a turn can still be followed. */
  suit(): void {
    const turn = (2 * Math.PI) / Math.max(Math.abs(this.speed), 1e-6);
    this.rate = RATES.find((rate) => turn / rate >= SLOW) ?? 0.01;
  }

  /** Play a run of so many seconds from its start. */
  run(span: number): void {
    if (this.time === null) this.ofCycle = this.rate;
    [this.time, this.span] = [0, span];
    this.rate = RATES.find((rate) => span / rate >= LONG) ?? 0.01;
  }

  /** Play the cycle again. */
  leave(): void {
    if (this.time === null) return;
    this.time = null;
    this.rate = this.ofCycle;
  }

  /** Play or stop; a run that has come to its end begins anew. */
  toggle(): void {
    this.playing = !this.playing;
    if (this.playing && this.time !== null && this.time >= this.span) this.time = 0;
  }

  /** How many places the slider has. */
  get steps(): number {
    return this.time === null ? this.count : STEPS_OF_RUN + 1;
  }

  get step(): number {
    return this.time === null ? this.sample : Math.round((this.time / (this.span || 1)) * STEPS_OF_RUN);
  }

  set step(k: number) {
    if (this.time === null) this.sample = k;
    else this.time = (Math.min(Math.max(k, 0), STEPS_OF_RUN) / STEPS_OF_RUN) * this.span;
  }

  get sample(): number {
    return Math.round(this.part * this.count) % this.count;
  }

  set sample(k: number) {
    this.part = (((k % this.count) + this.count) % this.count) / this.count;
  }

  /** Crank angle of the sample, degrees from the first. */
  get angle(): number {
    return (this.sample / this.count) * 360 * this.turns;
  }

  set angle(degrees: number) {
    this.sample = Math.round((degrees / (360 * this.turns)) * this.count);
  }

  /** How long the cycle, or the run, takes as it is played, s. */
  get duration(): number {
    return this.time === null ? this.turns / Math.abs(this.turning) : this.span / this.rate;
  }

  /** How much of the cycle, or of the run, is over, as a share of it. */
  get share(): number {
    return this.time === null ? this.part : this.time / (this.span || 1);
  }

  set share(share: number) {
    if (this.time === null) this.part = share;
    else this.time = share * this.span;
  }

  /** Turns in a second as it is played; a machine that stands still can be turned by hand, and so it is here. */
  private get turning(): number {
    return this.speed ? (this.rate * this.speed) / (2 * Math.PI) : 1 / SLOW;
  }

  /** Let time pass; returns whether another sample is to be shown. */
  tick(now: number): boolean {
    const before = this.sample;
    const passed = this.last === null ? 0 : Math.min((now - this.last) / 1000, 0.1);
    this.last = this.playing ? now : null;
    if (!this.playing) return false;
    if (this.time !== null) {
      this.time = Math.min(this.time + passed * this.rate, this.span);
      this.playing = this.time < this.span;
      return true;
    }
    const part = this.part + (passed * this.turning) / this.turns;
    this.part = part - Math.floor(part);
    return this.sample !== before;
  }
}

const PLAY = "M4.5 2.5v11l8.5-5.5z";
const PAUSE = "M4 2.5h2.5v11H4zM9.5 2.5H12v11H9.5z";

export class TransportBar {
  readonly root: HTMLElement;
  private readonly play: HTMLButtonElement;
  private readonly slider: HTMLInputElement;
  private readonly reading = h("output", { class: "angle" });
  private readonly rates: HTMLSelectElement;
  private written = false;

  constructor(
    private readonly player: Player,
    toggle: () => void,
    turned: () => void,
  ) {
    this.play = h("button", { type: "button", class: "play", onclick: toggle }, icon(PLAY));
    this.slider = h("input", {
      type: "range",
      min: 0,
      max: 359,
      step: 1,
      "aria-label": say("Crank angle"),
    });
    this.slider.addEventListener("input", () => {
      player.step = Number(this.slider.value);
      turned();
    });
    this.rates = h(
      "select",
      {
        "aria-label": say("Speed of playing"),
        title: say("Speed of playing, of the true speed"),
      },
      ...RATES.map((rate) =>
        h(
          "option",
          { value: rate },
          rate === 1 ? say("true speed") : say("1/{part} speed", { part: Math.round(1 / rate) }),
        ),
      ),
    );
    this.rates.addEventListener("change", () => (player.rate = Number(this.rates.value)));
    this.root = h(
      "div",
      { class: "transport", role: "group", "aria-label": say("Motion") },
      this.play,
      this.slider,
      this.reading,
      this.rates,
    );
    this.state();
  }

  /** The samples or the rate are others. */
  take(): void {
    const { time, steps } = this.player;
    set(this.slider, { max: steps - 1, "aria-label": time === null ? say("Crank angle") : say("Time of the run") });
    put(this.rates, String(this.player.rate));
  }

  /** Playing or not. */
  state(): void {
    const { playing } = this.player;
    if (this.written === playing && this.play.hasAttribute("aria-label")) return;
    this.written = playing;
    set(this.play, {
      "aria-label": playing ? say("Pause") : say("Play"),
      title: playing ? say("Pause (Space)") : say("Play (Space)"),
    });
    this.play.replaceChildren(icon(playing ? PAUSE : PLAY));
  }

  point(): void {
    const { angle, step, time } = this.player;
    const seconds = time === null ? "" : time.toFixed(3);
    write(this.reading, seconds ? unbroken(`${decimals(seconds)} s`) : `${signed(angle.toFixed(1))}°`);
    put(this.slider, String(step));
    this.slider.style.setProperty("--part", (step / Math.max(Number(this.slider.max), 1)).toFixed(3));
    const spoken = seconds
      ? say("{time} s after the start", { time: seconds })
      : say("{angle} degrees", { angle: angle.toFixed(1) });
    set(this.slider, { "aria-valuetext": spoken });
  }
}
