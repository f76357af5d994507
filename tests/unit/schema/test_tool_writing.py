"""Writing files of tools: what is read again is exactly what was written."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from equipoise.errors import ModelError, UsageError
from equipoise.handheld.model import Hand, Impedance, Tool
from equipoise.handheld.shaft import Section
from equipoise.mechanism.parts.machine import LoadTable, Machine
from equipoise.schema import examples, load
from equipoise.schema.documents import dumps, save
from equipoise.schema.models import files_of, load_tool, loads_tool
from support.chosen import drawn
from support.refusals import refused
from unit.schema.samples import changed
from unit.schema.tool_samples import EVERY_TOOL, TOOL

TABLE = Impedance((20.0, 40.0, 1e3 / 3), (0.0, 150.0, 1 / 3), (-80.0, 1e-7, 10.0), "hand.csv")


TOGETHER = (
    ("length", "start", "stop", "position", "low", "high"),
    ("outer_diameter", "inner_diameter"),
    ("speed", "speeds", "idling", "racing"),
)
BOUNDED = ("poisson_ratio", "loss_factor", "duration")


def held_by(*tables: Impedance) -> Tool:
    """A tool with a hand of such impedances."""
    return loads_tool(TOOL).with_station("handle", hand=Hand(impedance=tables))


def shaken_by(machine: Machine, file: str = "") -> Tool:
    """A tool that a linkage shakes."""
    tool = loads_tool(TOOL)
    (force,) = tool.excitations
    return replace(tool, excitations=(replace(force, force=None, linkage=machine, file=file),))


# -- text ------------------------------------------------------------------------------------------


def test_a_file_is_written_as_people_write_it() -> None:
    text = TOOL.replace('mass = "3.6 kg"', 'mass = "3.6 kg"\ninertia = "2500 kg mm^2"')
    assert dumps(loads_tool(text)) == text


def test_everything_survives() -> None:
    tool = loads_tool(EVERY_TOOL)
    assert loads_tool(dumps(tool)) == tool
    assert dumps(loads_tool(dumps(tool))) == dumps(tool)


@pytest.mark.parametrize("name", examples("tool"))
def test_examples_survive(name: str) -> None:
    tool = load_tool(name)
    assert loads_tool(dumps(tool)) == tool


@given(st.data())
@settings(max_examples=drawn(40))
def test_random_edits_survive(data: st.DataObject) -> None:
    factors: dict[str, float] = {}

    def draw(name: str, old: float) -> float:
        if name not in factors:
            most = 1.0 if name in BOUNDED else 100.0
            same = next((names for names in TOGETHER if name in names), (name,))
            factors.update(dict.fromkeys(same, data.draw(st.floats(0.01, most) | st.just(1.0))))
        return old * factors[name]

    tool = changed(loads_tool(EVERY_TOOL), draw)
    assert loads_tool(dumps(tool)) == tool


size = st.floats(1e-20, 1e20)
pairs = st.tuples(size | st.just(0.0), size | st.just(0.0))


@given(pairs, pairs, pairs, size, st.text(max_size=5).filter(str.isprintable))
def test_any_numbers_and_names_survive(
    inertia: tuple[float, float],
    stiffness: tuple[float, float],
    damping: tuple[float, float],
    mass: float,
    name: str,
) -> None:
    assume(name.strip())
    tool = loads_tool(TOOL)
    station = replace(
        tool.stations[0], name=name, mass=mass, inertia=inertia, rotational_stiffness=stiffness
    )
    harnessed = replace(tool.stations[1], name=f"{name}2", stiffness=stiffness, damping=damping)
    shaken = replace(tool.excitations[0], station=name, phase=mass, ratio=-mass)
    tool = replace(tool, stations=(station, harnessed), excitations=(shaken,))
    assert loads_tool(dumps(tool)) == tool


def test_nothing_is_written_that_a_file_cannot_tell() -> None:
    tool = loads_tool(TOOL)
    profile = Section(980.0, 2.3, shear_stiffness=1e6)
    with refused(ModelError, "shaft"):
        dumps(replace(tool, shaft=replace(tool.shaft, profile=profile)))


def test_what_has_no_file_is_not_dumped() -> None:
    with refused(ModelError, "excitations[1].linkage"):
        dumps(shaken_by(load("scotch-yoke")))
    with refused(ModelError, "shaft.stations[2].hand.impedance"):
        dumps(held_by(replace(TABLE, file="")))
    with refused(ModelError, "shaft.stations[2].hand.impedance.lateral"):
        dumps(held_by(TABLE, replace(TABLE, file="")))
    assert 'hand.impedance = "hand.csv"\n' in dumps(held_by(TABLE))
    assert 'linkage = "engine.toml"\n' in dumps(shaken_by(load("scotch-yoke"), "engine.toml"))


def test_an_example_that_was_changed_is_not_dumped() -> None:
    lighter = load("scotch-yoke").with_link("yoke", mass=1.0)
    with refused(ModelError, "excitations[1].linkage", file="scotch-yoke"):
        dumps(shaken_by(lighter, "scotch-yoke"))


# -- files -----------------------------------------------------------------------------------------


def saved(tool: Tool, folder: Path) -> list[str]:
    """Save a tool; the names of its files, after reading them again."""
    path = folder / "a.toml"
    save(tool, path)
    written = sorted(folder.iterdir())
    assert sorted(files_of(tool, path)) == written
    assert load_tool(path) == tool
    return [file.name for file in written]


def test_saving_and_loading(tmp_path: Path) -> None:
    assert saved(loads_tool(EVERY_TOOL), tmp_path) == ["a.toml"]


def test_impedances_are_saved_beside(tmp_path: Path) -> None:
    names = saved(held_by(TABLE, replace(TABLE, reactance=(0.0, 1.0, 2.0))), tmp_path)
    assert names == ["a.impedance-1.csv", "a.impedance-2.csv", "a.toml"]


def test_linkages_are_saved_beside(tmp_path: Path) -> None:
    lighter = load("scotch-yoke").with_link("yoke", mass=1.0)
    table = LoadTable((0.0, pi), ((1.0, 2.0), (0.0, 1.0)))
    (load_,) = load("slider-crank-engine").loads
    pushed = replace(load_, force=None, table=table, outside="hold")
    loaded = replace(load("slider-crank-engine"), loads=(pushed,))
    tool = shaken_by(lighter, "scotch-yoke")
    (first,) = tool.excitations
    second = replace(first, name="second", linkage=loaded)
    third = replace(first, name="third", linkage=load("scotch-yoke"))
    assert saved(replace(tool, excitations=(first, second, third)), tmp_path) == [
        "a.linkage-1.toml",
        "a.linkage-2.load-1.csv",
        "a.linkage-2.toml",
        "a.toml",
    ]


def test_a_file_that_would_hide_an_example(tmp_path: Path) -> None:
    (tmp_path / "scotch-yoke").write_text("something else")
    save(shaken_by(load("scotch-yoke"), "scotch-yoke"), tmp_path / "a.toml")
    assert (tmp_path / "a.linkage-1.toml").is_file()
    assert load_tool(tmp_path / "a.toml").excitations[0].linkage == load("scotch-yoke")


@pytest.mark.parametrize("name", ["missing/tool.toml", "."])
def test_places_that_cannot_be_written(tmp_path: Path, name: str) -> None:
    with refused(UsageError, place=str(tmp_path / name)):
        save(loads_tool(TOOL), tmp_path / name)
    assert not list(tmp_path.iterdir())
