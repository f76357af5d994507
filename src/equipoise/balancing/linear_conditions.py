"""Linear conditions on the inertial parameters that balance a linkage, or leave it a pure sine.

The shaking force and moment are linear in the parameters of all links, values @ columns.  What must
vanish of them, all orders or all but the crank's own, is a matrix whose null space holds every
balanced machine; grouped like base parameters, its rows are the conditions.  Four-bars get the
conditions of Berkof and Lowen, which are (80) and (83) of Yamashita, Ichikawa and Mori.

(84) to (87) of Yamashita, Ichikawa and Mori for any linkage: the conditions are linear in the added
moments x, rows x = -residuals, and x has the least sum of squares; moments of free links cost
nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any, ClassVar, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq, pinv, svd
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
from equipoise.mechanism.parts.machine import Machine, Vector, size_of, unknown
from equipoise.quantities import Dimension, display
from equipoise.results.blocks import Block, Cell, Column, Facts, Table, Text, Value
from equipoise.results.outputs import output_named
from equipoise.results.result import Result
from equipoise.signals import Array, harmonics

UNITS = dict(zip(QUANTITIES, ("kg", "kg m", "kg m", "kg m2"), strict=True))


WORDS = {
    "mass": to_say("mass of {name}"),
    "moment_x": to_say("mass*x of {name}"),
    "moment_y": to_say("mass*y of {name}"),
    "inertia": to_say("inertia of {name}"),
}
"""What a parameter of a link is called in a sum."""


@dataclass(frozen=True)
class ParameterTerm:
    """A parameter of a link in a sum.

    sign : ``+`` or ``-``.  size : by which it is multiplied, so that the sum is in kg; None where
    it stands alone.
    """

    sign: str
    link: str
    quantity: str
    size: float | None = None

    @property
    def around(self) -> tuple[str, str]:
        """What stands before and behind its name, such as the length over which it stands."""
        if self.size is None:
            return "", ""
        if self.quantity == "mass":
            return "" if f"{self.size:.5g}" == "1" else f"{self.size:.5g} ", ""
        length = 1 / (self.size**0.5 if self.quantity == "inertia" else self.size)
        unit = display("length", [length])
        text = f"{unit.factor * length:.5g} {unit.unit}"
        return "", f" / ({text})^2" if self.quantity == "inertia" else f" / {text}"


@dataclass(frozen=True)
class ParameterSum:
    """A combination of inertial parameters as a sum.

    factor : by which the combination was multiplied for it.  unit : of the sum.
    """

    terms: tuple[ParameterTerm, ...]
    factor: float
    unit: str

    @property
    def text(self) -> str:
        """The condition, such as ``coupler.moment_x / 71.5 mm + rocker.moment_x / 80 mm``."""
        return self._sum(lambda term: f"{term.link}.{term.quantity}")

    @property
    def words(self) -> str:
        """Text for readers, ``mass*x of coupler / 71.5 mm + mass*x of rocker / 80 mm``."""
        return self._sum(lambda term: say(WORDS[term.quantity], name=term.link))

    def _sum(self, named: Callable[[ParameterTerm], str]) -> str:
        parts = [
            f"{term.sign} {term.around[0]}{named(term)}{term.around[1]}" for term in self.terms
        ]
        first = parts[0].removeprefix("+ ")
        return " ".join([f"-{first[2:]}" if first.startswith("- ") else first, *parts[1:]])


def machine_size(machine: Machine) -> float:
    """Diagonal of the largest link, or of the frame where all links are points, m."""
    sizes = [size_of(link.points) for link in machine.links.values()]
    return max(sizes) or size_of(machine.frame) or 1.0


def joint_length(machine: Machine, link: str) -> float:
    """Distance of a link's two joints that are farthest apart; its size where there are none, m."""
    own = machine.links[link].points
    others = [other.points for name, other in machine.links.items() if name != link]
    slides = {name for slider in machine.sliders for name in (slider.point, slider.through)}
    places = [
        complex(*place)
        for name, place in own.items()
        if name in slides or any(name in body for body in (machine.frame, *others))
    ]
    apart = max((abs(a - b) for a, b in combinations(places, 2)), default=0.0)
    return apart or size_of(own) or machine_size(machine)


def reading(machine: Machine, row: Array, signed: bool = False) -> ParameterSum:
    """A combination (P,) of a machine's inertial parameters in words.

    It is divided so that a mass stands alone, else so that the first moment that comes first stands
    over the length of its link: as (80) and (83) of Yamashita, Ichikawa and Mori, divided by their
    lengths.  Unless `signed`, it is turned so that the first term is positive.
    """
    names = parameter_names(machine)
    terms = [(*names[k], float(row[k])) for k in np.flatnonzero(row)]
    sign = -1.0 if terms[0][2] < 0 and not signed else 1.0
    if len(terms) == 1:
        link, quantity, value = terms[0]
        term = ParameterTerm("-" if sign * value < 0 else "+", link, quantity)
        return ParameterSum((term,), sign / abs(value), UNITS[quantity])
    factor = sign / _divisor(machine, terms)
    parts = tuple(
        ParameterTerm("-" if factor * value < 0 else "+", link, quantity, abs(factor * value))
        for link, quantity, value in terms
    )
    return ParameterSum(parts, factor, "kg")


def _divisor(machine: Machine, terms: list[tuple[str, str, float]]) -> float:
    """Positive, in SI units of a combination over kg."""
    for wanted, power in (("mass", 0), ("moment", 1), ("inertia", 2)):
        for link, quantity, value in terms:
            if quantity.startswith(wanted):
                return abs(value) * joint_length(machine, link) ** power
    return 1.0


ConditionKind = Literal["zero", "sine"]

