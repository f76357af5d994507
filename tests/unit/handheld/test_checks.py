"""Checks of a tool that is built in Python: one sentence that tells the place in a file."""

from __future__ import annotations

from dataclasses import replace
from math import inf, nan, pi
from typing import Any

import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.handheld.design_plan import DesignLimit, DesignPlan, DesignVariable
from equipoise.handheld.model import (
    Absorber,
    Excitation,
    Hand,
    Harness,
    Impedance,
    Operation,
    Station,
    Tool,
    Work,
)
from equipoise.handheld.shaft import Section, Segment, Shaft, Tube
from support.refusals import refused

SECTION = Section(980.0, 2.3)
TUBE = Tube(0.026, 0.023, 70e9, 2700.0)
ENGINE = Station("engine", 0.0, 3.6)
BELT = Station("belt", 0.3, harness=Harness((1500.0, 1500.0)))
HANDLE = Station("handle", 0.55, hand=Hand(0.15, (8e3, 8e3), (90.0, 90.0)))
FORCE = Excitation("engine force", "engine", force=100.0)
MOVED = DesignVariable("belt", "position", 0.2, 0.4)
DESIGN = DesignPlan((600.0, 800.0), (MOVED,))
IMPEDANCE = Impedance((20.0, 40.0), (120.0, 150.0), (-80.0, 10.0))


def tool(**changes: Any) -> Tool:
    """A tool with everything, and some of it changed; a shaft is given by its fields."""
    shaft = {"length": 1.5, "profile": SECTION, **changes.pop("shaft", {})}
    given = {
        "stations": (ENGINE, BELT, HANDLE),
        "excitations": (FORCE,),
        "operation": Operation(700.0, (600.0, 900.0), 280.0, 950.0),
        "work": (Work("mowing", 700.0, 7200.0),),
        "design": DESIGN,
    }
    return Tool("Tool", Shaft(**shaft), **{**given, **changes})


def complaint(**changes: Any) -> str:
    with pytest.raises(ModelError) as caught:
        tool(**changes)
    said = str(caught.value)
    assert "\n" not in said
    assert len(said) < 400
    return said


def test_a_tool_with_everything_is_accepted() -> None:
    tube = Tube(0.03, 0.0, 70e9, 2700.0)
    tool(shaft={"profile": TUBE, "theory": "timoshenko", "loss_factor": 0.99})
    tool(shaft={"segments": (Segment(0.0, 0.5, tube), Segment(0.5, 1.5, SECTION))})
    tool(shaft={"profile": Section(1.0, 1.0, 1e6, 1e-5), "theory": "timoshenko"})
    tool(
        design=replace(
            DESIGN, limits=(DesignLimit("added_mass", 0.0), DesignLimit("force", 1, "belt"))
        )
    )
    Tool("Bare", Shaft(1.0, SECTION))


def test_the_same_shaft_may_be_used_again() -> None:
    first = tool(shaft={"profile": TUBE})
    assert first.shaft.mass > 0  # the sections are known now
    again = first.with_station("belt", position=0.4)
    assert again.shaft is first.shaft
    assert again == first.with_station("belt", position=0.4)


