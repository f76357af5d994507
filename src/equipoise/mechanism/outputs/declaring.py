"""How an output is declared: what it is called, what it measures, how it is had, what it is for.

`outputs.declared` has the declarations.  `{}` in the name of a family stands for its members:
``links.{}.angle`` is declared once for all links.

    @output("crank_power", "power", to_say("power of the crank"), linear=True)
    def crank_power(result):
        return result.forces.drive_torque * result.motion.speed
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property, lru_cache
from itertools import dropwhile
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, PartName, capital, say, speaking, spoken, to_say
from equipoise.quantities import SI, Dimension

if TYPE_CHECKING:
    from equipoise.signals import Array

ResultT = TypeVar("ResultT")
Needs = Literal["motion", "masses", "planes", "rows", "support"]
Statistic = Literal["rms", "ripple", "peak", "peak_to_peak", "area"]
"""Statistic that reduces an output to one number; see `mechanism.parts.balance`."""
Yardstick = Literal[
    "", "weight", "span", "bearings", "effort", "acting", "pressure", "transmission", "vibration"
]
"""Against what an output is measured to say whether it is large; see `results.yardsticks`."""
VectorPart = Literal["", "x", "y", "size"]
OutputReader = Callable[..., Any]
"""From an analysis, and the name of the member for families, to values (N,), complex of vectors."""

KINEMATIC = "{what} is a part of the motion, which masses do not change"
ONLY_READ = "{what} is only read; it is not known to be linear in the masses"
"""Why balancing cannot take an output."""
GROUPS = {
    "links": to_say("links"),
    "points": to_say("points"),
    "sliders": to_say("sliders"),
    "transmission": to_say("transmission angles"),
    "centers": to_say("instant centres"),
    "forces": to_say("frame and drive"),
    "drives": to_say("drives"),
    "joints": to_say("joints"),
    "bearings": to_say("bearings"),
    "rows": to_say("all rows together"),
    "gauges": to_say("gauges"),
}
"""Groups of outputs and their headings, in the order in which they are offered; kinds of parts add
theirs before those of all rows."""


@lru_cache(maxsize=4096)  # asked for again with every analysis
def _named(name: str, item: str) -> str:
    return name.replace("{}", item)


@lru_cache(maxsize=4096)
def _path(name: str, item: str) -> tuple[str, ...]:
    return tuple(item if key == "{}" and item else key for key in name.split("."))


def _only_one(_: Any) -> Iterable[str]:
    return ("",)


@dataclass(frozen=True)
class Declared:
    """One output, or a family of outputs.

    name : by which it is found.
    dimension : of its values, which are in SI units.
    label : in English, for `say`; ``{name}`` stands for the member of a family.
    read : has it from an analysis, as values or with values as its `value`; None where it belongs
        to a response instead (gauges).
    part : of the vector that `read` gives, where that is one; its size goes by the vector's name.
    needs : what a machine must have; planes of links go with masses.
    members : from a machine to the members that it may have; ``""`` where it is no family.
    items : from an analysis to the members that it has, where they depend on more than the machine.
    spoken : a member in words.
    linear : whether it is linear in the masses, as long as the same flanks and strands bear.
    reason : why balancing cannot take it; empty where it can.
    internal : whether it is a force between bodies of one linkage, in which it counts which flank
        of teeth or strand of a chain bears.
    loop : has it in compiled loops, from a function that looks values up there by name: for a
        family those of its member.
    about : whether it depends on the point about which moments are taken.
    array : whether it stands among the arrays.  summed : whether it stands in the summary.
    ordered : whether tables of orders include it.
    compared : measures that are reported before and after balancing.
    with_loads : of frame and drive, whether it holds what loads do, which may be a hundred times
        what shakes: such outputs have a unit of their own.
    unbounded : whether there are crank angles at which it is infinite, which NaN stands for; it is
        had by its name alone.
    yardstick : against what it is measured to say whether it is large; empty where it is not.
    by_friction : whether friction in joints changes it, so that with it masses do not enter it
        linearly.
    """

    name: str
    dimension: Dimension | None
    label: str
    read: OutputReader | None
    part: VectorPart = ""
    needs: Needs = "masses"
    members: Callable[[Any], Iterable[str]] = _only_one
    items: Callable[[Any], Iterable[str]] | None = None
    spoken: Callable[[str], str] = str
    linear: bool = False
    reason: str = ""
    internal: bool = False
    loop: Callable[[Callable[[str], Any]], Any] | None = None
    about: bool = False
    array: bool = True
    summed: bool = True
    ordered: bool = False
    compared: tuple[Statistic, ...] = ()
    with_loads: bool = False
    unbounded: bool = False
    yardstick: Yardstick = ""
    by_friction: bool = False

    @property
    def unit(self) -> str:
        """SI unit; empty of plain numbers."""
        return "" if self.dimension is None else SI[self.dimension]

    @cached_property
    def group(self) -> str:
        """One of `GROUPS`."""
        first = self.name.partition(".")[0]
        return first if first in GROUPS else "forces"

    @property
    def is_family(self) -> bool:
        """Whether it is declared once for several members."""
        return "{}" in self.name

    @property
    def is_vector(self) -> bool:
        """Whether its name stands for a vector, of which it is the size."""
        return self.part == "size"

    @property
    def is_split(self) -> bool:
        """Whether it can be split by cause and by link: it is linear, and a force of one row."""
        return self.is_of_row and not self.reason

    def linear_in(self, machine: Any) -> bool:
        """Whether it is linear in the masses of a machine: no contact in it changes sides, and no
        friction in it follows from forces.
        """
        if self.by_friction and machine.rubs:
            return False
        return self.linear and not (self.internal and machine.switches)

    @property
    def is_of_row(self) -> bool:
        """Whether it is a force, or a moment, of one row."""
        return self.needs in ("masses", "planes")

    def named(self, item: str) -> str:
        """The name of a member."""
        return _named(self.name, item)

    def path(self, item: str = "") -> tuple[str, ...]:
        """Keys that lead to a member in nested values; members may have dots in their names."""
        return _path(self.name, item)

    def item_of(self, name: str) -> str | None:
        """The member that goes by a name; None where none can."""
        if not self.is_family:
            return "" if name == self.name else None
        before, after = self.name.split("{}")
        inside = name[len(before) : len(name) - len(after)]
        return inside if inside and self.named(inside) == name else None

    def note(self, item: str = "") -> Note:
        """What it is called, to be said in any language."""
        result = Note(
            self.label, **({"name": PartName(item, self.spoken)} if self.is_family else {})
        )
        if self.part in ("x", "y"):
            both = to_say("{what}, {axis}") if self.is_family else to_say("{what} {axis}")
            result = Note(both, what=result, axis=self.part)
        return Note(to_say("all rows: {what}"), what=result) if self.needs == "rows" else result

    def title(self, item: str = "") -> str:
        """Heading of a table of this output, in the language that is spoken."""
        text = replace(self, part="").say(item)
        if self.part in ("x", "y"):
            text = say("{what} along {axis}", what=text, axis=self.part)
        return capital(text)

    def say(self, item: str = "", of_one: bool = False) -> str:
        """What it is called, in the language that is spoken; where that lacks it, in English.

        of_one : whether it is of one row of several.
        """
        return _localized_label(self, item, of_one and self.is_of_row, spoken())

    def items_of(self, result: Any) -> Iterable[str]:
        """Members that an analysis has; ``""`` where it is no family."""
        return self.members(result.machine) if self.items is None else self.items(result)

    def values(self, result: Any, item: str = "") -> Array:
        """Values (N,) of an analysis; the component, or the size, of what is a vector."""
        whole = self.component(self.vector(result, item))
        return abs(whole) if self.is_vector else whole

    def component(self, whole: Array) -> Array:
        """That component of a vector which this is; all of it where it is its size."""
        if self.part == "x":
            return whole.real
        return whole.imag if self.part == "y" else whole

    def vector(self, result: Any, item: str = "") -> Array:
        """Values of the output, complex of a vector, whichever of its parts this is.

        result : whatever has the motion and the forces; (..., N) where the forces have more axes.
        """
        assert self.read is not None
        whole = self.read(result, item) if self.is_family else self.read(result)
        import numpy as np  # here, so that a file is read without it

        return np.asarray(getattr(whole, "value", whole))


@dataclass(frozen=True)
class OutputSource:
    """What outputs are read of where it is no analysis: a motion, and forces that belong to it.

    forces : such as a `Regressor` or `Split`, whose arrays have more axes before the last.
    """

    motion: Any
    forces: Any

    @property
    def machine(self) -> Any:
        return self.motion.machine


DECLARED: dict[str, Declared] = {}
"""All declared outputs, by name, in the order of reports."""
_FORGETTING: list[Callable[[], None]] = []


def kept_until_declared(most: int) -> Callable[[Callable[..., ResultT]], Callable[..., ResultT]]:
    """A function whose last results are kept until another output is declared.

    most : number of results.
    """

    def keeping(function: Callable[..., ResultT]) -> Callable[..., ResultT]:
        cached = lru_cache(most)(function)
        _FORGETTING.append(cached.cache_clear)
        return cached

    return keeping


def _forget() -> None:
    for forget in _FORGETTING:
        forget()


def declare_as(declared: Declared) -> None:
    """Declare an output as it is."""
    DECLARED[declared.name] = declared
    _forget()


def output(
    name: str,
    dimension: Dimension | None,
    label: str,
    *,
    parts: tuple[str, str] | None = None,
    linear: bool = False,
    reason: str = "",
    needs: Needs = "masses",
    summed: tuple[bool, bool] | bool = True,
    sized: bool = True,
    **options: Any,
) -> Callable[[OutputReader], OutputReader]:
    """Declare an output by the function that has it from an analysis.

    Parameters
    ----------
    name, dimension, label, needs : as in `Declared`, as are all others.
    parts : names of the components along x and y of what is a vector; `name` is then its size.
    linear : whether it is linear in the masses of the links.
    reason : why balancing cannot take it; where it is not linear, that it is not, if not given.
    summed : whether it stands in the summary; of a vector, its size and its components.
    sized : whether the magnitude of a vector is an output too.
    """
    if not (linear or reason):
        reason = KINEMATIC if needs == "motion" else ONLY_READ
    of_size, of_parts = summed if isinstance(summed, tuple) else (summed, summed)

    def declare(read: OutputReader) -> OutputReader:
        item = Declared(
            name, dimension, label, read, needs=needs, linear=linear, reason=reason, **options
        )
        if parts is None:
            declare_as(replace(item, summed=of_size))
            return read
        one_part = replace(
            item, summed=of_parts, compared=item.compared if of_parts else (), yardstick=""
        )
        declare_as(replace(one_part, name=parts[0], part="x"))
        declare_as(replace(one_part, name=parts[1], part="y"))
        if sized:
            declare_as(replace(item, part="size", array=False, summed=of_size, ordered=False))
        return read

    return declare


@contextmanager
def declaring() -> Iterator[None]:
    """Inside, outputs may be declared that are forgotten at the end."""
    before = [(known, dict(known)) for known in (DECLARED, GROUPS)]
    try:
        yield
    finally:
        for known, values in before:
            known.clear()
            known.update(values)  # type: ignore[arg-type]
        _forget()


@contextmanager
def of_parts() -> Iterator[None]:
    """Inside, outputs and groups are declared that stand before those of all rows."""
    last: list[tuple[dict[str, Any], dict[str, Any]]] = []
    for known in (DECLARED, GROUPS):
        later = [*dropwhile(lambda name: name.partition(".")[0] != "rows", known)]
        last.append((known, {name: known.pop(name) for name in later}))
    yield
    for known, values in last:
        known.update(values)
    _forget()


def matches(name: str) -> tuple[tuple[Declared, str], ...]:
    """Declarations that a name may mean, each with the member, the likeliest first.

    Balancing calls ``joints.B.x`` what is a component of a vector, and ``roll_moment`` what only
    all rows together have.
    """
    return _matches(name)


@kept_until_declared(8192)
def _matches(name: str) -> tuple[tuple[Declared, str], ...]:
    """Matching outputs, kept until another is declared: advice asks a hundred thousand times."""
    values = [(entry, item) for entry in DECLARED.values() for item in [entry.item_of(name)]]
    # joints.B.moment is the moment in B, and no force in a joint B.moment
    known = sorted(((entry, item) for entry, item in values if item is not None),
                   key=lambda pair: -len(pair[0].name))  # fmt: skip
    if f"rows.{name}" in DECLARED:
        known.append((DECLARED[f"rows.{name}"], ""))
    whole, _, axis = name.rpartition(".")
    for element, item in _matches(whole) if whole and axis in ("x", "y") else ():
        if element.is_vector:
            part: VectorPart = "x" if axis == "x" else "y"
            known.append((replace(element, name=f"{element.name}.{axis}", part=part), item))
    return tuple(known)


def declared(name: str) -> tuple[Declared, str] | None:
    """The declaration of an output, and its member, by the name of the output; None if unknown."""
    return next(iter(_matches(name)), None)


@lru_cache(8192)
def _localized_label(declared: Declared, item: str, of_one: bool, language: str) -> str:
    """What a member is called in a language; a page says a hundred names at each move of a drag."""
    with speaking(language):
        text = declared.note(item).localized()
        if not Note(declared.label).is_translated:
            text = f"{text} (en)"
        return say("one row: {what}", what=text) if of_one else text


def looked_up(name: str) -> Callable[[Callable[[str], Any]], Any]:
    """What a compiled loop has by this name."""
    return lambda value: value(name)


def alike(where: str, read: Callable[..., Any], **shared: Any) -> Callable[..., None]:
    """A way to declare outputs whose names begin alike, and that are read alike.

    read : from the rest of the name (or `had`), an analysis and the member.  shared : as of
        `output`.
    parts : of a vector; those that begin with a dot go on after its name, others stand in its
        place.  loop : True where compiled loops know it by its name.
    of : makes values of what is read.
    """

    def declare(
        name: str,
        dimension: Dimension | None,
        label: str,
        parts: tuple[str, ...] = (),
        had: str = "",
        of: Callable[[Any], Any] = lambda values: values,
        **options: Any,
    ) -> None:
        options = {**shared, **options}
        if parts:
            stem = {part: where + name if part[0] == "." else where for part in parts}
            options["parts"] = tuple(stem[part] + part for part in parts)
        if options.get("loop") is True:
            options["loop"] = looked_up(name.replace("_", " "))
        output(where + name, dimension, label, **options)(
            lambda *source: of(read(had or name, *source))
        )

    return declare
