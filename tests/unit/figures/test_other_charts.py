"""Charts of exposure and decay; how axes are numbered; files of every kind."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.exposure.daily import Exposure, Task, daily_exposure
from equipoise.exposure.spectra import weigh_spectrum
from equipoise.exposure.weighting import NOMINAL, Weighted
from equipoise.figures import measured, plot, render
from equipoise.figures import measured as of_decay
from equipoise.figures.chart_parts import compared, crank_axis
from equipoise.figures.layout import SAMPLE, LegendKey, draw_legend
from equipoise.figures.sheet import CanvasStroke
from equipoise.figures.style import look_of
from equipoise.figures.view import AxisScale, ends_of, ticks_of
from equipoise.measured.decay import Decay, identify_decay
from equipoise.measured.record import simulate_decay
from equipoise.results.charts import RPM, Axis, Chart, Curve, Panel, four_digits
from equipoise.signals import Array, Figures, figures
from support.refusals import refused
from unit.figures.checks import check
from unit.figures.samples import words

HOUR = 3600.0
TIME = np.linspace(0.0, 4.0, 2000)


# -- exposure --------------------------------------------------------------------------------------


def weighted(**more: bool) -> Weighted:
    rms = np.array([np.linspace(1, 9, 24), np.full(24, 2.0), np.geomspace(9, 0.1, 24)])
    return weigh_spectrum(NOMINAL, rms, bands=True, **more)


def day(*tasks: tuple[str, float, float]) -> Exposure:
    return daily_exposure(Task(name, a, hours * HOUR) for name, a, hours in tasks)


WORK = day(("mowing", 4.6, 2.0), ("felling", 6.0, 1.0), ("stripping", 3.6, 2.0))


def tools(item: Exposure) -> list[tuple[str, float]]:
    return [(task.name, task.acceleration) for task in item.tasks]


def test_the_spectrum_before_and_after_weighting() -> None:
    result = weighted()
    chart = measured.spectrum(result, "mow.csv")
    assert result.band_a_h is not None
    curves, low = chart.panels[0].curves, chart.panels[0].y.low
    for curve, wanted in zip(curves, (result.band_a_h, result.band_a_hw), strict=True):
        total = np.sqrt(np.sum(wanted**2, axis=0))
        np.testing.assert_allclose(curve.y[::2], np.maximum(total, low))
    assert not chart.panels[0].areas  # nothing stands on a 0 that its axis does not have
    assert f"weighted, total value aₕᵥ = {result.a_hv:.4g} m/s²" in words(chart)
    assert len(measured.spectrum(weighted(weighted=True), "x").panels[0].curves) == 1
    names = measured.exposure_charts([("a", result), ("b", result)], tools(WORK), WORK)
    assert list(names) == ["spectrum", "spectrum-2", "exposure"]
    check(measured.spectrum(weigh_spectrum(NOMINAL, np.zeros((3, 24)), bands=True), "nothing"))


def test_tasks_and_the_day_stand_at_their_hours() -> None:
    chart = measured.exposure(tools(WORK), WORK)
    signs = [(mark.x, mark.y) for mark in chart.panels[0].marks if mark.sign]
    assert (WORK.duration / HOUR, WORK.a8) in signs
    for task in WORK.tasks:
        assert (task.duration / HOUR, task.partial) in signs
    limits = {line.at for line in chart.panels[0].lines}
    assert limits == {2.5, 5.0}
    for curve, task in zip(chart.panels[0].curves, WORK.tasks, strict=False):
        reach = np.interp(np.log(5.0), np.log(curve.y), np.log(curve.x))
        assert np.exp(reach) == pytest.approx(8 * (5.0 / task.acceleration) ** 2, rel=1e-6)


def test_what_is_beyond_a_value_has_a_sign_that_the_legend_reports() -> None:
    first = day(("calm", 1.0, 1.0), ("mowing", 6.0, 3.0), ("clearing", 13.0, 1.5))
    chart = measured.exposure(tools(first), first)
    roles = {mark.text: mark.role for mark in chart.panels[0].marks}
    assert [roles[name] for name in ("calm", "mowing", "clearing", "all of them")] == [
        "task",
        "warned",
        "broken",
        "broken",
    ]
    assert "above the limit value of 5 m/s² (2002/44/EC)" in words(chart)
    assert "above the action value of 2.5 m/s² (2002/44/EC)" in words(chart)
    assert len({look_of(role).sign for role in roles.values()} - {""}) == 3
    check(chart)
    calm = day(("calm", 1.0, 1.0), ("calmer", 0.5, 1.0))
    assert "above the" not in words(measured.exposure(tools(calm), calm))


@pytest.mark.parametrize(
    "exposure",
    [
        day(("one", 3.0, 4.0)),
        day(*((f"task number {k}", 1.0 + 0.3 * k, 0.2 + 0.1 * k) for k in range(12))),
        day(("short", 30.0, 5 / 3600), ("long", 0.2, 16.0)),
        day(("nothing", 0.0, 1.0)),
    ],
)
def test_odd_days(exposure: Exposure) -> None:
    check(measured.exposure(tools(exposure), exposure))
    check(measured.exposure(tools(exposure), None))


# -- decay -----------------------------------------------------------------------------------------


def decayed(kind: str = "length", **more: float) -> Decay:
    values = {"damping_ratio": 0.02, "coulomb": 0.001, "start": 0.04, "noise": 2e-4, **more}
    record = simulate_decay(TIME, natural_frequency=12.4, kind=kind, **values)
    return identify_decay(record)


def test_the_record_and_the_line_of_half_swings() -> None:
    result = decayed(center=0.1)
    charts = of_decay.decay_charts(result, "rig.csv")
    (panel,) = charts["record"].panels
    samples, fit = panel.curves
    assert [mark.y for mark in panel.marks] == pytest.approx(list(result.turns.displacement))
    np.testing.assert_allclose(fit.y, result.fitted(fit.x))
    assert len(samples.x) <= of_decay.MOST_DRAWN
    assert panel.y.text == "displacement, mm"
    result = decayed("angle")
    charts = of_decay.decay_charts(result, r"$x$ 減衰 \alpha " + "long " * 30)
    assert charts["record"].panels[0].y.text == "angle, deg"
    line = charts["swings"].panels[0].curves[1]
    slope, cut = result.line["slope"].value, result.line["intercept"].value
    np.testing.assert_allclose(line.y, slope * line.x + cut)
    for chart in charts.values():
        check(chart)


# -- axes and files --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("axis", "values", "wanted"),
    [
        (Axis(), [0.0, 10.0], ("0", "10")),
        (Axis(), [-3e-7, 4e-7], ("0", "2")),
        (Axis(low=0.0, high=2 * pi, scale="crank", unit=RPM), [], ("0", "")),
        (Axis(scale="log"), [0.02, 300.0], ("0.1", "100")),
        (Axis(scale="log"), [2.0, 2.6], ("2", "2")),
        (Axis(), [5.0, 5.0], ("4", "6")),
        (Axis(), [np.nan, 12345.0, 99999.0], ("20000", "100000")),
    ],
)
def test_numbers_on_axes(axis: Axis, values: list[float], wanted: tuple[str, str]) -> None:
    scale = AxisScale(axis, *ends_of(axis, [values]), 0.0, 300.0)
    ticks = ticks_of(scale)
    assert len(ticks) >= 3
    places = [float(scale.of(place)) for place, _ in ticks]
    assert places == sorted(places) and places[0] >= -0.1 and places[-1] <= 300.1
    reported = "".join(text for _, text in ticks)
    assert all(text in reported for text in wanted)


def small() -> Chart:
    x = np.linspace(0, 1, 50)
    panel = Panel(Axis("x"), Axis("y"), (Curve(x, x**2, "square"),))
    return Chart("small", "A title", "what", (panel,))


@pytest.mark.exhaustive(but=["png-\\x89PNG", "svg-<svg"])
@pytest.mark.parametrize(
    ("kind", "start"), [("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF")]
)
def test_files_are_the_same_on_every_run(kind: str, start: bytes) -> None:
    file = render(small(), kind)  # type: ignore[arg-type]
    assert file.startswith(start) and file == render(small(), kind)  # type: ignore[arg-type]
    for stamp in (b"Date", b"matplotlib.org", b"Software"):
        assert stamp not in file


# In this process: the test above.
@pytest.mark.exhaustive
def test_the_same_bytes_in_another_process() -> None:
    program = (
        "import equipoise as eq, hashlib\n"
        "from equipoise.figures import render\n"
        "from equipoise.figures.forces import polar\n"
        "chart = polar(eq.analyze(eq.load('yamashita-1')))\n"
        "print(hashlib.sha256(render(chart)).hexdigest())\n"
    )
    runs = {
        subprocess.run([sys.executable, "-c", program], capture_output=True, check=True).stdout
        for _ in range(2)
    }
    assert len(runs) == 1 and runs != {b""}


def test_the_users_settings_do_not_matter() -> None:
    import matplotlib as mpl

    file = render(small(), "png")
    with mpl.rc_context({"font.size": 30, "axes.grid": False}):
        before = dict(mpl.rcParams)
        assert render(small(), "png") == file
        assert dict(mpl.rcParams) == before


def test_pictures_by_name() -> None:
    analysis = eq.analyze(eq.load("yamashita-1"), 90)
    assert plot(analysis, "torque").get_size_inches()[0] == pytest.approx(7.2)
    with refused(eq.EquipoiseError, given="torqe", name="torque"):
        plot(analysis, "torqe")


def around(wave: Callable[[Array], Array], size: float) -> tuple[Array, Array, Figures]:
    """A wave over a turn with its end, and its figures."""
    theta = np.linspace(0.0, 2 * np.pi, 361)
    values = size * wave(theta)
    return theta, values, figures(theta[:-1], values[:-1], 2 * np.pi)


def test_values_of_lower_peaks_stand_under_their_curves() -> None:
    """Above it they would be taken for the other curve's."""
    lines = {"before": around(np.sin, 2.0), "after": around(lambda theta: np.sin(theta - 0.1), 1.0)}
    panel = compared(crank_axis("crank", 10.0, 1), "size", "force", lines)
    wishes = {(mark.role, mark.y > 0): mark.wish for mark in panel.marks}
    assert wishes == {
        ("before", True): 90.0,
        ("before", False): -90.0,
        ("after", True): -90.0,
        ("after", False): 90.0,
    }