SHAFTS: dict[str, tuple[dict[str, Any], str]] = {
    "length": ({"length": 0.0}, "shaft.length: got 0 m; give more than 0"),
    "loss": ({"loss_factor": -0.1}, "shaft.loss_factor: got -0.1; give 0 or more"),
    "all loss": ({"loss_factor": 1.0}, "shaft.loss_factor: got 1; give less than 1"),
    "theory": ({"theory": "timosenko"}, "shaft.theory: got 'timosenko'; give 'euler-bernoulli'"),
    "stiffness": ({"profile": Section(0.0, 1.0)}, "shaft.bending_stiffness: got 0 N m^2; give mo"),
    "mass": ({"profile": Section(1.0, -1.0)}, "shaft.mass_per_length: got -1 kg/m; give more"),
    "rotary": ({"profile": Section(1.0, 1.0, inf, -1.0)}, "shaft.rotary_inertia: got -1; give 0"),
    "shear": ({"profile": Section(1.0, 1.0, 0.0)}, "shaft.shear_stiffness: got 0 N; give more"),
    "no shear": ({"theory": "timoshenko"}, "shaft.bending_stiffness: does not determine the"),
    "wall": ({"profile": Tube(0.02, 0.02, 7e10, 2700)}, "shaft.inner_diameter: got 20 mm inside"),
    "bore": ({"profile": Tube(0.02, -0.01, 7e10, 2700)}, "shaft.inner_diameter: got -0.01 m; gi"),
    "modulus": ({"profile": Tube(0.02, 0.0, 0.0, 2700)}, "shaft.youngs_modulus: got 0 Pa; give"),
    "density": ({"profile": Tube(0.02, 0.0, 7e10, 0.0)}, "shaft.density: got 0 kg/m^3; give mo"),
    "poisson": ({"profile": replace(TUBE, poisson_ratio=0.6)}, "shaft.poisson_ratio: got 0.6; gi"),
    "carried": ({"profile": replace(TUBE, carried=-1)}, "shaft.carried: got -1 kg/m; give 0 or"),
    "infinite": ({"length": inf}, "shaft.length: got inf; give a finite number"),
    "none": ({"profile": Section(nan, 1.0)}, "shaft.bending_stiffness: got nan; give a finite"),
    "huge": ({"profile": Section(1e40, 1.0)}, "shaft.bending_stiffness: got 1e+40 in SI units,"),
    "off": ({"segments": (Segment(1.0, 1.6, SECTION),)},
            "shaft.segments[1]: goes from 1 m to 1.6 m; give a part of the shaft, which goes from"),
    "backwards": ({"segments": (Segment(1.0, 0.5, SECTION),)}, "shaft.segments[1]: goes from 1 m"),
    "overlap": ({"segments": (Segment(0.5, 1.0, SECTION), Segment(0.0, 0.6, SECTION))},
                "shaft.segments[1]: begins at 0.5 m, where shaft.segments[2] still goes on to 0.6"),
    "part": ({"segments": (Segment(0.0, 1.0, Section(-1.0, 1.0)),)},
             "shaft.segments[1].bending_stiffness: got -1 N m^2; give more than 0"),
    "many": ({"segments": (Segment(0.0, 1.0, SECTION),) * 201}, "shaft.segments: got 201; at mo"),
}  # fmt: skip


@pytest.mark.parametrize(("shaft", "said"), SHAFTS.values(), ids=SHAFTS)
def test_shafts(shaft: dict[str, Any], said: str) -> None:
    assert complaint(shaft=shaft).startswith(said)


HAND = HANDLE.hand
assert HAND is not None
STATIONS: dict[str, tuple[Station, str]] = {
    "off": (replace(ENGINE, position=-0.1), "position: got -0.1 m, which is off the shaft; give 0"),
    "name": (replace(ENGINE, name=" "), "name: is empty; give a name"),
    "long": (replace(ENGINE, name="x" * 201), "name: 201 characters; give at most 200"),
    "control": (replace(ENGINE, name="a\x1b"), "name: got 'a\\x1b'; give printable characters"),
    "mass": (replace(ENGINE, mass=-1.0), "mass: got -1 kg; give 0 or more"),
    "inertia": (replace(ENGINE, inertia=(0.0, -1.0)), "inertia.lateral: got -1 kg m^2; give"),
    "stiffness": (replace(ENGINE, stiffness=(-1.0, 0.0)), "stiffness.vertical: got -1 N/m; "),
    "damping": (replace(ENGINE, damping=(-1.0, 0.0)), "damping.vertical: got -1 N s/m; gi"),
    "turning": (replace(ENGINE, rotational_stiffness=(-1.0, 0.0)), "rotational_stiffness.vert"),
    "infinite": (replace(ENGINE, stiffness=(inf, 0.0)), "stiffness.vertical: got inf; give a"),
    "absorber": (replace(ENGINE, absorber=Absorber(-1.0, (1, 1))), "absorber.mass: got -1 kg; gi"),
    "harness": (replace(ENGINE, harness=Harness((1, -1))), "harness.stiffness.lateral: got -1 N/"),
    "hand": (replace(ENGINE, hand=Hand(-1.0)), "hand.mass: got -1 kg; give 0 or more"),
    "no hand": (replace(ENGINE, hand=Hand()), "hand: the hand has no properties; give mass, st"),
    "hands": (replace(ENGINE, hand=replace(HAND, hands=3)), "hand.hands: got 3; give 1 or 2"),
    "both": (replace(ENGINE, hand=replace(HAND, impedance=(IMPEDANCE,))),
             "hand.mass: has no place beside an impedance; leave it out"),
    "three": (replace(ENGINE, hand=Hand(impedance=(IMPEDANCE,) * 3)),
              "hand.impedance: got 3 tables; give one, or one for each plane"),
    "columns": (replace(ENGINE, hand=Hand(impedance=(replace(IMPEDANCE, reactance=(1.0,)),))),
                "hand.impedance: the columns differ in length"),
    "falling": (replace(ENGINE, hand=Hand(impedance=(replace(IMPEDANCE, frequency=(2.0, 1.0)),))),
                "hand.impedance: the frequencies must rise from row to row"),
    "active": (replace(ENGINE, hand=Hand(impedance=(replace(IMPEDANCE, resistance=(1, -1)),))),
               "hand.impedance: the resistance at 40 Hz is -1 N s/m; a hand only takes energy"),
}  # fmt: skip


