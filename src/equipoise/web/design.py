"""What a page edits: a machine with the counterweights that are tried on it, and its steps."""

from __future__ import annotations

from abc import ABC, abstractmethod
from cmath import phase
from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from functools import cached_property
from math import cos, pi, sin
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.parts.links import MASS_FIELDS
from equipoise.mechanism.parts.machine import Drive, Link, Machine, Vector
from equipoise.mechanism.parts.shown_units import ShownUnits
from equipoise.quantities import Measured, clean, clean_place

DRAGGED = 7
"""Those of a place to which something is dragged, over the size of the machine: a page knows places
as 32-bit floats, and what it shows as 100 mm is to be that in a file, not 99.999999637 mm."""


@dataclass(frozen=True)
class Counterweight:
    """A mass on a link that is pinned to the frame.

    mass : kg.  radius : from the pin, m.  direction : in the link's axes, rad.
    gyration : radius of gyration about its own centre of mass, m; 0 of a point mass.
    """

    mass: float = 0.0
    radius: float = 0.0
    direction: float = 0.0
    gyration: float = 0.0

    @property
    def arm(self) -> complex:
        """From the pin to the mass, m."""
        return self.radius * complex(cos(self.direction), sin(self.direction))


@dataclass(frozen=True, eq=False)
class PageDraft(ABC):
    """A machine on a page, finished (`Design`) or not (`Sketch`), with what is tried on it.

    name : of the file or example.
    counterweights : by link; those of mass 0 do nothing, and keep their place.
    shafts : links that balancing has added, which balancing again replaces.
    expressions : by which numbers were given that are none of the file's, by path: lengths and
        directions of oblique lines, and counterweights.
    """

    if TYPE_CHECKING:  # a default of a field is looked up in the classes above

        @property
        def name(self) -> str: ...

        @property
        def own(self) -> Machine: ...

        @property
        def counterweights(self) -> Mapping[str, Counterweight]: ...

        @property
        def shafts(self) -> frozenset[str]: ...

        @property
        def expressions(self) -> Mapping[str, str]: ...

        @property
        def frame(self) -> Mapping[str, Vector]: ...

        @property
        def links(self) -> Mapping[str, Link]: ...

        @property
        def drive(self) -> Drive | None: ...

    drawn_keys: ClassVar[tuple[str, ...]] = ()
    """Keys of couplings that follow from where links are drawn."""

    @property
    @abstractmethod
    def units(self) -> ShownUnits | None:
        """In which its file has values shown."""

    @property
    @abstractmethod
    def parameters(self) -> Mapping[str, Any]:
        """Those of its file, by name."""

    @property
    @abstractmethod
    def known_machine(self) -> Machine | None:
        """The machine without the counterweights; None where what there is makes none yet."""

    @abstractmethod
    def with_machine(self, own: Machine) -> Self:
        """Return the draft with another machine, whose counterweights stay."""

    @abstractmethod
    def with_number(self, path: KeyPath, value: float) -> Self:
        """Return the draft with another number of the machine, by its path in the file.

        Raises
        ------
        EquipoiseError : it cannot be.
        """

    @abstractmethod
    def with_point(self, body: str, point: str, place: Vector) -> Self:
        """Return the draft with a point of a body elsewhere, in the axes of that, m."""

    @abstractmethod
    def points_about(self, body: str, keep: Iterable[str]) -> Mapping[str, Vector]:
        """Points of a body in its axes, m, with those of other bodies that are kept in place.

        keep : names of points from which one of the body keeps its distance.
        """

    def altered(self, **values: Any) -> Self:
        """Return the draft with other values of its fields."""
        return replace(self, **values)

    @cached_property
    def machine(self) -> Machine:
        """The machine with its counterweights in mass, centre of mass and inertia of the links."""
        machine = self.own
        for name, weight in self.counterweights.items():
            if weight.mass:
                link = joined(machine.links[name], weight, place_of_pin(machine, name))
                values: dict[str, Any] = {"bodies": link.bodies}
                if not link.bodies:
                    values = {mass_field: getattr(link, mass_field) for mass_field in MASS_FIELDS}
                machine = machine.with_link(name, **values)
        return machine

    def forget(self) -> None:
        """Let go of what is kept with the machine, as there are many designs in a history."""
        self.machine.forget()
        self.own.forget()

    def weight_on(self, link: str) -> Counterweight:
        """The counterweight on a link; at first without mass, but where it would do some good."""
        return self.counterweights.get(link) or _opposite(self.own, link)

    def with_weight(self, link: str, weight: Counterweight) -> Self:
        """Another counterweight on a link.

        Raises
        ------
        UsageError : its mass or radius is below 0.
        """
        for given, what in (
            (Measured(weight.mass, "mass", "g"), Note("mass")),
            (Measured(weight.radius, "length", "mm"), Note("radius")),
        ):
            if given.value < 0:
                raise UsageError(
                    Note("got a {what} of {text}; give 0 or more", what=what, text=given)
                )
        weights = {**self.counterweights, link: weight}
        return self.altered(counterweights=MappingProxyType(weights))

    def without(self, links: Iterable[str]) -> Self:
        """The counterweights of some links without mass, in their places."""
        bare = {name: replace(self.counterweights[name], mass=0.0) for name in links}
        weights = {**self.counterweights, **bare}
        return self.altered(counterweights=MappingProxyType(weights))

    def own_center(self, link: str, center: complex) -> complex:
        """Centre of mass that a link needs so that it lies there with its counterweight, m.

        Raises
        ------
        UsageError : the link has no mass of its own to be moved.
        """
        weight = self.counterweights.get(link)
        if weight is None or not weight.mass:
            return center
        mass = self.links[link].mass or 0.0
        if not mass:
            raise UsageError(
                Note(
                    "{link} has no mass but its counterweight; change that, or give the link a "
                    "mass",
                    link=link,
                )
            )
        return center + (center - place_of_pin(self.own, link) - weight.arm) * (weight.mass / mass)


