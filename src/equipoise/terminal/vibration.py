"""What `equipoise respond` prints of one speed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.terminal.tables import PER_RPM, Row, number, table
from equipoise.terminal.units import Units
from equipoise.vibration.response import EQUATIONS

if TYPE_CHECKING:
    from equipoise.signals import Periodic
    from equipoise.vibration.mode_shapes import Mode
    from equipoise.vibration.response import GaugeSignals, Response

NOTHING = 1e-12
"""m, rad and their rates."""
MOST_ORDERS = 8
"""Columns of the table of orders."""


def print_response(response: Response, others: Mapping[str, Response | None], units: Units) -> None:
    """Tables of gauges, orders, mounts and drive; and the gauges by the other models."""
    machine = response.machine
    print(machine.title)
    print(_driven(response, units))
    print(f"model {response.model}, {EQUATIONS[response.model]}")
    if response.modes:
        print(modes_table(response.modes))
    if response.gauges:
        print(_gauges(response, units))
        print(_orders(response, units))
    if others:
        print(_by_model(response, others, units))
    if response.mounts:
        print(_mounts(response, units))
    print(_drive(response, units))
    if response.joints:
        print(_joints(response, units))
    for line in _solution(response):
        print(line)
    for note in response.notes:
        print(f"note: {note}")


def _driven(response: Response, units: Units) -> str:
    link = response.machine.drive.link
    text = f"{link} driven at {speed_shown(response.speed, units)}"
    rows = len(response.machine.rows)
    text += f", {rows} rows" if rows > 1 else ""
    return text + (", speed by the motor" if response.drive.speed is not None else "")


def speed_shown(speed: float, units: Units) -> str:
    """A speed of the crank in the unit that is printed, and in rad/s."""
    shown = f"{units.shown(speed, 'angular speed')} {units.name('angular speed')}"
    return shown if units.name("angular speed") == "rad/s" else f"{shown} ({number(speed)} rad/s)"


def modes_table(modes: Iterable[Mode]) -> str:
    """Natural frequencies and damping, one mode a row."""
    rows = []
    for count, mode in enumerate(modes, 1):
        frequency = mode.natural_frequency
        told = (number(frequency), number(frequency / 2 / pi), number(frequency / PER_RPM))
        damping = "" if frequency == 0 else number(mode.damping_ratio, 1e-6)
        rows.append((str(count), *told, damping, _kind(mode)))
    header = ("mode", "rad/s", "Hz", "1/min", "damping ratio", "")
    return table("Natural frequencies", header, rows)


def _kind(mode: Mode) -> str:
    if mode.natural_frequency == 0:
        return "free, without a spring"
    if mode.eigenvalue.real > 1e-9 * mode.natural_frequency:
        return "unstable: falls over" if not mode.swings else "unstable: grows"
    return "" if mode.swings else "overdamped"


def _gauges(response: Response, units: Units) -> str:
    rows = []
    for name, gauge in response.gauges.items():
        cells = [name]
        for signal, scale in zip(_signals(gauge), _scales(gauge, units), strict=True):
            cells += [_number(signal.peak_to_peak, scale), _number(signal.vibration_rms, scale)]
        rows.append((*cells, _unit(gauge, units)))
    header = ("", "range", "RMS", "velocity range", "RMS", "acceleration range", "RMS", "")
    return table("Gauges; range is peak to peak, RMS about the mean", header, rows)


def _signals(gauge: GaugeSignals) -> tuple[Periodic, Periodic, Periodic]:
    return gauge.displacement, gauge.velocity, gauge.acceleration


def _scales(gauge: GaugeSignals, units: Units) -> tuple[float, float, float]:
    """Printed units in one SI unit, of displacement, velocity and acceleration."""
    if gauge.rotation:
        return (units.value(1.0, "angle"), 1.0, 1.0)
    return (
        units.value(1.0, "length"),
        units.value(1.0, "speed"),
        units.value(1.0, "acceleration"),
    )


def _unit(gauge: GaugeSignals, units: Units) -> str:
    if gauge.rotation:
        return f"{units.name('angle')}, rad/s, rad/s^2"
    return f"{units.name('length')}, {units.name('speed')}, {units.name('acceleration')}"


def _number(value: object, scale: float = 1.0) -> str:
    """A value in SI units times a scale; what is smaller than atoms is rounding."""
    size = float(value)  # type: ignore[arg-type]
    return "0" if abs(size) < NOTHING else number(size * scale)


def _orders(response: Response, units: Units) -> str:
    """Amplitude of the first orders that there are, at each gauge."""
    gauges = response.gauges
    count = max(len(gauge.displacement.orders) for gauge in gauges.values())
    loud = np.zeros(count)
    for gauge in gauges.values():
        sizes = gauge.displacement.sizes
        largest = float(np.max(sizes[1:], initial=0.0))
        if largest:
            loud[: len(sizes)] = np.maximum(loud[: len(sizes)], sizes / largest)
    loud[0] = 0.0
    columns = np.flatnonzero(loud > 1e-6)[:MOST_ORDERS]
    rows = []
    for name, gauge in gauges.items():
        scale = _scales(gauge, units)[0]
        sizes = np.pad(gauge.displacement.sizes, (0, count))
        largest = float(np.max(sizes[1:], initial=0.0)) * scale
        unit = units.name("angle" if gauge.rotation else "length")
        told = (number(sizes[k] * scale, 1e3 * largest) for k in columns)
        quiet = largest < NOTHING * scale
        rows.append((name, *("0" if quiet else size for size in told), unit))
    header = ("order", *(_order(k / response.turns) for k in columns), "")
    return table("Gauges by order; amplitude", header, rows)


def _order(order: float) -> str:
    return f"{order:.4g}"


def _by_model(response: Response, others: Mapping[str, Response | None], units: Units) -> str:
    """Peak to peak at each gauge, by every model that costs little."""
    rows: list[Row] = []
    for name, gauge in response.gauges.items():
        scale = _scales(gauge, units)[0]
        told = (
            "none"
            if other is None
            else _number(other.gauges[name].displacement.peak_to_peak, scale)
            for other in others.values()
        )
        rows.append((name, *told, units.name("angle" if gauge.rotation else "length")))
    return table("Gauges by each model; peak to peak", ("", *others, ""), rows)


def _mounts(response: Response, units: Units) -> str:
    rows = []
    lifting = any(mount.lifts_off for mount in response.mounts.values())
    for name, mount in response.mounts.items():
        dimension = "torque" if mount.torsional else "force"
        force = mount.force
        values = (
            float(force.mean),
            mount.largest,
            mount.smallest,
            float(force.vibration_rms),
        )
        scale = 100 * max(map(abs, values))
        cells = [units.shown(value, dimension, scale) for value in values]  # type: ignore[arg-type]
        ratio = "" if np.isnan(mount.whole) else number(mount.whole, 1.0)
        in_the_air = f"{100 * mount.lifts_off:.0f} %" if mount.least == 0 else ""
        off = [in_the_air] if lifting else []
        rows.append((name, *cells, ratio, *off, units.name(dimension)))  # type: ignore[arg-type]
    header = ["", "mean", "largest", "smallest", "RMS", "transmissibility"]
    header += ["in the air"] if lifting else []
    title = (
        "Mounts; force on the support, RMS about the mean; what they hand on of the shaking force"
    )
    return table(title, (*header, ""), rows)


def _drive(response: Response, units: Units) -> str:
    torque = response.drive.torque
    rows = [_row("drive torque", torque, units.value(1.0, "torque"), units.name("torque"))]
    speed = response.drive.speed
    if speed is not None:
        unit = units.name("angular speed")
        rows.append(_row("crank speed", speed, units.value(1.0, "angular speed"), unit))
    text = table("Drive, all rows together", ("", "mean", "largest", "smallest", "range", ""), rows)
    if speed is None:
        return text
    line = f"\nspeed fluctuates by {100 * response.drive.fluctuation:.3g} % of its mean"
    if abs(response.drive.shift) > 1e-9 * abs(response.speed):
        shift = speed_shown(response.drive.shift, units)
        line += f"; the motor's curve is shifted by {shift} to hold the mean"
    return text + line


def _row(name: str, signal: Periodic, scale: float, unit: str) -> Row:
    high, low = float(signal.extreme(1)[0]), float(signal.extreme(-1)[0])
    largest = max(abs(high), abs(low)) * scale
    values = (float(signal.mean), high, low, high - low)
    return (name, *(number(value * scale, largest) for value in values), unit)


def _joints(response: Response, units: Units) -> str:
    rows = [
        (name, units.shown(joint.peak, "force"), units.shown(joint.on_ground, "force"))
        for name, joint in response.joints.items()
    ]
    title = f"Largest force in each joint of the first row, {units.name('force')}"
    return table(title, ("", "here", "on solid ground, constant speed"), rows)


def _solution(response: Response) -> Iterable[str]:
    """How far the periodic solution can be trusted."""
    if response.residual is not None:
        yield f"\nperiodic solution: residual {response.residual:.1e}"
    if response.energy is not None and response.mounts:
        energy = response.energy
        yield (
            f"energy in a period: {energy.fed_in:.6g} J fed in, {energy.lost:.6g} J lost in mounts"
        )
    if response.multipliers is not None and response.multipliers.size:
        largest = abs(response.multipliers[0])
        verdict = "stable" if response.stable else "not stable"
        yield f"{verdict}: the largest multiplier of a disturbance over a period is {largest:.4f}"
