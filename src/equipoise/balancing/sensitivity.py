"""What each link's mass, centre of mass and inertia does to an output, at every crank angle.

(64) of Yamashita, Ichikawa and Mori, for any linkage and for moment and torque too: derivatives of
an output at constant crank speed, and the crank angles at which they vanish, so that the output
there stays as it is whatever the parameter.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np

from equipoise.balancing.linear_conditions import machine_size
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, number_list, say, to_say
from equipoise.mechanism.dynamics.parameters import ACROSS, QUANTITIES, regressor
from equipoise.mechanism.kinematics.jumps import resolved
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.kinematics.tip import roots
from equipoise.mechanism.outputs.declared import DECLARED, OutputSource
from equipoise.mechanism.parts.links import moments_across
from equipoise.mechanism.parts.machine import Link, Machine, unknown
from equipoise.quantities import Dimension, angle, display, fixed
from equipoise.results.blocks import Block, Cell, Column, Table, Text, Value
from equipoise.results.outputs import output_named
from equipoise.results.result import Result
from equipoise.signals import Array

CHANGES: dict[str, tuple[Dimension, str, str]] = {
    "mass": ("mass", "kg", to_say("mass")),
    "center_x": ("length", "mm", to_say("centre of mass, x")),
    "center_y": ("length", "mm", to_say("centre of mass, y")),
    "center_z": ("length", "mm", to_say("centre of mass, z")),
    "inertia": ("inertia", "kg mm^2", to_say("inertia")),
}
"""Mass at a fixed centre of mass, that centre at a fixed mass, inertia about it: what each is, the
unit in which it is usually shown, and what it is called.  z matters to rocking moments alone."""
ANGLES, PERCENT = 720, 0.01
"""Crank angles in a turn, as signs of signals change between them; change of a number of which the
effect is reported."""
NOTHING = 1e-10
"""Share of the largest effect below which there is none."""
SIGN_OFFSET, JUMP = 1e-8, 1e-4
"""rad, beside a change of sign; share of the largest effect below which a smooth one is there."""
LEAST_ANGLES = 8
"""Crank angles below which a mean over a turn is meaningless."""
AT_ONCE, FOR_EACH = 2**27, 700
"""Bytes that the regressor may take, and those that it takes at a crank angle for each pair of
links, as measured on machines of 3 to 8 links."""


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """Derivative of an output by one parameter of a link.

    values : (N,) at each crank angle, unit of the output over unit of the parameter.
    rms : of it, integrated between the crank angles at which it jumps.
    no_effect_at : crank angles (rad) within the cycle at which it passes zero; empty where there is
        no effect at all.
    percent : RMS of what a small change does: 1 % of the link's mass, 1 % of its moment of
        inertia, or its centre of mass moved by 1 % of the machine's size; unit of the output.
    """

    link: str
    change: str
    values: Array
    rms: float
    no_effect_at: Array
    percent: float

    @property
    def name(self) -> str:
        """Dotted name of the number, such as ``coupler.center_x``."""
        return f"{self.link}.{self.change}"

    @property
    def has_effect(self) -> bool:
        """Whether the output depends on the parameter at all."""
        return self.rms > 0


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivities(Result):
    """Sensitivities of one output, by link in file order and by change as in `CHANGES`.

    crank_angle : (N,) rad, over the whole cycle.  turns : of the crank in it.
    """

    machine: Machine
    output: str
    crank_angle: Array
    turns: int
    by_name: Mapping[str, Sensitivity]

    blocks_in = "balancing.sensitivity.sensitivities_blocks"

    @property
    def ranked(self) -> tuple[Sensitivity, ...]:
        """Numbers with an effect, the largest of a change of 1 % first."""
        values = [item for item in self.by_name.values() if item.has_effect]
        return tuple(sorted(values, key=lambda sensitivity: -sensitivity.percent))

    def __getitem__(self, name: str) -> Sensitivity:
        """One of them, by a name such as ``coupler.center_x``."""
        if name not in self.by_name:
            raise UsageError(unknown(name, self.by_name, "sensitivity"))
        return self.by_name[name]

    def to_dict(self, signals: bool = True) -> dict[str, Any]:
        """Everything as plain data, in SI units and rad; with its arrays or without."""
        rows = {
            name: {
                **({"values": sensitivity.values} if signals else {}),
                "rms": sensitivity.rms,
                "percent": sensitivity.percent,
                "has_effect": sensitivity.has_effect,
                "no_effect_at": sensitivity.no_effect_at,
            }
            for name, sensitivity in self.by_name.items()
        }
        angles = {"crank_angle": self.crank_angle} if signals else {}
        return {"output": self.output, **angles, "sensitivities": rows}


def known_outputs(machine: Machine) -> list[str]:
    """Names of a machine's outputs that are one number, and linear in the masses, on the whole."""
    return [
        item.name
        for item in DECLARED.values()
        if item.is_of_row
        and not (item.reason or item.is_family or item.is_vector)
        and item.members(machine)
    ]


