"""What `equipoise check` tells of support, rows, springs and motor."""

from __future__ import annotations

from pathlib import Path

from surface.running import READY, equipoise, succeeded, unfolded
from unit.schema.samples import FOUR_BAR, ROWS, SUPPORT

MOTOR = '\n[drive.motor]\nno_load_speed = "3000 rpm"\nstall_torque = "2 N m"\nratio = 12.5\n'


def checked(text: str) -> list[str]:
    Path("model.toml").write_text(FOUR_BAR + text)
    lines = succeeded(equipoise("check", "model.toml")).splitlines()
    assert lines[-1] == READY
    return lines


def test_nothing_of_them_where_there_are_none() -> None:
    text = "\n".join(checked(""))
    assert not any(word in text for word in ("support", "rows", "motor", "flywheel"))


def test_support() -> None:
    lines = checked(SUPPORT)
    texts = [
        "support: 60.00 kg; it can heave and pitch",
        "  mount front: pushes along 90.00 deg at (400.0, -200.0, 0) mm, 50000 N/m, 400.0 N s/m",
        "  mount float: pushes along (0.5000, 2.000, 0) at (-400.0, -200.0, 30.00) mm, 9807 N/m, "
        "90.00 N as drawn, one-sided",
        "  mount hitch: about the pitch axis, 500.0 N m/rad, 3.000 N m s/rad, -20.00 N m as drawn",
        "  handle: a gauge that reads along -30.00 deg at (-707.1, 707.1, 0) mm",
        "  nod: a gauge that reads about the pitch axis",
    ]
    assert unfolded("\n".join(texts)) in unfolded("\n".join(lines))


def test_pivot_without_mounts() -> None:
    text = SUPPORT[: SUPPORT.index("inertia")]
    lines = checked(f'{text}pivot = ["0 mm", "-100 mm"]\npivot_inertia = "20 kg m^2"\n')
    begin = lines.index("support: 60.00 kg; it can pitch about the pivot at (0, -100.0) mm")
    assert lines[begin + 1] == "  no mounts"


def test_axes_that_do_not_turn_are_noted() -> None:
    text = SUPPORT.replace('axis = "pitch"', 'axis = "roll"')
    notes = [line for line in checked(text) if line.startswith("note: support")]
    assert notes == [
        "note: support.mounts.hitch does nothing: the support cannot roll",
        "note: support.gauges.nod does nothing: the support cannot roll",
    ]


def test_rows() -> None:
    assert "rows: 2 on one shaft, ahead by 0 and 180.0 deg" in checked(ROWS)
    assert "rows: 1 on one shaft, ahead by 0 deg" in checked("\n[[rows]]\n")
    many = f"rows: 20 on one shaft, ahead by {', '.join('0' * 12)} and 8 more deg"
    assert many in checked("\n[[rows]]\n" * 20)


def test_motor() -> None:
    line = "motor: 3000 rpm without load, 2.000 N m at standstill, ratio 12.50"
    assert f"{line}; mean speed is the drive's" in checked(MOTOR)
    free = checked(f'{MOTOR}inertia = "8 kg cm^2"\nmean_speed = "free"\n')
    assert f"{line}, rotor 800.0 kg mm^2; mean speed follows from it" in unfolded("\n".join(free))
    Path("m.csv").write_text("speed [rpm],torque [N m]\n0,2\n1500,1.9\n3000,-0.5\n")
    table = checked('\n[drive.motor]\ntable = "m.csv"\n')
    assert "motor: 3 rows from 0 to 3000 rpm, ratio 1.000; mean speed is the drive's" in table


def test_springs() -> None:
    lines = succeeded(equipoise("check", "spring-balanced-crank")).splitlines()
    assert "spring: from F of rocker to S, 3300 N/m, free at 76.00 mm" in lines
    assert not any(line.startswith("note: ") for line in lines)


def test_flywheel() -> None:
    text = FOUR_BAR.replace("[frame]", 'flywheel = "0.2 kg m^2"\n[frame]')
    Path("model.toml").write_text(text)
    lines = succeeded(equipoise("check", "model.toml")).splitlines()
    assert "flywheel: 0.2000 kg m^2" in lines


def test_loads() -> None:
    """Their work: the area under a triangle, nothing of a force that stays, and none without."""
    Path("stroke.csv").write_text("crank_angle [deg],torque [N m]\n0,0\n90,10\n180,0\n")
    lines = checked(
        '[[loads]]\nlink = "crank"\ntable = "stroke.csv"\noutside = "zero"\n'
        '[[loads]]\nlink = "coupler"\npoint = "C"\nforce = ["3 N", "-4 N"]\n'
        '[[loads]]\nlink = "crank"\ntorque = "-2 N m"\nfrom = "300 deg"\nto = "30 deg"\n'
    )
    begin = lines.index("Loads, and their work in a cycle")
    assert [line.split() for line in lines[begin + 4 : begin + 7]] == [
        ["crank,", "N", "m", "torque,", "stroke.csv", "0.0", "180.0", "zero", "10.00", "15.71"],
        ["C", "of", "coupler,", "N", "force", "always", "5.000", "0"],
        ["crank,", "N", "m", "torque", "300.0", "30.0", "zero", "2.000", "-3.142"],
    ]
