"""Supports that `equipoise respond` and `modes` cannot answer, and odd ones that they can."""

from __future__ import annotations

import json
import math
import re
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from support.chosen import few
from surface.running import (
    changed,
    equipoise,
    example_text,
    massless,
    no_constant,
    read,
    refused,
    refuses,
    succeeded,
    written,
)

RIG = "yamashita-rig"
MODELS = ("linear", "torque", "moment", "coupled", "exact")


def test_orders_without_masses() -> None:
    line = refuses(f"analyze {written(massless())} --orders 3", "")
    assert line.startswith("model.toml: forces need mass, center_of_mass and inertia of every link")


@pytest.mark.parametrize("command", ["respond", "modes"])
def test_pictures_do_not_take_the_place_of_a_file(command: str) -> None:
    Path("file").touch()
    refuses(f"{command} {RIG} --plot file", "give the name of a folder")
    refuses(f"{command} {RIG} --plot file/new", "'file/new'; give")


# -- machines that cannot --------------------------------------------------------------------------

SPRING = """[support.mounts.spring]
point = ["10 mm", "0 mm"]             # L_E = 1.35 m from O
stiffness = "182 kgf/m"
"""
BEARING = """[support.mounts.bearing]
axis = "pitch"
torsional_damping = "0.333 kgf m s/rad"
"""
GAUGE = """[support.gauges.gauge]
point = ["160 mm", "0 mm"]            # 1.5 m from O
"""
FLAT = ("schema = 1\n", 'schema = 1\ngravity = ["0 m/s^2", "0 m/s^2"]\n')
UNCARRIED = "support.mounts: they do not carry the weight in pitch; add a mount there"
CANNOT = {
    # changes, words, what is said of the file
    "massless": ([('mass = "199 g"\ncenter_of_mass = ["12 mm", "0 mm"]\ninertia = "30 kg mm^2"  '
                   "              # assumed\n", "")], "forces need mass, center_of_mass and inert"),
    "no spring": ([(SPRING, "")], UNCARRIED),
    "no mounts": ([(SPRING, ""), (BEARING, "")], UNCARRIED),
    "pushed away": ([FLAT, (SPRING, "")], "a constant force drives the support away in pitch"),
}  # fmt: skip


RESPOND = [f"respond model.toml --csv x.csv {more}" for more in
           ("", "--model exact", "--drive", "--speed '20:30 rpm'", "--json")]  # fmt: skip
FREE = ["modes model.toml", "modes model.toml --json", "simulate model.toml '1 s'"]
"""Which a support that is pushed away has all the same."""


@pytest.mark.parametrize(
    ("name", "words"),
    [*product(CANNOT, RESPOND), *product([name for name in CANNOT if "away" not in name], FREE)],
)
def test_a_machine_that_cannot(name: str, words: str) -> None:
    changes, said = CANNOT[name]
    changed(RIG, *changes)
    assert refuses(words, said).startswith("model.toml: ")


def test_a_motor_that_never_pulls() -> None:
    """A curve that rises everywhere has no speed at which it settles."""
    Path("motor.csv").write_text("speed [rpm],torque [N m]\n0,1\n1500,2\n", encoding="utf-8")
    old = 'no_load_speed = "1500 rpm"\nstall_torque = "1.2 N m"'
    changed(RIG, (old, 'table = "motor.csv"'))
    line = refuses("respond model.toml --drive", "give a stronger motor")
    assert line.startswith("model.toml: drive.motor: its torque nowhere falls through")


# Motors that stall: tests/unit/vibration/test_transient.py.
@pytest.mark.exhaustive
def test_a_motor_too_weak_to_turn_the_crank() -> None:
    """Which stands still before the first turn is over: no speed follows from it."""
    weak = ('"1.2 N m"', '"1e-6 N m"\nmean_speed = "free"')
    changed(RIG, weak, ('inertia = "400 g cm^2"\n', ""))
    refuses("respond model.toml --drive", "model.toml: ")


HELD = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "-100 mm"]
inertia = "4 kg m^2"
freedoms = ["{0}"]

[support.mounts.spring]
point = ["0 mm", "0 mm"]
direction = "{1} deg"
stiffness = "5 kN/m"
"""
HEAVE, SURGE = HELD.format("heave", 90), HELD.format("surge", 0)
DAMPED = 'damping = "40 N s/m"\n'
WHEEL = """
schema = 1
title = "A wheel"
drive = {{ link = "wheel", speed = "{speed}" }}
frame.points.A = ["0 mm", "0 mm"]

