"""Named parameters of a model, and the units in which a reader wants values.

A number that is written as an expression, such as ``length = "=2*crank + 3 mm"``, is worked out
when the model is read.  The machine has the number, and beside it the expression, so that the
model is written as it was for as long as the number is what the expression gives.
"""

from __future__ import annotations

from collections.abc import Mapping
from keyword import iskeyword
from typing import Any, ClassVar, cast

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.keys import Frozen, Key, TextKind, declared, key, keys_of
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.checks import unknown
from equipoise.quantities import KINDS, Amount, Dimension, parse_amount, parse_expression
from equipoise.quantities.expressions import NamedAmounts, names_in, parse_number, spelled
from equipoise.quantities.reading import described, plain_unit, unit_meant
from equipoise.quantities.units import OF_UNIT


def _unit_of(dimension: Dimension) -> Any:
    return key(TextKind(tuple(KINDS[dimension].units)), f"of {dimension}", default=None)


@declared
class ShownUnits(Frozen):
    """Units by what they are of; None where the one is shown that suits the sizes."""

    wanted: ClassVar[Note] = Note("such as ShownUnits(length='in')")

    length: str | None = _unit_of("length")
    mass: str | None = _unit_of("mass")
    force: str | None = _unit_of("force")
    angle: str | None = _unit_of("angle")
    torque: str | None = _unit_of("torque")
    inertia: str | None = _unit_of("inertia")
    unbalance: str | None = _unit_of("unbalance")
    speed: str | None = _unit_of("speed")
    acceleration: str | None = _unit_of("acceleration")
    angular_speed: str | None = _unit_of("angular speed")
    angular_acceleration: str | None = _unit_of("angular acceleration")
    time: str | None = _unit_of("time")
    frequency: str | None = _unit_of("frequency")
    stiffness: str | None = _unit_of("stiffness")
    damping: str | None = _unit_of("damping")
    power: str | None = _unit_of("power")
    energy: str | None = _unit_of("energy")

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, unit in self._given().items():
            if unit not in _units(name):
                raise ModelError(
                    name,
                    Note("got {given}; {right}", given=described(unit), right=_right(name, unit)),
                )

    def _given(self) -> dict[str, str]:
        return {name: unit for name in _keys() if (unit := getattr(self, name)) is not None}

    @property
    def by_dimension(self) -> dict[Dimension, str]:
        """The given units, as `equipoise.quantities.showing` takes them."""
        return {_dimension(name): unit for name, unit in self._given().items()}


def _keys() -> Mapping[str, Key]:
    return keys_of(ShownUnits)


def _dimension(name: str) -> Dimension:
    return cast(Dimension, name.replace("_", " "))


def _units(name: str) -> tuple[str, ...]:
    return cast(TextKind, _keys()[name].kind).names


def _right(name: str, unit: str) -> Note:
    meant = unit_meant(unit, _dimension(name))
    right = Note(
        "{dimension} is shown in one of {units}",
        dimension=_dimension(name),
        units=", ".join(_units(name)),
    )
    return Note('did you mean "{meant}"? {right}', meant=meant, right=right) if meant else right


def units_of(model: Any) -> dict[Dimension, str]:
    """The units that the file of a machine or tool asks for, or that of a study's model.

    None of anything else.
    """
    of_study = getattr(model, "model", None)
    units = getattr(model if of_study is None else of_study.base(), "units", None)
    return units.by_dimension if isinstance(units, ShownUnits) else {}


def read_units(text: str) -> dict[Dimension, str]:
    """Units by dimension, from a list such as ``length=in, force=lbf`` or ``in, lbf``.

    Raises
    ------
    UsageError : there is no such unit or dimension, or there are two of a dimension.
    """
    given: dict[str, str] = {}
    for part in filter(None, map(str.strip, text.split(","))):
        name, statement, unit = (piece.strip() for piece in part.partition("="))
        name, unit = ("_".join(name.split()), plain_unit(unit)) if statement else _named(name)
        if name not in _keys():
            raise UsageError(unknown(name, _keys(), "dimension of units"))
        if unit not in _units(name):
            raise UsageError(
                Note(
                    "got {unit!r} for {dimension}; {right}",
                    unit=unit,
                    dimension=_dimension(name),
                    right=_right(name, unit),
                )
            )
        if given.setdefault(name, unit) != unit:
            raise UsageError(
                Note(
                    "got {first!r} and {second!r}, both units of {dimension}; give one",
                    first=given[name],
                    second=unit,
                    dimension=_dimension(name),
                )
            )
    return {_dimension(name): unit for name, unit in given.items()}


