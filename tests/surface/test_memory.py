"""Memory that a command takes at most, as the system counts it."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from equipoise.limits import USUAL_OUTPUTS
from support.chosen import EXHAUSTIVE, few
from surface.running import Result, command, equipoise, example_text, refused, succeeded

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

PEAK = """
import atexit, re, sys
from pathlib import Path
from equipoise.__main__ import main

def tell():
    peak = re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1]
    print(f"peak {int(peak) // 1000} MB", file=sys.stderr)

atexit.register(tell)
main()
"""


def peak_of(*arguments: str | Path, **variables: str) -> tuple[Result, int]:
    """What a command left behind, and the memory that its process held at most, MB.

    variables : of its environment.
    """
    words = [sys.executable, "-c", PEAK, *command(*arguments)[3:]]
    environment = {**os.environ, **variables}
    done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment)
    match = re.search(r"peak (\d+) MB\n$", done.stderr)
    assert match, done.stderr
    return Result(done.returncode, done.stdout, done.stderr), int(match[1])


STUDY = """
schema = 1
title = "Masses of type I"
model = "yamashita-1"

[[vary]]
path = "links.crank.mass"
range = ["199 g", "400 g"]

[sampling]
method = "sobol"
designs = 2000

[accuracy]
angles = 180

[[outputs]]
name = "first order"
value = "by_order.shaking_force.x.harmonics[2]"
make = "smallest"
"""


# What grows with use is looked for before a release; of one design or analysis on every change, in
# tests/unit/test_memory_at_once.py and tests/unit/studies/test_evaluate.py.
@EXHAUSTIVE
def test_a_search_gives_back_the_memory_of_its_designs() -> None:
    """Analyses of 300 designs hold 25 MB."""
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    computed, peaks = [], []
    for generations in ("1", "4"):
        words = ("--population", "100", "--generations", generations, "--json")
        result, peak = peak_of("search", "study.toml", *words)
        assert result.status == 0, result.err
        computed.append(json.loads(result.out)["computed"])
        peaks.append(peak)
    assert computed[1] - computed[0] > 250
    assert peaks[1] - peaks[0] < 15


TOLERANCES = (
    STUDY.partition("[[vary]]")[0]
    + """
[[vary]]
path = "links.crank.mass"
normal = { deviation = "5 g" }

[sampling]
method = "sobol"
designs = 512

[accuracy]
angles = 180

[[outputs]]
name = "first order"
value = "by_order.shaking_force.x.harmonics[2]"
"""
)


# What grows with use is looked for before a release; of one design or analysis on every change, in
# tests/unit/test_memory_at_once.py and tests/unit/studies/test_evaluate.py.
@pytest.mark.exhaustive
def test_tolerances_give_back_the_memory_of_their_machines() -> None:
    """Each held 10 MB; fewer than 160 are not taken."""
    Path("study.toml").write_text(TOLERANCES, encoding="utf-8")
    result, peak = peak_of(
        "tolerance", "study.toml", "--designs", "160", "--workers", "1", "--json"
    )
    assert result.status == 0, result.err
    assert peak < 230


# What grows with use is looked for before a release; of one design or analysis on every change, in
# tests/unit/test_memory_at_once.py and tests/unit/studies/test_evaluate.py.
@pytest.mark.exhaustive
def test_a_long_sweep_gives_back_the_memory_of_its_speeds() -> None:
    """Each held 39 MB."""
    words = ("yamashita-rig", "--speed", "20 rpm : 400 rpm", "--speeds", "5", "--model", "exact")
    result, peak = peak_of("respond", *words)
    assert result.status == 0, result.err
    assert peak < 125


LONG = """
[links.wheel]
points.E = ["0 mm", "0 mm"]
mass = "416 g"
center_of_mass = ["25 mm", "0 mm"]
inertia = "305 kg mm^2"

[[gears]]
between = ["crank", "wheel"]
teeth = [{}, {}]
"""
"""A wheel whose teeth make the cycle as many turns long as it has."""


def turning(example: str, turns: int) -> str:
    """Name of a bundled model with a wheel by which its cycle takes so many turns."""
    point = 'points.A = ["0 mm", "0 mm"]\n'
    added = (point, f'{point}points.E = ["-70 mm", "10 mm"]\n')
    text = example_text(example).replace(*added, 1) + LONG.format(turns - 1, turns)
    Path("long.toml").write_text(text, encoding="utf-8")
    return "long.toml"


def test_what_needs_more_than_the_limit_is_refused_in_a_sentence() -> None:
    long = turning("yamashita-1", 997)
    result, peak = peak_of("analyze", long, "--json", EQUIPOISE_MEMORY="400 MB")
    assert (result.status, result.out) == (2, "")
    assert "equipoise: not enough memory: needs " in result.err
    assert "and 381 MiB may be used" in result.err and 'EQUIPOISE_MEMORY="1 GB"' in result.err
    assert peak < 450


@pytest.mark.parametrize(
    ("example", "words", "message"),
    [
        (
            "yamashita-1",
            ("analyze", "--json", "--split"),
            "forces by cause and link at 7200 crank angles, of 20 turns: needs 110 MiB of memory, "
            'and 1.91 MiB may be used; ask for less, or set EQUIPOISE_MEMORY="1 GB"',
        ),
        (
            "yamashita-rig",
            ("respond", "--speed", "60 : 400 rpm", "--speeds", "100"),
            r"1\d\d speeds of a cycle of 20 turns: needs .* MiB of memory, and 1.91 MiB may be",
        ),
    ],
)
def test_what_is_large_is_refused_before_it_begins(
    example: str, words: tuple[str, ...], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With what follows from what was asked for, not when memory has run out."""
    monkeypatch.setenv("EQUIPOISE_MEMORY", "2 MB")
    assert re.search(message, refused(equipoise(words[0], turning(example, 20), *words[1:])))


