/** Playing, pausing, turning the crank by hand. */

import { h, icon, put, set, write } from "./dom";
import { decimals } from "./decimals";
import { signed, unbroken } from "./format";
import { type Player, RATES } from "./player";
import { say } from "./words";

const PLAY = "M4.5 2.5v11l8.5-5.5z";
const PAUSE = "M4 2.5h2.5v11H4zM9.5 2.5H12v11H9.5z";

export class TransportBar {
  readonly root: HTMLElement;
  private readonly play: HTMLButtonElement;
  private readonly slider: HTMLInputElement;
  private readonly told = h("output", { class: "angle" });
  private readonly rates: HTMLSelectElement;
  private shown = false;

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
      this.told,
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
    if (this.shown === playing && this.play.hasAttribute("aria-label")) return;
    this.shown = playing;
    set(this.play, {
      "aria-label": playing ? say("Pause") : say("Play"),
      title: playing ? say("Pause (Space)") : say("Play (Space)"),
    });
    this.play.replaceChildren(icon(playing ? PAUSE : PLAY));
  }

  point(): void {
    const { angle, step, time } = this.player;
    const seconds = time === null ? "" : time.toFixed(3);
    write(this.told, seconds ? unbroken(`${decimals(seconds)} s`) : `${signed(angle.toFixed(1))}°`);
    put(this.slider, String(step));
    this.slider.style.setProperty(
      "--part",
      (step / Math.max(Number(this.slider.max), 1)).toFixed(3),
    );
    const spoken = seconds ? say("{time} s after the start", { time: seconds }) : say("{angle} degrees", { angle: angle.toFixed(1) });
    set(this.slider, { "aria-valuetext": spoken });
  }
}
