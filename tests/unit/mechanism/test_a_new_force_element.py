"""A kind of force element that this test declares, and then finds wherever force elements are."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, ClassVar
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exchange.formats import FORMATS, Job
from equipoise.exchange.tree import Tree
from equipoise.i18n import Note
from equipoise.keys import TextKind, declared, key
from equipoise.mechanism import Machine
from equipoise.mechanism.checks import FRAME, Bodies, unknown_link
from equipoise.mechanism.parts.element_kinds import Action, ForceElement, Placed
from equipoise.present.checks import machine_blocks
from equipoise.quantities import Dimension
from equipoise.symbols.shapes import BodyMark, circle
from support.own_kinds import (
    designs_by_numbers,
    drawn,
    exported,
    left_out_by_formats,
    machine_with,
    on_the_page,
    own_outputs,
    read_back,
    scripted,
    with_own,
)
from support.refusals import refused


@declared
class Magnet(ForceElement):
    """It draws a point of a link towards a point of the frame, by a force that falls with way."""

    called = "{what} of magnet {number}"
    list_name = "magnets"
    list_text = "magnets"
    sign = f"{__name__}:magnet_sign"
    title = "Magnets"
    group = "magnets"
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "attraction": ("force", "attraction of magnet {name}")
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {"attraction": ("least", "most")}

    link: str = key(TextKind(of="link"), "the link that it draws", example="rocker")
    point: str = key(TextKind(of="point", on="link"), "its point", example="C")
    to: str = key(TextKind(of="point"), "the point of the frame that draws it", example="S")
    attraction: float = key("force", "at the distance `reach`", example="5 N", above=0)
    reach: float = key("length", "at which it has that", default=0.1, above=0)

    @property
    def bodies(self) -> tuple[str, str]:
        return self.link, FRAME

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        return (self.link, self.point), (FRAME, self.to)

    @property
    def label(self) -> Note:
        return Note("{point} to {other}", point=self.point, other=self.to)

    @property
    def route(self) -> tuple[str, str]:
        return self.point, self.to

    def _way(self, at: Placed) -> Any:
        return at.point(FRAME, self.to) - at.point(self.link, self.point)

    def actions(self, at: Placed) -> Iterator[Action]:
        way = self._way(at)
        size2 = way.real * way.real + way.imag * way.imag
        force = way * (self.attraction * self.reach**2 / (size2 * size2**0.5))
        yield self.link, self.point, force, 0.0
        yield FRAME, self.to, -force, 0.0

    def values(self, at: Placed) -> Mapping[str, Any]:
        way = self._way(at)
        size2 = way.real * way.real + way.imag * way.imag
        return {"attraction": self.attraction * self.reach**2 / size2}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        return unknown_link(f"{where}.link", self.link, bodies)

    def demands(self) -> Iterator[Any]:
        yield self.attraction > 0

    def sentence(self) -> Note:
        return Note("Magnet at {point}", point=self.to)

    def summary(self) -> str:
        return f"magnet: {self.point} of {self.link} to {self.to}"


def magnet_sign(item: Magnet, *_: Any) -> Iterator[BodyMark]:
    """What its drawing consists of."""
    yield BodyMark(item.link, item.point, circle("spiral", 0j, 0.01))


def mjcf_site(root: ET.Element, tree: Tree, _: Job) -> None:
    """What stands for it in a file for MuJoCo."""
    for magnet in tree.machine.magnets:  # type: ignore[attr-defined]
        ET.SubElement(root.find("worldbody") or root, "site", name=f"magnet at {magnet.to}")


Magnetic = machine_with(Magnet)


def magnetic(*magnets: Magnet) -> Machine:
    return with_own(Magnetic, eq.load("spring-balanced-crank"), springs=(), magnets=magnets)


MAGNET = Magnet("rocker", "C", "S", 30.0)
MACHINE = magnetic(MAGNET)


outputs = own_outputs(Magnetic)


def test_it_is_read_written_and_refused() -> None:
    rows = '[[magnets]]\nlink = "rocker"\npoint = "C"\nto = "S"\nattraction = "30 N"\n'
    read_back(MACHINE, "magnets", rows, ("rocker", "rockr"), "magnets[1].link", "rocker")
    with refused(ModelError, "magnets[1].attraction", limit="0"):
        magnetic(Magnet("rocker", "C", "S", -1.0))


def test_analysis_has_its_force_and_its_outputs() -> None:
    actual, bare = (eq.analyze(item, 90) for item in (MACHINE, magnetic()))
    way = actual.motion.points["S"].place - actual.motion.points["C"].place
    force = way / np.abs(way) * 30.0 * (0.1 / np.abs(way)) ** 2
    np.testing.assert_allclose(
        actual.outputs["magnets.1.attraction"].values, np.abs(force), rtol=1e-12
    )
    work = (np.conj(force) * actual.motion.points["C"].place_1).real
    more = actual.forces.drive_torque - bare.forces.drive_torque
    np.testing.assert_allclose(more, -work, atol=1e-9)
    np.testing.assert_allclose(actual.forces.frame_force.value, bare.forces.frame_force.value)
    assert np.max(np.abs(actual.forces.joints["C"].value - bare.forces.joints["C"].value)) > 1.0
    text = " ".join(str(block) for block in machine_blocks(MACHINE))
    assert "magnet: C of rocker to S" in text


def test_compiled_loops_have_designs_by_its_numbers() -> None:
    def alone(attraction: float, reach: float) -> Machine | None:
        good = attraction > 0
        return magnetic(Magnet("rocker", "C", "S", attraction, reach)) if good else None

    names = ("drive_torque", "joints.C", "magnets.1.attraction")
    paths = ["magnets[1].attraction", "magnets[1].reach"]
    sizes = [(30.0, 0.1), (50.0, 0.08), (-1.0, 0.1)]
    designs_by_numbers(MACHINE, paths, names, sizes, alone)


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_have_it(tmp_path: Path) -> None:
    scripted(MACHINE, ["drive_torque", "magnets.1.attraction"], tmp_path)


def test_interactive_pages_and_fmus_have_it(tmp_path: Path) -> None:
    exported(MACHINE, "magnets.1.attraction", tmp_path)


def test_formats_write_it_as_it_says_or_leave_it_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    left_out_by_formats(MACHINE, "magnets", tmp_path)
    assert not FORMATS["mjcf"].has_kind(Magnet)
    monkeypatch.setattr(Magnet, "exports", {"mjcf": f"{__name__}:mjcf_site"})
    assert FORMATS["mjcf"].has_kind(Magnet)
    assert "magnets" not in eq.export(MACHINE, tmp_path / "mine.xml")
    assert 'name="magnet at S"' in (tmp_path / "mine.xml").read_text("utf-8")


def test_drawings_have_the_sign_that_it_names() -> None:
    _, shapes = drawn(MACHINE, "spiral")
    assert [shape.radius for shape in shapes] == [0.01]


def test_the_page_has_its_form_and_its_numbers() -> None:
    keys = ["link", "point", "to", "attraction", "reach"]
    on_the_page(MACHINE, "magnets", keys, ["attraction", "reach"])
