"""The result of balancing, and figures before and after, against analyses, responses and the
planting figures of the machines themselves."""

from __future__ import annotations

import json
from dataclasses import replace
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.balanced import Balanced
from equipoise.balancing.comparison import figures_of, worse_of
from equipoise.balancing.workshop import Change, in_short
from equipoise.mechanism.outputs.declared import DECLARED
from equipoise.mechanism.parts.balance import AddedMass, Balance, Limit, Objective, Weight

MACHINE = eq.load("yamashita-1")
CRANK = AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8))
ROCKER = AddedMass("rocker", "D", Weight("any", 0.06, at_most=0.5))
LIFT, TORQUE = Objective("shaking_force.y", "ripple"), Objective("drive_torque", "peak")
PLAN = Balance(
    masses=(CRANK, ROCKER),
    objectives=(LIFT, replace(TORQUE, weight=0.5)),
    limits=(Limit(Objective("joints.D", "peak"), ratio=1.02),),
    added_mass=0.9,
)
FOUND = eq.balance(MACHINE, PLAN)


def with_figures(result: Balanced, before: dict[str, float], after: dict[str, float]) -> Balanced:
    """The result as if it had these figures."""
    result = replace(result)
    result.__dict__.update(before=before, after=after, _shaking=(before, after))
    return result


def test_figures_are_those_of_the_analysis() -> None:
    for machine, figures in ((MACHINE, FOUND.before), (FOUND.machine, FOUND.after)):
        analysis = eq.analyze(machine, acceleration=0.0)
        forces, summary = analysis.forces, analysis.summary
        moment, torque = forces.shaking_moment, forces.drive_torque
        wanted = {
            "mass": sum(link.mass for link in machine.links.values()),
            "shaking_force.rms": np.sqrt(np.mean(forces.shaking_force.size**2)),
            "shaking_force.x.peak": summary["shaking_force.x"].peak,
            "shaking_force.y.rms": np.sqrt(np.mean(forces.shaking_force.y**2)),
            "shaking_moment.rms": np.sqrt(np.mean(moment**2)),
            "shaking_moment.area": 2 * pi * np.mean(np.abs(moment)),
            "drive_torque.ripple": np.std(torque),
            "drive_torque.peak_to_peak": summary["drive_torque"].peak_to_peak,
            **{f"joints.{name}.peak": summary[f"joints.{name}"].peak for name in forces.joints},
        }
        assert wanted == pytest.approx({name: figures[name] for name in wanted}, rel=1e-12)


def test_objectives_are_read_off_the_machines() -> None:
    for machine, k in ((MACHINE, 0), (FOUND.machine, 1)):
        analysis = eq.analyze(machine, acceleration=0.0)
        forces, torque = analysis.forces, analysis.summary["drive_torque"].peak
        assert FOUND.objectives[LIFT.name][k] == pytest.approx(np.std(forces.shaking_force.y))
        assert FOUND.objectives[TORQUE.name][k] == pytest.approx(torque, rel=1e-11)


def test_cost_bound_and_gap() -> None:
    shares = {name: after / before for name, (before, after) in FOUND.objectives.items()}
    assert FOUND.cost == pytest.approx(shares[LIFT.name] + 0.5 * shares[TORQUE.name])
    assert FOUND.bound <= FOUND.cost < 1.5
    assert FOUND.gap == pytest.approx((FOUND.cost - FOUND.bound) / 1.5)
    assert FOUND.gap < 1e-8


def test_limits_are_kept() -> None:
    assert FOUND.after["joints.D.peak"] <= 1.02 * FOUND.before["joints.D.peak"] * (1 + 1e-8)
    assert FOUND.added_mass <= 0.9 + 1e-8
    assert FOUND.added_mass == pytest.approx(
        sum(change.values["mass"] for change in FOUND.changes), rel=1e-9
    )
    for change, most in zip(FOUND.changes, (0.8, 0.5), strict=True):
        assert change.values["mass"] <= most + 1e-9