def sensitivities(
    machine: Machine, output: str = "shaking_force.y", angles: int = ANGLES
) -> Sensitivities:
    """Derivatives of an output by mass, centre of mass and inertia of every link.

    Parameters
    ----------
    output : one of `known_outputs`; moments are about the drive pivot, the drive torque is with
        weight.  The crank's speed is constant, that of the machine.
    angles : crank angles in each turn of the cycle.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the linkage cannot turn fully.
    UsageError : there is no such output, or too few crank angles.
    """
    if output not in (known := known_outputs(machine)):
        raise UsageError(unknown(output, known, "output of this kind"))
    given: Any = angles
    if not isinstance(given, int | np.integer) or given < LEAST_ANGLES:
        raise UsageError(
            Note(
                "got {given!r} crank angles; give a number of at least {least_angles}",
                given=given,
                least_angles=LEAST_ANGLES,
            )
        )
    motion = move(machine, int(angles), acceleration=0.0)
    pieces, changes = resolved(motion), _changes(output)
    whole = _derivatives(pieces, output)
    values = whole if pieces.sampling is None else whole[:, pieces.sampling.grid]
    size, mass = machine_size(machine), machine.mass or 1.0
    effects = np.max(np.abs(values), axis=1)
    scales = {"mass": mass, "inertia": mass * size**2}
    effects = effects * np.tile(
        [scales.get(change, size) for change in changes], len(machine.links)
    )
    nothing = effects <= NOTHING * np.max(effects)  # which is only rounding
    values[nothing] = 0.0
    rms_of_each = np.where(nothing, 0.0, np.sqrt(pieces.mean(np.square(whole)))).tolist()
    by_name = {}
    each = zip(values, rms_of_each, _sign_changes(motion, output, values), strict=True)
    for (link, change), (own, rms, at) in zip(product(machine.links, changes), each, strict=True):
        body = machine.links[link]
        step = {"mass": body.mass or 0.0, "inertia": body.inertia or 0.0}.get(change, size)
        by_name[f"{link}.{change}"] = Sensitivity(link, change, own, rms, at, PERCENT * step * rms)
    return Sensitivities(machine, output, motion.crank_angle, motion.turns, by_name)


def _changes(output: str) -> list[str]:
    """Those of `CHANGES` that an output may depend on."""
    return [
        change for change in CHANGES if change != "center_z" or DECLARED[output].needs == "planes"
    ]


