"""What vibration on the support shows: at one speed, over speeds, free, and in time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from equipoise.i18n import say, to_say
from equipoise.quantities import PER_RPM, Dimension, number
from equipoise.results.analysis_blocks import loud
from equipoise.results.blocks import (
    Block,
    Cell,
    Column,
    Facts,
    Notes,
    Table,
    Text,
    Value,
)
from equipoise.results.machine_blocks import driven

if TYPE_CHECKING:
    from equipoise.signals import Periodic
    from equipoise.vibration.mode_shapes import Mode
    from equipoise.vibration.response import GaugeSignals, Response
    from equipoise.vibration.transient import Transient

Array = np.ndarray[Any, Any]

MODELS = {
    "linear": to_say("the shaking force at the drive's pivot; equation (59) of Yamashita et al."),
    "torque": to_say(
        "the shaking force at the drive's pivot, and the drive torque; equation (57) of "
        "Yamashita et al."
    ),
    "moment": to_say("the whole force and moment of the joints on the frame"),
    "coupled": to_say(
        "as torque, with the torque that the motion of the support takes; equation (54) of "
        "Yamashita et al."
    ),
    "exact": to_say("all bodies, large motion; equations (37) to (45) of Yamashita et al."),
}
"""What each model of the support stands for."""
NOTHING = 1e-2
"""m, rad and their rates: scale beside which what is smaller than atoms is rounding."""
PARTS = 5
"""Equal stretches of a time, of which the first and the last show whether it has settled."""


class Units(NamedTuple):
    """Dimensions of a gauge's displacement, velocity and acceleration, and their usual units."""

    dimensions: tuple[Dimension, Dimension, Dimension]
    names: tuple[str | None, str | None, str | None]

    def columns(self, *labels: str) -> tuple[Column, ...]:
        """Two columns for each of the three."""
        kinds = (kind for kind in zip(self.dimensions, self.names, strict=True) for _ in range(2))
        pairs = zip(labels, kinds, strict=True)
        return tuple(Column(label, kind, unit) for label, (kind, unit) in pairs)


MOVED = Units(("length", "speed", "acceleration"), ("mm", "mm/s", "m/s^2"))
TURNED = Units(("angle", "angular speed", "angular acceleration"), ("mrad", None, None))


def model_told(model: str) -> str:
    """Which model answers, and what it stands for."""
    return say("Vibration by the model {model}: {what}", model=model, what=say(MODELS[model]))


# -- at one speed ----------------------------------------------------------------------------------


def response_blocks(
    response: Response, others: Mapping[str, Response | None] | None = None
) -> Iterator[Block]:
    """Gauges, orders, mounts and drive; and the gauges by the other models."""
    yield Text(_driven(response))
    yield Text(model_told(response.model))
    if response.modes:
        yield modes_table(response.modes)
    yield from gauge_tables(response)
    if response.gauges:
        yield _orders(response)
    if others:
        yield _by_model(response, others)
    if response.mounts:
        yield mounts_table(response)
    yield from _drive(response)
    if response.joints:
        yield _joints(response)
    if lines := tuple(_solution(response)):
        yield Facts(say("Periodic solution"), lines)
    if response.notes:
        yield Notes(response.notes)


def _driven(response: Response) -> str:
    rows = len(response.machine.rows)
    parts = [driven(response.machine, response.speed)]
    if rows > 1:
        parts.append(say("{rows} rows", rows=rows))
    if response.drive.speed is not None:
        parts.append(say("speed by the motor"))
    return say(", ").join(parts)


def modes_table(modes: Iterable[Mode]) -> Table:
    """Natural frequencies and damping, one mode a row."""
    rows: list[tuple[Cell, ...]] = []
    for count, mode in enumerate(modes, 1):
        rate = mode.natural_frequency
        damping = Value(mode.damping_ratio, 1e-6) if rate else None
        sizes = (Value(rate), Value(rate / 2 / pi), Value(rate / PER_RPM))
        rows.append((str(count), *sizes, damping, _kind(mode)))
    columns = (
        Column(say("mode")),
        Column("rad/s"),
        Column("Hz"),
        Column("1/min"),
        Column(say("damping ratio")),
        Column(""),
    )
    return Table(say("Natural frequencies"), columns, tuple(rows))


