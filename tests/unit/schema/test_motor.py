"""Flywheel and motor of the model file, and the motor's CSV file beside it."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import pi
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.mechanism.force_elements import Motor, MotorTable
from equipoise.mechanism.model import Load, LoadTable, Machine
from equipoise.schema import dumps, json_schema, load, loads, save
from equipoise.schema.saving import files_of, parts_of
from equipoise.schema.tables import format_motor, read_motor
from unit.schema.samples import FOUR_BAR, MOTOR

VALIDATOR = Draft202012Validator(json_schema())
CURVE = '\n[drive.motor]\ntable = "motor.csv"\n'
RPM = 2 * pi / 60
TABLE = MotorTable((0.0, 100.0, 1000 / 3), (2.0, 1.5, -1 / 3), "motor.csv")
CSV = "speed [rpm],torque [N m]\n0,2\n1500,1.9\n3000,-0.5\n"


def motor_of(machine: Machine) -> Motor:
    motor = machine.drive.motor
    assert motor is not None
    return motor


# -- reading ---------------------------------------------------------------------------------------


def test_values_arrive_in_si_units() -> None:
    assert motor_of(loads(FOUR_BAR + MOTOR)) == Motor(3000 * RPM, 2.0)
    more = 'ratio = 25\ninertia = "80 g cm^2"\nmean_speed = "free"\n'
    motor = motor_of(loads(FOUR_BAR + MOTOR + more))
    assert motor == Motor(3000 * RPM, 2.0, ratio=25.0, inertia=8e-6, mean_speed="free")
    text = FOUR_BAR.replace("[frame]", 'flywheel = "2 kg cm^2"\n[frame]')
    assert loads(text).drive.flywheel == 2e-4
    assert loads(FOUR_BAR).drive.flywheel == 0
    assert loads(FOUR_BAR).drive.motor is None


@pytest.mark.parametrize("text", [MOTOR, CURVE, f"{MOTOR}ratio = 2.5\n"])
def test_schema_accepts(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))


# -- tables ----------------------------------------------------------------------------------------


def test_a_table_is_read_beside_the_model(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR + CURVE)
    (tmp_path / "motor.csv").write_text(CSV)
    motor = motor_of(load(path))
    expected = MotorTable((0.0, 1500 * RPM, 3000 * RPM), (2.0, 1.9, -0.5))
    assert motor == Motor(table=expected)
    assert motor.table is not None
    assert motor.table.file == "motor.csv"


HEADER = "speed [rpm],torque [N m]"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, "motor.csv: there is no such file"),
        ("", f"motor.csv, line 1: got no column; the header is {HEADER}"),
        ("speed [rpm]\n0\n", f"line 1: got speed; the header is {HEADER}"),
        ("depth [mm],torque [N m]\n0,1\n", "line 1: got the column 'depth [mm]'; the header is"),
        ("speed,torque [N m]\n0,1\n", "line 1, column speed: the unit is missing; speed [rad/s]"),
        ("speed [m/s],torque [N m]\n0,1\n", "column speed: got '0 m/s'; m/s is the unit of a sp"),
        ("speed [rpm],torque [N]\n0,1\n", "column torque: got '0 N'; N is the unit of a force"),
        (f"{HEADER}\n", "there are no rows"),
        (f"{HEADER}\n0,1\n", "the table has fewer than two rows; a curve needs two"),
        (f"{HEADER}\n0,1\n0,2\n", "line 3, column speed: the speeds must rise from row to row"),
        (f"{HEADER}\n0,1,2\n", "line 2: got 3 values; the header has 2 columns"),
        (f"{HEADER}\n0,x\n", "line 2, column torque: got 'x'; give a finite number"),
    ],
)
def test_bad_tables(text: str | None, said: str, tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR + CURVE)
    if text is not None:
        (tmp_path / "motor.csv").write_text(text)
    with pytest.raises(ModelError) as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}: drive.motor.table: ")
    assert said in str(caught.value)


def test_tables_are_saved_beside_the_model(tmp_path: Path) -> None:
    crank = Load("crank", table=LoadTable((0.0, pi), ((1.0, 2.0),)))
    machine = replace(loads(FOUR_BAR), loads=(crank,)).with_drive(motor=Motor(table=TABLE))
    assert [part.where for part in parts_of(machine)] == ["drive.motor.table", "loads[1].table"]
    save(machine, tmp_path / "a.toml")
    written = sorted(tmp_path.iterdir())
    assert [file.name for file in written] == ["a.load-1.csv", "a.motor.csv", "a.toml"]
    assert sorted(files_of(machine, tmp_path / "a.toml")) == written
    again = load(tmp_path / "a.toml")
    assert again == machine
    assert motor_of(again).table == replace(TABLE, file="a.motor.csv")


def test_a_table_without_a_file_is_not_dumped() -> None:
    bare = loads(FOUR_BAR).with_drive(motor=Motor(table=replace(TABLE, file="")))
    with pytest.raises(ModelError, match=r"^drive.motor.table: the table has no file; save"):
        dumps(bare)
    named = bare.with_drive(motor=Motor(table=TABLE))
    assert '[drive.motor]\ntable = "motor.csv"\n' in dumps(named)


def test_a_table_is_written_in_handy_units() -> None:
    table = MotorTable((0.0, 1500 * RPM, 3000 * RPM), (2.0, 1.9, -0.5))
    assert format_motor(table) == CSV.replace("0,2\n", "0,2.0\n", 1)


speeds = st.lists(
    st.floats(1e-20, 1e6) | st.floats(-1e6, -1e-20) | st.integers(0, 9000).map(lambda n: n * RPM),
    min_size=2,
    max_size=5,
    unique=True,
)


@given(speeds.map(sorted), st.lists(st.just(0.0) | st.floats(1e-20, 1e20), min_size=5, max_size=5))
def test_random_tables_survive(
    tmp_path_factory: pytest.TempPathFactory, speed: list[float], torque: list[float]
) -> None:
    table = MotorTable(tuple(speed), tuple(torque[: len(speed)]))
    folder = tmp_path_factory.getbasetemp()
    (folder / "random-motor.csv").write_text(format_motor(table))
    assert read_motor("random-motor.csv", folder) == table


# -- writing ---------------------------------------------------------------------------------------


def test_a_motor_is_written_as_people_write_it() -> None:
    written = dumps(loads(FOUR_BAR + MOTOR))
    assert f'speed = "193 rpm"\n{MOTOR}\n[frame]\n' in written


size = st.floats(1e-20, 1e20)
positive = st.just(0.0) | size


@given(size, size, size, positive, positive, st.sampled_from(["held", "free"]))
def test_random_motors_survive(
    speed: float, torque: float, ratio: float, inertia: float, flywheel: float, mean: str
) -> None:
    motor = Motor(speed, torque, ratio=ratio, inertia=inertia, mean_speed=mean)  # type: ignore[arg-type]
    machine = loads(FOUR_BAR).with_drive(flywheel=flywheel, motor=motor)
    text = dumps(machine)
    VALIDATOR.validate(tomllib.loads(text))
    assert loads(text) == machine
