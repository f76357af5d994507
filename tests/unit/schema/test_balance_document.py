"""[balance] of the model file: read in SI units."""

from __future__ import annotations

import tomllib
from math import pi, radians

import pytest
from jsonschema import Draft202012Validator

from equipoise.mechanism.balance import (
    MATERIALS,
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    SpringChoice,
    Weight,
)
from equipoise.mechanism.objectives import MEASURED_IN
from equipoise.mechanism.outputs import DECLARED
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import BALANCE, FOUR_BAR, ROWS, SUPPORT

VALIDATOR = Draft202012Validator(json_schema())
BASE = FOUR_BAR + SUPPORT + ROWS
RPM = 2 * pi / 60


def balance_of(text: str) -> Balance:
    balance = loads(BASE + text).balance
    assert balance is not None
    return balance


# -- reading ---------------------------------------------------------------------------------------


def test_all_values_arrive_in_si_units() -> None:
    balance = balance_of(BALANCE)
    assert (balance.added_mass, balance.combine) == (0.5, "squares")
    assert balance.phases == Phases(radians(10))
    assert balance.moves == (CenterMove("crank", (-0.06, 0.02), (-0.03, 0.03)),)
    assert balance.masses == (
        AddedMass("crank", "A", Weight("sector", 0.06, 0.01, 0.008, 7850.0, at_most=0.8)),
        AddedMass("rocker", "D", Weight(mass=0.5)),
    )
    assert balance.geared == (
        GearedWeight("rocker", Weight(radius=0.04), (0.3, 2.0), pitch_radius=0.05,
                     direction=(0.0, 0.0),
                     gear_thickness=0.008, gear_density=7850.0, clear_of=("coupler",)),
        GearedWeight("crank", Weight("disc", 0.04, 0.0, 0.008, 7800.0), teeth=(17, 80),
                     module=0.002, axis=(0.1, 0.0), gear_thickness=0.008, gear_density=7800.0,
                     name="other"),
    )  # fmt: skip
    assert balance.shafts == (BalanceShafts(2, ((0.0, -0.06), (0.04, -0.06)), Weight(radius=0.03)),)
    assert balance.springs == (SpringChoice("rocker", "C", "A", 5000.0, (0.02, 0.12)),)
    assert balance.objectives == (
        Objective("shaking_moment", "peak", (1.0, 2.0), "D", 2.0),
        Objective("gauges.handle", speeds=(150 * RPM, 240 * RPM)),
    )
    assert balance.limits == (
        Limit(Objective("joints.B", "peak"), 120.0),
        Limit(Objective("shaking_force.x", "area"), ratio=0.8),
    )


def test_few_values_and_the_defaults_of_the_others() -> None:
    assert loads(FOUR_BAR).balance is None
    assert balance_of("[balance]\n") == Balance()
    assert balance_of("[balance.phases]\n") == Balance(phases=Phases())
    text = '[[balance.geared]]\ndriver = "rocker"\nratio = 1\npitch_radius = "1 cm"\nmass = "1 g"\n'
    assert balance_of(text).geared[0].ratio == (1.0, 1.0)


@pytest.mark.parametrize(
    ("output", "measure", "at_most", "value"),
    [
        ("shaking_force", "rms", "2 kN", 2000.0),
        ("joints.B.x", "peak_to_peak", "1 kgf", 9.80665),
        ("drive_torque", "peak", "3 N cm", 0.03),
        ("yaw_moment", "ripple", "3 N m", 3.0),
        ("drive_torque", "area", "2 kJ", 2000.0),
        ("gauges.handle", "peak", "2 mm", 0.002),
        ("gauges.nod", "peak", "180 deg", pi),
    ],
)
def test_units_of_limits(output: str, measure: str, at_most: str, value: float) -> None:
    text = f'[[balance.limits]]\noutput = "{output}"\nmeasure = "{measure}"\nat_most = "{at_most}"'
    assert balance_of(text).limits[0].at_most == pytest.approx(value, rel=1e-15)
    VALIDATOR.validate(tomllib.loads(BASE + text))
    assert loads(dumps(loads(BASE + text))) == loads(BASE + text)


@pytest.mark.parametrize("material", MATERIALS)
def test_materials(material: str) -> None:
    plate = 'shape = "disc"\nradius = "1 cm"\nthickness = "1 mm"\n'
    text = f'[[balance.masses]]\nlink = "crank"\nat = "A"\n{plate}material = "{material}"\n'
    assert balance_of(text).masses[0].weight.density == MATERIALS[material]
    assert f'material = "{material}"' in dumps(loads(BASE + text))
    VALIDATOR.validate(tomllib.loads(BASE + text))


def test_dimensions_of_limits_are_those_of_outputs() -> None:
    linear = {one.dimension for one in DECLARED.values() if not one.reason}
    assert linear | {"energy", "angle"} == {*MEASURED_IN}
