"""Machines of the same build side by side, and designs that no machine can have.

Their steps differ in nothing but parameters.  With the parameters stacked, one run of the steps
solves all machines at all their crank angles.

Everything that puts a linkage together from numbers (`mechanism.assembly.linkage`) works on columns
as well as on numbers.  So the steps of all designs are made in one go.  What a single machine is
refused for is here a design of which `invalid_designs` is true.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import combinations
from typing import Any, TypeVar

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.keys import (
    Frozen,
    Quantity,
    changed,
    innermost,
    keys_of,
    quantities_of,
    with_fields,
)
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.cam_shapes import can_be_made, fits_of
from equipoise.mechanism.assembly.joints import Structure, all_sliders, coupling_pins
from equipoise.mechanism.assembly.linkage import Linkage, ordered
from equipoise.mechanism.assembly.steps import (
    KernelCall,
    Rotation,
    RunningAngle,
    State,
    Step,
    p,
    planar,
    run,
    u,
)
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.rolling import stacked
from equipoise.mechanism.parts.bodies import Body, outlined_by_columns
from equipoise.mechanism.parts.couplings import Coupling, PathPattern, coupling_kinds
from equipoise.mechanism.parts.element_kinds import element_kinds
from equipoise.mechanism.parts.links import demands_across
from equipoise.mechanism.parts.machine import FRAME, Machine, Vector
from equipoise.quantities.units import HUGE, TINY
from equipoise.signals import Array

Triple = tuple[Array, Array, Array]


class Family:
    """P linkages with the same links, joints and assembly.

    Their values in a state are (P, K), or broadcast to that.
    """

    def __init__(self, linkages: Sequence[Linkage]) -> None:
        self.linkages = tuple(linkages)
        self.first = self.linkages[0]
        self._arms: dict[tuple[str, str], Array] = {}
        self._frame = {
            name: column(complex(*k.machine.frame[name]) for k in self.linkages)
            for name in self.first.machine.frame
        }
        self.steps = self._side_by_side()

    def _side_by_side(self) -> list[Step] | None:
        """Steps that solve all machines at once; None where a running angle has to be counted on
        from a machine's own cycle.
        """
        if any(linkage.machine.pushers for linkage in self.linkages):
            return None
        known = (FRAME, self.first.machine.drive.link)
        steps: list[Step] = []
        for same in zip(*(k.motion for k in self.linkages), strict=True):
            match same[0]:
                case KernelCall():
                    steps.append(_stacked(same))
                case Rotation() as turned:
                    steps.append(turned)
                case RunningAngle(link) if link in known:
                    pass  # that of the frame and of the drive is there from the start
                case _:
                    return None
        return steps

    def solve(self, theta: Array) -> State:
        """Every link known at crank angles (P, K), rad."""
        if self.steps is None:
            return self._one_by_one(theta)
        with np.errstate(all="ignore"):
            return run(self.steps, self._start(theta))

    def point(self, state: State, link: str, point: str) -> Triple:
        """A point of a link and its derivatives by crank angle, (P, K)."""
        given = [state[name] for name in (*p(self.first.anchors[link]), *u(link))]
        values: Triple = kernels.point(*given, self._arm(link, point))  # type: ignore[call-arg]
        shape = np.shape(state["theta"])
        place, first, second = (np.broadcast_to(value, shape) for value in values)
        return place, first, second

    def _arm(self, link: str, point: str) -> Array:
        """Vector from a link's anchor to a point of it, in the link's axes, (P, 1)."""
        if (link, point) not in self._arms:
            bodies = (k.machine.assembled_points(link) for k in self.linkages)
            anchor = self.first.anchors[link]
            arms = (complex(*body[point]) - complex(*body[anchor]) for body in bodies)
            self._arms[link, point] = column(arms)
        return self._arms[link, point]

    def rates(self, state: State, link: str) -> tuple[Array, Array]:
        """First and second derivative of a link's angle by crank angle, (P, K)."""
        shape = np.shape(state["theta"])
        _, first, second = (np.broadcast_to(state[name], shape) for name in u(link))
        return first, second

    def margins(self, state: State) -> Array:
        """Smallest assembly margin of any dyad at each crank angle, (P, K); below 0 it is open."""
        names = [group.margin for group in self.first.groups if group.margin is not None]
        values = [np.broadcast_to(state[name], np.shape(state["theta"])) for name in names]
        smallest: Array = np.min([np.ones(np.shape(state["theta"])), *values], axis=0)
        return smallest

    def _start(self, theta: Array) -> State:
        state: State = {"theta": theta}
        for name, places in self._frame.items():
            state.update({f"p({name})": places, f"p1({name})": 0j, f"p2({name})": 0j})
        state.update(zip(u(FRAME), (1 + 0j, 0.0, 0.0), strict=True))
        state[f"phi({FRAME})"] = np.zeros_like(theta)
        for alike in zip(*(k.machine.driven for k in self.linkages), strict=True):
            angle, w, a = alike[0].turned(theta)
            if any(drive != alike[0] for drive in alike):
                each = (drive.turned(row) for drive, row in zip(alike, theta, strict=True))
                rows = [np.broadcast_arrays(*values) for values in each]
                angle, w, a = map(np.array, zip(*rows, strict=True))
            state.update(zip(u(alike[0].link), (np.exp(1j * angle), w, a), strict=True))
            state[f"phi({alike[0].link})"] = angle
        return state

    def _one_by_one(self, theta: Array) -> State:
        """Solve designs one by one: some couplings and loops need a cycle of their own for each."""
        rows = [k.solve(row) for k, row in zip(self.linkages, theta, strict=True)]
        names = [name for name, value in rows[0].items() if np.ndim(value) < 2]
        return {
            name: np.array(
                [np.broadcast_to(row[name], t.shape) for row, t in zip(rows, theta, strict=True)]
            )
            for name in names
        }


