"""The shaft of a tool, and what sits on it and holds it: values in SI units, and their checks.

A section is given by stiffness and mass, or by the measures of a tube.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from math import inf, pi
from typing import Any, ClassVar, Literal, NamedTuple, Self, get_args

import numpy as np

from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    PLANES,
    ROW,
    File,
    Frozen,
    Key,
    KeyConditions,
    Keys,
    KeyTable,
    Number,
    Planes,
    Quantity,
    Tables,
    TextKind,
    Whole,
    declared,
    inside,
    key,
    keys_of,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import numbered, unknown
from equipoise.mechanism.parts.balance import MATERIALS as DENSITIES
from equipoise.quantities import Dimension, Measured

Theory = Literal["euler-bernoulli", "timoshenko"]


@declared
class Section(Frozen):
    """Cross-section by its stiffness and mass, EI and rho A.

    shear_stiffness : kGA, N; infinite where shear does not count.
    rotary_inertia : rho I, kg m; 0 where it does not count.
    """

    bending_stiffness: float = inside("bending stiffness", above=0)
    mass_per_length: float = inside("mass per length", above=0)
    shear_stiffness: float = inside("force", default=inf, above=0, endless=True)
    rotary_inertia: float = inside(Number(), default=0.0, at_least=0)

    def section(self, theory: Theory) -> Section:
        """The section as a theory sees it."""
        if theory == "timoshenko":
            return self
        return replace(self, shear_stiffness=inf, rotary_inertia=0.0)


@declared
class Tube(Frozen):
    """Cross-section by its measures and material; 0 inside for a rod.

    poisson_ratio : for shear.
    carried : mass per length of what runs in it and does not stiffen it.
    """

    outer_diameter: float = inside("length", above=0)
    inner_diameter: float = inside("length", at_least=0)
    youngs_modulus: float = inside("modulus", above=0)
    density: float = inside("density", above=0)
    poisson_ratio: float = inside(Number(), default=0.3)
    carried: float = inside("mass per length", default=0.0, at_least=0)

    @property
    def material(self) -> tuple[str, Material]:
        """Material of a piece, and the name of that, empty where it is no known one."""
        own = Material(self.youngs_modulus, self.density, self.poisson_ratio)
        return next((name for name, values in MATERIALS.items() if values == own), ""), own

    def section(self, theory: Theory) -> Section:
        """The section as a theory sees it; shear by the coefficient of Cowper (1966)."""
        area = pi / 4 * (self.outer_diameter**2 - self.inner_diameter**2)
        second = pi / 64 * (self.outer_diameter**4 - self.inner_diameter**4)
        plain = Section(self.youngs_modulus * second, self.density * area + self.carried)
        if theory != "timoshenko":
            return plain
        nu, ratio = self.poisson_ratio, self.inner_diameter / self.outer_diameter
        square = (1 + ratio**2) ** 2
        coefficient = 6 * (1 + nu) * square / ((7 + 6 * nu) * square + (20 + 12 * nu) * ratio**2)
        shear = coefficient * self.youngs_modulus / (2 * (1 + nu)) * area
        return replace(plain, shear_stiffness=shear, rotary_inertia=self.density * second)


class Material(NamedTuple):
    """Of a tube: youngs_modulus, Pa; density, kg/m3; poisson_ratio."""

    youngs_modulus: float
    density: float
    poisson_ratio: float = 0.3


MATERIALS = {
    "aluminium": Material(70e9, DENSITIES["aluminium"], 0.33),
    "steel": Material(210e9, DENSITIES["steel"], 0.3),
    "titanium": Material(110e9, 4500.0, 0.34),
    "magnesium": Material(45e9, 1780.0, 0.35),
}
"""The usual values of their alloys."""


def _key(
    kind: Dimension | Number | TextKind, text: str, default: Any = None, **options: Any
) -> Key:
    of = Quantity(dimension=kind) if isinstance(kind, str) else kind
    return Key("", of, text, default=default, **options)


PROFILE: Keys = {
    "mass_per_length": _key("mass per length", "goes with `bending_stiffness`"),
    "bending_stiffness": _key(
        "bending stiffness", "modulus of elasticity times second moment of area"
    ),
    "outer_diameter": _key(
        "length", "of a tube, instead of `bending_stiffness` and the mass", example="26 mm"
    ),
    "inner_diameter": _key("length", "of a tube; 0 for a rod", 0.0),
    "material": _key(TextKind(suggested=(*MATERIALS,)), "of a tube", example="aluminium"),
    "youngs_modulus": _key("modulus", "modulus of elasticity of a tube, instead of `material`"),
    "density": _key("density", "goes with `youngs_modulus`"),
    "poisson_ratio": _key(Number(), "goes with `youngs_modulus`", written_default=0.3),
    "carried": _key("mass per length", "of what runs in a tube and does not stiffen it", 0.0),
}
"""Keys of a table that has a cross-section."""
OF_MATERIAL = ("youngs_modulus", "density", "poisson_ratio")
OF_TUBE = ("outer_diameter", "inner_diameter", "material", *OF_MATERIAL, "carried")
OF_SECTION = ("bending_stiffness", "mass_per_length", "mass")
EITHER = Note("give either bending_stiffness and mass_per_length, or outer_diameter and material")


def profile_conditions(*masses: str) -> dict[str, Any]:
    """JSON Schema of a table with a section; `masses` are the keys that give its mass."""
    by_stiffness = {
        "required": ["bending_stiffness"],
        "properties": dict.fromkeys(OF_TUBE, False),
        "oneOf": [{"required": [mass]} for mass in masses],
    }
    by_measures = {
        "required": ["outer_diameter"],
        "properties": dict.fromkeys(("bending_stiffness", *masses), False),
        "oneOf": [
            {"required": ["material"], "properties": dict.fromkeys(OF_MATERIAL, False)},
            {"required": ["youngs_modulus", "density"], "properties": {"material": False}},
        ],
    }
    return {"oneOf": [by_stiffness, by_measures]}


def profile_of(given: Mapping[str, Any], linear: float | None = None) -> Section | Tube:
    """The section of a table; `linear` is its mass per length (kg/m) where that follows from more.

    Raises
    ------
    ModelError : keys are missing, or do not go together.
    """
    if "bending_stiffness" not in given:
        return _tube(given)
    for name in OF_TUBE:
        if name in given:
            raise ModelError(name, Note("has no place beside bending_stiffness; leave it out"))
    mass_per_length = given.get("mass_per_length") if linear is None else linear
    if mass_per_length is None:
        raise ModelError(
            "mass_per_length", Note("missing; give it together with bending_stiffness")
        )
    return Section(given["bending_stiffness"], mass_per_length)


def _linear(given: dict[str, Any]) -> float | None:
    """Mass per length, kg/m, where the mass of the whole shaft is given."""
    if "mass" not in given:
        return None
    if "mass_per_length" in given:
        raise ModelError("mass", Note("has no place beside mass_per_length; give one of both"))
    if given.get("segments"):
        raise ModelError(
            "mass", Note("does not determine that of each segment; give mass_per_length")
        )
    length, mass = given["length"], given["mass"]
    if mass <= 0:
        right = Note("give more than {limit:g}", limit=0)
        raise ModelError(
            "mass", Note("got {text}; {right}", text=Measured(mass, "mass"), right=right)
        )
    return mass / length if length > 0 else 0.0  # the checks of the tool refuse 0


def _tube(given: Mapping[str, Any]) -> Tube:
    if "outer_diameter" not in given:
        raise ModelError("", EITHER)
    for name in OF_SECTION:
        if name in given:
            raise ModelError(
                name, Note("has no place beside outer_diameter; carried adds to a tube")
            )
    measures = (given["outer_diameter"], given.get("inner_diameter", 0.0))
    return Tube(*measures, *_material(given), carried=given.get("carried", 0.0))


def _material(given: Mapping[str, Any]) -> Material:
    own = [name for name in OF_MATERIAL if name in given]
    if "material" not in given:
        for name, other in (("density", "youngs_modulus"), ("youngs_modulus", "density")):
            if name not in given and other in given:
                raise ModelError(name, Note("missing; give it together with {own}", own=own[0]))
        if "density" not in given:
            sentence = Note('missing; give one such as "aluminium", or youngs_modulus and density')
            raise ModelError("material", sentence)
        return Material(**{name: given[name] for name in own})
    if own:
        raise ModelError(own[0], Note("has no place beside material; give one of both"))
    if given["material"] not in MATERIALS:
        others = Note(
            "{sentence} (youngs_modulus and density stand for any other)",
            sentence=unknown(given["material"], MATERIALS, "material"),
        )
        raise ModelError("material", others)
    return MATERIALS[given["material"]]


def profile_table(profile: Section | Tube) -> dict[str, Any]:
    """What the file says of a section.

    Raises
    ------
    ModelError : it has what no file can represent.
    """
    if isinstance(profile, Section):
        if profile != profile.section("euler-bernoulli"):
            sentence = Note(
                "a file has no keys for shear_stiffness and rotary_inertia; give a Tube instead"
            )
            raise ModelError("", sentence)
        return {name: getattr(profile, name) for name in ("mass_per_length", "bending_stiffness")}
    name, values = profile.material
    made_of = {"material": name} if name else values._asdict()
    if made_of.get("poisson_ratio") == Material._field_defaults["poisson_ratio"]:
        del made_of["poisson_ratio"]
    table = {"outer_diameter": profile.outer_diameter, **made_of}
    rest = {"inner_diameter": profile.inner_diameter, "carried": profile.carried}
    return table | {name: value for name, value in rest.items() if value}


class Profiled(Frozen):
    """What has a cross-section, whose keys stand beside its own in a file."""

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Self:
        own = {name: value for name, value in given.items() if name not in {*PROFILE, "mass"}}
        return cls(**own | {"profile": profile_of(given, _linear(given))})

    @classmethod
    def to_table(cls, value: Any) -> dict[str, Any]:
        return {**super().to_table(value), **profile_table(value.profile)}


@declared
class Segment(Profiled):
    """A part of the shaft with another section, from one place to another."""

    called = to_say("{what} of segment {number}")
    extra_keys: ClassVar[Keys] = PROFILE
    conditions: ClassVar[KeyConditions] = profile_conditions("mass_per_length")

    start: float = key("length", "where it begins", name="from", example="1.2 m")
    stop: float = key("length", "where it ends", name="to", example="1.35 m")
    profile: Section | Tube = inside(KeyTable(Frozen, flat=True))


@declared
class Shaft(Profiled):
    """The shaft, free at both ends; what holds it are its stations.

    profile : its section, but where `segments` say otherwise.
    """

    extra_keys: ClassVar[Keys] = {
        **PROFILE,
        "mass": Key(
            "mass",
            Quantity(dimension="mass"),
            "of the whole shaft, instead of `mass_per_length`; only without segments",
            default=None,
        ),
    }
    file_order = ("length", *PROFILE, "mass", "loss_factor", "theory", "segments")
    conditions: ClassVar[KeyConditions] = profile_conditions("mass_per_length", "mass")

    length: float = key("length", "from end to end", example="1.5 m", above=0)
    profile: Section | Tube = inside(KeyTable(Frozen, flat=True))
    segments: tuple[Segment, ...] = key(
        Tables(KeyTable(Segment)), "parts with another section", default=()
    )
    loss_factor: float = key(
        Number(),
        "of its material: the bending stiffness times 1 + i `loss_factor` counts",
        default=0.0,
        at_least=0,
        below=1,
    )
    theory: Theory = key(
        TextKind(get_args(Theory)),
        "`timoshenko`: with shear and rotary inertia; needs the measures of tubes",
        default="euler-bernoulli",
    )

    @cached_property
    def pieces(self) -> tuple[tuple[float, float, Section], ...]:
        """Start, stop and section of each part, from end to end."""
        parts, at = [], 0.0
        for segment in sorted(self.segments, key=lambda item: item.start):
            if segment.start > at:
                parts.append((at, segment.start, self.profile.section(self.theory)))
            parts.append((segment.start, segment.stop, segment.profile.section(self.theory)))
            at = segment.stop
        if at < self.length:
            parts.append((at, self.length, self.profile.section(self.theory)))
        return tuple(parts)

    @property
    def mass(self) -> float:
        """kg."""
        return sum((stop - start) * item.mass_per_length for start, stop, item in self.pieces)


# -- what sits on it -------------------------------------------------------------------------------

Both = tuple[float, float]
"""One number for bending in the vertical plane, one for the lateral one."""
NOTHING: Both = (0.0, 0.0)
"""A stiffness or damping that is not there, in both planes."""


KEYS: dict[str, Dimension] = {
    "position": "length",
    "mass": "mass",
    "stiffness": "stiffness",
    "damping": "damping",
    "rotational_stiffness": "torsional stiffness",
    "rotational_damping": "torsional damping",
    "harness.stiffness": "stiffness",
    "harness.damping": "damping",
    "absorber.mass": "mass",
    "absorber.stiffness": "stiffness",
    "absorber.damping": "damping",
}
"""Numbers of a station that a design may change, each with its dimension."""


OF_HAND = ("mass", "stiffness", "damping")
"""What is said of a hand that has no measured impedance."""
STIFFNESS = Planes(Quantity(dimension="stiffness"))
DAMPING = Planes(Quantity(dimension="damping"))
INERTIA = Planes(Quantity(dimension="inertia"))
TURNING_STIFFNESS = Planes(Quantity(dimension="torsional stiffness"))
TURNING_DAMPING = Planes(Quantity(dimension="torsional damping"))


@declared
class Absorber(Frozen):
    """A mass on a spring and damper of its own."""

    called = to_say("{what} of the absorber")

    mass: float = key("mass", "of it", example="150 g", at_least=0)
    stiffness: Both = key(STIFFNESS, "between it and the shaft", example="50 kN/m", at_least=0)
    damping: Both = key(DAMPING, "between it and the shaft", default=NOTHING, at_least=0)


@declared
class Impedance(CsvTable):
    """Driving-point impedance of a hand against frequency, linear between its rows.

    frequency : Hz, rising.
    resistance, reactance : real and imaginary part, N s/m.
    file : name of the CSV file that it came from.
    """

    sort = "impedance"
    forms = (("frequency", "resistance", "reactance"), ("frequency", "magnitude", "phase"))
    columns: ClassVar[Mapping[str, tuple[Dimension, str]]] = {"resistance": ("damping", "N s/m")}

    frequency: tuple[float, ...] = inside(ROW)
    resistance: tuple[float, ...] = inside(ROW)
    reactance: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class Hand(Frozen):
    """What a hand with its arm is to the tool: mass, spring and damper, or a measured impedance.

    hands : how many hold on here; all else is of one.
    """

    called = to_say("{what} of the hand")
    conditions: ClassVar[KeyConditions] = {
        "if": {"required": ["impedance"]},
        "then": {"properties": dict.fromkeys(OF_HAND, False)},
        "else": {"anyOf": [{"required": [item]} for item in OF_HAND]},
    }

    mass: float = key("mass", "that moves with the tool", default=0.0, at_least=0)
    stiffness: Both = key(STIFFNESS, "to the body", default=NOTHING, at_least=0)
    damping: Both = key(DAMPING, "to the body", default=NOTHING, at_least=0)
    impedance: tuple[Impedance, ...] = key(
        Planes(File("impedance")),
        "CSV file beside this one, instead of these: `frequency [Hz],resistance [N s/m],"
        "reactance [N s/m]` or `frequency [Hz],magnitude [N s/m],phase [deg]`; a table for unlike "
        "planes",
        default=(),
        example="hand.csv",
    )
    hands: int = key(
        Whole(names=(1, 2)),
        "that hold on here; all else is of one",
        default=1,
        word=to_say("number of hands"),
    )


@declared
class Harness(Frozen):
    """The belt that carries the tool, as a spring and damper to the body."""

    called = to_say("{what} of the harness")

    stiffness: Both = key(STIFFNESS, "to the body", example="2 kN/m", at_least=0)
    damping: Both = key(DAMPING, "to the body", default=NOTHING, at_least=0)


@declared
class Station(Frozen):
    """A place of the shaft and what sits there."""

    called = to_say("{what} of the {name}")

    name: str = key(TextKind(), "by which the other tables call it", example="engine")
    position: float = key("length", "from the left end of the shaft", example="0 mm")
    mass: float = key("mass", "of a rigid body", default=0.0, at_least=0)
    inertia: Both = key(
        INERTIA,
        "of it, about the axes across the shaft, through the shaft",
        default=NOTHING,
        at_least=0,
    )
    stiffness: Both = key(STIFFNESS, "to the ground", default=NOTHING, at_least=0)
    damping: Both = key(DAMPING, "to the ground", default=NOTHING, at_least=0)
    rotational_stiffness: Both = key(
        TURNING_STIFFNESS, "to the ground, against bending", default=NOTHING, at_least=0
    )
    rotational_damping: Both = key(
        TURNING_DAMPING, "to the ground, against bending", default=NOTHING, at_least=0
    )
    absorber: Absorber | None = key(
        KeyTable(Absorber), "a mass on a spring and damper of its own", default=None
    )
    hand: Hand | None = key(KeyTable(Hand), "what a hand with its arm is to the tool", default=None)
    harness: Harness | None = key(KeyTable(Harness), "the belt that carries the tool", default=None)

    @property
    def grounded(self) -> bool:
        """Whether a spring or damper to the ground holds it."""
        return any(self.stiffness) or any(self.damping)

    def number(self, key: str) -> float | Both:
        """A number by its key, such as ``mass`` or ``harness.stiffness``, in SI units."""
        value: Any = self
        for part in key.split("."):
            value = getattr(value, part)
        result: float | Both = value
        return result


@declared
class ShaftTable(Frozen):
    """The shaft with what sits on it and holds it; a tool has both apart."""

    called = to_say("{what} of the shaft")
    extra_keys: ClassVar[Keys] = {
        **keys_of(Shaft),
        "stations": Key(
            "stations", Tables(KeyTable(Station)), "what sits on it and holds it", default=()
        ),
    }
    conditions: ClassVar[KeyConditions] = Shaft.conditions

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> tuple[Shaft, tuple[Station, ...]]:
        stations = given.pop("stations", ())
        return Shaft.from_table(given), stations

    @classmethod
    def to_table(cls, value: tuple[Shaft, tuple[Station, ...]]) -> dict[str, Any]:
        shaft, stations = value
        return {**Shaft.to_table(shaft), **({"stations": stations} if stations else {})}


def has_number(station: Station, key: str) -> bool:
    """Whether a station has what a key's number belongs to."""
    owner, dot, _ = key.partition(".")
    return not dot or getattr(station, owner) is not None


