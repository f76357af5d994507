"""What `check` asks of a file is also a note of `analyze`, in print and in the JSON."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism import Motor, Resistance, TorsionSpring
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import idle_parts
from equipoise.present.checks import machine_blocks
from equipoise.results.blocks import Block, Notes
from support.chosen import DISTINCT, few


def noted(blocks: object) -> set[str]:
    return {str(n) for block in blocks if isinstance(block, Notes) for n in block.notes}  # type: ignore[attr-defined]


def with_crank(machine: Machine, **changes: object) -> Machine:
    crank = replace(machine.links["crank"], **changes)  # type: ignore[arg-type]
    return (
        machine.with_links(crank=crank)
        if hasattr(machine, "with_links")
        else replace(machine, links={**machine.links, "crank": crank})
    )


def both(machine: Machine) -> tuple[set[str], set[str], set[str]]:
    analysis = eq.analyze(machine, 36)
    blocks: list[Block] = [*analysis.blocks()]
    return noted(machine_blocks(machine)), noted(blocks), set(analysis.to_dict()["notes"])


def test_an_inertia_in_another_unit_is_asked_of() -> None:
    checked, shown, plain = both(with_crank(eq.load("yamashita-1"), inertia=1500.0))
    (asked,) = (item for item in checked if "radius of gyration" in item)
    assert asked in shown and asked in plain and "check its unit" in asked


def test_lengths_in_different_units_are_asked_of() -> None:
    machine = eq.load("slider-crank-engine")
    (name, (x, y)) = [*machine.links["crank"].points.items()][1]
    shorter = {**machine.links["crank"].points, name: (x / 1000, y / 1000)}
    checked, shown, plain = both(with_crank(machine, points=shorter))
    (asked,) = (item for item in checked if "check their units" in item)
    assert asked in shown and asked in plain
    assert not any("check their units" in item for item in both(machine)[0])


def test_a_gauge_along_a_direction_in_which_nothing_moves_is_asked_of() -> None:
    machine = eq.load("yamashita-rig")
    support = machine.support
    assert support is not None and support.pivot is not None
    assert not [*idle_parts(support)]
    (name, gauge) = next(iter(support.gauges.items()))
    arm = complex(gauge.point[0] - support.pivot[0], gauge.point[1] - support.pivot[1])
    outward = (arm.real / abs(arm), arm.imag / abs(arm), 0.0)  # a pin lets nothing move along it
    still = replace(support, gauges={name: replace(gauge, direction=outward)})
    checked, shown, plain = both(replace(machine, support=still))
    (asked,) = (item for item in checked if "reads nothing" in item)
    assert asked in shown and asked in plain and f"support.gauges.{name}" in asked


def test_what_a_machine_is_asked_is_said_once() -> None:
    for name in ("straw-walker", "cam-pusher", "sieve"):
        analysis = eq.analyze(eq.load(name), 90)
        said = [
            str(n) for block in analysis.blocks() if isinstance(block, Notes) for n in block.notes
        ]
        assert len(said) == len(set(said))
        assert set(analysis.notes) >= {item for item in said if "dead position" in item}


def test_a_table_that_the_motion_never_reaches_is_asked_of() -> None:
    """A cut counted from another point: nothing acted, and no figure showed it."""
    base = eq.load("spring-balanced-crank")
    motion = eq.move(base)
    way = abs(motion.points["F"].place - complex(*base.frame["S"]))
    along = motion.points["F"].x - base.frame["S"][0]
    angle = motion.links["rocker"].angle
    spring, torsion, cut = base.springs[0], TorsionSpring("rocker", stiffness=1.0), Resistance(
        "rocker", "F", "S", direction=0.0, positions=(0.0, 1.0), forces=(0.0, 9.0), speed=0.01
    )  # fmt: skip

    def asked(low: float, high: float, values: np.ndarray, table: str) -> set[str]:
        ends = (float(low), float(high))
        changes: dict[str, object] = {"springs": (), "torsion_springs": (), "resistances": ()}
        if table == "springs":
            own = replace(spring, stiffness=None, free_length=0.0, lengths=ends, forces=(1.0, 2.0))
            changes[table] = (own,)
        elif table == "torsion_springs":
            changes[table] = (replace(torsion, stiffness=None, angles=ends, torques=(1.0, -1.0)),)
        else:
            changes[table] = (replace(cut, positions=ends),)
        machine = replace(base, balance=None, **changes)  # type: ignore[arg-type]
        alike = [
            {note.split(":")[0] for note in notes if "so that none is reached" in note}
            for notes in both(machine)
        ]
        assert alike[0] == alike[1] == alike[2] and alike[0] <= {f"{table}[1]"}
        return alike[0]

    for table, values in (("springs", way), ("resistances", along), ("torsion_springs", angle)):
        low, high = values.min(), values.max()
        size = high - low
        assert not asked(low - size, high + size, values, table)
        assert not asked(low + 0.3 * size, low + 0.6 * size, values, table)
        assert not asked(low - size, low + 0.1 * size, values, table)
        assert asked(high + 0.1 * size, high + 0.2 * size, values, table)
        assert asked(low - 0.2 * size, low - 0.1 * size, values, table)


def test_loads_that_drive_a_machine_with_a_motor_are_asked_of() -> None:
    """The same load against the motion, and with the crank turning the other way."""
    base = eq.load("spring-balanced-crank")
    motor = Motor(no_load_speed=200.0, stall_torque=5.0)
    for force, speed in ((0.5, 1), (-0.5, 1), (0.5, -1)):
        turning = force * speed > 0
        drive = replace(base.drive, motor=motor, speed=speed * abs(base.drive.speed))
        load = eq.Load("crank", torque=force)
        machine = replace(base, drive=drive, loads=(load,), balance=None)
        _, shown, plain = both(machine)
        asked = {note for note in plain if "its motor has to brake" in note}
        assert asked <= shown and bool(asked) is turning
        if asked:  # springs and masses give back what they take
            (note,) = asked
            assert "0.5000 N m at the crank" in note or "500.0 N mm at the crank" in note
    alone = replace(base, drive=replace(base.drive, motor=motor), balance=None)
    without_motor = replace(base, loads=(eq.Load("crank", torque=0.5),), balance=None)
    for machine in (alone, without_motor):
        assert not any("has to brake" in note for note in both(machine)[2])


@pytest.mark.parametrize(("share", "brakes"), [(0.005, False), (0.02, True)])
def test_a_motor_that_brakes_by_less_than_rounding_is_not_asked_of(
    share: float, brakes: bool
) -> None:
    """A torque at the crank of some share of the RMS of what springs and masses make there."""
    base = eq.load("spring-balanced-crank").with_balance(None)
    base = replace(base, drive=replace(base.drive, motor=Motor(200.0, 5.0)))
    figures = eq.analyze(base).outputs["drive_torque"].figures
    torque = (share * figures.rms + figures.mean) * (1 if base.drive.speed > 0 else -1)
    machine = replace(base, loads=(eq.Load("crank", torque=torque),))
    assert any("has to brake" in note for note in both(machine)[2]) is brakes


@pytest.mark.parametrize("name", few(eq.examples("linkage"), DISTINCT))
def test_every_surface_has_every_remark(name: str) -> None:
    machine, analysis = eq.load(name), eq.analyze(eq.load(name))
    plain = set(analysis.to_dict()["notes"])
    assert plain <= noted(analysis.blocks())
    assert plain <= noted(machine_blocks(machine))