def _stacked(calls: Sequence[Any]) -> KernelCall:
    """One call for all machines, with columns (P, 1) for parameters."""
    first = calls[0]
    columns = (
        _stacked_values(values) for values in zip(*(c.parameters for c in calls), strict=True)
    )
    return KernelCall(first.kernel, first.inputs, tuple(columns), first.outputs)


def _stacked_values(values: tuple[Any, ...]) -> Any:
    """Numbers as a column (P, 1); laws as one that takes angles (P, K), a row for each machine."""
    if not callable(values[0]):
        return column(values)
    with suppress(ValueError):
        return stacked(values)

    def law(angles: Any) -> tuple[Array, ...]:
        rows = (value(row) for value, row in zip(values, angles, strict=True))
        return tuple(map(np.array, zip(*rows, strict=True)))

    return law


def column(values: Iterable[Any]) -> Array:
    """One value for each machine, (P, 1)."""
    return np.array(list(values))[:, None]


# -- columns ---------------------------------------------------------------------------------------

ColumnValues = Mapping[str, Array]
"""Path of a number -> its values (P, 1), SI units."""
ValueT = TypeVar("ValueT")
NumberKey = str | tuple[str, int]
"""Key of a number, or of a list of numbers and the place in it."""

PAIR = {"x", "y", "distance", "direction"}


HOLDERS: Mapping[PathPattern, Set[str] | None] = {
    ("drive",): {"speed", "acceleration"},
    ("gravity",): PAIR,
    ("frame", "points", str): PAIR,
    ("links", str, "points", str): PAIR,
    ("links", str, "center_of_mass"): PAIR,
    ("links", str, "bodies", int, "at"): PAIR,
    ("links", str, "bodies", int): {*quantities_of(Body)},
    ("links", str, "sides"): None,
    ("links", str, "planes"): None,
    ("links", str): {"mass", "inertia", "length", "plane"},
    ("bearings", str): {"plane"},
    ("sliders", int): {"direction", "angle"},
}
"""Pattern of paths in the model file (`KeyPath.matches`) of what has numbers that may be columns ->
their keys; None where these are names.  Couplings declare theirs, and of elements all quantities
may be columns.
"""


