/** Charts of outputs that were looked for: each over the crank angle, until it is closed. */

import { besides, scaled, times } from "./chart";
import { h, icon } from "./dom";
import { Finder } from "./finder";
import type { Output, State } from "./protocol";
import { capital } from "./readings";
import { turning, wide } from "./scale";
import { Abscissa, column, measured } from "./signals";
import { Strip } from "./strip";
import type { Role, Theme } from "./theme";
import { say } from "./words";

const THIRD: Role = "third";
const PREFIX = "output.";

interface Drawn {
  strip: Strip;
  button: HTMLButtonElement;
}

export class Outputs {
  readonly root = h("div", { class: "group" });
  private readonly x = new Abscissa();
  private readonly finder: Finder;
  private readonly drawn = new Map<string, Drawn>();
  private names: string[] = [];
  private width = 0;

  constructor(
    private readonly theme: Theme,
    private readonly picked: (degrees: number) => void,
    private readonly wanted: (names: string[]) => void,
    private readonly made: (strip: Strip, output: Output) => void,
  ) {
    this.finder = new Finder(
      say("Any output over crank angle"),
      say("No output has such a name"),
      (name) => this.add(name),
    );
    this.root.append(this.finder.root);
  }

  get strips(): Strip[] {
    return [...this.drawn.values()].map(({ strip }) => strip);
  }

  resize(width: number): void {
    this.width = width;
    for (const { strip } of this.drawn.values()) strip.resize(width);
  }

  point(degrees: number, k: number): void {
    for (const { strip } of this.drawn.values()) strip.point(degrees, k);
  }

  /** Draw the outputs whose numbers came with a state. */
  show(state: State): void {
    this.finder.call(say("Any output over crank angle")); // which goes by the machine that is open
    this.finder.offer(state.outputs);
    const there = state.numbers.names(PREFIX).map((name) => name.slice(PREFIX.length));
    const told = there.flatMap((name) => state.outputs.find((one) => one.name === name) ?? []);
    this.names = told.map(({ name }) => name);
    for (const [name, { strip }] of this.drawn) {
      if (this.names.includes(name)) continue;
      strip.close();
      this.drawn.delete(name);
    }
    for (const output of told) this.draw(state, output);
  }

  private draw(state: State, output: Output): void {
    const found = column(state, `${PREFIX}${output.name}`, 1, 0, true, output.winds);
    if (!found) return;
    const { strip, button } = this.drawn.get(output.name) ?? this.make(output);
    const title = capital(output.label);
    button.setAttribute("aria-label", say("Close chart of {output}", { output: output.label }));
    const model = { label: "", role: THIRD, ...scaled(found, output) };
    const seen = measured(state.numbers, output.name, 1, 0, found.values.length, output.winds);
    const curves = seen ? besides(model, times(seen, output)) : [model];
    const x = this.x.of(state.angles, state.turns);
    strip.show({ title, x, unit: output.unit, curves, log: wide(found.values) });
  }

  private make(output: Output): Drawn {
    const { name } = output;
    const button = h(
      "button",
      { type: "button", class: "close", onclick: () => this.remove(name) },
      icon("M4 4l8 8M12 4l-8 8"),
    );
    const strip = new Strip(
      { height: 110, xAxis: true, xLabel: "°", xStep: turning, picked: this.picked, button },
      this.theme,
    );
    const one = { strip, button };
    this.drawn.set(name, one);
    this.root.append(strip.root);
    strip.resize(this.width);
    this.made(strip, output);
    return one;
  }

  /** Ask for the numbers of an output; they come with the state, now and after every change. */
  private add(name: string): void {
    this.wanted([...this.names.filter((one) => one !== name), name]);
  }

  private remove(name: string): void {
    const next = this.finder.root.querySelector("input");
    this.wanted(this.names.filter((one) => one !== name));
    next?.focus({ preventScroll: true });
  }
}
