"""Units in which a reader wants values: the table `units` of a file, and the option `--units`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, cast

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.keys import Frozen, Key, TextKind, declared, key, keys_of
from equipoise.mechanism.checks import unknown
from equipoise.quantities import KINDS, Dimension
from equipoise.quantities.reading import described, plain_unit, unit_meant


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
        """Those that are given, as `equipoise.quantities.showing` takes them."""
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