@pytest.mark.parametrize(("station", "said"), STATIONS.values(), ids=STATIONS)
def test_stations(station: Station, said: str) -> None:
    changed = tuple(replace(item) for item in (BELT, HANDLE))
    assert complaint(stations=(*changed, station)).startswith(f"shaft.stations[3].{said}")


YOKE = eq.load("scotch-yoke")
EXCITATIONS: dict[str, tuple[Excitation, str]] = {
    "station": (replace(FORCE, station="engin"), ".station: no station is called 'engin'; did you"),
    "nothing": (replace(FORCE, force=None), ": give exactly one of force, unbalance and linkage"),
    "two": (replace(FORCE, linkage=YOKE), ": give exactly one of force, unbalance and linkage"),
    "force": (replace(FORCE, force=-1.0), ".force: got -1 N; give 0 or more"),
    "unbalance": (Excitation("x", "engine", unbalance=-1e-3), ".unbalance: got -0.001 kg m; give"),
    "direction": (replace(FORCE, direction="up"), ".direction: got 'up'; give 'vertical', "),  # type: ignore[arg-type]
    "turned": (Excitation("x", "engine", unbalance=1.0, direction="lateral"),
               ".direction: goes with a force; leave it out"),
    "ratio": (replace(FORCE, ratio=0.0), ".ratio: got 0; what does not turn shakes nothing"),
    "phase": (replace(FORCE, phase=nan), ".phase: got nan; give a finite number"),
    "name": (replace(FORCE, name=""), ".name: is empty; give a name"),
}  # fmt: skip


@pytest.mark.parametrize(("excitation", "said"), EXCITATIONS.values(), ids=EXCITATIONS)
def test_excitations(excitation: Excitation, said: str) -> None:
    assert complaint(excitations=(excitation,)).startswith(f"excitations[1]{said}")


def variable(station: str, key: str, low: float = 1.0, high: float = 2.0) -> DesignPlan:
    return replace(DESIGN, variables=(DesignVariable(station, key, low, high),))


def limit(output: str, station: str | None = None, at_most: float = 1.0) -> DesignPlan:
    return replace(DESIGN, limits=(DesignLimit(output, at_most, station),))


