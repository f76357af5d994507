"""An analysis as plain data: nested values, columns with units, tables."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures.forces import torque
from equipoise.mechanism.parts.support import Row
from equipoise.results.analysis import Analysis
from equipoise.results.blocks import Table
from equipoise.results.outputs import unit_of
from support.chosen import DISTINCT, few
from support.machines import make
from support.refusals import refused

NAMES = sorted(eq.examples("linkage"))


def analysis(name: str = "geared-counterweight", angles: Any = 12) -> Analysis:
    return eq.analyze(eq.load(name), angles)


def bare() -> Analysis:
    machine = eq.load("yamashita-1")
    given = machine.with_link("rocker", mass=None, center_of_mass=None, inertia=None)
    return eq.analyze(given, 8)


@pytest.mark.parametrize("name", few(NAMES, DISTINCT))
def test_keys(name: str) -> None:
    content = analysis(name).to_dict()
    machine = eq.load(name)
    assert list(content)[:7] == [
        "title", "speed", "acceleration", "turns", "crank_angle", "links", "points"
    ]  # fmt: skip
    assert list(content["links"]) == list(machine.links)
    along = ["stress", "axial_force", "bending_moment"]
    for name, link in content["links"].items():
        more = along if machine.links[name].section is not None else []
        assert list(link) == ["angle", "angular_velocity", "angular_acceleration", *more]
    for point in content["points"].values():
        assert list(point) == ["x", "y", "vx", "vy", "ax", "ay"]
    for joint in content["joints"].values():
        assert {"on", "by", "force_x", "force_y"} <= joint.keys()
    assert {"shaking_force", "shaking_moment", machine.drive.effort, "summary"} <= content.keys()
    assert "missing" not in content


@pytest.mark.parametrize("name", NAMES)
def test_every_array_has_one_value_a_crank_angle(name: str) -> None:
    result = analysis(name)
    for output in result.outputs:
        assert output.values.shape == result.crank_angle.shape, output.name
        assert output.values.dtype == float, output.name
        assert np.all(np.isfinite(output.values)) or output.declared.unbounded, output.name


def test_no_table_is_empty() -> None:
    """A shaft that bears no point moves none."""
    shaft = eq.Link({"A": (0.0, 0.0)}, 1.0, (0.1, 0.0), 0.2)
    result = eq.analyze(eq.Machine("", eq.Drive("shaft", 9.0), {"A": (0.0, 0.0)}, {"shaft": shaft}))
    assert all(table.rows for table in result.blocks() if isinstance(table, Table))


def test_values_are_those_of_the_analysis() -> None:
    result = analysis()
    values, forces = result.to_dict(), result.forces
    np.testing.assert_allclose(values["crank_angle"], np.arange(12) * np.pi / 6)
    np.testing.assert_array_equal(values["shaking_force"]["y"], forces.shaking_force.y)
    np.testing.assert_array_equal(values["joints"]["B"]["force_x"], forces.joints["B"].x)
    mesh = values["gears"]["rocker to counterweight"]
    assert (mesh["on"], mesh["by"]) == ("counterweight", "rocker")
    np.testing.assert_array_equal(values["points"]["A"]["vx"], result.motion.points["A"].vx)
    np.testing.assert_array_equal(values["drive_torque"], forces.drive_torque)
    assert values["about"] == {"x": 0.0, "y": 0.0}


@pytest.mark.parametrize("name", ["geared-counterweight", "quick-return", "scotch-yoke"])
def test_split_is_added_where_asked_for(name: str) -> None:
    values = analysis(name).to_dict(split=True)
    assert "by_cause" not in analysis(name).to_dict()
    for key, parts in (("by_cause", 5), ("by_link", len(values["links"]))):
        reported = values[key]
        assert reported["joints"].keys() == values["joints"].keys()
        assert reported.get("gears", {}).keys() == values.get("gears", {}).keys()
        assert len(reported["drive_torque"]) == parts
        np.testing.assert_allclose(
            sum(reported["drive_torque"].values()), values["drive_torque"], atol=1e-10
        )
        for family in ("joints", "gears"):
            for joint, whole in values.get(family, {}).items():
                total = sum(part["x"] for part in reported[family][joint].values())
                np.testing.assert_allclose(total, whole["force_x"], atol=1e-9)


def test_a_machine_without_masses() -> None:
    result = bare()
    values = result.to_dict()
    assert "missing for rocker" in values["missing"]
    assert not {"joints", "shaking_force", "drive_torque"} & values.keys()
    assert list(values["summary"]) == ["transmission.C", "four_bar"]
    assert {output.group for output in result.outputs} == {
        *("links", "points", "transmission", "centers")
    }
    with refused(UsageError, given="drive_torque"):
        result.outputs["drive_torque"]


def test_turns_are_reported_of_whole_cycles_only() -> None:
    assert analysis().to_dict()["turns"] == 1
    assert "turns" not in analysis(angles=[0.1, 0.2]).to_dict()


# -- summary ---------------------------------------------------------------------------------------


def test_summary() -> None:
    result = analysis("quick-return", 90)
    summary, sampling = result.to_dict()["summary"], result.resolved.motion.sampling
    assert list(result.summary) == [item.name for item in result.outputs.summed]
    for name in result.summary:
        signal, text = result.outputs[name].resolved, summary[name]
        mean, signal = signal @ sampling.shares, signal[sampling.curve_places]
        most = result.summary[name].peak_to_peak / 20 + 1e-8
        assert signal.max() <= text["max"] <= signal.max() + most
        assert signal.min() - most <= text["min"] <= signal.min()
        assert text["mean"] == pytest.approx(mean)
        assert text["peak"] == max(text["max"], -text["min"])
        assert text["peak_to_peak"] == text["max"] - text["min"]
        assert text == {**asdict(result.summary[name]), "peak_to_peak": text["peak_to_peak"]}
    assert "joints.block on lever.moment" in summary
    assert "four_bar" not in summary


KINKED = dict.fromkeys(
    [
        *(
            "air-compressor",
            "baler-pickup",
            "elliptic-quick-return",
            "four-stroke-engine",
            "hydraulic-loader",
        ),
        *("knife-drive", "pick-and-place", "quick-return", "rotary-transplanter"),
        *("straw-walker", "transplanter", "two-motor-mixer"),
    ],
    1e-3,
) | {"cutter-bar": 0.04}
"""By how much of its range a sample may miss an extreme: gears and belts that change sides, tables
of loads, slots along arcs and lines, laws whose jerk jumps, friction in pins that turn back; the
force of a cut, which stops at once where the knife has passed.  There samples stand, or curves are
a little off."""


@pytest.mark.parametrize("name", NAMES)
def test_extremes_are_those_of_the_machine(name: str) -> None:
    """The machine has each extreme at its crank angle, or beside it where forces jump, and nothing
    beyond it anywhere.
    """
    result = eq.analyze(eq.load(name))
    names, figures = zip(*result.summary.items(), strict=True)
    places = np.array([at for figure in figures for at in (figure.max_at, figure.min_at)])
    near = 3e-8 * result.motion.turns * np.array([[-1.0], [0.0], [1.0]])
    there = eq.analyze(result.machine, (places + near).ravel()).outputs
    everywhere = eq.analyze(result.machine, 7200 // result.motion.turns)
    beyond, missed = (1e-5, KINKED[name]) if name in KINKED else (2e-7, 1e-7)
    for k, (output, text) in enumerate(zip(names, figures, strict=True)):
        if output.startswith(("transmission.", "curved_slots.")):
            continue  # the one folds at a right angle, the other begins anew in a closed slot
        rounding = 1e-9 * text.rms + 1e-9
        some, most = (share * text.peak_to_peak + rounding for share in (beyond, missed))
        if output in there:  # all rows together need the whole cycle
            high, low = there[output].values.reshape(3, -1, 2)[:, k].T
            assert text.max <= np.max(high) + some
            assert text.min >= np.min(low) - some
        values = everywhere.outputs[output].resolved
        assert np.max(values) <= text.max + most
        assert np.min(values) >= text.min - most


def test_a_four_bar_is_described_by_its_links() -> None:
    """Of a six-bar too, where it is not plain which of the links are meant."""
    blocks = analysis("watt-six-bar").blocks()
    (table,) = [item for item in blocks if getattr(item, "title", "").startswith("Four-bar")]
    machine = analysis("watt-six-bar").four_bar
    assert machine is not None
    assert [row[:3] for row in table.rows] == [
        ("ground (fixed link)", "frame", "A, D"),
        ("crank", machine.crank, "A, B"),
        ("coupler", machine.coupler, "B, C"),
        ("rocker", machine.rocker, "D, C"),
    ]
    said = " ".join(item for block in blocks for item in getattr(block, "items", ()))
    assert "The crank can turn fully" in said


def test_summary_of_a_four_bar() -> None:
    content = analysis("yamashita-1").to_dict()["summary"]["four_bar"]
    assert content["type"] == "crank-rocker"
    assert content["a"] == pytest.approx(0.088)


# -- tables ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ("crank_angle", "rad"),
        ("links.rocker.angle", "rad"),
        ("links.rocker.angular_velocity", "rad/s"),
        ("links.rocker.angular_acceleration", "rad/s^2"),
        ("points.P.x", "m"),
        ("points.P.vy", "m/s"),
        ("points.P.ax", "m/s^2"),
        ("points.weight.x", "m"),
        ("joints.B.force_x", "N"),
        ("joints.block on lever.normal", "N"),
        ("joints.block on lever.moment", "N m"),
        ("gears.rocker to weight.tangential", "N"),
        ("gears.rocker to weight.radial", "N"),
        ("shaking_force.x", "N"),
        ("weight.y", "N"),
        ("frame_force.y", "N"),
        ("shaking_moment", "N m"),
        ("weight_moment", "N m"),
        ("frame_moment", "N m"),
        ("drive_torque", "N m"),
    ],
)
def test_units(column: str, unit: str) -> None:
    assert unit_of(column) == unit


@pytest.mark.parametrize("point", ["shaking_force", "weight", "frame_force"])
def test_points_that_are_called_like_forces(point: str) -> None:
    assert unit_of(f"points.{point}.x") == "m"


@pytest.mark.parametrize("name", ["geared-counterweight", "quick-return", "class-three"])
def test_frame_of_pandas(name: str) -> None:
    pandas = pytest.importorskip("pandas")
    result = analysis(name)
    frame = result.to_frame()
    assert isinstance(frame, pandas.DataFrame)
    assert frame.index.name == "crank_angle [rad]"
    np.testing.assert_array_equal(frame.index, result.crank_angle)
    heads = [f"{array.name} [{array.unit}]" for array in result.outputs.arrays]
    assert [str(column) for column in frame.columns] == [head.removesuffix(" []") for head in heads]
    np.testing.assert_array_equal(frame["drive_torque [N m]"], result.forces.drive_torque)


@pytest.mark.parametrize("name", ["geared-counterweight", "quick-return", "class-three"])
def test_dataset_of_xarray(name: str) -> None:
    pytest.importorskip("xarray")
    result = analysis(name)
    dataset = result.to_dataset()
    assert dict(dataset.sizes) == {"crank_angle": 12}
    assert dataset.attrs["title"] == eq.load(name).title
    assert dataset.attrs["speed"] == result.motion.speed
    assert list(dataset.data_vars) == [item.name for item in result.outputs.arrays]
    for key, array in dataset.data_vars.items():
        assert array.attrs["units"] == unit_of(str(key))
        assert array.attrs["long_name"] == result.outputs[str(key)].label()
    np.testing.assert_array_equal(dataset["drive_torque"], result.forces.drive_torque)


def test_tables_without_masses() -> None:
    names = [array.name for array in bare().outputs.arrays]
    assert "points.P.ax" in names
    assert not [name for name in names if name.startswith(("joints", "shaking", "drive"))]


def test_machine_and_four_bar_of_an_analysis() -> None:
    result = analysis("yamashita-1")
    assert result.machine is result.motion.machine
    assert result.four_bar is not None
    assert result.four_bar == eq.mechanism.four_bar(result.machine)


def test_rows_of_a_machine_that_is_pushed() -> None:
    """What pushes each row is added up, each row ahead by its phase."""
    rows = (Row(0.0, -0.5), Row(0.4 * np.pi, 0.5))
    result = eq.analyze(replace(eq.load("hydraulic-loader"), rows=rows), 45)
    first, both = (result.outputs[name].values for name in ("drive_force", "rows.drive_force"))
    np.testing.assert_allclose(both, first + np.roll(first, -9), rtol=1e-9)
    assert "rows.drive_torque" not in result.outputs
    assert {role for role, _ in torque(result).keys} == {"one", "all"}


def test_an_attribute_that_there_is_not() -> None:
    """It is refused with the sentence of Python, which offers the attribute meant."""
    with pytest.raises(AttributeError, match="'Analysis' object has no attribute 'summry'"):
        _ = bare().summry  # type: ignore[attr-defined]


def test_cams_of_a_machine_whose_forces_jump_are_listed() -> None:
    """Their pressure angles over the crank angles that resolve the jumps, as their forces are."""
    analysis = eq.analyze(make("camshaft_tappet", 0).machine)
    assert analysis.resolved is not analysis
    (table,) = (block for block in analysis.blocks()
                if isinstance(block, Table) and block.title.startswith("Cams;"))  # fmt: skip
    assert len(table.rows) == len(analysis.machine.cams)
    assert max(len(line) for line in table.rows) == len(table.columns)