def _kind(mode: Mode) -> str:
    if mode.natural_frequency == 0:
        return say("free, without a spring")
    if mode.eigenvalue.real > 1e-9 * mode.natural_frequency:
        return say("unstable: grows") if mode.swings else say("unstable: falls over")
    return "" if mode.swings else say("overdamped")


def gauge_tables(response: Response) -> Iterator[Table]:
    """What gauges read: first those that move along a line, then those that turn."""
    labels = (say("peak to peak"), say("RMS"))
    rates = (say("velocity, peak to peak"), say("RMS"))
    further = (say("acceleration, peak to peak"), say("RMS"))
    for title, units, rotation in (
        (say("Gauges; RMS about the mean"), MOVED, False),
        (say("Gauges of rotation; RMS about the mean"), TURNED, True),
    ):
        rows: tuple[tuple[Cell, ...], ...] = tuple(
            (name, *(cell for signal in _signals(gauge) for cell in _ranges(signal)))
            for name, gauge in response.gauges.items()
            if gauge.rotation is rotation
        )
        if rows:
            columns = (Column(""), *units.columns(*labels, *rates, *further))
            yield Table(title, columns, rows)


def _signals(gauge: GaugeSignals) -> tuple[Periodic, Periodic, Periodic]:
    return gauge.displacement, gauge.velocity, gauge.acceleration


def _ranges(signal: Periodic) -> tuple[Value, Value]:
    sizes = (float(signal.peak_to_peak), float(signal.vibration_rms))
    return Value(sizes[0], NOTHING), Value(sizes[1], NOTHING)


def _orders(response: Response) -> Table:
    """Amplitude of the first orders that there are, at each gauge."""
    gauges = response.gauges
    count = max(len(gauge.displacement.orders) for gauge in gauges.values())
    padded = {
        name: np.pad(gauge.displacement.sizes, (0, count - len(gauge.displacement.sizes)))
        for name, gauge in gauges.items()
    }
    places = loud(list(padded.values()))
    rows: list[tuple[Cell, ...]] = []
    for name, sizes in padded.items():
        scale = max(1e3 * float(np.max(sizes[1:], initial=0.0)), NOTHING)
        cells = (reading(float(sizes[k]), gauges[name].rotation, scale) for k in places)
        rows.append((name, *cells))
    labels = (f"{k / response.turns:.4g}" for k in places)
    columns = (Column(say("order")), *map(Column, labels))
    return Table(say("Gauges by order; amplitude"), columns, tuple(rows))


def reading(value: float, rotation: bool, scale: float = NOTHING) -> Value:
    """What a gauge reads, m or rad, as a cell of its own kind."""
    kind = (TURNED if rotation else MOVED).dimensions[0]
    return Value(value, scale, dimension=kind, unit=(TURNED if rotation else MOVED).names[0])


def _by_model(response: Response, others: Mapping[str, Response | None]) -> Table:
    """Peak to peak at each gauge, by every model that costs little."""
    rows: list[tuple[Cell, ...]] = []
    for name, gauge in response.gauges.items():
        cells = (
            say("none")
            if other is None
            else reading(float(other.gauges[name].displacement.peak_to_peak), gauge.rotation)
            for other in others.values()
        )
        rows.append((name, *cells))
    columns = (Column(""), *map(Column, others))
    return Table(say("Gauges by each model; peak to peak"), columns, tuple(rows))


def mounts_table(response: Response) -> Table:
    """Forces of the mounts, and what they hand on."""
    rows: list[tuple[Cell, ...]] = []
    lifting = any(mount.lifts_off for mount in response.mounts.values())
    for name, mount in response.mounts.items():
        kind: Dimension = "torque" if mount.torsional else "force"
        force = mount.force
        values = (float(force.mean), mount.largest, mount.smallest, float(force.vibration_rms))
        scale = 100 * max(map(abs, values))
        cells = (Value(value, scale, dimension=kind) for value in values)
        ratio = None if np.isnan(mount.whole) else Value(mount.whole, 1.0)
        off = Value(100 * mount.lifts_off, after=0) if mount.least == 0 else None
        rows.append((name, *cells, ratio, *([off] if lifting else [])))
    labels = (say("mean"), say("largest"), say("smallest"), say("RMS"), say("transmissibility"))
    columns = (Column(""), *map(Column, labels))
    columns += (Column(say("in the air"), unit="%"),) if lifting else ()
    title = say(
        "Mounts: force on the support, RMS about the mean; what they hand on of the shaking force"
    )
    return Table(title, columns, tuple(rows))