def test_values_beside_each_other_stand_outside_their_curves() -> None:
    lines = {"before": around(np.sin, 2.0), "after": around(np.sin, -1.0)}
    panel = compared(crank_axis("crank", 10.0, 1), "size", "force", lines)
    assert all(mark.wish == (90.0 if mark.y > 0 else -90.0) for mark in panel.marks)


def test_samples_of_legends_look_like_what_is_drawn() -> None:
    """Also where a sign of machines has the same name."""
    drawn: list[Any] = []
    sheet: Any = SimpleNamespace(add=lambda item, _order: drawn.append(item))
    draw_legend(sheet, [LegendKey("room", "room allowed", "line")], 0.0, 200.0, 0.0)
    (line,) = [item for item in drawn if isinstance(item, CanvasStroke)]
    look = look_of("room")
    assert (line.color, line.width) == (look.color, look.width)
    shown = line.dashes
    assert np.allclose(np.array(shown) / shown[0], np.array(look.lengths) / look.lengths[0])
    assert 1.5 * sum(shown) <= SAMPLE + 1e-9


def test_numbers_are_plain_where_those_of_axes_are() -> None:
    """A speed of 12000 rpm, or an acceleration beside the marks of its axis."""
    written = {
        11923.4: "11920",
        -250123.0: "\N{MINUS SIGN}250100",
        9549.3: "9549",
        0.01235: "0.01235",
    }
    assert {value: four_digits(value) for value in written} == written
    assert four_digits(2.5e6) == "2.5×10⁶"