def check_key(station: Station, key: str) -> None:
    """A station must have the number that a key names."""
    known = [name for name in KEYS if has_number(station, name)]
    if key not in KEYS:
        raise UsageError(unknown(key, known, Note("number of {name!r}", name=station.name)))
    if key not in known:
        raise UsageError(
            Note(
                "{name!r} has no {key}; give it one first",
                name=station.name,
                key=key.partition(".")[0],
            )
        )


def alike(part: Station | Hand | Harness | Absorber | None) -> bool:
    """Whether each pair of numbers of a station, or of what it holds, is of two equal ones."""
    if part is None:
        return True
    if isinstance(part, Hand) and len(part.impedance) == 2:
        return part.impedance[0] == part.impedance[1]
    of_planes = (item for item in keys_of(type(part)).values() if isinstance(item.kind, Planes))
    pairs = (
        value
        for of_plane in of_planes
        if len(value := getattr(part, of_plane.field)) == len(PLANES)
    )
    within = (part.absorber, part.hand, part.harness) if isinstance(part, Station) else ()
    return all(item == other for item, other in pairs) and all(map(alike, within))


def is_damped(station: Station) -> bool:
    """Whether anything but a hand's table takes power there."""
    parts = (station, station.absorber, station.hand, station.harness)
    dampers = [part.damping for part in parts if part is not None]
    return any(map(any, [*dampers, station.rotational_damping]))