@pytest.mark.parametrize(
    ("name", "wider"),
    [
        ("mass on rocker", lambda h: {"masses": (CRANK, heavier(ROCKER, h))}),
        ("added mass", lambda h: {"added_mass": 0.9 + h}),
        ("peak of joints.D", lambda h: {"limits": (Limit(Objective("joints.D", "peak"),
                                                          at_most=JOINT + 1e2 * h),)}),
    ],
)  # fmt: skip
def test_prices_are_differences(name: str, wider: object) -> None:
    """Of the combined objective, for one SI unit more of the limit."""
    step = 1e-4
    more, less = (
        eq.balance(MACHINE, replace(PLAN, **wider(sign * step))).cost  # type: ignore[operator]
        for sign in (1, -1)
    )
    unit = 1e2 if name.startswith("peak") else 1.0
    difference = (less - more) / (2 * step * unit)
    assert FOUND.prices[name].price == pytest.approx(difference, rel=1e-3, abs=1e-5)


JOINT = 1.02 * FOUND.before["joints.D.peak"]


def heavier(added: AddedMass, more: float) -> AddedMass:
    assert added.weight.at_most is not None
    return replace(added, weight=replace(added.weight, at_most=added.weight.at_most + more))


def test_changes_make_the_machine() -> None:
    """Pieces screwed onto the old links are the new links."""
    for change in FOUND.changes:
        old, new = MACHINE.links[change.link], FOUND.machine.links[change.link]
        bodies = [(old.mass, complex(*old.center_of_mass), old.inertia)]
        bodies += [(p["mass"], complex(*p["place"]), 0.0) for p in change.values["pieces"]]
        mass = sum(m for m, _, _ in bodies)
        center = sum(m * at for m, at, _ in bodies) / mass
        inertia = sum(own + m * abs(at - center) ** 2 for m, at, own in bodies)
        assert new.mass == pytest.approx(mass)
        assert new.center_of_mass == pytest.approx((center.real, center.imag))
        assert new.inertia == pytest.approx(inertia, rel=1e-7)


def test_angles_of_a_sector_are_those_that_can_be_marked_out() -> None:
    """Tenths of a degree, where a plan's optimum has more; none of what is whole."""
    piece = {"shape": "sector", "angle": 3.14145, "direction": -3.0469, "outer_radius": 0.06,
             "inner_radius": 0.0, "thickness": 0.01, "density": 7850.0, "mass": 0.4,
             "place": (0.0, 0.0)}  # fmt: skip
    values = {"at": "A", "center": (0.0, 0.0), "pieces": [piece], "mass": 0.4, "moment": 0.01,
              "direction": 0.0, "radius": 0.025}  # fmt: skip
    (line,) = in_short(Change("added mass", "crank", values))
    assert "180° wide, its middle at -174.6°" in line


def test_equivalent_speeds_give_the_old_figures() -> None:
    assert FOUND.equivalent_speeds
    for name, speed in FOUND.equivalent_speeds.items():
        faster = figures_of(eq.analyze(FOUND.machine.with_drive(speed=speed)))
        assert faster[name] == pytest.approx(FOUND.before[name], rel=1e-9)


def test_json() -> None:
    content = json.loads(json.dumps(FOUND.to_dict(), default=np.ndarray.tolist))
    wanted = {"before", "after", "changes", "gap", "prices", "bound", "cost", "objectives", "notes"}
    assert wanted <= set(content)
    assert content["before"] == pytest.approx(FOUND.before)
    assert content["objectives"][LIFT.name]["after"] == FOUND.objectives[LIFT.name][1]
    assert content["prices"]["added mass"]["at_most"] == 0.9
    assert [change["link"] for change in content["changes"]] == ["crank", "rocker"]
    assert "shaking_force.y" in content["sensitivities"]
    assert content["planting_kept"] is None


