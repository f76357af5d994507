"""Keys of study files; values come through as they are, since their dimension is that of a path."""

from __future__ import annotations

from typing import Any, ClassVar

from equipoise.i18n import Note
from equipoise.keys import (
    SCHEMA_VERSION,
    VERSION,
    Anything,
    Frozen,
    KeyConditions,
    Keys,
    KeyTable,
    Listing,
    Number,
    Tables,
    TextKind,
    Whole,
    Wording,
    declared,
    inside,
    key,
)
from equipoise.keys.requirement_kinds import RequirementKeys, split_asks
from equipoise.quantities import NUMBER
from equipoise.studies.study import COMMANDS, METHODS, Sampling

SPREADS = ("range", "list", "normal", "uniform")
VALUE = Anything(
    schema={
        "anyOf": [{"type": "number"}, {"type": "string", "pattern": rf"^{NUMBER} +\S"}],
        "examples": ["60 mm"],
    }
)
"""Number and unit in quotes, or a plain number, by the dimension of what it is a value of."""
LIMITS = Listing(VALUE, (2,), Note('two limits, such as ["60 mm", "80 mm"]'))
ANY_WHOLE = Whole(most=10**18)
PATHS = Listing(TextKind(), (2,), Note("a list of two paths"))


@declared
class NormalTable(Frozen):
    """A normal spread."""

    deviation: Any = key(VALUE, "standard deviation", example="2 g")
    mean: Any = key(VALUE, "that of the model if left out", default=None)
    cut: float | None = key(Number(), "deviations beyond which nothing lies", default=None)


@declared
class UniformTable(Frozen):
    """A uniform spread."""

    half_width: Any = key(VALUE, "to either side of the centre", example="0.1 mm")
    centre: Any = key(VALUE, "that of the model if left out", default=None)


@declared
class VaryTable(Frozen):
    """A number of the model that varies: over a range or a list, or by a tolerance."""

    conditions: ClassVar[KeyConditions] = {
        "oneOf": [{"required": [spread]} for spread in SPREADS],
        "dependentRequired": {"steps": ["range"]},
    }

    path: str = key(TextKind(), "of it in the model file", example="links.crank.mass")
    range: Any = key(LIMITS, "lowest and highest", default=None)
    steps: int | None = key(ANY_WHOLE, "of a range on a grid", default=None)
    list: Any = key(
        Listing(VALUE, right=Note('a list such as ["100 g", "200 g"]')),
        "all that it can be",
        default=None,
    )
    normal: NormalTable | None = key(KeyTable(NormalTable), "a normal spread", default=None)
    uniform: UniformTable | None = key(KeyTable(UniformTable), "a uniform spread", default=None)


@declared
class CorrelationTable(Frozen):
    """Two numbers that go together."""

    between: tuple[str, str] = key(PATHS, "paths of both", example=["links.a.mass", "links.b.mass"])
    coefficient: float = key(Number(), "between -1 and 1", example=0.9)


@declared
class SamplingTable(Frozen):
    """Which designs are computed."""

    method: str = key(TextKind(suggested=(*METHODS,)), "how designs are spread", example="sobol")
    designs: int | None = key(ANY_WHOLE, "their number; not of a grid", default=None)
    seed: int | None = key(
        ANY_WHOLE, "of random numbers; not of a grid", default=None, written_default=Sampling.seed
    )


@declared
class OutputTable(Frozen):
    """A figure that is computed of every design."""

    extra_keys: ClassVar[Keys] = RequirementKeys("outputs", VALUE)

    value: str = key(
        TextKind(), "place in the JSON object of the command", example="shaking_force.y.rms"
    )
    name: str | None = key(TextKind(), "of its column; its place if left out", default=None)
    of: str | None = key(TextKind(suggested=(*COMMANDS,)), "the command that has it", default=None)
    asks: Any = inside(Anything(), factory=dict)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> OutputTable:
        return cls(**split_asks(given, cls.extra_keys))

    @classmethod
    def to_table(cls, value: OutputTable) -> dict[str, Any]:
        return {**super().to_table(value), **value.asks}


@declared
class AccuracyTable(Frozen):
    """How exactly figures of an analysis are computed."""

    conditions: ClassVar[KeyConditions] = {"maxProperties": 1}

    angles: int | None = key(ANY_WHOLE, "crank angles in a turn", default=None)
    tolerance: float | None = key(Number(), "to which figures stand still", default=None)


@declared
class StudyTable(Frozen):
    """Many designs of one model."""

    extra_keys: ClassVar[Keys] = {"schema": VERSION}
    file_order = ("schema", "title", "model", "vary", "correlations")

    model: str = key(
        TextKind(),
        "model file beside this one, or name of a bundled example",
        example="yamashita-1",
    )
    vary: tuple[VaryTable, ...] = key(Tables(KeyTable(VaryTable)), "what varies")
    sampling: SamplingTable = key(
        KeyTable(SamplingTable), "which designs are computed", example={"method": "sobol"}
    )
    outputs: tuple[OutputTable, ...] = key(Tables(KeyTable(OutputTable)), "what is computed")
    title: str | None = key(Wording(), "that of the model if left out", default=None)
    correlations: tuple[CorrelationTable, ...] = key(
        Tables(KeyTable(CorrelationTable)), "what goes together", default=()
    )
    accuracy: AccuracyTable | None = key(
        KeyTable(AccuracyTable), "how exactly figures are computed", default=None
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> StudyTable:
        del given["schema"]
        return cls(**given)

    @classmethod
    def to_table(cls, value: StudyTable) -> dict[str, Any]:
        return {**super().to_table(value), "schema": SCHEMA_VERSION}