# -- checks ----------------------------------------------------------------------------------------


def wrong_shaft(shaft: Shaft) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a shaft."""
    yield from _wrong_profile("shaft", shaft.profile, shaft)
    for where, segment in numbered("shaft.segments", shaft.segments):
        if not 0 <= segment.start < segment.stop <= shaft.length:
            yield ModelError(
                where,
                Note(
                    "goes from {start} to {stop}; give a part of the shaft, which goes from "
                    "{end} to {length}",
                    start=Measured(segment.start, "length"),
                    stop=Measured(segment.stop, "length"),
                    end=Measured(0.0, "length", limit=True),
                    length=Measured(shaft.length, "length"),
                ),
            )
        yield from _wrong_profile(where, segment.profile, shaft)
    ordered = sorted(numbered("shaft.segments", shaft.segments), key=lambda place: place[1].start)
    for (before, first), (where, second) in pairwise(ordered):
        if second.start < first.stop:
            yield ModelError(
                where,
                Note(
                    "begins at {start}, where {before} still goes on to {stop}; parts must not "
                    "overlap",
                    start=Measured(second.start, "length"),
                    before=before,
                    stop=Measured(first.stop, "length"),
                ),
            )


def _wrong_profile(where: str, profile: Section | Tube, shaft: Shaft) -> Iterator[ModelError]:
    if isinstance(profile, Section):
        if shaft.theory == "timoshenko" and profile == profile.section("euler-bernoulli"):
            yield ModelError(
                f"{where}.bending_stiffness",
                Note(
                    "does not determine the shear stiffness; with theory timoshenko give the "
                    "dimensions of a tube, outer_diameter and material"
                ),
            )
        return
    inner, outer, ratio = profile.inner_diameter, profile.outer_diameter, profile.poisson_ratio
    if inner >= outer:
        yield ModelError(
            f"{where}.inner_diameter",
            Note(
                "got {inner} inside of {outer}; give less than that",
                inner=Measured(inner, "length", "mm"),
                outer=Measured(outer, "length", "mm"),
            ),
        )
    if not 0 <= ratio <= 0.5:
        yield ModelError(
            f"{where}.poisson_ratio",
            Note("got {ratio:g}; give a number from 0 to 0.5", ratio=ratio),
        )


def wrong_station(where: str, station: Station, length: float) -> Iterator[ModelError]:
    """Everything that is wrong with a station of a shaft that is so long (m)."""
    if not 0 <= station.position <= length:
        yield ModelError(
            f"{where}.position",
            Note(
                "got {position}, which is off the shaft; give {start} to {length}",
                position=Measured(station.position, "length"),
                start=Measured(0.0, "length", limit=True),
                length=Measured(length, "length"),
            ),
        )
    if station.hand is not None:
        yield from _wrong_hand(f"{where}.hand", station.hand)


def _wrong_hand(where: str, hand: Hand) -> Iterator[ModelError]:
    given = [name for name in OF_HAND if np.any(getattr(hand, name))]
    if hand.impedance and given:
        yield ModelError(
            f"{where}.{given[0]}", Note("has no place beside an impedance; leave it out")
        )
    elif not hand.impedance and not given:
        yield ModelError(
            where,
            Note("the hand has no properties; give mass, stiffness and damping, or an impedance"),
        )
    if len(hand.impedance) > 2:
        yield ModelError(
            f"{where}.impedance",
            Note(
                "got {impedance} tables; give one, or one for each plane",
                impedance=len(hand.impedance),
            ),
        )
    for table in hand.impedance:
        what = _wrong_rows(table)
        if what:
            what = at_place(table.file, what) if table.file else what
            yield ModelError(f"{where}.impedance", what)


def _wrong_rows(table: Impedance) -> Note | None:
    rows = len(table.frequency)
    if {rows} != {len(table.resistance), len(table.reactance)}:
        return Note("the columns differ in length")
    if rows < 2:
        return Note("the table has fewer than two rows; a curve needs two")
    if any(b <= a for a, b in pairwise(table.frequency)):
        return Note("the frequencies must rise from row to row")
    if table.frequency[0] <= 0:
        return Note(
            "the first frequency is {frequency:g} Hz; give more than 0",
            frequency=table.frequency[0],
        )
    least = min(table.resistance)
    if least >= 0:
        return None
    at = table.frequency[table.resistance.index(least)]
    return Note(
        "the resistance at {at:g} Hz is {least:g} N s/m; a hand only takes "
        "energy away, give 0 or more",
        at=at,
        least=least,
    )
