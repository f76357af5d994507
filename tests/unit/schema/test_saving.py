"""Writing model files: what is read again is exactly what was written."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.parts.machine import Drive, Link, Machine, Position
from equipoise.mechanism.parts.support import UP
from equipoise.schema import dumps, examples, load, loads, save
from support.refusals import refused
from unit.schema.samples import EVERYTHING, FOUR_BAR, changed_machine, survives

size = st.floats(1e-25, 1e25)
number = size | size.map(lambda x: -x) | st.just(0.0) | st.floats(1e-3, 1e3)
printable = st.text(max_size=20).filter(str.isprintable)
names = printable.filter(lambda name: bool(name.strip()) and name != "frame")


@pytest.mark.parametrize("name", examples("linkage"))
def test_examples_survive(name: str) -> None:
    machine = load(name)
    if all(load.table is None for load in machine.loads):
        survives(machine)


def test_everything_survives() -> None:
    machine = loads(EVERYTHING)
    text = survives(machine)
    assert list(loads(text).links) == list(machine.links)
    assert dumps(loads(text)) == text


def test_a_file_is_written_as_people_write_it() -> None:
    assert dumps(loads(FOUR_BAR)) == FOUR_BAR


@given(st.data())
def test_random_edits_survive(data: st.DataObject) -> None:
    def draw(_: str, old: float) -> float:
        # The sign is kept: a mass stays one, and a pressure angle below a right angle.  What
        # also stands for a value that has no place there is kept: 0, and up as a direction.
        if old in (0, UP):
            return old
        new = data.draw(st.floats(1e-25, 1.5) | st.floats(1e-3, 1.5))
        return new if old > 0 else -new

    try:
        # What may be changed hangs together too much; `test_balance` has its own.
        machine = changed_machine(loads(EVERYTHING).with_balance(None), draw)
    except ModelError as error:  # a window of no width
        assume("from and to must differ" not in str(error))
        raise
    survives(machine)


@given(
    st.dictionaries(names, st.tuples(number, number), min_size=1, max_size=3),
    printable,
    names,
    number,
)
def test_any_names_and_numbers_survive(
    points: dict[str, tuple[float, float]], title: str, name: str, speed: float
) -> None:
    machine = Machine(
        title,
        Drive(name, speed),
        points,
        {name: Link(points, abs(speed), (speed, speed), abs(speed))},
        {name: "left"},
        position=Position(speed, points, {name: speed}),
    )
    assert loads(dumps(machine)) == machine


@pytest.mark.parametrize("point", [(1e25, 1e-25), (1e30, 1e30), (-1e30, 1e-30), (1 / 3, 0.0)])
def test_points_that_are_short_in_no_form_survive(point: tuple[float, float]) -> None:
    machine = replace(loads(FOUR_BAR), frame={"A": point, "D": (0.0, 0.0)})
    assert loads(dumps(machine)) == machine


def test_saving_and_loading(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    machine = loads(FOUR_BAR)
    save(machine, path)
    assert load(path) == machine
    path.chmod(0o640)
    save(machine, path)
    assert path.stat().st_mode & 0o777 == 0o640
    assert [file.name for file in tmp_path.iterdir()] == ["model.toml"]


def test_saving_goes_through_a_link(tmp_path: Path) -> None:
    (tmp_path / "link.toml").symlink_to(tmp_path / "model.toml")
    save(loads(FOUR_BAR), tmp_path / "link.toml")
    assert (tmp_path / "link.toml").is_symlink()
    assert (tmp_path / "model.toml").is_file()


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("missing/model.toml", {"reason": "no such file or directory"}),
        (".", {}),
        ("nu\0ll.toml", {"reason": "embedded null byte"}),
    ],
)
def test_places_that_cannot_be_written(tmp_path: Path, name: str, reason: dict[str, str]) -> None:
    with refused(UsageError, **reason):
        save(loads(FOUR_BAR), tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_an_interrupted_save_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR)

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with refused(UsageError, reason="no space left on device"):
        save(replace(loads(FOUR_BAR), title="New"), path)
    assert path.read_text() == FOUR_BAR
    assert [file.name for file in tmp_path.iterdir()] == ["model.toml"]
