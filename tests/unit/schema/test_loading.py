"""Reading model files: what is understood, and one sentence for everything else."""

from __future__ import annotations

import os
import tracemalloc
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from equipoise.errors import EquipoiseError, ModelError
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import STANDARD_GRAVITY
from equipoise.schema import examples, load, loads, open_files
from support.refusals import refused
from unit.schema.samples import EVERYTHING, FOUR_BAR


def test_values_arrive_in_si_units() -> None:
    machine = loads(FOUR_BAR)
    assert machine.drive.speed == pytest.approx(193 * 2 * 3.141592653589793 / 60, rel=1e-15)
    assert machine.links["crank"].points["B"] == (0.0335, 0.0)
    assert machine.links["crank"].inertia == 3e-5
    angle = radians(-83)
    assert machine.frame["D"] == pytest.approx((0.088 * cos(angle), 0.088 * sin(angle)))
    assert machine.gravity == STANDARD_GRAVITY
    assert list(machine.links) == ["crank", "coupler", "rocker"]


def test_everything_is_read() -> None:
    machine = loads(EVERYTHING)
    assert machine.gravity == (9.80665, 0.0)
    assert machine.sliders[0].angle == pytest.approx(radians(5))
    first, second = machine.gears
    assert first.speed_ratio == 20 / 41
    assert (second.speed_ratio, second.carrier) == (-2, "rocker")
    assert second.pressure_angle == Gear("a", "b").pressure_angle
    assert machine.loads[0].force == (1.0, -19.6133)
    assert machine.position is not None
    assert machine.position.points == {"B": (0.001, 0.002)}


def test_a_file_of_an_older_version_is_brought_up_to_date(monkeypatch: pytest.MonkeyPatch) -> None:
    """Step by step, each from a version to the next: here a link's mass was called otherwise."""

    def links(content: dict[str, Any]) -> dict[str, Any]:
        return {"links": content.pop("bars"), **content}

    def masses(content: dict[str, Any]) -> dict[str, Any]:
        named = {"weight": "mass"}
        return {
            **content,
            "links": {
                name: {named.get(key, key): value for key, value in link.items()}
                for name, link in content["links"].items()
            },
        }

    monkeypatch.setattr(open_files, "MIGRATIONS", {-1: links, 0: masses})
    older = FOUR_BAR.replace("\nmass =", "\nweight =").replace("[links.", "[bars.")
    assert loads(older.replace("schema = 1", "schema = -1")) == loads(FOUR_BAR)
    with refused(ModelError, "bars", given="bars", more="17"):
        loads(older)


def test_right_angles_are_exact() -> None:
    text = FOUR_BAR.replace('"-83 deg"', '"-90 deg"')
    assert loads(text).frame["D"] == (0.0, -0.088)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('mass = "199 g"', 'mass = "1 g"\nmass = "2 g"', {"by": "key_value_rule"}),
        (
            "[assembly]",
            "[assembly",
            {"text": "[assembly]"},
        ),
        ("[assembly]", "x = " + "[" * 10**5, {}),  # which function gives up depends on the stack
        ("[assembly]", "x = " + "9" * 5000, {"by": "match_to_number"}),
        (
            "[assembly]",
            f'[[gears]]\nbetween = ["crank", "rocker"]\nteeth = [1, 0x{"f" * 5000}]\n[assembly]',
            {"place": "gears[1].teeth[2]"},
        ),
        ("[assembly]", "a." * 40_000 + "a = 1", {"line": 27}),
    ],
)
def test_what_is_no_toml_is_reported_with_its_line(
    old: str, new: str, expected: dict[str, Any]
) -> None:
    with refused(ModelError, **expected) as caught:
        loads(FOUR_BAR.replace(old, new, 1), "model.toml")
    assert str(caught.value).startswith("model.toml: ")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400


def test_files_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "binary").write_bytes(bytes(range(256)))
    (tmp_path / "utf16").write_text(FOUR_BAR, encoding="utf-16")
    with open(tmp_path / "large", "wb") as file:
        file.truncate(100_000_000)
    tracemalloc.start()
    for name, said in [
        ("missing.toml", "there is no such file; give a path, or the name of an example: run"),
        ("", "this is a directory; give a file"),
        ("binary", "line 2 is not text in UTF-8"),
        ("utf16", "line 1 is not text in UTF-8"),
        ("large", "the file has 100 MB; at most 2 MB are read"),
        ("nu\0ll", "cannot be read"),
        ("x" * 5000, "cannot be read"),
    ]:
        with pytest.raises(ModelError) as caught:
            load(tmp_path / name)
        assert said in str(caught.value)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 20_000_000, "a file of 100 MB was read"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs POSIX")
def test_pipes_and_devices_do_not_hang(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", "/dev/zero"):
        with refused(ModelError, place=str(path)):
            load(path)


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may read everything")
def test_forbidden_file(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.touch(mode=0)
    with refused(ModelError, place=str(path)):
        load(path)


def test_byte_order_mark_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text(FOUR_BAR, encoding="utf-8-sig")
    assert load(path) == loads(FOUR_BAR)


def test_examples_load_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = examples("linkage")
    assert names
    for name, title in names.items():
        assert load(name).title == title


def test_near_names_of_examples() -> None:
    with refused(ModelError, name="yamashita-1"):
        load("yamashita-11")


def test_a_file_goes_before_an_example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("yamashita-1").write_text(FOUR_BAR)
    assert load("yamashita-1").title == "Four-bar"


def complaint(text: str) -> str:
    try:
        loads(text)
    except EquipoiseError as error:
        return str(error)
    return ""


@given(st.data())
def test_damaged_files_never_give_a_traceback(data: st.DataObject) -> None:
    lines = EVERYTHING.splitlines()
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(lines) - 1))
        begin = data.draw(st.integers(0, len(lines[at])))
        end = data.draw(st.integers(begin, len(lines[at])))
        tokens = st.sampled_from(['"', "[", "]", "{}", "1", "nan", "true", '"1 mm"', "[[x]]", "."])
        with_ = data.draw(st.just("") | tokens | st.text(max_size=3))
        lines[at] = lines[at][:begin] + with_ + lines[at][end:]
    assert "\n" not in complaint("\n".join(lines))


@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
        lambda inner: (
            st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3)
        ),
        max_leaves=6,
    ),
    st.data(),
)
def test_any_value_anywhere_is_refused_in_one_sentence(value: object, data: st.DataObject) -> None:
    import tomllib

    import tomli_w

    content = tomllib.loads(EVERYTHING)
    place: object = content
    while True:
        keys = list(place) if isinstance(place, dict) else range(len(place))  # type: ignore
        key = data.draw(st.sampled_from(keys))
        inner = place[key]  # type: ignore[index]
        if not isinstance(inner, dict | list) or data.draw(st.booleans()):
            place[key] = value  # type: ignore[index]
            break
        place = inner
    try:
        text = tomli_w.dumps(content)
    except (TypeError, ValueError):  # what TOML cannot hold
        return
    assert "\n" not in complaint(text)


def test_a_file_beside_that_is_spelt_alike_is_suggested(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Or one that lacks its ending only; before an example that is spelt alike."""
    monkeypatch.chdir(tmp_path)
    Path("sieve-2.toml").write_text(FOUR_BAR, encoding="utf-8")
    for name in ("sieve-2", "siev-2.toml"):
        with refused(ModelError, name="sieve-2.toml"):
            load(name)
    with refused(ModelError, place="nothing-at-all"):
        load("nothing-at-all")