def _listed_holders(of: type[Frozen]) -> Iterator[tuple[PathPattern, Set[str]]]:
    """As `HOLDERS`, of the couplings and elements of a class of machines."""
    for table, coupling in coupling_kinds(of).items():
        for inner, keys in coupling.columns.items():
            yield (table, int, *inner), keys
    for table, kind in element_kinds(of).items():
        known = keys_of(kind).items()
        yield (
            (table, int),
            {name for name, item in known if isinstance(innermost(item.kind), Quantity)},
        )


def _check_holder(whole: KeyPath, parts: Set[NumberKey], of: type[Frozen] = Machine) -> None:
    """A `KeyError` where what stands at a path has no such numbers that may be columns."""
    names = {part if isinstance(part, str) else part[0] for part in parts}
    for pattern, keys in (*HOLDERS.items(), *_listed_holders(of)):
        if whole.matches(pattern) and (keys is None or names <= keys):
            return
    raise KeyError(str(whole))


def _split(path: KeyPath) -> tuple[KeyPath, NumberKey]:
    """What holds a number, and which of its numbers it is."""
    *_, name, last = ("", "", *path)
    if isinstance(last, int):
        return path.begin(-2), (str(name), last)
    return path.parent, last


def can_vary(machine: Machine, path: str) -> bool:
    """Whether a number of a machine, by its path in the model file, may be a column."""
    try:
        with_columns(machine, {path: np.ones((1, 1))})
    except UsageError:
        return False
    return True


def with_columns(machine: Machine, columns: ColumnValues) -> Machine:
    """A machine some of whose numbers are columns.

    It passes no checks and serves `linkage_of` alone.

    Raises
    ------
    UsageError : there is no such number, or it cannot be a column.
    """
    base, rows_of_values = machine, dict[KeyPath, dict[NumberKey, Array]]()
    for path, column in columns.items():
        whole, part = _split(_path(path))
        rows_of_values.setdefault(whole, {})[part] = column
    for whole, parts in rows_of_values.items():
        try:
            _check_holder(whole, parts.keys(), type(machine))
            machine = changed(machine, whole, partial(_filled, parts), with_fields)
            _check_outlines(machine)
            _check_shapes(machine, base)
        except (KeyError, IndexError):
            paths = (
                KeyPath((*whole, *((part,) if isinstance(part, str) else part))) for part in parts
            )
            raise _no_column(" and ".join(map(str, paths))) from None
    return machine


def _path(text: str) -> KeyPath:
    try:
        return KeyPath.parse(text)
    except ModelError:
        raise _no_column(text) from None


def _no_column(paths: str) -> UsageError:
    return UsageError(
        Note("got {paths}; the machine has no such number that can be a column", paths=paths)
    )


def _filled(parts: Mapping[NumberKey, Array], template: Any) -> Any:
    """What holds numbers with columns for some of them, which have to be given."""
    if isinstance(template, tuple):
        return _pair(template, parts)
    if isinstance(template, Mapping) and parts.keys() <= template.keys():
        return {**template, **parts}
    if not isinstance(template, Frozen):
        raise KeyError
    fields: dict[str, Any] = {}
    for part, column in parts.items():
        name, place = (part, None) if isinstance(part, str) else part
        value = fields.get(name, getattr(template, name))
        if value is None or (place is not None) != isinstance(value, tuple):
            raise KeyError
        if place is not None and place >= len(value):
            raise KeyError
        fields[name] = column if place is None else (*value[:place], column, *value[place + 1 :])
    return with_fields(template, **template.following(fields))


def _check_outlines(machine: Machine) -> None:
    """Raise where outlines depend on columns: the fit of plates and holes needs plain numbers."""
    for link in machine.links.values():
        if any(outlined_by_columns(body, link.points) for body in link.bodies):
            raise KeyError


