"""Pictures of hand-arm vibration."""

from __future__ import annotations

from itertools import combinations
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

from equipoise.exposure.daily import Exposure, Task, daily_exposure
from equipoise.exposure.spectra import weigh_spectrum
from equipoise.exposure.weighting import NOMINAL, Weighted
from equipoise.plotting.exposure import drawings
from equipoise.plotting.style import render, styled
from unit.figures.samples import texts, words

HOUR = 3600.0


def weighted(**more: bool) -> Weighted:
    rms = np.array([np.linspace(1, 9, 24), np.full(24, 2.0), np.geomspace(9, 0.1, 24)])
    return weigh_spectrum(NOMINAL, rms, bands=True, **more)


def day(*tasks: tuple[str, float, float]) -> Exposure:
    return daily_exposure(Task(name, a, hours * HOUR) for name, a, hours in tasks)


WORK = day(("mowing", 4.6, 2.0), ("felling", 6.0, 1.0), ("stripping", 3.6, 2.0))


def tools(exposure: Exposure) -> list[tuple[str, float]]:
    return [(task.name, task.acceleration) for task in exposure.tasks]


def lines(figure: Figure) -> list[np.ndarray]:
    return [line.get_xydata() for line in figure.axes[0].get_lines()]


def test_the_spectrum_before_and_after_weighting() -> None:
    found = weighted()
    figure = drawings([("mow.csv", found)], [], None)["spectrum"]
    top, curve = figure.axes
    filled = [patch.get_data().values for patch in top.patches]
    assert found.band_a_h is not None
    for wanted in (found.band_a_h, found.band_a_hw):
        total = np.sqrt(np.sum(wanted**2, axis=0))
        assert any(np.allclose(values, total) for values in filled)
    assert curve.get_xlim() == top.get_xlim()
    told = words(figure)
    assert "mow.csv" in told and "frequency, Hz" in told and "RMS, m/s²" in told


def test_a_spectrum_that_is_weighted_already_has_no_other() -> None:
    figure = drawings([("mow.csv", weighted(weighted=True))], [], None)["spectrum"]
    assert len(figure.axes[0].patches) == 2  # area and outline
    assert not any("RMS, " in label for label in words(figure) if "m/s²" not in label)


def test_tasks_and_the_day_stand_at_their_hours() -> None:
    figure = drawings([], tools(WORK), WORK)["exposure"]
    points = [pair[0] for pair in lines(figure) if len(pair) == 1]
    wanted = [(task.duration / HOUR, task.partial) for task in WORK.tasks]
    np.testing.assert_allclose(points, [*wanted, (5.0, WORK.a8)])
    for wanted_value in (2.5, 5.0):
        assert any(np.all(pair[:, 1] == wanted_value) for pair in lines(figure))
    told = words(figure)
    assert "limit value 5 m/s²" in told and "action value 2.5 m/s²" in told
    assert "all of them" in told and "felling" in told and "A(8) = 3.61 m/s²" in told


def test_lines_reach_the_limit_where_the_times_say() -> None:
    figure = drawings([], [("saw", 7.4)], None)["exposure"]
    slope = next(pair for pair in lines(figure) if np.ptp(pair[:, 1]) > 0)
    hours = np.exp(np.interp(np.log(5.0), *np.log(slope[:, ::-1]).T))
    assert hours == pytest.approx(8 * (5 / 7.4) ** 2)
    assert "saw" in words(figure)


def test_every_file_has_a_spectrum_of_its_own() -> None:
    made = drawings([("a", weighted()), ("b", weighted())], tools(WORK), WORK)
    assert list(made) == ["spectrum", "spectrum-2", "exposure"]


ODD = {
    "nothing": day(("rest", 0.0, 1.0)),
    "weak": day(("sanding", 0.02, 1.0)),
    "strong": day(("hammer", 900.0, 0.01), ("saw", 4.0, 2.0)),
    "alike": day(*[(f"task {k}", 4.0, 1.0) for k in range(12)]),
    "long": day(("long " * 30, 3.0, 24.0)),
    "short": day(("at once", 3.0, 0.001)),
    "signs": day(("$x$ 機 [1]", 3.0, 1.0)),
}


@pytest.mark.parametrize("exposure", ODD.values(), ids=ODD)
def test_odd_days(exposure: Exposure) -> None:
    for times in (exposure, None):
        figure = drawings([], tools(exposure), times)["exposure"]
        ElementTree.fromstring(render(figure, "svg"))
        inside(figure)


def test_texts_keep_clear_of_each_other() -> None:
    for figure in drawings([("mow.csv", weighted())], tools(WORK), WORK).values():
        inside(figure)
        with styled():
            boxes = [(text.get_text(), text.get_window_extent()) for text in texts(figure)]
        for (one, a), (other, b) in combinations(boxes, 2):
            across, up = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
            assert across <= 0.5 or up <= 0.5, (one, other)


def inside(figure: Figure) -> None:
    """No text leaves the picture."""
    with styled():
        figure.draw_without_rendering()
        width, height = figure.get_size_inches() * figure.dpi
        for text in texts(figure):
            box = text.get_window_extent()
            assert box.x0 >= 0 and box.y0 >= 0, text.get_text()
            assert box.x1 <= width and box.y1 <= height, text.get_text()


def test_a_spectrum_of_nothing() -> None:
    found = weigh_spectrum([100.0], [0.0])
    ElementTree.fromstring(render(drawings([("still", found)], [], None)["spectrum"], "svg"))


@pytest.mark.parametrize("kind", ["svg", "png", "pdf"])
def test_the_same_bytes_on_every_run(kind: str) -> None:
    one, other = (drawings([("a", weighted())], tools(WORK), WORK) for _ in range(2))
    for name, figure in one.items():
        assert render(figure, kind) == render(other[name], kind)