def _drive(response: Response) -> Iterator[Block]:
    rows = [_extremes(say("drive torque"), response.drive.torque, "torque")]
    speed = response.drive.speed
    if speed is not None:
        rows.append(_extremes(say("crank speed"), speed, "angular speed", "rpm"))
    labels = ("", say("mean"), say("largest"), say("smallest"), say("peak to peak"))
    yield Table(say("Drive, all rows together"), tuple(map(Column, labels)), tuple(rows))
    if speed is None:
        return
    yield Text(
        say(
            "The speed fluctuates by {share} % of its mean.",
            share=f"{100 * response.drive.fluctuation:.3g}",
        )
    )
    shift = response.drive.shift
    if abs(shift) > 1e-9 * abs(response.speed):
        yield Text(
            say(
                "The motor's curve is shifted by {shift} rpm to hold the mean.",
                shift=number(shift / PER_RPM),
            )
        )


def _extremes(
    name: str, signal: Periodic, kind: Dimension, unit: str | None = None
) -> tuple[Cell, ...]:
    high, low = float(signal.extreme(1)[0]), float(signal.extreme(-1)[0])
    scale = max(abs(high), abs(low))
    values = (float(signal.mean), high, low, high - low)
    return (name, *(Value(value, scale, dimension=kind, unit=unit) for value in values))


def _joints(response: Response) -> Table:
    columns = (
        Column(""),
        Column(say("here"), "force"),
        Column(say("on solid ground, constant speed"), "force"),
    )
    rows = tuple(
        (name, Value(joint.peak), Value(joint.on_ground)) for name, joint in response.joints.items()
    )
    return Table(say("Largest force in each joint of the first row"), columns, rows)


def _solution(response: Response) -> Iterator[str]:
    """How far the periodic solution can be trusted."""
    if response.residual is not None:
        yield say("residual {residual}", residual=f"{response.residual:.1e}")
    if response.energy is not None and response.mounts:
        yield say(
            "energy in a period: {fed} J fed in, {lost} J lost in mounts",
            fed=f"{response.energy.fed_in:.6g}",
            lost=f"{response.energy.lost:.6g}",
        )
    if response.multipliers is not None and response.multipliers.size:
        yield say(
            "{verdict}: the largest multiplier of a disturbance over a period is {size}",
            verdict=say("stable") if response.stable else say("not stable"),
            size=f"{abs(response.multipliers[0]):.4f}",
        )


def transient_blocks(found: Transient) -> Iterator[Block]:
    """Extremes of every gauge and mount, in the first and the last stretch of the time."""
    yield Text(
        say(
            "From rest for {time} s, {turns} turns of the crank",
            time=number(float(found.time[-1])),
            turns=number(abs(float(found.crank_angle[-1])) / (2 * pi)),
        )
    )
    rows = []
    for name, values in found.gauges.items():
        units = MOVED if found.unit(name) == "m" else TURNED
        rows.append(_stretch(name, values, units.dimensions[0], units.names[0]))
    for name, values in found.mounts.items():
        rows.append(_stretch(name, values, "force" if found.along(name) else "torque"))
    rows.append(_stretch(say("crank speed"), found.crank_speed, "angular speed", "rpm"))
    labels = (
        "",
        say("smallest"),
        say("largest"),
        say("range in the first fifth"),
        say("range in the last fifth"),
    )
    yield Table(say("Gauges, mounts and drive"), tuple(map(Column, labels)), tuple(rows))


def _stretch(
    name: str, values: Array, kind: Dimension, unit: str | None = None
) -> tuple[Cell, ...]:
    stretch = max(1, len(values) // PARTS)
    low, high = float(np.min(values)), float(np.max(values))
    ranges = (float(np.ptp(values[:stretch])), float(np.ptp(values[-stretch:])))
    scale = max(abs(low), abs(high))
    cells = (low, high, *ranges)
    return (name, *(Value(value, scale, dimension=kind, unit=unit) for value in cells))


SHOWS = {
    "Response": response_blocks,
    "Transient": transient_blocks,
}
