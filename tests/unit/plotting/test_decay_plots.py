"""Pictures of a free decay."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

import equipoise as eq
from equipoise.plotting.decay import MOST_DRAWN, drawings
from equipoise.plotting.style import render
from unit.plotting.samples import words

TIME = np.linspace(0.0, 4.0, 2000)


def decay(kind: str = "length", **more: float) -> eq.measured.Decay:
    values = {"damping_ratio": 0.02, "coulomb": 0.001, "start": 0.04, "noise": 2e-4, **more}
    record = eq.measured.simulate_decay(TIME, natural_frequency=12.4, kind=kind, **values)
    return eq.measured.identify_decay(record)


def lines(figure: Figure) -> dict[str, np.ndarray]:
    return {str(line.get_label()): line.get_xydata() for line in figure.axes[0].get_lines()}


def test_the_record_with_its_fit_and_turning_points() -> None:
    found = decay(center=0.1)
    drawn = lines(drawings(found, "rig.csv")["record"])
    np.testing.assert_allclose(drawn["turning points"][:, 1], 1e3 * found.turns.displacement)
    at, values = drawn["fit"].T
    np.testing.assert_allclose(values, 1e3 * found.fitted(at))
    assert len(drawn["samples"]) <= MOST_DRAWN


def test_the_line_of_half_swings() -> None:
    found = decay("angle")
    figure = drawings(found, "rig.csv")["swings"]
    heights = np.degrees(found.turns.heights)
    pairs = [line.get_xydata() for line in figure.axes[0].get_lines()]
    assert any(np.array_equal(pair, np.column_stack([heights[:-1], heights[1:]])) for pair in pairs)
    box = figure.axes[0].get_window_extent()
    assert box.width == pytest.approx(box.height)


def test_axes_tell_units() -> None:
    for kind, unit in (("length", "displacement, mm"), ("angle", "angle, deg")):
        pictures = drawings(decay(kind), "rig.csv")
        record, swings = (words(figure) for figure in pictures.values())
        assert "rig.csv" in record and "rig.csv" in swings
        assert "time, s" in record and unit in record
        assert f"height of the next, {unit.split()[1]}" in swings
        assert "no decay" in swings


@pytest.mark.parametrize("title", ["$x$ 機 [1].csv", "long " * 40])
def test_odd_titles(title: str) -> None:
    for figure in drawings(decay(), title).values():
        svg = render(figure, "svg")
        assert title[:10].strip() in "".join(ElementTree.fromstring(svg).itertext())


@pytest.mark.parametrize("change", [{"damping_ratio": 0.3}, {"coulomb": 0.0, "damping_ratio": 0.0}])
def test_odd_decays(change: dict[str, float]) -> None:
    """Few half-swings far apart; all of them alike."""
    for figure in drawings(decay(**change), "rig.csv").values():
        ElementTree.fromstring(render(figure, "svg"))


@pytest.mark.parametrize("kind", ["svg", "png", "pdf"])
def test_the_same_bytes_on_every_run(kind: str) -> None:
    one, other = (drawings(decay(), "rig.csv") for _ in range(2))
    for name, figure in one.items():
        assert render(figure, kind) == render(other[name], kind)
