"""What parts do not bear, and a motor does not give, heads what is said of a machine."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.balancing.blocks import balanced_headline
from equipoise.errors import ModelError
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Weight
from equipoise.mechanism.parts.joint_properties import JointProperties, RollingBearing
from equipoise.mechanism.parts.links import LinkSection
from equipoise.mechanism.parts.motors import Motor, MotorTable
from equipoise.results.analysis_blocks import verdict_blocks
from equipoise.results.blocks import Text
from equipoise.results.yardsticks import assess, verdict


def engine() -> eq.Machine:
    return replace(eq.load("slider-crank-engine"), balance=None)


def with_rod(machine: eq.Machine, diameter: str) -> eq.Machine:
    section = LinkSection(
        None, diameter=diameter, elastic_modulus="206 GPa", yield_strength="355 MPa",
        fatigue_limit="180 MPa",
    )  # fmt: skip
    return replace(
        machine, links=machine.links | {"rod": replace(machine.links["rod"], section=section)}
    )


def with_life(machine: eq.Machine, life: float) -> eq.Machine:
    rod = machine.links["rod"]
    assert rod.section is not None
    rod = replace(rod, section=replace(rod.section, life=life))
    return replace(machine, links=machine.links | {"rod": rod})


def with_bearing(machine: eq.Machine, rating: str, life: str = "2000 h") -> eq.Machine:
    bearing = RollingBearing(rating, "15 kN", life=life)
    return replace(machine, joints=(JointProperties("joints.B", bearing=bearing),))


def with_motor(machine: eq.Machine, stall_torque: float) -> eq.Machine:
    motor = Motor(no_load_speed="3000 rpm", stall_torque=stall_torque, ratio=4)
    return replace(machine, drive=replace(machine.drive, motor=motor))


def headed(machine: eq.Machine) -> str:
    """The text that stands first of an analysis."""
    return next(iter(verdict_blocks(eq.analyze(machine)))).text


def test_a_rod_that_yields_is_the_verdict() -> None:
    machine = with_rod(engine(), "2 mm")
    analysis = eq.analyze(machine)
    stress = analysis.sections["rod"]
    assert stress.safety is not None and stress.safety < 1
    first = verdict(assess(analysis))
    assert first is not None and first.is_broken and first.output == "sections.rod"
    least = min(stress.safety, stress.buckling_safety or 9.0, stress.fatigue_safety or 9.0)
    assert first.value == least and first.ratio == pytest.approx(1 / least)
    assert headed(machine).startswith("Safety against")


def test_a_bearing_that_misses_its_life_is_the_verdict() -> None:
    machine = with_bearing(engine(), "100 N")
    analysis = eq.analyze(machine)
    life = analysis.rolling_bearings["B"].rated_life
    first = verdict(assess(analysis))
    assert first is not None and life is not None and life < 2000 * 3600
    assert first.output == "rolling_bearings.B" and first.value == life
    assert first.ratio == pytest.approx(2000 * 3600 / life)
    assert headed(machine).startswith("Life at the wanted reliability, B: ")


@pytest.mark.parametrize(("share", "broken"), [(0.9, False), (1.1, True)])
def test_a_rod_of_finite_life_is_judged_by_the_one_that_is_wanted(
    share: float, broken: bool
) -> None:
    """Its safety against fatigue is below 1, as it is meant to be; an endless life is enough."""
    plain = with_rod(engine(), "5 mm")
    stress = eq.analyze(plain).sections["rod"]
    assert stress.fatigue_safety is not None and stress.fatigue_safety < 1 < stress.safety
    wanted = with_life(plain, share * stress.life)
    entries = {entry.figure: entry for entry in assess(eq.analyze(wanted)) if entry.is_capacity}
    assert "sections.rod.fatigue_safety" not in entries
    entry = entries["sections.rod.life"]
    assert (entry.is_broken, entry.ratio) == (broken, pytest.approx(share))
    assert headed(wanted).startswith("Life, rod: ") == broken
    assert headed(plain).startswith("Safety against fatigue, rod: ")
    thick = assess(eq.analyze(with_life(with_rod(engine(), "60 mm"), 1e9)))
    assert {entry.figure for entry in thick if entry.is_capacity} == {
        "sections.rod.safety", "sections.rod.buckling_safety",
    }  # fmt: skip


def test_a_rod_that_its_mean_stress_breaks_has_no_ratio_in_a_record() -> None:
    """Its safety is 0, of which 1 is no multiple; JSON has no infinity."""
    machine = with_rod(engine(), "0.2 mm")
    rod = machine.links["rod"]
    assert rod.section is not None
    rod = replace(rod, section=replace(rod.section, tensile_strength=190e6))
    balanced = advise(replace(machine, links=machine.links | {"rod": rod}))
    assert balanced.advice is not None
    first, *_ = (entry for entry in balanced.advice.before if entry.is_capacity)
    assert (first.figure, first.value) == ("sections.rod.fatigue_safety", 0.0)
    large = balanced.to_dict()["large"]
    record = next(item for item in large if item["figure"] == first.figure)
    assert record["ratio"] is None and record["large"] is True
    json.dumps(large, allow_nan=False)


def test_a_life_that_is_wanted_goes_with_a_fatigue_limit() -> None:
    rod = replace(engine().links["rod"], section=LinkSection(None, diameter="9 mm", life="10 h"))
    with pytest.raises(ModelError) as refused:
        eq.analyze(replace(engine(), links=engine().links | {"rod": rod}))
    assert "links.rod.section.life" in str(refused.value)
    assert "fatigue_limit" in str(refused.value)


def test_a_motor_that_is_too_weak_is_the_verdict() -> None:
    """Its largest torque at the crank is that at standstill, times the ratio."""
    pump = eq.load("quick-return")
    mean = eq.analyze(pump).summary["drive_torque"].mean
    for share, broken in ((0.9, True), (1.1, False)):
        machine = with_motor(pump, share * abs(mean) / 4)
        first = verdict(assess(eq.analyze(machine)))
        assert first is not None and (first.output == "drive.motor") == broken
    assert "the largest torque of the motor at the crank" in headed(with_motor(pump, abs(mean) / 9))


def test_what_bears_enough_is_no_verdict() -> None:
    """What is judged first is then what it is without sections, bearings and motor."""
    for machine in (with_rod(engine(), "60 mm"), with_bearing(engine(), "5000 kN")):
        entries = assess(eq.analyze(machine))
        plain = verdict(assess(eq.analyze(engine())))
        first = verdict(entries)
        assert any(entry.is_capacity for entry in entries)
        assert first is not None and plain is not None and first.figure == plain.figure


def test_balancing_says_so_before_anything_of_masses() -> None:
    """Of a machine of which nothing else is large, too."""
    first = next(iter(balanced_headline(advise(with_rod(engine(), "2 mm")), alone=True)))
    assert isinstance(first, Text) and first.text.startswith("Safety against")


def test_a_plan_of_balancing_says_what_does_not_bear_with_its_changes() -> None:
    """By the machine with the counterweight, on whose rod its mass does not act."""
    disc = Weight("disc", 0.1, mass=1.0, thickness=0.02, density=7850.0)
    plan = Balance(
        masses=(AddedMass("crank", "A", disc),), objectives=(Objective("shaking_force"),)
    )
    for diameter, broken in (("2 mm", True), ("60 mm", False)):
        balanced = eq.balance(with_rod(engine(), diameter), plan)
        first = next(iter(balanced_headline(balanced, alone=True)))
        assert isinstance(first, Text)
        assert first.text.startswith("With these changes: Safety against") == broken
        if broken:
            safety = eq.analyze(balanced.machine).sections["rod"].fatigue_safety
            assert f"rod: {safety:.4f}" in first.text


def test_the_largest_torque_of_a_motor() -> None:
    assert Motor(no_load_speed=100.0, stall_torque=2.0).largest_torque == 2.0
    assert Motor(torque=3.0).largest_torque == 3.0
    table = MotorTable((50.0, 100.0, 150.0), (4.0, 6.0, 0.0))
    assert Motor(table=table).largest_torque == 6.0
    falling = MotorTable((50.0, 100.0), (4.0, 2.0))  # on to standstill as between its rows
    assert Motor(table=falling).largest_torque == 6.0
    braking = MotorTable((-10.0, 10.0), (50.0, 4.0))  # 27 N m at standstill, between its rows
    assert Motor(table=braking).largest_torque == 27.0
