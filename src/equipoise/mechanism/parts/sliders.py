"""Sliding joints and bearings as frozen values; what a machine is to those who see its parts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import ClassVar, Protocol

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen, TextKind, declared, key
from equipoise.mechanism.checks import (
    Bodies,
    Vector,
    unknown_body,
    unknown_link,
    unknown_point,
)
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.support import Row, Support


@declared
class Slider(Frozen):
    """A sliding joint: `point` of `link` stays on a line of the body `on`, without turning."""

    called = to_say("{what} of the guide of the {link}")
    group: ClassVar[str] = to_say("slider on a straight line")

    link: str = key(TextKind(of="link"), "the sliding link", example="piston")
    point: str = key(TextKind(of="point", on="link"), "its point on the line", example="C")
    on: str = key(
        TextKind(of="body"), 'the guiding link, or `"frame"`', example="frame", word=to_say("guide")
    )
    through: str = key(
        TextKind(of="point", on="on"),
        "a point of the guide on the line",
        example="A",
        word=to_say("point of the guide"),
    )
    direction: float = key("angle", "of the line, in the axes of the guide", example="0 deg")
    angle: float = key("angle", "of the sliding link's x axis, from the line", default=0.0)
    label: str = key(
        TextKind(),
        "its name in outputs, `LINK on BODY` if left out; a second guide of the same link on the "
        "same body needs one",
        default="",
    )

    @property
    def name(self) -> str:
        return self.label or f"{self.link} on {self.on}"


@declared
class Bearing(Frozen):
    """One of both bearings in which a link turns about its pin in the frame."""

    called = to_say("{what} of bearing {name}")

    link: str = key(
        TextKind(of="link"), "that turns in it; it has one pin in the frame", example="crank"
    )
    plane: float = key("length", "z of its middle", example="-20 mm")


class Mechanism(Protocol):
    """What a machine is to those who only look at its parts."""

    @property
    def drive(self) -> Drive: ...
    @property
    def pushers(self) -> Sequence[Drive | FurtherDrive]: ...
    @property
    def frame(self) -> Mapping[str, Vector]: ...
    @property
    def links(self) -> Mapping[str, Link]: ...
    @property
    def bodies(self) -> Bodies: ...
    @property
    def sliders(self) -> Sequence[Slider]: ...
    @property
    def couplings(self) -> Sequence[Coupling]: ...
    @property
    def rows(self) -> Sequence[Row]: ...
    @property
    def bearings(self) -> Mapping[str, Bearing]: ...
    @property
    def support(self) -> Support | None: ...
    @property
    def has_planes(self) -> bool: ...


# -- checks ----------------------------------------------------------------------------------------


def wrong_slider(where: str, slider: Slider, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with a sliding joint."""
    if problem := [*unknown_link(f"{where}.link", slider.link, bodies)]:
        yield from problem
        return
    yield from unknown_body(f"{where}.on", slider.on, bodies)
    if slider.link == slider.on:
        yield ModelError(f"{where}.on", Note("{link!r} cannot slide on itself", link=slider.link))
    if slider.on in bodies:
        yield from unknown_point(f"{where}.through", slider.through, slider.on, bodies)
    yield from unknown_point(f"{where}.point", slider.point, slider.link, bodies)
