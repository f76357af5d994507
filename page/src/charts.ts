/** All charts beside the linkage. */

import { chooser, finder } from "./chooser";
import { h } from "./dom";
import { lengths } from "./format";
import { Plane, type Trace } from "./plane";
import type { Numbers, Output, ResponseMessage, State, Unit } from "./protocol";
import { capital } from "./readings";
import { Abscissa, both, closed, rounding } from "./signals";
import { Strip } from "./strip";
import type { Role, Theme } from "./theme";
import type { Content } from "./uplot_options";

const HIGHEST = 10;
/** Whose spectra there are; only the first is told of all rows together too. */
const SPECTRA = ["shaking_force", "shaking_moment", "drive_torque"];
/** What stands before the names of all rows together. */
const ROWS = "rows.";

export class Charts {
  readonly root: HTMLElement;
  private readonly x = new Abscissa();
  private readonly squares = h("div", { class: "squares" });
  private readonly whose = chooser("Forces of", () => {
    if (this.state) this.offerSpectra(this.state);
    this.chosen();
  });
  private readonly whoseRow = h("div", { class: "whose" }, this.whose.label);
  private readonly pathOf = chooser("Path of", () => this.chosen());
  private readonly jointOf = chooser("Force in joint", () => this.chosen());
  private readonly spectrumOf = chooser("Spectrum of", () => this.chosen());
  private readonly gaugeOf = chooser("Response of", () => this.answer());
  private readonly outputOf = finder("Any output over crank angle", (name) => this.ask(name));
  private readonly polar = new Plane("Shaking force, polar", true, h("b", {}, "Polar force"));
  private readonly path = new Plane("Path", false, this.pathOf.label);
  private readonly force: Strip;
  private readonly moment: Strip;
  private readonly torque: Strip;
  private readonly joint: Strip;
  private readonly spectrum: Strip;
  private readonly output: Strip;
  private readonly response: Strip;
  private readonly sweep: Strip;
  private readonly strips: Strip[];
  private state: State | null = null;
  private heard: [ResponseMessage, Numbers] | null = null;
  private at = 0;
  private readonly watcher = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const strip = this.strips.find(({ root }) => root === target);
      if (strip) strip.visible = isIntersecting;
    }
  });

  constructor(
    theme: Theme,
    picked: (degrees: number) => void,
    private readonly wanted: (names: string[]) => void,
  ) {
    const over = { xLabel: "°", xStep: (span: number) => (span > 400 ? 180 : 90), picked };
    const strip = (height: number, xAxis: boolean, control?: HTMLElement) =>
      new Strip({ height, xAxis, ...over, ...(control && { control }) }, theme);
    this.force = strip(88, false);
    this.moment = strip(72, false);
    this.torque = strip(92, true);
    this.joint = strip(100, true, this.jointOf.label);
    const bars = { height: 104, xAxis: true, bars: true };
    this.spectrum = new Strip({ ...bars, control: this.spectrumOf.label }, theme);
    this.output = strip(110, true, this.outputOf.label);
    this.response = strip(110, true, this.gaugeOf.label);
    this.sweep = new Strip({ height: 110, xAxis: true, quiet: true }, theme);
    this.strips = [
      this.force,
      this.moment,
      this.torque,
      this.spectrum,
      this.joint,
      this.output,
      this.response,
      this.sweep,
    ];
    this.squares.append(this.polar.root, this.path.root);
    this.root = h(
      "div",
      { class: "charts" },
      this.whoseRow,
      this.squares,
      ...this.strips.map((s) => s.root),
    );
    this.response.root.hidden = this.sweep.root.hidden = true;
    for (const { root } of this.strips) this.watcher.observe(root);
  }

  close(): void {
    this.watcher.disconnect();
  }

  /** Draw what is out of sight too, and tell in words what there is to see. */
  settle(): void {
    for (const strip of this.strips) {
      strip.settle();
      strip.describe();
    }
  }

  resize(width: number): void {
    if (width < 40) return;
    for (const strip of this.strips) strip.resize(width);
    const side = Math.floor((width - 12) / 2);
    const forces = !this.polar.root.hidden;
    const height = Math.max(Math.min(side, 216), 150);
    this.polar.resize(side, height);
    this.path.resize(forces ? side : width, height);
  }

  show(state: State, other: boolean): void {
    this.state = state;
    if (other) this.heard = null;
    if (!state.numbers.has("shaking_force") !== this.polar.root.hidden || other)
      this.arrange(state);
    // Rows that stand still have no forces together.
    this.whoseRow.hidden = !state.numbers.has("rows.shaking_force");
    if (other) this.offer(state);
    this.outputOf.offer(state.outputs);
    this.again();
  }

  /** A state's response came; it is kept while the next is computed. */
  answered(message: ResponseMessage, numbers: Numbers): void {
    const first = !this.heard;
    this.heard = [message, numbers];
    if (first)
      this.gaugeOf.offer(
        message.gauges.map((g) => [g.name, `Response of ${g.label.replace(/_/g, " ")}`]),
      );
    this.answer();
  }

  /** The joint whose force is shown, where there is one of that name. */
  choose(joint: string): void {
    if (!this.jointOf.has(joint) && !this.pathOf.has(joint)) return;
    if (this.jointOf.has(joint)) this.jointOf.value = joint;
    this.again();
  }

  point(k: number, degrees: number): void {
    this.at = k;
    this.polar.point(k);
    this.path.point(k);
    for (const strip of [this.force, this.moment, this.torque, this.joint, this.output])
      strip.point(degrees, k);
    const samples = this.heard?.[1].get("response.angle")?.length;
    if (samples && this.state)
      this.response.point(degrees, Math.round((k / this.state.angles) * samples) % samples);
  }

  repaint(): void {
    for (const strip of this.strips) strip.repaint();
  }

  private arrange(state: State): void {
    const forces = state.numbers.has("shaking_force");
    for (const part of [
      this.polar,
      this.force,
      this.moment,
      this.torque,
      this.joint,
      this.spectrum,
    ]) {
      part.root.hidden = !forces;
    }
    this.response.root.hidden = this.sweep.root.hidden = true;
    this.squares.classList.toggle("alone", !forces);
  }

  private offer(state: State): void {
    const names = state.numbers.names("place.").map((name) => name.slice(6));
    const moving = names.filter((name) => !state.scene.frame.includes(name));
    const first = state.scene.traced ?? [];
    const points = [...first, ...moving.filter((name) => !first.includes(name))];
    const ground = state.planting
      ? [[`ground.${state.planting.tip}`, `${state.planting.tip} over ground`]]
      : [];
    this.pathOf.offer([
      ...(ground as [string, string][]),
      ...points.map((p): [string, string] => [p, `Path of ${p}`]),
    ]);
    const joints = state.numbers.names("joint.").map((name) => name.slice(6));
    this.jointOf.offer(joints.map((name) => [name, capital(known(state, `joints.${name}`).label)]));
    this.whose.offer([
      [ROWS, "Forces of all rows together"],
      ["", "Forces of one row"],
    ]);
    if (this.whoseRow.hidden) this.whose.value = "";
    this.offerSpectra(state);
  }

  private offerSpectra(state: State): void {
    const there = SPECTRA.filter((name) => state.numbers.has(name));
    const chosen = this.spectrumOf.value;
    this.spectrumOf.offer(
      there.map((name) => {
        const { label } = known(state, name === SPECTRA[0] ? `${this.rows}${name}` : name);
        return [name, `${capital(label)}, by order`];
      }),
    );
    if (there.includes(chosen)) this.spectrumOf.value = chosen;
  }

  /** What stands before the names of the forces that are shown. */
  private get rows(): string {
    return this.whoseRow.hidden ? "" : this.whose.value;
  }

  private chosen(): void {
    this.again();
    this.settle();
  }

  private again(): void {
    const { state } = this;
    if (!state) return;
    this.drawPath(state);
    if (state.numbers.has("shaking_force")) this.drawForces(state);
    this.drawOutput(state);
    this.point(this.at, (this.at / state.angles) * 360 * state.turns);
  }

  private drawForces(state: State): void {
    const x = this.x.of(state.angles, state.turns);
    const { rows } = this;
    const force = `${rows}shaking_force`;
    const traces: Trace[] = [];
    const least = rounding(state);
    const was = state.before ? state.numbers.get(`before.${force}`) : undefined;
    if (was) traces.push({ points: was, kind: "before", closed: true });
    const now = state.numbers.get(force);
    if (now) traces.push({ points: now, kind: "now", closed: true });
    const every = state.angles / (12 * state.turns);
    const { label, ...unit } = known(state, force);
    this.polar.show({ title: capital(label), ...unit, traces, every, least });
    const strip = (name: string, array = name): Content => {
      const { label, ...unit } = known(state, name);
      const found = both(state, array);
      const curves = found ? [{ label: "", role: "main" as Role, ...scaled(found, unit) }] : [];
      return { title: capital(label), x, unit: unit.unit, curves, least };
    };
    const parts = (["main", "stress"] as const).flatMap((role, part) => {
      const found = both(state, force, 2, part);
      return found ? [{ label: "xy".charAt(part), role, ...scaled(found, unit) }] : [];
    });
    this.force.show({ ...strip(force), curves: parts });
    this.moment.show(strip(`${rows}shaking_moment`));
    this.torque.show(strip(`${rows}drive_torque`));
    this.joint.show(strip(`joints.${this.jointOf.value}`, `joint.${this.jointOf.value}`));
    this.drawSpectrum(state, rows, least);
  }

  private drawSpectrum(state: State, rows: string, least: number): void {
    const chosen = this.spectrumOf.value;
    const { label, ...unit } = known(state, chosen);
    const most = state.turns > 1 ? HIGHEST / 2 : HIGHEST;
    const kept = state.orders
      .map((order, i) => [order, i] as const)
      .filter(([o]) => o > 0 && o <= most);
    const column = (name: string) => {
      const row = state.numbers.get(name);
      return row && Float64Array.from(kept, ([, i]) => (row[i] ?? 0) * unit.factor);
    };
    const bars = (name: string, label: string, role: Role) => {
      const values = column(`spectrum.${name}`);
      const before = state.before ? column(`before.spectrum.${name}`) : undefined;
      return values ? [{ label, role, values, before }] : [];
    };
    const prefix = chosen === "shaking_force" ? rows : "";
    const curves =
      chosen === "shaking_force"
        ? [
            ...bars(`${prefix}shaking_force.x`, "x", "main"),
            ...bars(`${prefix}shaking_force.y`, "y", "stress"),
          ]
        : bars(chosen, "", "main");
    const x = Float64Array.from(kept, ([order]) => order);
    this.spectrum.show({ title: `${capital(label)}, by order`, x, unit: unit.unit, curves, least });
  }

  private drawPath(state: State): void {
    const name = this.pathOf.value;
    // Without speed nothing goes over the ground: then the path is that on the machine.
    const over = name.startsWith("ground.") && state.numbers.has(name);
    const points = state.numbers.get(over ? name : `place.${name.replace("ground.", "")}`);
    if (!points) return;
    const every = state.angles / (24 * state.turns);
    const level = over ? state.planting?.surface : undefined;
    const traces: Trace[] = [{ points, kind: "now", closed: !over }];
    this.path.show({ title: "Path", ...lengths(), traces, every, level, least: 1e-6 });
  }

  /** Ask for the numbers of an output; they come with the state, now and after every change. */
  private ask(name: string): void {
    const known = this.state?.outputs.some((one) => one.name === name);
    this.wanted(known ? [name] : []);
  }

  private drawOutput(state: State): void {
    const one = state.outputs.find(({ name }) => state.numbers.has(`output.${name}`));
    const found = one && both(state, `output.${one.name}`);
    const curves = found ? [{ label: "", role: "third" as Role, ...scaled(found, one) }] : [];
    this.output.root.classList.toggle("empty", !found);
    const [title, unit] = [capital(one?.label ?? "output"), one?.unit ?? ""];
    this.output.show({ title, x: this.x.of(state.angles, state.turns), unit, curves });
  }

  private answer(): void {
    if (!this.heard || !this.state) return;
    const [message, numbers] = this.heard;
    const angle = numbers.get("response.angle");
    const gauge = message.gauges.find((g) => g.name === this.gaugeOf.value) ?? message.gauges[0];
    const values = gauge && numbers.get(`response.${gauge.name}`);
    this.response.root.hidden = this.sweep.root.hidden = !values || !angle;
    if (!gauge || !values || !angle) return;
    const x = this.x.of(angle.length, this.state.turns);
    const curve = { label: "", role: "third" as Role, values: times(closed(values), gauge) };
    this.response.show({ title: `Response of ${gauge.label}`, x, unit: gauge.unit, curves: [curve] });
    this.drawSweep(message, numbers);
  }

  private drawSweep(message: ResponseMessage, numbers: Numbers): void {
    const found =
      message.sweep?.of.find((g) => g.name === this.gaugeOf.value) ?? message.sweep?.of[0];
    const { sweep } = message;
    const speeds = sweep && numbers.get(sweep.speeds);
    const values = found && numbers.get(found.array);
    this.sweep.root.hidden = !values || !speeds;
    if (!sweep || !found || !values || !speeds) return;
    const x = times(Float64Array.from(speeds), sweep);
    const curves = [{ label: "", role: "third" as Role, values: times(Float64Array.from(values), found) }];
    const unit = `${found.unit} peak to peak, over ${sweep.unit}`;
    this.sweep.show({ title: "Response against speed", x, unit, curves });
    this.sweep.point(sweep.own * sweep.factor, null);
  }
}

type Pair = { values: Float64Array; before?: Float64Array | undefined };

/** What is known of an output: its label, its unit. */
function known(state: State, name: string): Output {
  const found = state.outputs.find((one) => one.name === name);
  return found ?? { name, label: "", group: "", unit: "", factor: 1 };
}

/** Values in SI units in those of something else. */
function times(values: Float64Array, { factor }: Unit): Float64Array {
  return values.map((value) => value * factor);
}

function scaled({ values, before }: Pair, unit: Unit): Pair {
  return { values: times(values, unit), before: before && times(before, unit) };
}
