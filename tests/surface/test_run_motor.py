"""A motor that the command line puts on a crank."""

from __future__ import annotations

from pathlib import Path

import pytest

import equipoise as eq
from equipoise.mechanism.parts.motors import Motor
from surface.running import equipoise, read, refused


def test_a_motor_on_the_command_line_is_the_one_of_a_file() -> None:
    given = "no_load_speed = 288 rpm, stall_torque = 20 N m, ratio = 1.5"
    values = read("run", "transplanter", "--turns", "2", "--motor", given)
    machine = eq.load("transplanter")
    motor = Motor(288 * 3.141592653589793 / 30, 20.0, ratio=1.5)
    wanted = eq.run(machine.with_drive(motor=motor), turns=2)
    assert values["time"][-1] == pytest.approx(wanted.time[-1], rel=1e-12)
    assert values["crank_speed"][-1] == pytest.approx(wanted.crank_speed[-1], rel=1e-12)


def test_a_run_ends_and_a_motor_is_switched_off_at_an_angle() -> None:
    values = read("run", "cutter-bar", "--turns", "0.75", "--off-turns", ".25")
    turned = values["crank_angle"][-1] - values["crank_angle"][0]
    assert turned == pytest.approx(0.75 * 2 * 3.141592653589793, rel=1e-9)
    for wrong in ("0", "-1", "1e5", "x"):
        done = equipoise("run", "cutter-bar", "--turns", wrong)
        assert done.status == 2 and "give a number above 0, up to 10000" in done.err


def test_a_motor_has_tables_and_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("motor.csv").write_text("speed [rpm],torque [N m]\n0,20\n288,0\n")
    for motor in (
        "table = motor.csv",
        "dc.voltage = 24 V, dc.resistance = 0.5 ohm, dc.torque_constant = 0.05 N m/A, ratio = 20",
    ):
        done = equipoise("run", "transplanter", "--turns", "1", "--motor", motor)
        assert done.status == 0 and "1.000 turns" in done.out


@pytest.mark.parametrize(
    ("motor", "sentence"),
    [
        ("torque", "--motor: got 'torque'; give such as no_load_speed = 300 rpm"),
        ("torque = 2 N m, torque = 3 N m", "with torque twice; give it once"),
        ("speed_at_no_load = 2 rpm", "--motor: speed_at_no_load: no key is called"),
        ("no_load_speed = 300 rpm", "--motor: give either no_load_speed and stall_torque"),
        ("torque = -2 N m", "--motor: torque: got -2 N m; give more than 0"),
        ("torque = 2 mm", "--motor: torque: "),
        ("table = motor.csv", "--motor: table: motor.csv: there is no such file"),
    ],
)
def test_wrong_motors(motor: str, sentence: str) -> None:
    done = equipoise("run", "transplanter", "--motor", motor)
    assert done.status == 2 and sentence in done.err


def test_a_motor_s_number_without_a_unit_is_shown_as_it_was_given() -> None:
    shown = refused(
        equipoise("run", "transplanter", "--motor", "no_load_speed = 2000, stall_torque = 2 N m")
    )
    assert "--motor" in shown and "2000" in shown and "2000.0" not in shown
