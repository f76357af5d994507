"""What files of other programs hold of links beside each other."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import equipoise as eq
from equipoise.exchange.tree import tensor_of
from equipoise.mechanism.parts.bodies import Body
from equipoise.mechanism.parts.machine import Machine
from support.machines import make
from support.machines_planes import set_apart


def machine() -> Machine:
    """Return a slider-crank whose links lie beside each other."""
    return set_apart(make("slider_crank", 3).machine, np.random.default_rng(5))


@pytest.mark.parametrize("suffix", [".xml", ".urdf"])
def test_places_across(suffix: str, tmp_path: Path) -> None:
    """Where links hang one on another, their planes add up."""
    made, file = machine(), tmp_path / f"model{suffix}"
    eq.export(made, file)
    root = ET.parse(file).getroot()
    actual: dict[str, float] = {}
    if suffix == ".urdf":
        for joint in root.iter("joint"):
            across = float(joint.find("origin").get("xyz").split()[2])
            parent = joint.find("parent").get("link")
            actual[joint.find("child").get("link")] = actual.get(parent, 0.0) + across
    else:
        parents = {child: parent for parent in root.iter("body") for child in parent}
        for body in root.iter("body"):
            above = actual.get(parents[body].get("name"), 0.0) if body in parents else 0.0
            actual[body.get("name")] = above + float(body.get("pos").split()[2])
    for name, link in made.links.items():
        assert actual[name] == pytest.approx(link.plane)


@pytest.mark.parametrize("suffix", [".xml", ".urdf"])
def test_names_with_quotes_of_both_kinds(suffix: str, tmp_path: Path) -> None:
    """But for the name, the file of a machine whose loop is cut, across planes where it can."""
    text = (Path(eq.__file__).parent / "examples" / "yamashita-1.toml").read_text(encoding="utf-8")
    text = text.replace("[links.coupler]", '[links.coupler]\nplane = "5 mm"')
    odd, file, parts = "'\"", tmp_path / f"model{suffix}", {}
    for name, key in (("C", "C"), (odd, '"\'\\""')):
        eq.export(eq.loads(text.replace("C = ", f"{key} = ")), file)
        parts[name] = [
            {key: value.replace(odd, "C") for key, value in part.attrib.items()}
            for part in ET.parse(file).getroot().iter()
        ]
    assert parts[odd] == parts["C"]


@pytest.mark.parametrize("suffix", [".py", ".mo"])
def test_planar_formats_tell(suffix: str, tmp_path: Path) -> None:
    left_out = eq.export(machine().with_springs(()), tmp_path / f"model{suffix}")
    assert any("planes of links" in item for item in left_out)


def test_products_of_inertia_of_a_dumbbell() -> None:
    """Two points across each other: m x z of each."""
    made = make("slider_crank", 3).machine.links["crank"]
    points = [Body("point", at=(x, 0.0), mass=0.5, plane=z) for x, z in ((0.2, 0.1), (-0.2, -0.1))]
    mass, center, tensor = tensor_of(made.altered(bodies=tuple(points)))
    assert (mass, center) == (1.0, [0.0, 0.0, 0.0])
    want = [[0.01, 0.0, -0.02], [0.0, 0.05, 0.0], [-0.02, 0.0, 0.04]]
    np.testing.assert_allclose(tensor, want, atol=1e-15)