def _named(unit: str) -> tuple[str, str]:
    """The dimension that a unit is of, and the unit."""
    plain = plain_unit(unit)
    for name in _keys():
        if plain in _units(name):
            return name, plain
    if unit.replace(" ", "_") in _keys():
        raise UsageError(
            Note(
                'got {unit!r} without a unit; give such as "{unit}={units}"',
                unit=unit,
                units=_units(unit)[0],
            )
        )
    for name in _keys():
        if meant := unit_meant(unit, _dimension(name)):
            raise UsageError(Note("got {unit!r}; did you mean {meant!r}?", unit=unit, meant=meant))
    known = "; ".join(f"{_dimension(name)}: {', '.join(_units(name))}" for name in _keys())
    raise UsageError(Note("got {unit!r}; choose among {known}", unit=unit, known=known))


PARAMETERS = "parameters"
"""The table of a model file."""
SIGN = "="
"""Begins an expression."""
MOST = 1000
"""Parameters of a model; each may name others, so that a file could make its reading long."""


def amounts_of(parameters: object) -> NamedAmounts:
    """What the names of parameters stand for, by the name as an expression has it.

    Parameters
    ----------
    parameters : texts such as ``"33.5 mm"`` or ``"=2*crank"`` and plain numbers, by name.

    Raises
    ------
    ModelError : a name or a value cannot be used, or parameters are worked out from each other.
    """
    if not isinstance(parameters, Mapping):
        return {}  # its reader says what is wrong with it
    if len(parameters) > MOST:
        what = Note("there are {count}; give at most {most}", count=len(parameters), most=MOST)
        raise ModelError(PARAMETERS, what)
    amounts: dict[str, Amount] = {}
    given: dict[str, object] = {}
    waiting: dict[str, set[str]] = {}
    for name, value in parameters.items():
        needed, key = _named_by(name, value), spelled(name)
        if key in given:
            what = Note("{name!r} is given twice; give another name", name=name)
            raise ModelError(_place(name), what)
        given[key], waiting[key] = value, needed
    while waiting:
        ready = [name for name, of in waiting.items() if not of & waiting.keys()]
        if not ready:
            circle = _circle(waiting)
            what = Note(
                "is worked out from itself: {names}; give one of them as a number",
                names=" \N{RIGHTWARDS ARROW} ".join(circle),
            )
            raise ModelError(_place(circle[0]), what)
        for name in ready:
            try:
                amounts[name] = parse_amount(str(given[name]), amounts)
            except UsageError as error:
                raise ModelError(_place(name), error.note) from error
            del waiting[name]
    return amounts


def worked_out(expression: str, dimension: Dimension | None, names: NamedAmounts) -> float:
    """The number that an expression gives, in SI units.

    dimension : of the number; None of a plain one.

    Raises
    ------
    UsageError : it gives no such number.
    """
    if dimension is None:
        return parse_number(expression, names)
    return parse_expression(expression, dimension, names)


def _place(name: object) -> str:
    return KeyPath((PARAMETERS, str(name))).abbreviated


def _named_by(name: object, value: object) -> set[str]:
    """The names in the value of a parameter."""
    if not isinstance(name, str) or not name.isidentifier() or iskeyword(name) or name[0] == "_":
        what = Note("got {name!r}; give letters, digits and _, such as crank_2", name=str(name))
        raise ModelError(_place(name), what)
    if name in OF_UNIT:
        raise ModelError(_place(name), Note("{name} is a unit; give another name", name=name))
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        right = Note('give a quantity such as "33.5 mm", or a plain number')
        what = Note("got {given}; {right}", given=described(value), right=right)
        raise ModelError(_place(name), what)
    return names_in(value) if isinstance(value, str) else set()


def _circle(waiting: Mapping[str, set[str]]) -> list[str]:
    """Some parameters that are worked out from each other, each from the next."""
    names = [min(waiting)]
    while names[-1] not in names[:-1]:
        names.append(min(waiting[names[-1]] & waiting.keys()))
    return names[names.index(names[-1]) :]
