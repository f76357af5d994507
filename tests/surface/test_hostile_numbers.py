"""Numbers that nobody would give, for every key of bearings, sections, slots, motors, brakes,
parameters, constraints, runs and duties: a command works, or refuses them in a sentence.

A Python warning is an error, and so are numbers that are not finite in a JSON object.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from support import machines_any
from support.chosen import EXHAUSTIVE, few
from surface.running import equipoise, no_constant, refused, within

Path_ = tuple[Any, ...]
SEEDS = (0, 1, 2, 8, 10, 12, 18, 21, 23, 24, 28, 33, 41, 54, 114, 116, 159, 212, 273, 342)
"""Machines from nothing that have all these keys together."""
TABLES = re.compile(
    r"joints\.\*\.|links\.\*\.section|circular_slots|curved_slots|drive\.|parameters|constraints"
    r"|run|duty"
)
SIZES = ("0", "-1", "1e30", "-1e30", "1e-30", "nan", "inf", "1e308", "5e-324")
PLAIN = (0, -1, 1e30, 1e-30, float("nan"), float("inf"), 10**40, True, "", "text", "=1/0", [], [1],
         ["A"], {"a": 1})  # fmt: skip
PARTS = 96
SECONDS = 60
"""Of the processor, for a command: a turn of the slowest of these machines takes 23."""
KEYS = {
    "RollingBearing": "joints.*.bearing",
    "JointProperties": "joints.*",
    "LinkSection": "links.*.section",
    "CircularSlot": "circular_slots.*",
    "CurvedSlot": "curved_slots.*",
    "ServoMotor": "drive.motor.servo",
    "DcMotor": "drive.motor.dc",
    "InductionMotor": "drive.motor.induction",
    "RunPlan": "run",
    "DutyState": "duty.*",
}
"""Tables of the schema, and where they stand."""
BESIDE = {"joints.*.stiffness", "curved_slots.*.table", "curved_slots.*.direction"} | {
    f"{kind}_slots.*.label" for kind in ("circular", "curved")
}
"""Keys that exclude others, or are words."""


def paths(value: Any, path: Path_ = ()) -> Iterator[Path_]:
    """Paths of every key and every item of a document."""
    for key in value if isinstance(value, dict) else range(len(value)):
        yield (*path, key)
        if isinstance(value[key], dict | list):
            yield from paths(value[key], (*path, key))


def general(path: Path_) -> str:
    """A path with a star for the names of links and parameters, and for positions."""
    named = path[0] in {"links", "parameters"}
    return ".".join(
        "*" if isinstance(key, int) or (named and k == 1) else key for k, key in enumerate(path)
    )


@cache
def places() -> list[tuple[int, Path_]]:
    """A machine and a path for every key, the first of each."""
    actual: dict[str, tuple[int, Path_]] = {}
    for seed in SEEDS:
        for path in paths(document(seed)):
            if TABLES.match(name := general(path)):
                actual.setdefault(name, (seed, path))
    return [*actual.values()]


@cache
def drawn(seed: int) -> tuple[dict[str, Any], dict[str, str]]:
    """The document and the tables of a machine, which take longer to draw than most commands."""
    return machines_any.files(seed)


def document(seed: int) -> dict[str, Any]:
    """A machine from nothing, with a brake, and a run and sections that have every key now and
    then.
    """
    made = deepcopy(drawn(seed)[0])
    for link in made["links"].values():
        section = link.get("section", {})
        if seed % 2 and {*section} >= {"width", "height"} and "wall" not in section:
            section["web"], section["flange"] = share(section["width"]), share(section["height"])
    if "motor" in made["drive"]:
        made["drive"]["brake"] = "3 N m"
        if seed % 2:
            made["run"] = {"duration": "0.1 s", "off": "0.05 s", "speed": "20 rpm", "turns": 2}
    return made


def share(size: str) -> str:
    """Three tenths of a size."""
    number, _, unit = size.partition(" ")
    return f"{0.3 * float(number)} {unit}"


def hostile(value: Any) -> Iterator[Any]:
    """What may be written instead of a value."""
    number, _, unit = str(value).partition(" ")
    if isinstance(value, str) and unit and re.match(r"[-.\d]", number):
        yield from (f"{size} {unit}" for size in SIZES)
    yield from PLAIN


def try_commands(seed: int, path: Path_, value: Any) -> None:
    """One value of one key through the commands that read it, up to the first that refuses it."""
    made = document(seed)
    table: Any = made
    for key in path[:-1]:
        table = table[key]
    table[path[-1]] = value
    Path("model.toml").write_text(tomli_w.dumps(made), encoding="utf-8")
    commands = ["check model.toml", "analyze model.toml --json"]
    if path[0] in {"drive", "run", "joints"}:
        commands.append("run model.toml --turns 1 --json")
    for command in commands:
        with within(SECONDS):
            result = equipoise(*command.split())
        if result.status:
            assert len(refused(result)) < 3000
            return
        if command.endswith("--json"):
            json.loads(result.out, parse_constant=no_constant)


@pytest.mark.parametrize("part", few(range(PARTS), (13,)))
def test_no_number_breaks_a_command(part: int) -> None:
    for seed, path in places()[part::PARTS]:
        made, tables = document(seed), drawn(seed)[1]
        for name, text in tables.items():
            Path(name).write_text(text, encoding="utf-8")
        given: Any = made
        for key in path:
            given = given[key]
        for value in hostile(deepcopy(given)):
            try:
                try_commands(seed, path, value)
            except BaseException as error:
                raise AssertionError(
                    f"seed {seed}, {general(path)} = {value!r}: {error!r}"
                ) from error


@pytest.mark.exhaustive(but=["1-path0-1e30 mm-section.wall: got a wall"])
@pytest.mark.parametrize(
    ("seed", "path", "value", "said"),
    [
        pytest.param(
            0,
            ("drive", "motor", "stall_torque"),
            "1e30 N m",
            "cannot be integrated beyond",
            marks=EXHAUSTIVE,
        ),
        (1, ("links", "crank", "section", "diameter"), "1e30 mm", "section.wall: got a wall"),
        (119, ("drive", "motor", "servo", "speed"), "1e30 rpm", "servo.speed_gain: the speeds"),
        (119, ("drive", "motor", "servo", "torque_limit"), "1e-30 N m", "lost in rounding"),
        (21, ("circular_slots", 0, "radius"), "1 m", "cannot be joined at any crank angle"),
    ],
)
def test_what_broke_once_is_refused(seed: int, path: Path_, value: str, said: str) -> None:
    made, tables = machines_any.files(seed)
    table: Any = made
    for key in path[:-1]:
        table = table[key]
    table[path[-1]] = value
    for name, text in (tables | {"model.toml": tomli_w.dumps(made)}).items():
        Path(name).write_text(text, encoding="utf-8")
    command = "run model.toml --turns 1" if path[0] == "drive" else "analyze model.toml"
    assert said in refused(equipoise(*command.split()))


def test_every_key_is_tried() -> None:
    """A new key of these tables joins, or says why not."""
    tables = json.loads(equipoise("schema").out)["$defs"]
    tried = {general(path) for _, path in places()}
    wanted = {f"{at}.{key}" for name, at in KEYS.items() for key in tables[name]["properties"]}
    assert wanted - tried <= BESIDE
    assert {"drive.brake", "parameters.*", "constraints.*.kind"} <= tried
