"""Charts of exposure, decay, studies and maps; how axes are numbered; files of every kind."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
import pytest
from scipy.interpolate import RectBivariateSpline

import equipoise as eq
from equipoise.exposure.daily import Exposure, Task, daily_exposure
from equipoise.exposure.spectra import weigh_spectrum
from equipoise.exposure.weighting import NOMINAL, Weighted
from equipoise.figures import figure, measured, plot, render, studies
from equipoise.figures import measured as of_decay
from equipoise.figures.curves import levels_of
from equipoise.figures.view import Scale, ends_of, ticks_of
from equipoise.measured.decay import Decay, identify_decay
from equipoise.measured.record import simulate_decay
from equipoise.mechanism.objectives import Objective
from equipoise.results.charts import RPM, Axis, Chart, Curve, Panel
from equipoise.schema.studies import load_study
from equipoise.schema.study_units import units_of
from equipoise.schema.template import Template
from equipoise.studies.objective_map import Landscape, landscape
from equipoise.studies.search import Searched, search_designs
from equipoise.studies.selection import Best
from equipoise.studies.tolerances import Tolerances, tolerance
from unit.figures.checks import check
from unit.figures.samples import words

HOUR = 3600.0
TIME = np.linspace(0.0, 4.0, 2000)
OWN = (np.array([0.199, 0.012, 0.0, 0.0715, 0.08]), np.array([8.7, 12.2, 0.21]))


# -- exposure --------------------------------------------------------------------------------------


def weighted(**more: bool) -> Weighted:
    rms = np.array([np.linspace(1, 9, 24), np.full(24, 2.0), np.geomspace(9, 0.1, 24)])
    return weigh_spectrum(NOMINAL, rms, bands=True, **more)


def day(*tasks: tuple[str, float, float]) -> Exposure:
    return daily_exposure(Task(name, a, hours * HOUR) for name, a, hours in tasks)


WORK = day(("mowing", 4.6, 2.0), ("felling", 6.0, 1.0), ("stripping", 3.6, 2.0))


def tools(one: Exposure) -> list[tuple[str, float]]:
    return [(task.name, task.acceleration) for task in one.tasks]


def test_the_spectrum_before_and_after_weighting() -> None:
    found = weighted()
    chart = measured.spectrum(found, "mow.csv")
    assert found.band_a_h is not None
    for area, wanted in zip(chart.panels[0].areas, (found.band_a_h, found.band_a_hw), strict=True):
        total = np.sqrt(np.sum(wanted**2, axis=0))
        np.testing.assert_allclose(area.high[::2], np.maximum(total, area.low[0]))
    assert f"weighted, a_hv = {found.a_hv:.4g} m/s²" in words(chart)
    assert len(measured.spectrum(weighted(weighted=True), "x").panels[0].areas) == 1
    names = measured.exposure_charts([("a", found), ("b", found)], tools(WORK), WORK)
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


@pytest.mark.parametrize(
    "one",
    [
        day(("one", 3.0, 4.0)),
        day(*((f"task number {k}", 1.0 + 0.3 * k, 0.2 + 0.1 * k) for k in range(12))),
        day(("short", 30.0, 5 / 3600), ("long", 0.2, 16.0)),
        day(("nothing", 0.0, 1.0)),
    ],
)
def test_odd_days(one: Exposure) -> None:
    check(measured.exposure(tools(one), one))
    check(measured.exposure(tools(one), None))


# -- decay -----------------------------------------------------------------------------------------


def decayed(kind: str = "length", **more: float) -> Decay:
    values = {"damping_ratio": 0.02, "coulomb": 0.001, "start": 0.04, "noise": 2e-4, **more}
    record = simulate_decay(TIME, natural_frequency=12.4, kind=kind, **values)
    return identify_decay(record)


def test_the_record_and_the_line_of_half_swings() -> None:
    found = decayed(center=0.1)
    charts = of_decay.decay_charts(found, "rig.csv")
    (panel,) = charts["record"].panels
    samples, fit = panel.curves
    assert [mark.y for mark in panel.marks] == pytest.approx(list(found.turns.displacement))
    np.testing.assert_allclose(fit.y, found.fitted(fit.x))
    assert len(samples.x) <= of_decay.MOST_DRAWN
    assert panel.y.text == "displacement, mm"
    found = decayed("angle")
    charts = of_decay.decay_charts(found, r"$x$ 減衰 \alpha " + "long " * 30)
    assert charts["record"].panels[0].y.text == "angle, deg"
    line = charts["swings"].panels[0].curves[1]
    slope, cut = found.line["slope"].value, found.line["intercept"].value
    np.testing.assert_allclose(line.y, slope * line.x + cut)
    for chart in charts.values():
        check(chart)


# -- studies ---------------------------------------------------------------------------------------


@cache
def tolerances() -> Tolerances:
    study = load_study("study-of-tolerances")
    return tolerance(replace(study, angles=90, sampling=replace(study.sampling, designs=800)))


@cache
def of_tolerances() -> dict[str, Chart]:
    return studies.tolerance_charts(tolerances(), units_of(tolerances().study))


@cache
def searched() -> Searched:
    pytest.importorskip("pymoo")
    study = replace(load_study("study-of-balance"), angles=90)
    return search_designs(study, population=12, generations=3)


@cache
def of_search() -> dict[str, Chart]:
    return studies.searched_charts(searched(), units_of(searched().study), OWN)


@cache
def of_three() -> dict[str, Chart]:
    """Three aims, as `equipoise best` finds them in a store."""
    found = searched()
    count = len(found.values)
    by = {"forward": "smallest", "upward": "smallest", "stroke": "largest"}
    names = (found.study.paths, found.study.names)
    numbers = np.arange(count) + 100
    best = Best(by, *names, numbers, found.values, found.figures, *[count] * 4)  # type: ignore[arg-type]
    return studies.best_charts(best, "A store", units_of(found.study))


def test_histograms_are_the_scatter_and_pale_outside_of_the_limit() -> None:
    chart, found = of_tolerances()["scatter"], tolerances()
    for panel, one in zip(chart.panels, found.scatters.values(), strict=True):
        (bars,) = panel.bars
        np.testing.assert_allclose(bars.size, one.counts / found.designs)
        np.testing.assert_allclose(bars.at - np.asarray(bars.width) / 2, one.edges[:-1])
        limit = one.output.at_most
        assert {line.at for line in panel.lines} == {one.base, *([] if limit is None else [limit])}
        pale = [x for x, role in zip(one.edges, bars.roles, strict=False) if role == "outside"]
        assert all(limit is not None and x >= limit for x in pale)


def test_what_to_tighten_first_stands_at_the_top_and_shares_are_of_each() -> None:
    found, chart = tolerances(), of_tolerances()["tighten"]
    (panel,) = chart.panels
    gains = [max(cause.gain, 0.0) for cause in found.causes]
    np.testing.assert_allclose(panel.bars[0].size, gains)
    assert panel.y.low is not None and panel.y.high is not None and panel.y.low > panel.y.high
    assert panel.y.ticks is not None and panel.y.ticks[0][1] == "drive.speed"
    assert "links.coupler.mass + inertia" in words(chart)
    for part, name in zip(of_tolerances()["shares"].panels, found.scatters, strict=True):
        effects = [cause.effects[name] for cause in found.causes]
        for bars, kind in zip(part.bars, ("total", "first"), strict=True):
            sizes = [max(getattr(effect, kind).value, 0.0) for effect in effects]
            np.testing.assert_allclose(bars.size, sizes)


def test_designs_are_drawn_with_the_model_beside_them() -> None:
    chart, found = of_search()["front"], searched()
    (panel,) = chart.panels
    np.testing.assert_allclose(panel.curves[0].x, found.figures[:, 0])
    np.testing.assert_allclose(panel.curves[0].y, found.figures[:, 1])
    assert [(m.x, m.y) for m in panel.marks if m.role == "own"] == [tuple(OWN[1][:2])]
    told = words(chart)
    assert "upward (small is good), N" in told and "the model itself" in told
    for number, (panel, label) in enumerate(
        zip(of_search()["designs"].panels, ("mass, g", "center_of_mass.x, mm"), strict=False)
    ):
        np.testing.assert_allclose(panel.curves[0].x, found.values[:, number])
        assert panel.x.text == f"links.crank.{label}"
    (curve,) = of_search()["search"].panels[0].curves
    np.testing.assert_allclose(curve.y, found.volumes)


def test_three_aims_are_drawn_in_pairs() -> None:
    chart, found = of_three()["front"], searched()
    aims = [panel.x.label.split(" ")[0] for panel in chart.panels]
    assert aims == ["forward", "forward", "upward"]
    np.testing.assert_allclose(chart.panels[2].curves[0].x, found.figures[:, 1])
    assert "stroke (large is good), mm" in words(chart)


@pytest.mark.parametrize("charts", [of_tolerances, of_search, of_three])
def test_charts_of_studies(charts: object) -> None:
    for chart in charts().values():  # type: ignore[operator]
        check(chart)


# -- maps ------------------------------------------------------------------------------------------


@cache
def smooth() -> Landscape:
    over = {
        "links.coupler.center_of_mass.x": np.linspace(-0.06, 0.06, 31),
        "links.coupler.center_of_mass.y": np.linspace(-0.04, 0.08, 31),
    }
    force = Objective("shaking_force.y", "ripple")
    return landscape(Template.load("yamashita-2"), over, force)


@cache
def broken() -> Landscape:
    """Half of these linkages cannot turn."""
    over = {
        "links.crank.points.B.x": np.linspace(0.011, 0.081, 9),
        "counterweights.crank.radius": np.linspace(0.0, 0.05, 9),
    }
    force, given = Objective("shaking_force"), {"counterweights.crank.mass": 0.3}
    return landscape(Template.load("yamashita-1"), over, force, given)


def test_the_least_and_the_model_are_marked_where_they_are() -> None:
    found = smooth()
    chart = studies.landscape(found)
    marks = {mark.role: (mark.x, mark.y) for mark in chart.panels[0].marks}
    assert marks == {"least": found.best, "own": found.start}
    assert f"{found.least:.4g} N" in words(chart) and f"{found.before:.4g} N" in words(chart)
    assert f"least {found.objective.name}: {found.least:.4g} N" in studies.told_best(found)
    spline = RectBivariateSpline(found.y, found.x, found.values)
    assert float(spline(found.best[1], found.best[0])[0, 0]) == pytest.approx(found.least, rel=0.05)
    levels = levels_of(found.values)
    assert 3 <= len(levels) <= 13 and np.allclose(np.diff(levels), levels[1] - levels[0])


def test_what_cannot_turn_is_hatched_and_what_was_set_is_told() -> None:
    chart = studies.landscape(broken())
    told = words(chart)
    assert "cannot turn" in told and "counterweights.crank.mass = 300 g" in told
    assert "cannot turn" not in words(studies.landscape(smooth()))
    level = replace(smooth(), values=np.full_like(smooth().values, 3.0))
    for one in (chart, studies.landscape(smooth()), studies.landscape(level)):
        check(one)
        assert render(one) == render(one)


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
    scale = Scale(axis, *ends_of(axis, [values]), 0.0, 300.0)
    ticks = ticks_of(scale)
    assert len(ticks) >= 3
    places = [float(scale.of(place)) for place, _ in ticks]
    assert places == sorted(places) and places[0] >= -0.1 and places[-1] <= 300.1
    told = "".join(text for _, text in ticks)
    assert all(text in told for text in wanted)


def small() -> Chart:
    x = np.linspace(0, 1, 50)
    panel = Panel(Axis("x"), Axis("y"), (Curve(x, x**2, "square"),))
    return Chart("small", "A title", "what", (panel,))


@pytest.mark.parametrize(
    ("kind", "start"), [("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF")]
)
def test_files_are_the_same_on_every_run(kind: str, start: bytes) -> None:
    file = render(small(), kind)  # type: ignore[arg-type]
    assert file.startswith(start) and file == render(small(), kind)  # type: ignore[arg-type]
    for stamp in (b"Date", b"matplotlib.org", b"Software"):
        assert stamp not in file


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
    one = plot(analysis, "torque")
    assert one.get_size_inches()[0] == pytest.approx(7.2)  # type: ignore[union-attr]
    assert set(plot(analysis, "force", "moment")) == {"force", "moment"}  # type: ignore[arg-type]
    with pytest.raises(eq.EquipoiseError, match="did you mean"):
        plot(analysis, "torqe")
    assert figure(small()).get_size_inches()[0] == pytest.approx(7.2)
