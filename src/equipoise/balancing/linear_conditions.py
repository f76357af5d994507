"""Which linear conditions on the inertial parameters balance a linkage, or leave it a pure sine.

The shaking force and moment are linear in the parameters of all links, values @ columns.  What must
vanish of them, all orders or all but the crank's own, is a matrix whose null space holds every
balanced machine; grouped like base parameters, its rows are the conditions.  Four-bars get the
conditions of Berkof and Lowen, which are (80) and (83) of Yamashita, Ichikawa and Mori.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, ClassVar, Literal

import numpy as np

from equipoise.balancing.readings import UNITS, ParameterSum, machine_size, reading
from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq, pinv
from equipoise.errors import UsageError
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.parameters import (
    QUANTITIES,
    independent_columns,
    parameter_names,
    parameter_values,
    regressor,
)
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.outputs.declared import DECLARED, OutputSource
from equipoise.mechanism.parts.machine import Machine, unknown
from equipoise.quantities import Dimension, display
from equipoise.results.blocks import Block, Column, Facts, Table, Text, Value
from equipoise.results.outputs import output_named
from equipoise.results.result import Result
from equipoise.signals import Array, harmonics

Kind = Literal["zero", "sine"]

KINDS: tuple[Kind, ...] = ("zero", "sine")
OUTPUTS = tuple(sorted(name for name in DECLARED if name.startswith("shaking_")))
"""What inertia alone makes: weight and loads are no part of it."""
ANGLES, MOST_ANGLES, LEAST_ANGLES = 360, 40_000, 40
"""Crank angles in a turn; in a cycle of many turns, all together and still in a turn."""
NOTHING = 1e-10
"""Share of the largest effect of any parameter below which there is none."""
RANK = 1e-12
"""Share of an effect below which what earlier ones leave of it is rounding."""
ROUNDING = 1e-13
"""Of an effect, relative to itself."""


@dataclass(frozen=True, eq=False, repr=False)
class Conditions(Result):
    """Conditions coefficients @ values = 0, necessary and sufficient, none of which is superfluous.

    kind : ``zero`` or ``sine``.  outputs : names of what they are about.
    parameters : P pairs of link and quantity, about the origin of the link's axes.
    coefficients : (B, P); the parameter that comes first in a row's order, first moments and
        inertia of all links and then masses, has the coefficient 1.
    residuals : (B,) what the machine's own parameters give, in `units`.
    units : of each row's residual, by that parameter: kg m, kg m2, or kg of masses alone.
    readings : each row in words, divided by lengths.  sentences : the same with "= 0".
    crank : whether a crank turns with the crank angle; else it tells the cycle's phase alone.
    without_effect : parameters that stand in no row.
    """

    blocks_in = "balancing.linear_conditions.conditions_blocks"
    records: ClassVar[str] = "conditions"

    kind: Kind
    outputs: tuple[str, ...]
    parameters: tuple[tuple[str, str], ...]
    coefficients: Array
    residuals: Array
    units: tuple[str, ...]
    readings: tuple[ParameterSum, ...]
    crank: bool

    @property
    def count(self) -> int:
        return len(self.coefficients)

    @property
    def sentences(self) -> tuple[str, ...]:
        return tuple(f"{parameter_sum.text} = 0" for parameter_sum in self.readings)

    @property
    def without_effect(self) -> tuple[tuple[str, str], ...]:
        unused = ~np.any(self.coefficients, axis=0)
        return tuple(self.parameters[k] for k in np.flatnonzero(unused))

    def __str__(self) -> str:
        return "\n".join(self.sentences)

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units; coefficients by parameter, zeros left out."""
        names = [".".join(pair) for pair in self.parameters]
        each = zip(self.sentences, self.coefficients, self.residuals, self.units, strict=True)
        rows = [
            {
                "condition": sentence,
                "coefficients": {names[k]: float(row[k]) for k in np.flatnonzero(row)},
                "residual": float(residual),
                "unit": unit,
            }
            for sentence, row, residual, unit in each
        ]
        unused = [".".join(pair) for pair in self.without_effect]
        outputs = list(self.outputs)
        return {"kind": self.kind, "outputs": outputs, "conditions": rows, "without_effect": unused}