KINDS: tuple[ConditionKind, ...] = ("zero", "sine")
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
    crank : whether a crank turns with the crank angle; else that is the cycle's phase alone.
    without_effect : parameters that stand in no row.
    """

    blocks_in = "balancing.linear_conditions.conditions_blocks"
    records: ClassVar[str] = "conditions"

    kind: ConditionKind
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
    machine: Machine, kind: ConditionKind = "zero", outputs: Sequence[str] = ("shaking_force",)
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

    def conditions(self, kind: ConditionKind, outputs: Sequence[str]) -> Conditions:
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


def _must_vanish(effects: Array, turns: int, kind: ConditionKind) -> Array:
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

    Masses come last in the order in which columns are grouped: so a condition leads with a first
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


MET = 1e-9
"""Share of a condition's largest term that may be left of it."""
SINGULAR_RANK = 1e-10
"""Share of the largest singular value below which one counts as none."""


@dataclass(frozen=True, eq=False, repr=False)
class Added(Result):
    """First moments to be added, in the axes of each link, kg m.

    moments : link -> (x, y) to be added.  totals : link -> (x, y) that it then has, about the
        origin of its axes.
    cost : root of the sum of squares of the moments of all links that are not free, kg m.
    machine : with them; masses, and moments of inertia about the centres of mass, are kept.
    """

    moments: Mapping[str, Vector]
    totals: Mapping[str, Vector]
    cost: float
    machine: Machine

    blocks_in = "balancing.linear_conditions.added_blocks"

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units."""
        centers = {link: self.machine.links[link].center_of_mass for link in self.moments}
        return {
            "added": {link: list(moment) for link, moment in self.moments.items()},
            "total": {link: list(moment) for link, moment in self.totals.items()},
            "center_of_mass": {link: list(center or ()) for link, center in centers.items()},
            "cost": self.cost,
        }


def least_moments(machine: Machine, links: Sequence[str], free: Sequence[str] = ()) -> Added:
    """First moments with the least sum of squares that make the shaking force zero.

    Parameters
    ----------
    links : whose first moments count.
    free : links that may take any first moment without cost.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the linkage cannot turn fully.
    UsageError : there is no such link, one is named twice or has mass 0, or these links do not
        suffice.
    """
    names = [*links, *free]
    for k, name in enumerate(names):
        if name not in machine.links:
            raise UsageError(unknown(name, machine.links, "link"))
        if name in names[:k]:
            raise UsageError(Note("{name} is named twice; name each link once", name=name))
        if machine.links[name].mass == 0:
            raise UsageError(
                Note("{name} has mass 0 and so no first moment; give it a mass", name=name)
            )
    result = conditions(machine)
    places = [
        result.parameters.index((link, moment))
        for link in names
        for moment in ("moment_x", "moment_y")
    ]
    sizes = np.abs(result.coefficients * parameter_scales(machine))  # of each condition's terms
    scale = np.max(sizes, axis=1) * (machine.mass or 1.0)
    rows, right = result.coefficients[:, places] / scale[:, None], -result.residuals / scale
    costed = 2 * len(links)
    x = _least(rows[:, :costed], rows[:, costed:], right)
    rest = np.abs(rows @ x - right)
    if rest.size and np.max(rest) > MET:
        worst = result.sentences[int(np.argmax(rest))]
        raise UsageError(
            Note(
                "first moments of {names} cannot meet {worst}; name more links",
                names=", ".join(names) or "no link",
                worst=worst,
            )
        )
    moments, totals = (
        {
            link: (float(a), float(b))
            for link, (a, b) in zip(names, flat.reshape(-1, 2), strict=True)
        }
        for flat in (x, parameter_values(machine)[places] + x)
    )
    changed = machine
    for link, (first, second) in totals.items():
        mass = machine.links[link].mass
        assert mass is not None
        changed = changed.with_link(link, center_of_mass=(first / mass, second / mass))
    return Added(moments, totals, float(np.linalg.norm(x[:costed])), changed)


def _least(costed: Array, free: Array, right: Array) -> Array:
    """Solution of costed x + free z = right with the least |x|; of least squares where none is."""
    blind = _blind_to(free)
    x = lstsq(blind @ costed, blind @ right, rcond=SINGULAR_RANK)[0]
    z = lstsq(free, right - costed @ x, rcond=SINGULAR_RANK)[0]
    return np.concatenate([x, z])


def _blind_to(columns: Array) -> Array:
    """Rows that are orthogonal to columns, and to each other."""
    left, sizes, _ = svd(columns, full_matrices=True)
    rank = int(np.sum(sizes > SINGULAR_RANK * np.max(sizes, initial=0.0)))
    return np.asarray(left[:, rank:].T)


def added_blocks(added: Added) -> Iterator[Block]:
    """First moments to be added, and what that makes of the centres of mass."""
    scale = max((abs(part) for pair in added.totals.values() for part in pair), default=0.0)
    rows: list[tuple[Cell, ...]] = []
    for link, moment in added.moments.items():
        center = added.machine.links[link].center_of_mass or (0.0, 0.0)
        size = max(map(abs, center))
        moments = (Value(1e3 * part, 1e3 * scale) for part in (*moment, *added.totals[link]))
        rows.append((link, *moments, *(Value(part, size) for part in center)))
    labels = (say("added x"), say("added y"), say("then x"), say("then y"))
    columns = (Column(""), *(Column(label, unit="kg mm") for label in labels))
    centers = (Column(say("centre x"), "length", "mm"), Column(say("centre y"), "length", "mm"))
    title = say("Least first moments that make the shaking force zero, in each link's axes")
    yield Table(title, (*columns, *centers), tuple(rows))