DraftT = TypeVar("DraftT", bound=PageDraft)


@dataclass(frozen=True)
class Design(PageDraft):
    """A finished machine with the counterweights that are tried on it.

    own : the machine without the counterweights.  Others as of a `PageDraft`.
    """

    name: str
    own: Machine
    counterweights: Mapping[str, Counterweight] = field(default_factory=dict)
    shafts: frozenset[str] = frozenset()
    expressions: Mapping[str, str] = field(default_factory=dict)

    @property
    def frame(self) -> Mapping[str, Vector]:
        """Points of the frame, m."""
        return self.own.frame

    @property
    def links(self) -> Mapping[str, Link]:
        """Links of the machine by name."""
        return self.own.links

    @property
    def drive(self) -> Drive:
        """The first drive."""
        return self.own.drive

    @property
    def units(self) -> ShownUnits | None:
        return self.own.units

    @property
    def parameters(self) -> Mapping[str, Any]:
        return self.own.parameters

    @property
    def known_machine(self) -> Machine:
        return self.own

    def with_machine(self, own: Machine) -> Design:
        return replace(self, own=own)

    def with_number(self, path: KeyPath, value: float) -> Design:
        return self.with_machine(self.own.with_number(path, value))

    def with_point(self, body: str, point: str, place: Vector) -> Design:
        return self.with_machine(self.own.with_point(body, point, place))

    def points_about(self, body: str, keep: Iterable[str]) -> Mapping[str, Vector]:
        return self.own.points_of(body)


def fitting_counterweights(
    weights: Mapping[str, Counterweight], machine: Machine
) -> Mapping[str, Counterweight]:
    """Counterweights of links that a machine has, with a pin and a mass."""
    return MappingProxyType({
        name: weight for name, weight in weights.items()
        if name in machine.links and machine.links[name].has_mass
        and pin_of(machine, name) is not None
    })  # fmt: skip


def pin_of(machine: Machine, link: str) -> str | None:
    """The link's point in the frame; None where it has none."""
    return next((name for name in machine.links[link].points if name in machine.frame), None)


def place_of_pin(machine: Machine, link: str) -> complex:
    """Place of that point in the link's axes, m."""
    name = pin_of(machine, link)
    assert name is not None
    return complex(*machine.links[link].points[name])


def _opposite(machine: Machine, link: str) -> Counterweight:
    """No mass yet, as far from the pin as the link reaches, opposite to its centre of mass."""
    from equipoise.balancing.room import reach_of

    body, pin = machine.links[link], place_of_pin(machine, link)
    away = pin - complex(*(body.center_of_mass or (pin.real, pin.imag)))
    return Counterweight(0.0, reach_of(machine, link), phase(away) if away else pi)


def joined(link: Link, weight: Counterweight, pin: complex) -> Link:
    """A link with a counterweight on it in mass, centre of mass and inertia.

    pin : from which the weight's place is measured, in the link's axes, m.
    """
    if not weight.mass:
        return link
    place, inertia = pin + weight.arm, weight.mass * weight.gyration**2
    if link.bodies:
        return link.with_added(weight.mass, clean_place(place), clean(inertia))
    with_added = link.with_added(weight.mass, (place.real, place.imag), inertia)
    assert (
        with_added.mass is not None
        and with_added.center_of_mass is not None
        and with_added.inertia is not None
    )
    center = clean_place(complex(*with_added.center_of_mass))
    return replace(
        with_added,
        mass=clean(with_added.mass),
        center_of_mass=center,
        inertia=clean(with_added.inertia),
    )


MOST_STEPS = 500
DesignT = TypeVar("DesignT")


@dataclass(frozen=True)
class HistoryStep(Generic[DesignT]):
    """What was edited to, and what was done to get there."""

    design: DesignT
    label: str


@dataclass(frozen=True)
class History(Generic[DesignT]):
    """Steps for undo and redo, as they were made; `now` stands between `past` and `future`."""

    now: HistoryStep[DesignT]
    past: tuple[HistoryStep[DesignT], ...] = ()
    future: tuple[HistoryStep[DesignT], ...] = ()

    @property
    def first(self) -> DesignT:
        """The design that was opened, or the oldest that is kept."""
        return (*self.past, self.now)[0].design

    @property
    def undo(self) -> str | None:
        """What would be taken back."""
        return self.now.label if self.past else None

    @property
    def redo(self) -> str | None:
        """What would be done again."""
        return self.future[0].label if self.future else None

    @property
    def content(self) -> dict[str, Any]:
        """What a page shows of it: what undo and redo would do, and how many steps there are."""
        steps = [len(self.past), len(self.future)]
        return {"undo": self.undo, "redo": self.redo, "steps": steps}

    def then(self, design: DesignT, label: str) -> History[DesignT]:
        """One step more; what was taken back is forgotten."""
        return History(HistoryStep(design, label), (*self.past[1 - MOST_STEPS :], self.now))

    def undone(self) -> History[DesignT]:
        """One step back, or a `UsageError`."""
        if not self.past:
            raise UsageError(Note("there is nothing to undo"))
        return History(self.past[-1], self.past[:-1], (self.now, *self.future))

    def redone(self) -> History[DesignT]:
        """One step forth again, or a `UsageError`."""
        if not self.future:
            raise UsageError(Note("there is nothing to redo"))
        return History(self.future[0], (*self.past, self.now), self.future[1:])
