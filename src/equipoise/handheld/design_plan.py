"""What may be changed in a tool so that the hands feel less, and what must be kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, Literal

from equipoise.design.variables import Range, Variable
from equipoise.errors import ModelError, UsageError
from equipoise.handheld.shaft import KEYS, Station
from equipoise.i18n import Note
from equipoise.keys import (
    DependentQuantity,
    Frozen,
    KeyConditions,
    Keys,
    KeyTable,
    Listing,
    Quantity,
    Tables,
    TextKind,
    declared,
    schema_by_dimension,
)
from equipoise.keys import key as _key
from equipoise.keys.requirement_kinds import Asks, RequiredFigure, RequirementKeys, asks_of
from equipoise.mechanism.checks import numbered, unknown, wrong_speeds
from equipoise.quantities import Dimension, Measured, format_exact, parse

ResponseMeasure = Literal["rms", "peak"]
MEASURES: tuple[ResponseMeasure, ...] = ("rms", "peak")
"""Root of the mean square over the speeds of the band, and the largest."""


OUTPUTS: dict[str, Dimension] = {
    "acceleration": "acceleration",
    "force": "force",
    "added_mass": "mass",
}
"""What can be limited: the weighted acceleration of a hand's station and the force on the body at a
station, root of the mean square over time, at the worst speed of the band; mass that is added."""

SPEEDS = Listing(
    Quantity(dimension="angular speed"), (2,), Note('two such as ["6000 rpm", "8000 rpm"]')
)


def _in_si(
    given: dict[str, Any], by: str, known: Mapping[str, Dimension], what: str, **ends: str
) -> dict[str, Any]:
    """The values of a table, in SI units where their dimension follows from another of its keys.

    ends : field of each of them, with its key in the file.
    """
    if given[by] not in known:
        raise ModelError(by, unknown(given[by], known, what))
    sizes = {}
    for field, name in ends.items():
        try:
            sizes[field] = parse(given[field], known[given[by]])
        except UsageError as error:
            raise ModelError(name, error.note) from error
    return given | sizes


@declared
class DesignVariable(Frozen):
    """A number of a station that may be anything from `low` to `high`, in SI units.

    key : one of `KEYS`; of a pair of numbers both become the same.
    """

    conditions: ClassVar[KeyConditions] = schema_by_dimension("key", ("from", "to"), KEYS)

    station: str = _key(TextKind(), "name of the station", example="belt")
    key: str = _key(
        TextKind(suggested=(*KEYS,)),
        "of the station; those of a part of it with a dot",
        example="position",
    )
    low: float = _key(DependentQuantity(), "the least", name="from", example="0.1 m")
    high: float = _key(DependentQuantity(), "the most", name="to", example="0.5 m")

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> DesignVariable:
        return cls(**_in_si(given, "key", KEYS, "key of a station", low="from", high="to"))

    @classmethod
    def to_table(cls, value: DesignVariable) -> dict[str, Any]:
        ends = {"from": value.low, "to": value.high}
        texts = {name: format_exact(end, KEYS[value.key]) for name, end in ends.items()}
        return {**super().to_table(value), **texts}

    @property
    def name(self) -> str:
        """Dotted name of the variable, such as ``belt harness.stiffness``."""
        return f"{self.station} {self.key}"

    @property
    def variable(self) -> Variable:
        """What a search may change, by its path in the file; `UsageError` where the range is none.

        The path has the station's name, such as ``shaft.stations.belt.harness.stiffness``.
        """
        path = f"shaft.stations.{self.station}.{self.key}"
        return Variable(path, Range(self.low, self.high), KEYS[self.key])


@declared
class DesignLimit(Frozen, RequiredFigure):
    """Something that must not become larger, in SI units.

    requirement : what else is asked of it, by the key of a `RequirementKind`.
    """

    file_order = ("output", "station")
    extra_keys: ClassVar[Keys] = RequirementKeys(
        "limits",
        DependentQuantity(),
        needed=True,
        text="in a unit of the output",
        example="5 m/s^2",
    )
    conditions: ClassVar[KeyConditions] = schema_by_dimension("output", (*extra_keys,), OUTPUTS)

    output: str = _key(
        TextKind(suggested=(*OUTPUTS,)),
        "`acceleration`: weighted, of a station that is held; `force`: on the body, at a station; "
        "`added_mass`: all that is added",
        example="acceleration",
    )
    station: str | None = _key(TextKind(), "of an acceleration or force", default=None)

    def __init__(
        self,
        output: str,
        at_most: float | None = None,
        station: str | None = None,
        *,
        asks: Asks = (),
        **requirement: Any,
    ) -> None:
        changed = requirement if at_most is None else {"at_most": at_most, **requirement}
        asked = asks_of(changed, asks)
        for name, value in (("output", output), ("station", station), ("asks", asked)):
            object.__setattr__(self, name, value)
        self.__post_init__()
        for key, given, right in self.wrong_asks():
            raise ModelError(key, Note("got {given}; {right}", given=given, right=right))

    @property
    def most(self) -> float:
        """The most that it may be, which every limit of a tool has."""
        assert self.at_most is not None
        return self.at_most

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> DesignLimit:
        asked = {key: key for key in cls.extra_keys if key in given}
        return cls(**_in_si(given, "output", OUTPUTS, "output", **asked))

    @classmethod
    def to_table(cls, value: DesignLimit) -> dict[str, Any]:
        texts = {key: format_exact(size, OUTPUTS[value.output]) for key, size in value.asks}
        return {**super().to_table(value), **texts}


@declared
class DesignPlan(Frozen):
    """The weighted acceleration of the hands over a band of speeds is to be as small as it can be.

    Over several hands it is that of the worst.
    """

    file_order = ("speeds", "measure", "hands")

    speeds: tuple[float, float] = _key(
        SPEEDS, "lowest and highest speed of the engine", example=["6000 rpm", "8000 rpm"]
    )
    variables: tuple[DesignVariable, ...] = _key(
        Tables(KeyTable(DesignVariable)), "what may be changed", default=()
    )
    limits: tuple[DesignLimit, ...] = _key(
        Tables(KeyTable(DesignLimit)), "what must not become larger", default=()
    )
    measure: ResponseMeasure = _key(
        TextKind(MEASURES),
        "over the speeds: `rms`: root of the mean square; `peak`: the largest",
        default="rms",
    )
    hands: tuple[str, ...] = _key(
        Listing(TextKind(), right=Note('a list of names such as ["handle"]')),
        "stations that count; all that are held if left out",
        default=(),
    )


def unknown_station(where: str, name: str, stations: Sequence[Station]) -> Iterator[ModelError]:
    """A name that no station has."""
    names = [station.name for station in stations]
    if name not in names:
        yield ModelError(where, unknown(name, names, "station"))


def wrong_design(
    design: DesignPlan, stations: Sequence[Station], length: float, is_excited: bool
) -> Iterator[ModelError]:
    """Everything that is wrong with a plan for a tool.

    length : of its shaft, m.  is_excited : whether anything shakes it.
    """
    hand_names = [station.name for station in stations if station.hand is not None]
    yield from wrong_speeds("design.speeds", design.speeds)
    if design.measure not in MEASURES:
        yield ModelError("design.measure", unknown(design.measure, MEASURES, "measure"))
    if not design.variables:
        yield ModelError("design.variables", Note("there is nothing to change; give at least one"))
    if not is_excited:
        yield ModelError("design", Note("nothing shakes the tool; give [[excitations]]"))
    if not hand_names:
        yield ModelError("design", Note("no hand holds the tool; give a station a hand"))
    for number, name in enumerate(design.hands, 1):
        yield from _not_a_hand(f"design.hands[{number}]", name, hand_names)
    used = set()
    for where, variable in numbered("design.variables", design.variables):
        yield from _wrong_variable(where, variable, stations, length)
        if (variable.station, variable.key) in used:
            yield ModelError(
                where, Note("{name!r} is given twice; give one of both", name=variable.name)
            )
        used.add((variable.station, variable.key))
    for where, limit in numbered("design.limits", design.limits):
        yield from _wrong_limit(where, limit, stations, hand_names)


def _not_a_hand(where: str, name: str, hand_names: Sequence[str]) -> Iterator[ModelError]:
    if name not in hand_names:
        yield ModelError(where, unknown(name, hand_names, "station with a hand"))


def _wrong_variable(
    where: str, variable: DesignVariable, stations: Sequence[Station], length: float
) -> Iterator[ModelError]:
    yield from unknown_station(f"{where}.station", variable.station, stations)
    if variable.key not in KEYS:
        yield ModelError(f"{where}.key", unknown(variable.key, KEYS, "key of a station"))
        return
    part, dot, _ = variable.key.partition(".")
    for station in stations:
        if dot and station.name == variable.station and getattr(station, part) is None:
            yield ModelError(
                f"{where}.key",
                Note("{name!r} has no {part}; give it one", name=station.name, part=part),
            )
    low, high = (Measured(end, KEYS[variable.key]) for end in (variable.low, variable.high))
    if variable.low < 0:
        yield ModelError(f"{where}.from", Note("got {text}; give 0 or more", text=low))
    if variable.low >= variable.high:
        what = Note("got {high} after from {low}; give more than that", high=high, low=low)
        yield ModelError(f"{where}.to", what)
    if variable.key == "position" and variable.high > length:
        yield ModelError(
            f"{where}.to",
            Note(
                "got {high}, which is off the shaft; give at most {length}",
                high=high,
                length=Measured(length, "length"),
            ),
        )


def _wrong_limit(
    where: str, limit: DesignLimit, stations: Sequence[Station], hand_names: Sequence[str]
) -> Iterator[ModelError]:
    if limit.output not in OUTPUTS:
        yield ModelError(f"{where}.output", unknown(limit.output, OUTPUTS, "output"))
        return
    if limit.at_most is None:
        yield ModelError(f"{where}.at_most", Note("missing; give {key}", key="at_most"))
    elif limit.at_most < 0 or (limit.at_most == 0 and limit.output != "added_mass"):
        template = (
            "give {limit:g} or more" if limit.output == "added_mass" else "give more than {limit:g}"
        )
        least = Note(template, limit=0)
        given = Measured(limit.at_most, OUTPUTS[limit.output])
        yield ModelError(f"{where}.at_most", Note("got {text}; {right}", text=given, right=least))
    if limit.output == "added_mass":
        if limit.station is not None:
            yield ModelError(
                f"{where}.station", Note("added_mass is of the whole tool; leave it out")
            )
    elif limit.station is None:
        yield ModelError(
            f"{where}.station", Note("missing; give that of the {output}", output=limit.output)
        )
    elif limit.output == "acceleration":
        yield from _not_a_hand(f"{where}.station", limit.station, hand_names)
    else:
        touching = [station.name for station in stations if station.hand or station.harness]
        if limit.station not in touching:
            sentence = unknown(limit.station, touching, "station with a hand or harness")
            yield ModelError(f"{where}.station", sentence)
