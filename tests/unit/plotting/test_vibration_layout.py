"""Pictures of vibration for odd machines: texts keep clear, names do for files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import pytest

import equipoise as eq
from equipoise.plotting.style import Kind, render
from equipoise.plotting.vibration import (
    mode_drawings,
    response_drawings,
    sweep_drawings,
    transient_drawings,
)
from equipoise.plotting.vibration.panels import Unit
from equipoise.vibration.forced import respond
from equipoise.vibration.sweep import sweep_speed
from unit.plotting.samples import words
from unit.plotting.vibration_samples import (
    KINDS,
    Drawn,
    check_texts,
    drawn_texts,
    hashed,
    pictures,
    plane,
    rig,
)


@pytest.mark.parametrize("kind", KINDS)
def test_texts_keep_clear_of_each_other(kind: str) -> None:
    for name, figure in pictures(kind).items():
        check_texts(f"{kind}: {name}", figure)


def test_names_in_order() -> None:
    response = ["gauge-handle", "gauge-seat", "gauge-tilt", "spectrum", "mounts", "drive"]
    sweep = ["response", "resonance-map", "mounts", "velocity", "acceleration"]
    found = list(pictures("clockwise"))
    assert found == [*response, *(f"sweep {name}" for name in sweep), "mode-1", "mode-2", "mode-3"]
    rest = [name for name in pictures("walking-transplanter") if name.startswith("rest")]
    assert rest == ["rest gauges", "rest mounts", "rest speed"]


def test_many_go_on_in_further_pictures() -> None:
    found = pictures("crowded")
    assert {"spectrum", "spectrum-2", "mounts", "mounts-2", "rest gauges-2"} <= found.keys()
    assert "11 to 11 of 11" in words(found["spectrum-2"])
    assert "6 quieter ones" in words(found["sweep mounts"])
    assert "5 quieter ones" in words(found["sweep response"])
    shown = [len(found[name].axes) for name in ("spectrum", "spectrum-2", "mounts", "mounts-2")]
    assert shown == [10, 1, 10, 2]


def test_odd_names_do_for_files_and_are_no_formulas() -> None:
    found = list(pictures("odd names"))
    assert found[:2] == ["gauge-a_b", "gauge-A_B-2"]
    assert found[2].startswith("gauge-CON_") and len(found[2]) <= 60
    for name, figure in pictures("odd names").items():
        svg = ElementTree.fromstring(render(figure, "svg"))
        assert "Costs $5 and " in "".join(svg.itertext()), name
    assert "$x_1$ long" in words(pictures("odd names")["mounts"])


def drawn_again() -> Drawn:
    machine = rig()
    swept = sweep_speed(machine, 3, 60, speeds=9)
    drawn = response_drawings(respond(machine))
    drawn |= {f"sweep {name}": figure for name, figure in sweep_drawings(swept).items()}
    drawn |= mode_drawings(eq.modes(machine))
    drawn |= transient_drawings(eq.simulate(machine, 0.4, samples=50))
    return drawn


def test_the_same_bytes_on_every_run() -> None:
    once, again = drawn_again(), drawn_again()
    for name, figure in once.items():
        kinds: tuple[Kind, ...] = ("svg", "png", "pdf") if name == "mode-1" else ("svg",)
        for kind in kinds:
            file = render(figure, kind)
            assert file == render(figure, kind) == render(again[name], kind), name


def test_the_same_bytes_in_another_process() -> None:
    program = "from unit.plotting.vibration_samples import hashed\nprint(hashed())\n"
    tests = str(Path(__file__).parents[2])
    run = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        check=True,
        text=True,
        env={**os.environ, "PYTHONHASHSEED": "7", "PYTHONPATH": tests},
    )
    assert run.stdout.strip() == hashed()


def test_the_users_settings_do_not_matter() -> None:
    figure = pictures("plane")["mode-1"]
    file = render(figure, "svg")
    with matplotlib.rc_context({"font.size": 30, "axes.grid": False, "lines.linewidth": 9}):
        assert render(mode_drawings(eq.modes(plane()))["mode-1"], "svg") == file


def test_units_fit_the_values() -> None:
    assert Unit.of("displacement", False, [0.003]).name == "mm"
    assert Unit.of("displacement", False, [3e-7, float("nan")]) == Unit(1e6, "µm")
    assert Unit.of("displacement", False, [20.0]) == Unit(1.0, "m")
    assert Unit.of("velocity", True, [0.1]).name == "mrad/s"
    assert Unit.of("acceleration", False, [0.0]).name == "m/s²"
    assert Unit.of("force", True, [2e4]) == Unit(1e-3, "kN m")


def test_nothing_is_drawn_that_is_not_there() -> None:
    shown = " ".join(text.get_text() for text in drawn_texts(pictures("rig")["sweep response"]))
    assert "not stable" not in shown and "quieter" not in shown