def test_units_of_objectives_and_limits() -> None:
    assert FOUND.units == {
        LIFT.name: "N",
        TORQUE.name: "N m",
        "peak of joints.D": "N",
        "mass on crank": "kg",
        "mass on rocker": "kg",
        "radius on crank": "m",
        "radius on rocker": "m",
        "added mass": "kg",
    }


def test_columns_before_and_after() -> None:
    columns = {name: values for name, _, values in FOUND.columns()}
    for name, machine in (("before", MACHINE), ("after", FOUND.machine)):
        force = eq.analyze(machine, 720, acceleration=0.0).forces.shaking_force
        scale = np.max(force.size)
        assert columns[f"shaking_force.y.{name}"] == pytest.approx(force.y, abs=1e-12 * scale)
    assert len(columns) == 9


def test_equivalent_speed_of_what_is_gone() -> None:
    before = {"shaking_force.rms": 4.0, "shaking_moment.rms": 1.0, "drive_torque.rms": 2.0}
    after = {"shaking_force.rms": 1.0, "shaking_moment.rms": 1e-17, "drive_torque.rms": 1.0}
    slow = replace(FOUND, original=MACHINE.with_drive(speed=10.0))
    assert with_figures(slow, before, after).equivalent_speeds == {"shaking_force.rms": 20.0}


def test_columns_cover_the_longer_cycle() -> None:
    """A shaft that is back after two turns."""
    gear = eq.Gear("crank", "wheel", ratio=-0.5)
    wheel = eq.Link({"W": (0.0, 0.0)}, 0.1, (0.01, 0.0), 1e-5)
    geared = replace(
        MACHINE,
        frame={**MACHINE.frame, "W": (0.1, 0.1)},
        links={**MACHINE.links, "wheel": wheel},
        gears=(gear,),
    )
    columns = replace(FOUND, machine=geared).columns()
    assert all(len(values) == 1440 for _, _, values in columns)
    before = {name: values for name, _, values in columns}["shaking_force.x.before"]
    assert before[:720] == pytest.approx(before[720:], abs=1e-9)


def test_planting_stays_as_it_is() -> None:
    machine = eq.load("transplanter")
    drive = machine.drive.link
    at = next(iter(machine.links[drive].points))
    plan = Balance(
        masses=(AddedMass(drive, at, Weight("any", 0.05, at_most=0.5)),),
        objectives=(LIFT,),
    )
    balanced = eq.balance(machine, plan)
    assert balanced.planting_kept is True
    assert any(name.startswith("planting.") for name in balanced.before)
    off = {name: value * (1 + 1e-6) for name, value in balanced.after.items()}
    assert with_figures(balanced, balanced.before, off).planting_kept is False
    assert with_figures(balanced, balanced.before, {}).planting_kept is False
    assert with_figures(balanced, {"mass": 1.0}, {"mass": 2.0}).planting_kept is None


def test_figures_of_gauges_and_rows() -> None:
    machine = eq.load("riding-transplanter")
    figures = figures_of(eq.analyze(machine, acceleration=0.0))
    gauge = eq.respond(machine).gauges["roll"].displacement
    assert figures["gauges.roll.peak_to_peak"] == pytest.approx(gauge.peak_to_peak)
    angles = np.arange(720) * pi / 360
    force = sum(
        eq.forces(eq.move(machine, angles + row.phase, acceleration=0.0)).shaking_force.value
        for row in machine.rows
    )
    assert figures["rows.shaking_force.rms"] == pytest.approx(np.sqrt(np.mean(np.abs(force) ** 2)))


def test_every_output_that_is_compared_may_get_worse() -> None:
    names = [f"{value.named('a')}.rms" for value in DECLARED.values() if "rms" in value.compared]
    assert {"bearings.a.rms", "cams.a.rms", "belts.a.pull.rms"} & {*names}
    result = worse_of(dict.fromkeys(names, 1.0), dict.fromkeys(names, 2.0), {})
    assert {f"{item.objective.output}.rms" for item in result} == {*names}