[links.wheel]
points.A = ["0 mm", "0 mm"]
mass = "4 kg"
center_of_mass = ["{eccentric} mm", "0 mm"]
inertia = "300 kg mm^2"
"""


def wheel(support: str, eccentric: float = 10, speed: str = "193 rpm") -> str:
    """An eccentric wheel on a support."""
    return written(WHEEL.format(eccentric=eccentric, speed=speed) + support)


def test_an_undamped_resonance() -> None:
    """64 kg on 1024 N/m: just 4 rad/s, where nothing holds an undamped support."""
    exact = HEAVE.replace('"5 kN/m"', '"1024 N/m"')
    said = "resonance without damping at 4 rad/s; give"
    refuses(f"respond {wheel(exact, speed='4 rad/s')} --csv out.csv", said)
    assert read("respond", wheel(exact))


@pytest.mark.parametrize("model", few(["linear", "moment", "exact"], {"linear", "moment"}))
def test_a_range_over_an_undamped_resonance(model: str) -> None:
    """That one speed has no answer does not take away those of the others."""
    exact = HEAVE.replace('"5 kN/m"', '"1024 N/m"')
    words = ("--speed", "3:5 rad/s", "--speeds", "4", "--model", model)
    content = read("respond", wheel(exact), *words)
    values = content["gauges"]["heave"]["peak_to_peak"]
    assert content["resonances"] == [pytest.approx(4)]
    assert values[0] > 0 < values[-1]


PENDULUM = (
    (SPRING + "\n" + BEARING, '[support.mounts.hold]\naxis = "pitch"\ntorsional_stiffness = '
     '"10 N m/rad"\ntorsional_preload = "0 N m"\n'),
    ('pivot = ["-1.34 m", "0 mm"]', 'pivot = ["-0.59 m", "-1 m"]'),
    ('center_of_mass = ["-0.59 m", "0 mm"]', 'center_of_mass = ["-0.618 m", "0 mm"]'),
    ('"19.0479488 kg m^2"', '"50 kg m^2"'),
)  # fmt: skip


def test_a_support_that_falls_over() -> None:
    """It is told of the mode, beside the answer, and seen from rest."""
    path = changed(RIG, *PENDULUM)
    assert "unstable: falls over" in succeeded(equipoise("modes", path))
    assert any("no stable equilibrium" in note for note in read("respond", path)["notes"])
    moved = read("simulate", path, "4 s")["gauges"]["gauge"]["displacement"]
    assert abs(moved[-1]) > 100 * abs(moved[100])


# -- odd machines that can -------------------------------------------------------------------------

PLANE = """
[support]
mass = "60 kg"
center_of_mass = ["10 mm", "-100 mm"]
inertia = "4 kg m^2"

[support.mounts.left]
point = ["-400 mm", "-200 mm"]
stiffness = "50 kN/m"
damping = "400 N s/m"

[support.mounts.right]
point = ["400 mm", "-200 mm"]
stiffness = "50 kN/m"
damping = "400 N s/m"
one_sided = true