def conditions(
    machine: Machine, kind: Kind = "zero", outputs: Sequence[str] = ("shaking_force",)
) -> Conditions:
    """Conditions under which outputs vanish, or are pure sines, at constant crank speed.

    Parameters
    ----------
    kind : ``zero``, or ``sine``: each component has order 1 of the crank's speed alone.  (A mean
        it never has.)
    outputs : of ``shaking_force``, ``shaking_force.x``, ``shaking_force.y`` and
        ``shaking_moment``, which is about the drive pivot.  Weight and loads are no part of them.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the linkage cannot turn fully.
    UsageError : there is no such kind or output.
    """
    if kind not in KINDS:
        raise UsageError(Note("got {kind!r} for kind; give zero or sine", kind=kind))
    wanted = (outputs,) if isinstance(outputs, str) else tuple(outputs)
    if not wanted:
        raise UsageError(Note("give at least one output, such as shaking_force"))
    for output in wanted:
        if output not in OUTPUTS:
            raise UsageError(unknown(output, OUTPUTS, "output of this kind"))
    return ParameterEffects.of(machine).conditions(kind, wanted)


@dataclass(frozen=True, eq=False)
class ParameterEffects:
    """What one unit of each inertial parameter does at 1 rad/s, over one cycle.

    regressor : shaking force (P, N) and moment (P, N) at N crank angles.  turns : of a cycle.
    """

    machine: Machine
    regressor: OutputSource
    turns: int

    @classmethod
    def of(cls, machine: Machine) -> ParameterEffects:
        """Compute the effects of a machine; raises what `conditions` does."""
        turns = assemble(machine).cycle.turns
        motion = move(machine, max(LEAST_ANGLES, min(ANGLES, MOST_ANGLES // turns)), 1.0, 0.0)
        return cls(machine, OutputSource(motion, regressor(motion)), turns)

    def conditions(self, kind: Kind, outputs: Sequence[str]) -> Conditions:
        """Conditions under which outputs vanish or are pure sines, as `conditions` returns them."""
        machine = self.machine
        scale = parameter_scales(machine)
        effects = self._on(outputs)
        matrix = _must_vanish(effects * scale[:, None, None], self.turns, kind)
        leading, rows = _grouped(matrix, scale)
        names, values = parameter_names(machine), parameter_values(machine)
        return Conditions(
            kind,
            tuple(outputs),
            names,
            rows,
            rows @ values,
            tuple(UNITS[names[k][1]] for k in leading),
            tuple(reading(machine, row) for row in rows),
            bool(machine.drive.crank),
        )

    def _on(self, outputs: Sequence[str]) -> Array:
        """Effect of each parameter on each component (P, C, N).

        Moments are divided by the size of the machine, to stand beside forces.
        """
        parts: list[Array] = []
        for output in map(DECLARED.__getitem__, outputs):
            whole = output.component(output.vector(self.regressor))
            if output.dimension == "torque":
                whole = whole / machine_size(self.machine)
            parts += [whole.real, whole.imag] if output.is_vector else [whole]
        return np.stack(parts, axis=1)


def parameter_scales(machine: Machine) -> Array:
    """What one unit of mass at the size of the machine makes of each parameter (P,)."""
    size = machine_size(machine)
    return np.tile([1.0, size, size, size**2], len(machine.links))


def _must_vanish(effects: Array, turns: int, kind: Kind) -> Array:
    """What must vanish of the effects (R, P): the amplitudes of all orders that are not allowed.

    What rounding has left of an effect of allowed orders alone is no effect.
    """
    amplitudes = harmonics(effects)
    sizes = np.linalg.norm(amplitudes.reshape(len(amplitudes), -1), axis=1)
    if kind == "sine":
        amplitudes[..., [0, turns]] = 0.0
    rows = amplitudes.reshape(len(amplitudes), -1).T
    rows[:, np.linalg.norm(rows, axis=0) <= NOTHING * np.max(sizes)] = 0.0
    return np.concatenate([rows.real, rows.imag])


def _grouped(matrix: Array, scale: Array) -> tuple[list[int], Array]:
    """Leading parameter of each condition, and the conditions (B, P).

    Masses come last in the order in which columns are grouped: so a condition is told by a first
    moment wherever one can meet it.
    """
    masses = np.arange(matrix.shape[1]) % len(QUANTITIES) == QUANTITIES.index("mass")
    order = np.argsort(masses, kind="stable")
    if not np.any(matrix):
        return [], np.zeros((0, matrix.shape[1]))
    sizes = np.linalg.norm(matrix, axis=0)
    sizes[sizes == 0] = 1.0
    columns = (matrix / sizes)[:, order]
    independent, grouping = independent_columns(columns, RANK)
    rows = np.zeros_like(grouping)
    rows[:, order] = _without_noise(columns[:, independent], grouping, columns)
    leading = [int(order[k]) for k in independent]
    factor = (scale / sizes)[leading]
    return leading, rows * factor[:, None] * (sizes / scale)


def _without_noise(independent: Array, grouping: Array, columns: Array) -> Array:
    """Factors (B, P) of columns = kept @ factors, without those that only rounding has made.

    Where the kept columns are nearly dependent, rounding makes factors that cancel each other.
    Small ones are left out together, the others fitted anew, and this is taken where nothing is
    lost by it.
    """
    noise = ROUNDING * np.linalg.norm(pinv(independent), axis=1)
    values = grouping.copy()
    for k, column in enumerate(columns.T):
        used = np.abs(grouping[:, k]) > noise
        fitted: Any = lstsq(independent[:, used], column, rcond=None)[0] if np.any(used) else []
        if np.linalg.norm(independent[:, used] @ fitted - column) <= ROUNDING:
            values[:, k] = 0.0
            values[used, k] = fitted
    return values


# -- what is shown ---------------------------------------------------------------------------------

WANTED = {
    ("zero", True): to_say("zero"),
    ("zero", False): to_say("zero"),
    ("sine", True): to_say("a pure sine of the crank angle"),
    ("sine", False): to_say("a pure sine, once a cycle"),
}
"""What outputs are to be, by kind, and by whether a crank turns."""
SHOWN: dict[str, tuple[Dimension, str]] = {
    "kg": ("mass", "kg"),
    "kg m": ("unbalance", "kg mm"),
    "kg m2": ("inertia", "kg mm^2"),
}
"""SI unit of a combination -> what it is, and the unit in which it is usually shown."""


def conditions_blocks(*conditions: Conditions, verdict: Sequence[str] = ()) -> Iterator[Block]:
    """Conditions, one table for each kind, and whether they can be met."""
    yield Text(
        say(
            "mass*x, mass*y: mass times x and y of the centre of mass; inertia: about the origin "
            "of the link"
        )
    )
    for item in conditions:
        yield _conditions(item)
    if verdict:
        title = say("By the links' own masses, none of them lighter than now")
        yield Facts(title, tuple(verdict))


def _conditions(conditions: Conditions) -> Block:
    subject = say(" and ").join(map(output_named, conditions.outputs))
    text = {"what": subject, "wanted": say(WANTED[conditions.kind, conditions.crank])}
    if not conditions.count:
        return Text(say("Conditions for {what} to be {wanted}: none, it always is.", **text))
    now = [
        parameter_sum.factor * float(k)
        for parameter_sum, k in zip(conditions.readings, conditions.residuals, strict=True)
    ]
    rows = tuple(
        (f"{parameter_sum.words} = 0", Value(unit.factor * value), unit.unit)
        for parameter_sum, value in zip(conditions.readings, now, strict=True)
        for dimension, usual in [SHOWN[parameter_sum.unit]]
        for unit in [display(dimension, now, usual)]
    )
    title = say("Conditions for {what} to be {wanted}", **text)
    return Table(title, (Column(""), Column(say("now")), Column("")), rows)