def _check_shapes(machine: Machine, base: Machine) -> None:
    """Whether the relations of couplings are formulas of their numbers."""
    pairs = zip(machine.couplings, base.couplings, strict=True)
    if not all(coupling.accepts_columns(before) for coupling, before in pairs):
        raise KeyError


def _pair(place: Vector, parts: Mapping[Any, Array]) -> tuple[Any, Any]:
    """A pair with coordinates, or polar coordinates, replaced; x and y go by what is there then."""
    x: Any
    y: Any
    x, y = place
    if parts.keys() & {"distance", "direction"}:
        distance = parts.get("distance", np.hypot(x, y))
        direction = parts.get("direction", np.arctan2(y, x))
        x, y = distance * np.cos(direction), distance * np.sin(direction)
    return parts.get("x", x), parts.get("y", y)


def linkage_of(machine: Machine, base: Linkage) -> Linkage:
    """The linkage of a machine with columns, in the order in which its base is solved."""
    needed = base.needed_references
    start = {f"reference({name})": base.cycle.reference(name, np.zeros(1)) for name in needed}
    with np.errstate(all="ignore"):
        return ordered(machine, joints_of(machine, base), start)


def joints_of(machine: Machine, base: Linkage) -> Structure:
    """The joints of a machine with columns, those of its base but for their numbers."""
    riders = machine.riders
    sliders = all_sliders(machine.sliders, riders)
    return replace(base.joints, sliders=sliders, couplings=machine.couplings, riders=riders)


def massive_link(path: str) -> str | None:
    """The link whose mass, centre of mass or moment of inertia a path leads to."""
    with suppress(KeyError, ModelError):
        steps = KeyPath.parse(path)
        whole, part = _split(steps)
        _check_holder(whole, {part})
        match whole:
            case ("links", str(link)) if part not in ("length", "plane"):
                return link
            case ("links", str(link), "center_of_mass" | "bodies", *_):
                return link
    return None


def invalid_designs(machine: Machine, base: Linkage, columns: ColumnValues) -> Array:
    """Which of the designs (P,) no machine can have."""
    count = max((len(column) for column in columns.values()), default=1)
    values = np.zeros((count, 1), dtype=bool)
    with np.errstate(all="ignore"):
        for column in columns.values():
            size = np.abs(column)
            values |= ~((size <= HUGE) & ((size >= TINY) | (size == 0)))
        for right in _demands(machine, base):
            values |= np.logical_not(right)
    return values[:, 0]


def _demands(machine: Machine, base: Linkage) -> Iterator[Any]:
    """What has to be true of the numbers of a machine: flags, or columns of them."""
    for body in (FRAME, *machine.links):
        points = machine.bodies[body]
        places = [planar(points[point]) for point in points if point in base.joints.pins]
        yield from (place != other for place, other in combinations(places, 2))
    for link in machine.links.values():
        if link.mass is not None and link.inertia is not None:
            yield (link.mass >= 0) & (link.inertia >= 0)
            yield (link.mass > 0) | (np.asarray(link.inertia) == 0)
        yield from link.demands()
    for coupling in machine.couplings:
        yield from coupling.demands(partial(_distance, machine, base, coupling))
    fits = fits_of(machine, joints_of(machine, base)) if _has_surfaces(machine) else ()
    yield from (can_be_made(fit) for fit in fits if fit.has_columns)
    yield from demands_across(machine)
    for *_, element in machine.elements:
        yield from element.demands()


def _has_surfaces(machine: Machine) -> bool:
    return any(coupling.contact == "surface" for coupling in machine.couplings)


def _distance(machine: Machine, base: Linkage, coupling: Coupling) -> Any:
    """Of the pins of driver and driven body."""
    points = machine.points_of(coupling.carrier)
    driver, driven = (planar(points[pin]) for pin in coupling_pins(base.joints, coupling))
    return abs(driven - driver)