def _derivatives(motion: Motion, output: str) -> Array:
    """Derivatives of an output by `_changes` of each link, C of them (C L, N).

    The regressor of all outputs takes far more memory than those of one, hence in parts.
    """
    count, links = len(motion.crank_angle), len(motion.machine.links)
    step = max(AT_ONCE // (FOR_EACH * links**2), 1)
    parts = [motion.part(slice(k, k + step)) for k in range(0, count, step)]
    return np.concatenate([_derivatives_of(part, output) for part in parts], axis=-1)


def _derivatives_of(motion: Motion, output: str) -> Array:
    """Derivatives as of `_derivatives`, at all crank angles at once."""
    item, links = DECLARED[output], motion.machine.links
    columns = item.component(item.vector(OutputSource(motion, regressor(motion))))
    flat, across = np.split(columns, [len(QUANTITIES) * len(links)])
    of_links = flat.reshape(len(links), len(QUANTITIES), -1)
    async_iterator = list(map(_by_change, links.values(), of_links))
    if len(across):
        out_of_plane = across.reshape(len(links), len(ACROSS), -1)
        async_iterator = list(map(_with_out_of_plane, links.values(), async_iterator, out_of_plane))
    return np.concatenate(async_iterator)


def _with_out_of_plane(link: Link, flat: Array, columns: Array) -> Array:
    """Derivatives (5, N), with the centre's z, from those (4, N) of masses in the plane 0 and those
    by mass times plane, and that times x and y (3, N); more mass lies as it does already.
    """
    (whole, moment), (x, y) = moments_across(link), link.center_of_mass or (0.0, 0.0)
    by_whole, by_x, by_y = columns
    by_mass = (whole * by_whole + moment.real * by_x + moment.imag * by_y) / (link.mass or np.inf)
    own = np.stack([by_mass, whole * by_x, whole * by_y, 0 * by_mass])
    by_z = (link.mass or 0.0) * (by_whole + x * by_x + y * by_y)
    return np.insert(flat + own, 3, by_z, axis=0)


def _by_change(link: Link, columns: Array) -> Array:
    """Derivatives by what `CHANGES` within the plane (4, N) from those by the regressor's (4, N).

    These are about the origin of the link's axes: S = m g and J = I + m |g|^2, and the chain rule.
    """
    mass, (x, y) = link.mass or 0.0, link.center_of_mass or (0.0, 0.0)
    by_mass, by_x, by_y, by_inertia = columns
    return np.stack(
        [
            by_mass + x * by_x + y * by_y + (x * x + y * y) * by_inertia,
            mass * (by_x + 2 * x * by_inertia),
            mass * (by_y + 2 * y * by_inertia),
            by_inertia,
        ]
    )


def _sign_changes(motion: Motion, output: str, values: Array) -> list[Array]:
    """Crank angles at which each derivative (4 L, N) passes zero, rising, within the cycle; where
    accelerations jump it may change its sign and have an effect on either side.

    Those of all derivatives are closed in on together, by solving the machine there.
    """
    period = 2 * np.pi * motion.turns
    step = period / values.shape[1]
    negative = np.signbit(values)
    which, k = np.nonzero(negative != np.roll(negative, -1, axis=1))
    if not which.size:
        return [np.empty(0)] * len(values)
    each = np.arange(len(which))

    def signal(theta: Array) -> Array:
        there = move(motion.machine, theta[0], motion.speed, 0.0)
        return _derivatives(there, output)[which, each][None]

    low = k * step
    root = roots(signal, low[None], low[None] + step)[0]
    sides = [np.abs(signal(root[None] + way)[0]) for way in (-SIGN_OFFSET, SIGN_OFFSET)]
    smooth = np.minimum(*sides) <= JUMP * np.max(np.abs(values), axis=1)[which]
    root = np.mod(root, period)
    return [np.sort(root[smooth & (which == row)]) for row in range(len(values))]


def sensitivities_blocks(sensitivities: Sensitivities, zero: float = 0.0) -> Iterator[Block]:
    """What each parameter does to an output, the largest first; crank angles from `zero`, rad."""
    if zero:
        yield Text(say("theta: crank angle from {angle}", angle=angle(zero)))
    rows: list[tuple[Cell, ...]] = []
    turned = display("angle")
    for entry in sensitivities.ranked:
        dimension, usual, word = CHANGES[entry.change]
        unit = display(dimension, (), usual)
        shifted = np.sort(np.mod(entry.no_effect_at - zero, 2 * np.pi * sensitivities.turns))
        places = number_list(fixed(turned, at, 1) for at in shifted) or say("never")
        size = Value(entry.rms / unit.factor)
        rows.append((entry.link, say(word), size, unit.unit, Value(entry.percent), places))
    kind = DECLARED[sensitivities.output].dimension
    columns = (
        Column(say("link")),
        Column(""),
        Column(say("RMS"), kind, alike=False),
        Column(say("per")),
        Column(say("RMS of 1 %"), kind),
        Column(f"{say('no effect at')}, {turned.unit}"),
    )
    title = say(
        "{what}: effect of each parameter, at constant crank speed",
        what=output_named(sensitivities.output),
    )
    yield Table(title, columns, tuple(rows))
    yield Text(
        say(
            "1 %: of the link's mass or inertia, or its centre of mass moved by 1 % of the "
            "machine's size"
        )
    )
    still = [
        f"{item.link} ({say(CHANGES[item.change][2])})"
        for item in sensitivities.by_name.values()
        if not item.has_effect
    ]
    if still:
        yield Text(say("No effect at any crank angle: {names}", names=say(", ").join(still)))