# What is held beside what is asked for fails tests/unit/test_memory_at_once.py too.
@pytest.mark.exhaustive
def test_a_study_takes_no_memory_for_outputs_that_it_does_not_want(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Forces by cause and by link take far more than all others."""
    monkeypatch.setenv("EQUIPOISE_MEMORY", "20 MB")
    named = STUDY.replace('"yamashita-1"', f'"{turning("yamashita-1", 20)}"')
    few = named.replace("designs = 2000", "designs = 2").replace("\nangles = 180", "\nangles = 720")
    Path("study.toml").write_text(few, encoding="utf-8")
    succeeded(equipoise("sweep", "study.toml", "-o", "designs.zarr"))


def test_a_limit_that_is_none() -> None:
    result, _ = peak_of("analyze", "yamashita-1", EQUIPOISE_MEMORY="much")
    assert result.status == 2
    assert "EQUIPOISE_MEMORY: got 'much'; give the memory that may be used, such as" in result.err


# Other inputs that are too large are refused on every change.
@pytest.mark.exhaustive
@pytest.mark.parametrize(
    "command_line",
    few(["analyze yamashita-1", "--help", "analyze --help"], {"analyze yamashita-1"}),
)
def test_a_terminal_of_a_thousand_million_columns(command_line: str) -> None:
    result, peak = peak_of(*command_line.split(), COLUMNS="1000000000")
    assert result.status == 0, result.err
    assert peak < 300
    assert max(map(len, result.out.splitlines())) <= 1000


def test_an_option_that_is_repeated_ten_thousand_times() -> None:
    result = equipoise("analyze", "yamashita-1", *["--output=joints.B"] * 10_000)
    refusal = refused(result)
    assert "--output: given 10000 times; give it 200 times at most" in refusal


def test_a_study_of_more_outputs_than_usual(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The limit is told with what raises it, which it then does."""
    assert USUAL_OUTPUTS == 1000  # of which each takes some ms
    monkeypatch.setattr("equipoise.limits.USUAL_OUTPUTS", 2)
    text = example_text("study-of-lengths").partition("[[outputs]]")[0]
    text += "".join(f'[[outputs]]\nname = "o{k}"\nvalue = "shaking_force.peak"\n' for k in range(3))
    (folder / "many.toml").write_text(text, encoding="utf-8")
    refusal = refused(equipoise("check", "many.toml"))
    assert "outputs: got 3; at most 2 are computed" in refusal
    (setting,) = re.findall(r"EQUIPOISE_OUTPUTS=\d+", refusal)
    monkeypatch.setenv(*setting.split("="))
    assert equipoise("check", "many.toml").status == 0
    monkeypatch.setenv("EQUIPOISE_OUTPUTS", "many")
    assert "EQUIPOISE_OUTPUTS: got 'many'; give how many" in refused(
        equipoise("check", "many.toml")
    )


# Other inputs that are too large are refused on every change.
@pytest.mark.exhaustive
def test_a_spline_of_very_many_points(folder: Path) -> None:
    drawing = ezdxf.new()
    angles = np.linspace(0, 6, 20_000)
    points = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    drawing.modelspace().add_open_spline(points.tolist())
    drawing.saveas(folder / "spline.dxf")
    result, peak = peak_of("import", "spline.dxf", "-o", "machine.toml")
    assert result.status == 2
    assert "a spline of 20000 points, of the layer '0': needs 8.94 GiB of memory" in result.err
    assert peak < 500


CONES = """
import sys
import numpy as np
from scipy import sparse
from equipoise.balancing.program import solve_cones
from equipoise.errors import UsageError
from equipoise.limits import limit_process

matrix = sparse.csc_matrix(np.random.default_rng(0).normal(size=(6000, 300)))
limit_process()
try:
    solve_cones(np.ones(300), matrix, np.ones(6000), [("nonnegative", 6000)], 1e-8)
except UsageError as error:
    sys.exit(str(error))
"""


def test_a_program_beyond_the_limit_does_not_abort() -> None:
    """Clarabel ends the whole process where it gets no memory."""
    environment = {**os.environ, "EQUIPOISE_MEMORY": "270 MB"}
    words = [sys.executable, "-c", CONES]
    done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 1, done.stderr
    assert done.stderr.startswith("a cone program of 6000 rows and 300 numbers: needs ")


@pytest.mark.parametrize("name", ["long.gif", "long.mp4"])
def test_a_film_of_too_many_turns_is_refused_before_it_is_computed(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Positions, paths and a support's motion over 500 turns took half a minute, for nothing."""
    monkeypatch.setattr("equipoise.results.analysis.analyze", None)
    said = refused(equipoise("animate", turning("yamashita-1", 500), "--out", name))
    assert "the film has" in said and "fewer turns" in said
    assert not Path(name).exists()
