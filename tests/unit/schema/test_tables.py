"""Tables in CSV: of loads, soil, motors and hands, and beside a model file."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise import move
from equipoise.errors import EquipoiseError, ModelError
from equipoise.handheld.model import Impedance
from equipoise.keys import ROW, TextKind, declared, inside
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.parts.field import Soil, SoilTable
from equipoise.mechanism.parts.laws import AngleLaw, AngleTable
from equipoise.mechanism.parts.machine import Load, LoadTable, Machine
from equipoise.mechanism.parts.motors import Motor, MotorTable
from equipoise.schema import dumps, load, loads, save
from equipoise.schema.models import files_of, parts_of
from equipoise.schema.open_files import opened_example
from equipoise.schema.tables import format_table, parse_table, read_beside
from equipoise.schema.template import Template
from support.refusals import refused
from unit.schema.samples import FOUR_BAR, PLANTING
from unit.schema.tool_samples import TOOL

RPM = 2 * pi / 60
LOADED = '[[loads]]\nlink = "coupler"\npoint = "C"\ntable = "f.csv"\noutside = "wrap"\n'
FORCES = "crank_angle [deg],force_x [N],force_y [N]\n0,1,2\n90,3,-4.5\n"


def test_forces_and_torques() -> None:
    assert parse_table("load", FORCES) == LoadTable((0.0, pi / 2), ((1.0, 3.0), (2.0, -4.5)))
    torque = parse_table("load", "torque [N mm], crank_angle [turn]\r\n\r\n1000,0\r\n2e3,.5\r\n")
    assert torque == LoadTable((0.0, pi), ((1.0, 2.0),))


def test_the_order_of_columns_does_not_matter() -> None:
    swapped = "force_y [N],crank_angle [deg],force_x [N]\n2,0,1\n-4.5,90,3\n"
    assert parse_table("load", swapped) == parse_table("load", FORCES)


ONE = LoadTable((0.0, pi / 2, 2 * pi), ((0.5, 1.033, 0.5), (0.0, 0.0, 0.0)))
AS_WRITTEN = {
    # what other programs write of one and the same table
    "decimal commas": "crank_angle [deg];force_x [N];force_y [N]\n0;0,5;0\n90;1,033;0\n360;,5;0\n",
    "one component": "crank_angle [deg],force_x [N]\n0,0.5\n90,1.033\n360,0.5\n",
    "tabs": "crank_angle [deg]\tforce_x [N]\n0\t0.5\n90\t1.033\n360\t0.5\n",
    "tabs and decimal commas": "crank_angle [deg]\tforce_x [N]\n0\t5,0e-1\n90\t1,033\n360\t0,5\n",
    "quotes": 'crank_angle [deg],force_x [N]\n"0","0,5"\n"90,0","1,033"\n"360","0,5"\n',
    "degree sign": "crank_angle [°],force_x [N]\n0,0.5\n90,1.033\n360,0.5\n",
    "comments": "# by me, 3; x\ncrank_angle [deg],force_x [N]\n% up\n0,.5\n//\n90,1.033\n360,.5\n",
    "header in a comment": "# May\n# crank_angle [deg], force_x [N]\n0,.5\n90,1.033\n360,.5\n",
}


@pytest.mark.parametrize("text", AS_WRITTEN.values(), ids=AS_WRITTEN.keys())
def test_tables_as_other_programs_write_them(text: str) -> None:
    assert parse_table("load", text) == ONE
    assert parse_table("load", format_table(parse_table("load", text))) == ONE


def test_comments_keep_the_numbers_of_lines() -> None:
    with refused(ModelError, line="5", column="torque", given="'x'"):
        parse_table("load", "# a\n\ncrank_angle [deg];torque [N m]\n# b\n0;x\n")


def test_the_other_component_alone() -> None:
    up = parse_table("load", "crank_angle [turn],force_y [kN]\n0,2\n1,2\n")
    assert up == LoadTable((0.0, 2 * pi), ((0.0, 0.0), (2000.0, 2000.0)))


SORTS = {
    # the file in which it is named, the name, and the place of that
    "load": (FOUR_BAR + LOADED, "f.csv", "loads[1].table"),
    "soil": (FOUR_BAR + PLANTING + 'soil.table = "soil.csv"\n', "soil.csv", "planting.soil.table"),
    "motor": (f'{FOUR_BAR}\n[drive.motor]\ntable = "motor.csv"\n', "motor.csv",
              "drive.motor.table"),
    "angles": (f'{FOUR_BAR}\n[drive.motion]\ntable = "law.csv"\n', "law.csv",
               "drive.motion.table"),
    "impedance": (TOOL.replace('hand.stiffness = "8000 N/m"', 'hand.impedance = "hand.csv"'),
                  "hand.csv", "shaft.stations[2].hand.impedance"),
}  # fmt: skip
TURNS = "speed [rpm],torque [N m]"
SWINGS = "crank_angle [deg],angle [deg]"
HAND = "frequency [Hz],resistance [N s/m],reactance [N s/m]"
BAD: dict[str, list[tuple[str | None, str]]] = {
    # text of the table, what is said
    "load": [
        ("", "line 1: got no column; the header is"),
        ("crank_angle [deg]\n0\n", "line 1: got crank_angle; the header is"),
        ("crank_angle [deg],force_x [N],torque [N m]\n0,1,1\n", "line 1: got crank_angle, force_x"),
        ("crank_angle [deg];torque [N m],x\n0;1\n", "line 1: the header has semicolons and commas"),
        ("time [s],torque [N m]\n0,1\n", "line 1, column time: got the column time; a load goes"),
        (
            "crank_angle [deg];torque [N m]\n0;1,033\n",
            "line 2, column torque: got '1,033'; a comma "
            "may be the decimal sign or separate thousands; write 1.033 or 1033",
        ),
        ("crank_angle [deg];torque [N m]\n0,5;1.033,5\n", "column crank_angle: got '0,5'; the dec"),
        (
            "crank_angle [deg];torque [N m]\n0;1.033,5\n",
            "leave out what separates thousands: 1033.5",
        ),
        (
            "crank_angle [deg],torque [N m]\n0,5,1,5\n",
            "line 2: got 4 values; the header has 2 columns; "
            "decimal commas need semicolons between values",
        ),
        (
            "crank_angle,torque [N m]\n0,1\n",
            "column crank_angle: the unit is missing; crank_angle [deg]",
        ),
        ("crank_angle [mm],torque [N m]\n0,1\n", "line 1, column crank_angle: got '0 mm'; mm is"),
        ("crank_angle [deg],torque [N m],torque [N m]\n0,1,1\n", "column torque: given twice"),
        ("crank_angle [deg],torque [N m]\n", "there are no rows"),
        ("crank_angle [deg],torque [N m]\n0,1\n5\n", "line 3: got 1 value; the header has 2"),
        ("crank_angle [deg],torque [N m]\n0,abc\n", "line 2, column torque: got 'abc'; give a"),
        ("crank_angle [deg],torque [N m]\n0,nan\n", "line 2, column torque: got 'nan'; give a"),
        ("crank_angle [deg],torque [N m]\n0,\n", "line 2, column torque: got ''; give a finite"),
        ("crank_angle [deg],torque [N m]\n0,1e300\n", "line 2, column torque: got '1e300 N m', "),
        ("crank_angle [deg],torque [N m]\n0,1\n\n0,2\n", "line 4, column crank_angle: the angles"),
        ('crank_angle [deg],torque [N m]\n0,"1\n', "no table of values with commas between"),
        (f"crank_angle [deg],torque [N m]\n0,{'1' * 200_000}\n", "no table of values with commas"),
    ],
    "soil": [
        (None, "soil.csv: there is no such file"),
        ("", "soil.csv, line 1: got no column; the header is depth [mm],resistance [N]"),
        ("depth [mm],resistance [N]\n0,1\n0,2\n", "line 3, column depth: the depths must rise"),
        ("depth [mm],resistance [N]\n-1,1\n0,2\n", "the depths must rise from row to row, from 0"),
        ("depth [mm],resistance [N]\n0,1\n5,-2\n", "got -2 N; soil resists, give 0 or more"),
    ],
    "motor": [
        (None, "motor.csv: there is no such file"),
        ("", f"motor.csv, line 1: got no column; the header is {TURNS}"),
        (f"{TURNS}\n0,1\n", "the table has fewer than two rows; a curve needs two"),
        (
            f"{TURNS}\n0,1\n0,2\n",
            "line 3, column speed: the speeds must rise from row to row",
        ),
    ],
    "angles": [
        (None, "law.csv: there is no such file"),
        ("crank_angle [deg],length [mm]\n", "the header is crank_angle [deg],angle [deg]"),
        (f"{SWINGS}\n0,1\n180,2\n", "got 2 values at 2 angles; give 3 to 720 of each"),
        (f"{SWINGS}\n0,1\n180,2\n90,2\n", "line 4, column crank_angle: the angles must rise"),
        (f"{SWINGS}\n0,1\n180,2\n400,1\n", "the rows go over 400 deg of crank angle, more than"),
        (f"{SWINGS}\n0,1\n180,2\n360,5\n", "begins at 1 deg and ends at 5 deg; let it come b"),
    ],
    "impedance": [
        (None, "hand.csv: there is no such file"),
        (
            "",
            f"hand.csv, line 1: got no column; the header is {HAND} or frequency [Hz],magnit",
        ),
        (f"{HAND}\n20,1,1\n20,1,1\n", "line 3, column frequency: the frequencies must rise"),
        ("frequency [Hz],resistance [N],reactance [N s/m]\n", "N is the unit of a force; a damp"),
        (f"{HAND}\n20,1,1\n", "the table has fewer than two rows; a curve needs two"),
        (f"{HAND}\n0,1,1\n1,1,1\n", "the first frequency is 0 Hz; give more than 0"),
        (
            f"{HAND}\n20,1,1\n30,-2,1\n",
            "the resistance at 30 Hz is -2 N s/m; a hand only takes",
        ),
    ],
}


@pytest.mark.parametrize(
    ("sort", "text", "said"), [(sort, *case) for sort, actual in BAD.items() for case in actual]
)
def test_bad_tables(sort: str, text: str | None, said: str, tmp_path: Path) -> None:
    model, name, place = SORTS[sort]
    path = tmp_path / "model.toml"
    path.write_text(model)
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(ModelError) as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}: {place}: ")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


SOIL_CSV = "depth [mm],resistance [N]\n0,1\n10,2.5\n40,1.5\n"
MOTOR_CSV = "speed [rpm],torque [N m]\n0,2\n1500,1.9\n3000,-0.5\n"
SOIL = SoilTable((0.0, 0.01, 0.04), (1.0, 2.5, 1.5), "soil.csv")
LAW_CSV = "crank_angle [deg],angle [deg]\n0,45\n90,90\n180,0\n"
LAW = AngleTable((0.0, *map(radians, (90, 180))), (radians(45), pi / 2, 0.0), "law.csv")
CURVE = MotorTable((0.0, 1500 * RPM, 3000 * RPM), (2.0, 1.9, -0.5), "motor.csv")
PUSH = LoadTable((0.0, 1.0, 2.5), ((1.0, 0.1, -3.0), (0.5, 1e-7, 1 / 3)), "f.csv")


def table_of(machine: Machine, sort: str) -> Any:
    """The table of a sort that a machine has."""
    return next(part.value for part in parts_of(machine) if part.sort == sort)


@pytest.mark.parametrize(
    ("sort", "text", "table"),
    [("soil", SOIL_CSV, SOIL), ("motor", MOTOR_CSV, CURVE), ("angles", LAW_CSV, LAW)],
)
def test_a_table_is_read_beside_the_model(sort: str, text: str, table: Any, tmp_path: Path) -> None:
    model, name, _ = SORTS[sort]
    (tmp_path / "model.toml").write_text(model)
    (tmp_path / name).write_text(text)
    result = table_of(load(tmp_path / "model.toml"), sort)
    assert (result, result.file) == (table, name)


def with_tables(file: str | None = None) -> Machine:
    """A machine with a table of each sort; ``file`` is the name of all of them."""
    push, soil, curve = (
        item if file is None else replace(item, file=file) for item in (PUSH, SOIL, CURVE)
    )
    machine = replace(
        loads(FOUR_BAR + PLANTING), loads=(Load("coupler", "C", table=push, outside="hold"),)
    )
    return machine.with_planting(soil=Soil(3.0, table=soil)).with_drive(motor=Motor(table=curve))


def test_a_motion_law_follows_its_table(tmp_path: Path) -> None:
    """As the same rows in the file itself, saved and carried along in studies."""
    (tmp_path / "law.csv").write_text(LAW_CSV)
    (tmp_path / "a.toml").write_text(SORTS["angles"][0])
    machine = load(tmp_path / "a.toml")
    given = AngleLaw(crank_angles=LAW.crank_angle, values=LAW.values)
    assert machine.drive.motion is not None
    np.testing.assert_array_equal(machine.drive.motion.value(1.0), given.value(1.0))
    save(machine, tmp_path / "b.toml")
    assert (tmp_path / "b.angles-1.csv").read_text().splitlines()[2] == "90,90"
    assert load(tmp_path / "b.toml") == machine
    carried = Template.restored(Template.load(tmp_path / "a.toml").texts())
    assert carried.base() == machine


def test_a_stroke_follows_its_table(tmp_path: Path) -> None:
    text = opened_example("hydraulic-loader").text
    start, end = text.index("[drive.stroke]"), text.index("[frame]")
    (tmp_path / "a.toml").write_text(f'{text[:start]}[drive.stroke]\ntable = "s.csv"\n{text[end:]}')
    (tmp_path / "s.csv").write_text("crank_angle [deg],length [mm]\n0,600\n150,1050\n210,1040\n")
    machine = load(tmp_path / "a.toml")
    places = move(machine, np.radians([0, 150, 210])).points
    lengths = np.abs(places["B"].place - places["A"].place)
    np.testing.assert_allclose(lengths, [0.6, 1.05, 1.04], rtol=1e-12)
    save(machine, tmp_path / "b.toml")
    assert load(tmp_path / "b.toml") == machine


def test_tables_are_saved_beside_the_model(tmp_path: Path) -> None:
    machine = with_tables()
    assert {part.where for part in parts_of(machine)} == {
        "drive.motor.table", "loads[1].table", "planting.soil.table"
    }  # fmt: skip
    save(machine, tmp_path / "a.toml")
    written = sorted(tmp_path.iterdir())
    names = ["a.load-1.csv", "a.motor.csv", "a.soil.csv", "a.toml"]
    assert [file.name for file in written] == names
    assert sorted(files_of(machine, tmp_path / "a.toml")) == written
    again = load(tmp_path / "a.toml")
    assert again == machine
    assert {table_of(again, sort).file for sort in ("load", "motor", "soil")} == {*names[:3]}


@pytest.mark.parametrize("sort", ["load", "soil", "motor"])
def test_a_table_without_a_file_is_not_dumped(sort: str) -> None:
    bare, whole = with_tables(""), with_tables()
    only = {
        "load": replace(whole, loads=bare.loads),
        "soil": replace(whole, planting=bare.planting),
        "motor": replace(whole, drive=bare.drive),
    }
    with pytest.raises(ModelError) as caught:
        dumps(only[sort])
    assert str(caught.value).startswith(f"{SORTS[sort][2]}: the table has no file; save")


def test_tables_are_named_in_the_text() -> None:
    text = dumps(with_tables())
    assert '[drive.motor]\ntable = "motor.csv"\n' in text
    assert 'soil.table = "soil.csv"' in text
    assert 'table = "f.csv"' in text


def test_a_curve_is_written_in_handy_units() -> None:
    assert format_table(CURVE) == MOTOR_CSV.replace("0,2\n", "0,2.0\n", 1)


SIZES = st.floats(1e-20, 1e20)
POSITIVE = st.just(0.0) | SIZES
TURNING = (
    st.floats(1e-20, 1e6) | st.floats(-1e6, -1e-20) | st.integers(0, 9000).map(lambda n: n * RPM)
)
RANDOM: dict[str, tuple[Any, Any, int, tuple[Any, ...]]] = {
    # its class, what its first column holds, its fewest rows, what the others hold
    "soil": (SoilTable, st.floats(1e-20, 1e6), 1, (POSITIVE,)),
    "motor": (MotorTable, TURNING, 2, (POSITIVE,)),
    "impedance": (Impedance, SIZES, 2, (SIZES, SIZES | SIZES.map(lambda x: -x))),
}


@pytest.mark.parametrize("sort", RANDOM)
@given(st.data())
def test_random_tables_survive(
    tmp_path_factory: pytest.TempPathFactory, sort: str, data: st.DataObject
) -> None:
    of, first, fewest, others = RANDOM[sort]
    at = data.draw(st.lists(first, min_size=fewest, max_size=5, unique=True).map(sorted))
    columns = (data.draw(st.tuples(*[other] * len(at))) for other in others)
    table = of(tuple(at), *columns)
    folder = tmp_path_factory.getbasetemp()
    (folder / f"random-{sort}.csv").write_text(format_table(table))
    assert read_beside(sort, f"random-{sort}.csv", folder) == table


def complaint(text: str) -> str:
    try:
        parse_table("load", text)
    except ModelError as error:
        return str(error)
    return "read"


@given(st.text())
def test_any_text_is_refused_with_a_sentence(text: str) -> None:
    for whole in (text, FORCES + text, text + FORCES):
        assert complaint(whole).startswith(("line ", "read"))


@given(
    st.lists(st.floats(0, 6), min_size=1, max_size=5, unique=True),
    st.floats(1e-20, 1e20),
)
def test_tables_survive(angles: list[float], value: float) -> None:
    angles = sorted(angle for angle in angles if angle > 1e-20) or [0.0]
    table = LoadTable(tuple(angles), ((value,) * len(angles), (-value,) * len(angles)))
    assert parse_table("load", format_table(table)) == table


def test_whole_degrees_are_written_as_degrees() -> None:
    assert format_table(parse_table("load", FORCES)).startswith(
        "crank_angle [deg],force_x [N],force_y [N]"
    )
    assert "\n90,3.0,-4.5\n" in format_table(parse_table("load", FORCES))


def test_errors_name_model_and_table(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR + LOADED)
    table = tmp_path / "f.csv"
    with refused(ModelError, "loads[1].table", place="f.csv"):
        load(path)
    table.write_bytes(b"\xff\xfe\x00")
    with refused(ModelError, "loads[1].table", place="f.csv", line="1"):
        load(path)
    table.write_text(FORCES.replace("-4.5", "x"))
    with refused(
        ModelError, "loads[1].table", place="f.csv", line="3", column="force_y", given="'x'"
    ) as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}: loads[1].table: ")
    table.write_text("\ufeff" + FORCES, encoding="utf-8")
    assert load(path).loads[0].table == parse_table("load", FORCES, "f.csv")
    assert read_beside("load", "f.csv", tmp_path).file == "f.csv"


def test_a_table_that_a_class_declares_is_read_written_and_refused() -> None:
    """Its sort, its columns and what they mean there stand in its class alone."""

    @declared
    class Heights(CsvTable):
        sort = "heights"
        forms = (("depth", "x"),)
        columns: ClassVar[Any] = {"x": ("torque", "N m")}
        rises = False

        depth: tuple[float, ...] = inside(ROW)
        x: tuple[float, ...] = inside(ROW)
        file: str = inside(TextKind(), default="", compare=False)

    try:
        text = "depth [mm],x [N m]\n20,1\n10,2\n"
        table = parse_table("heights", text, "mine.csv")
        assert table == Heights((0.02, 0.01), (1.0, 2.0))
        assert parse_table("heights", format_table(table)) == table
        with refused(EquipoiseError, headers="depth [mm],x [N m]"):
            parse_table("heights", "depth [mm],y [N m]\n1,2\n")
    finally:
        del CsvTable.kinds["heights"]