MOWING = Work("mowing", 700.0, 7200.0)
REST: dict[str, tuple[dict[str, Any], str]] = {
    "two stations": ({"stations": (ENGINE, ENGINE)}, "shaft.stations[2].name: 'engine' is given"),
    "two causes": ({"excitations": (FORCE, FORCE)}, "excitations[2].name: 'engine force' is given"),
    "many stations": ({"stations": (ENGINE,) * 201}, "shaft.stations: got 201; at most 200 are"),
    "many causes": ({"excitations": (FORCE,) * 201}, "excitations: got 201; at most 200 are"),
    "speed": ({"operation": Operation(0.0)}, "operation.speed: got 0 rad/s; give more than 0"),
    "idling": ({"operation": Operation(1.0, idling=-1.0)}, "operation.idling: got -1 rad/s; give"),
    "racing": ({"operation": Operation(1.0, (), 3.0, 2.0)}, "operation.racing: is not above idl"),
    "falling": ({"operation": Operation(1.0, (2.0, 1.0))}, "operation.speeds: got 19.0986 rpm to"),
    "still": ({"operation": Operation(1.0, (0.0, 1.0))}, "operation.speeds: got 0 rpm to 9.5493"),
    "three": ({"operation": Operation(1.0, (1.0, 2.0, 3.0))}, "operation.speeds: got 3; give the"),
    "no work": ({"work": (replace(MOWING, duration=0.0),)}, "work[1].duration: got 0 s; give more"),
    "slow work": ({"work": (replace(MOWING, speed=0.0),)}, "work[1].speed: got 0 rad/s; give more"),
    "two works": ({"work": (MOWING, MOWING)}, "work[2].name: 'mowing' is given twice; give an"),
    "long day": ({"work": (replace(MOWING, duration=90000.0),)}, "work: takes 25 h together; a "),
    "band": ({"design": replace(DESIGN, speeds=(2.0, 2.0))}, "design.speeds: got 19.0986 rpm to"),
    "measure": ({"design": replace(DESIGN, measure="mean")}, "design.measure: got 'mean'; give 'r"),
    "no change": ({"design": replace(DESIGN, variables=())}, "design.variables: there is nothing"),
    "silence": ({"excitations": ()}, "design: nothing shakes the tool; give [[excitations]]"),
    "no hand": ({"stations": (ENGINE, BELT)}, "design: no hand holds the tool; give a station a"),
    "not held": ({"design": replace(DESIGN, hands=("belt",))}, "design.hands[1]: no station with "),
    "unknown station": ({"design": variable("bel", "position", 0.1, 0.2)},
                        "design.variables[1].station: no station is called 'bel'; did you mean"),
    "unknown key": ({"design": variable("belt", "positon")}, "design.variables[1].key: no key of"),
    "lacking": ({"design": variable("handle", "absorber.mass")},
                "design.variables[1].key: 'handle' has no absorber; give it one"),
    "below": ({"design": variable("belt", "mass", -1.0)}, "design.variables[1].from: got -1 kg; "),
    "no range": ({"design": variable("belt", "mass", 2.0)}, "design.variables[1].to: got 2 kg aft"),
    "off": ({"design": variable("belt", "position", 1.0, 1.6)},
            "design.variables[1].to: got 1.6 m, which is off the shaft; give at most 1.5 m"),
    "twice": ({"design": replace(DESIGN, variables=(MOVED, MOVED))},
              "design.variables[2]: 'belt position' is given twice; give one of both"),
    "many": ({"design": replace(DESIGN, variables=(MOVED,) * 201)}, "design.variables: got 201;"),
    "output": ({"design": limit("forces")}, "design.limits[1].output: no output is called 'force"),
    "no station": ({"design": limit("force")}, "design.limits[1].station: missing; give that of"),
    "free station": ({"design": limit("acceleration", "belt")},
                     "design.limits[1].station: no station with a hand is called 'belt'; there"),
    "untouched": ({"design": limit("force", "engine")},
                  "design.limits[1].station: no station with a hand or harness is called 'engine'"),
    "mass at a station": ({"design": limit("added_mass", "belt")},
                          "design.limits[1].station: added_mass is of the whole tool; leave it"),
    "nothing left": ({"design": limit("force", "belt", 0.0)},
                     "design.limits[1].at_most: got 0 N; give more than 0"),
    "less than nothing": ({"design": limit("added_mass", None, -1.0)},
                          "design.limits[1].at_most: got -1 kg; give 0 or more"),
}  # fmt: skip


@pytest.mark.parametrize(("changes", "said"), REST.values(), ids=REST)
def test_the_rest(changes: dict[str, Any], said: str) -> None:
    assert complaint(**changes).startswith(said)


def test_titles() -> None:
    with refused(ModelError, "title", text="a\n"):
        Tool("a\n", Shaft(1.0, SECTION))


def test_a_day_may_be_full() -> None:
    tool(work=(Work("a", pi, 43200.0), Work("b", pi, 43200.0)))