[support.mounts.along]
point = ["0 mm", "-200 mm"]
direction = "0 deg"
stiffness = "50 kN/m"
damping = "400 N s/m"
"""
CARRIED = ("planetary-planting-arm", "slider-crank-engine", "class-three", "transplanter",
           "geared-counterweight", "quick-return", "scotch-yoke", "kim-chung-b")  # fmt: skip


def every_model(path: str) -> dict[str, Any]:
    """What each model answers; it may say in a sentence why not."""
    actual = {}
    for model in MODELS:
        result = equipoise("respond", path, "--model", model, "--json")
        if result.status:
            assert refused(result).startswith(f"{path}: ")
        else:
            content = json.loads(result.out, parse_constant=no_constant)
            assert content["gauges"]
            assert content.get("residual", 0) < 1e-8
            actual[model] = content
    assert not re.search(r"\b(nan|inf|None)\b", succeeded(equipoise("modes", path)))
    assert read("modes", path)
    return actual


ONE_SIDED = ("planetary-planting-arm", "geared-counterweight", "kim-chung-b")
"""On which a mount may let go; to look for that takes ten times as long."""


@pytest.mark.exhaustive(but=["scotch-yoke"])
@pytest.mark.parametrize(
    "name",
    few(CARRIED, {"planetary-planting-arm", "scotch-yoke"}),
)
def test_any_linkage_on_a_support(name: str) -> None:
    """Geared ones with cycles of several turns, loads with windows, soil."""
    held = () if name in ONE_SIDED else (("one_sided = true\n", ""),)
    result = every_model(written(example_text(name) + PLANE, *held))
    assert set(result) == set(MODELS)
    exact, moment = result["exact"], result["moment"]
    assert exact["energy"]["fed_in"] == pytest.approx(exact["energy"]["lost"], rel=1e-6)
    if name == "quick-return":
        return  # it shakes its support too hard for a linear model
    for gauge, values in moment["gauges"].items():
        near = exact["gauges"][gauge]["peak_to_peak"]
        assert values["peak_to_peak"] == pytest.approx(near, rel=0.1), gauge


# Mounts that lift off: tests/secondroute/test_vibration.py.
@pytest.mark.exhaustive
def test_a_yoke_that_shakes_its_light_support_off_a_mount() -> None:
    light = (('mass = "60 kg"', 'mass = "10 kg"'), ('"4 kg m^2"', '"0.7 kg m^2"'))
    result = every_model(written(example_text("scotch-yoke") + PLANE, *light))
    assert set(result) == set(MODELS)
    exact = result["exact"]
    assert exact["mounts"]["right"]["lifts_off"] > 0.1
    assert exact["energy"]["fed_in"] == pytest.approx(exact["energy"]["lost"], rel=1e-6)


ODD = {
    "no gauges": [(GAUGE, "")],
    "flat": [FLAT, (SPRING, ""), (BEARING, "")],
    "flat with a spring": [FLAT, (BEARING, "")],
    "undamped": [(BEARING, "")],
    "overdamped": [('"0.333 kgf m s/rad"', '"1e6 N m s/rad"')],
    "heavy": [('mass = "25 kg"', 'mass = "1e20 kg"'), ('"19.0479488 kg m^2"', '"1e20 kg m^2"')],
}


@pytest.mark.exhaustive(but=["flat", "no gauges"])
@pytest.mark.parametrize("changes", ODD.values(), ids=ODD)
def test_odd_supports(changes: list[tuple[str, str]]) -> None:
    every_model(changed(RIG, *changes))


@pytest.mark.exhaustive(but=["10-support1", "10-support0"])
@pytest.mark.parametrize(
    "support", few([HEAVE, SURGE, HEAVE + DAMPED, SURGE + DAMPED], {HEAVE, SURGE + DAMPED})
)
@pytest.mark.parametrize("eccentric", [0, 10])
def test_a_wheel_that_shakes_one_way(support: str, eccentric: float) -> None:
    """One freedom, m e w^2 / (k - M w^2); damping hardly counts that far from the resonance."""
    result = every_model(wheel(support, eccentric))
    assert set(result) == set(MODELS)
    square = (193 / 60 * math.tau) ** 2
    wanted = 2 * 4 * 1e-3 * eccentric * square / abs(5000 - 64 * square)
    for content in result.values():
        (gauge,) = content["gauges"].values()
        assert gauge["peak_to_peak"] == pytest.approx(wanted, rel=2e-3, abs=1e-12)


def test_links_without_mass_move_nothing() -> None:
    masses = [(f'mass = "{mass} g"', 'mass = "0 g"') for mass in (199, 687, 259)]
    inertias = [(f'inertia = "{own} kg mm^2"', 'inertia = "0 kg mm^2"') for own in (30, 1500, 300)]
    result = every_model(changed(RIG, *masses, *inertias))
    assert set(result) == set(MODELS)
    for content in result.values():
        assert content["gauges"]["gauge"]["peak_to_peak"] < 1e-12


def test_a_float_that_hangs_in_the_air() -> None:
    """Left out of small motion, with a note."""
    gap = ("one_sided = true", 'one_sided = true\npreload = "-50 N"')
    path = changed("walking-transplanter", gap)
    content = read("respond", path, "--speed", "150 rpm", "--model", "linear")
    assert "float has no contact at rest and is ignored" in content["notes"]
