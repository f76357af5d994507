"""Charts of an analysis and of planting: they hold what was computed, and say so in words."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import degrees, tau

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.cylinder_phasing import PhasedRows
from equipoise.errors import UsageError
from equipoise.figures import chart_parts as view
from equipoise.figures import forces, planting
from equipoise.figures import motion as of_motion
from equipoise.figures.analysis import analysis_charts
from equipoise.figures.chart_parts import angle_step, groups
from equipoise.figures.linkage import cut_at
from equipoise.figures.style import look_of
from equipoise.mechanism.dynamics.forces import CAUSES
from equipoise.mechanism.parts.balance import Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.planting.summary import plant
from equipoise.results.analysis import Analysis
from equipoise.results.charts import Chart, Panel
from equipoise.signals import Periodic
from equipoise.symbols.scene import Scene, clear_angle
from unit.figures.checks import Laid, check
from unit.figures.samples import BUNDLED, drawn, long_cycle, one_link, read_off, words

MOTION = ["linkage", "curves", "hodograph", "centrodes"]
FORCES = ["polar", "force", "moment", "torque"]
JOINTS = ["joints", "joint-polars"]
DRY = ["path", "ratio-coupler", "ratio-rocker"]
DRY += [f"{name}{part}" for name in ("velocity", "acceleration") for part in ("", "-x", "-y")]


@cache
def analysis_of(name: str) -> Analysis:
    return eq.analyze(eq.load(name), 360)


@cache
def charts_of(name: str) -> dict[str, Chart]:
    return analysis_charts(analysis_of(name))


def rotor() -> Machine:
    """A disc out of balance: none of its points moves."""
    link = eq.Link({"A": (0, 0)}, 1.0, (0.03, 0.0), 1e-3)
    return replace(one_link(), links={"crank": link}, planting=None)


def staggered() -> Machine:
    rows = (Row(0.0, -0.3), Row(1.0, 0.0, (0.05, -0.02)), Row(2.5, 0.3, (-0.1, 0.03)))
    return replace(eq.load("four-row-transplanter"), rows=rows, balance=None)


def signals(panel: Panel) -> list[np.ndarray]:
    """Curves without their last value, which is the first again."""
    return [curve.y[:-1] for curve in panel.curves]


def places(panel: Panel) -> list[np.ndarray]:
    return [(curve.x + 1j * curve.y)[:-1] for curve in panel.curves]


def has(result: list[np.ndarray], wanted: np.ndarray) -> bool:
    size = np.max(np.abs(wanted))
    return any(z.shape == wanted.shape and np.max(np.abs(z - wanted)) < 1e-9 * size for z in result)


def test_names() -> None:
    assert list(charts_of("yamashita-1")) == [*MOTION, *FORCES, "spectrum", *JOINTS]
    machine = eq.load("yamashita-1")
    assert list(analysis_charts(eq.analyze(machine, 60))) == [*MOTION, *FORCES, *JOINTS]
    assert list(analysis_charts(eq.analyze(machine, [0.3]))) == ["linkage"]
    assert list(analysis_charts(eq.analyze(rotor(), 360)))[:2] == ["linkage", "polar"]
    free = eq.Link(machine.links["crank"].points)
    massless = replace(machine, links={**machine.links, "crank": free})
    assert list(analysis_charts(eq.analyze(massless, 90))) == MOTION


def test_planes_from_the_side() -> None:
    """Bodies as thick as they are, crank pins a stroke apart, and each sign in its plane."""
    twin = eq.load("twin-engine")
    (panel,) = charts_of("twin-engine")["side"].panels
    boxes = [shape.places for shape in panel.signs if shape.role == "solid"]
    spans = [(places.real.min(), places.real.max()) for places in boxes]
    assert np.allclose(spans, [(-0.025, 0.025), (-0.052, -0.028), (0.028, 0.052)])
    assert [np.ptp(places.imag) for places in boxes] == pytest.approx([0.076, 0.02, 0.02])
    pins = {complex(np.round(s.places[0], 9)) for s in panel.signs if s.role == "pin"}
    assert {-0.04 + 0.025j, 0.04 - 0.025j, 0j} < pins
    stands = {complex(shape.places[0]) for shape in panel.signs if shape.role == "stand"}
    assert stands == {-0.075 + 0j, 0.075 + 0j}
    assert {mark.text for mark in panel.marks} == {*twin.links, *twin.bearings}
    rooms = [shape.places for shape in panel.signs if shape.role == "room"]
    spans = [(*np.round([z.real.min(), z.real.max()], 9), np.ptp(z.imag)) for z in rooms]
    assert np.allclose(spans, [(-0.065, -0.055, 0.076), (0.055, 0.065, 0.076)])
    through = [s for s in panel.signs if s.role == "edge" and np.any(s.offsets)]
    ends = {complex(p): o.real for s in through for p, o in zip(s.places, s.offsets, strict=True)}
    assert ends[-0.04 + 0.025j] < 0 < ends[0.04 - 0.025j]
    loose = analysis_charts(eq.analyze(replace(twin, bearings={}), [0.0]), at=[0.0])["side"]
    assert [s.places[0] for s in loose.panels[0].signs if s.role == "stand"] == [0j]


def test_a_cylinder_from_the_side() -> None:
    """It lies in the plane of its point of the boom, from there to its point of the frame."""
    machine = eq.load("hydraulic-loader").with_link("boom", planes={"B": 0.3})
    analysis = eq.analyze(machine, [0.0])
    (panel,) = analysis_charts(analysis, at=[0.0])["side"].panels
    actual = {sign.role: sign.places for sign in panel.signs if sign.role in ("piston", "barrel")}
    ends = [actual["barrel"][0], actual["piston"][0]]
    heights = [machine.frame["A"][0], analysis.motion.points["B"].x[0]]
    assert np.allclose(ends, 0.3 + 1j * np.array(heights))


def test_what_links_beside_each_other_bear_is_drawn() -> None:
    charts, across = charts_of("twin-engine"), analysis_of("twin-engine").forces.across
    drawn = [values for panel in charts["moment"].panels[1:] for values in signals(panel)]
    assert has(drawn, across.rocking_moment.x)
    assert has(drawn, across.rocking_moment.y)
    panels = [*charts["joints"].panels, *charts["joints-2"].panels]
    assert [panel.title for panel in panels[-2:]] == ["bearing front", "bearing rear"]
    every = [values for panel in panels for values in signals(panel)]
    assert all(has(every, bearing.size) for bearing in across.bearings.values())
    rows = eq.load("twin-engine").with_rows((Row(0.0), Row(1.0, lateral=0.3)))
    above, *below = forces.moment(eq.analyze(rows, 36)).panels  # with both rows above alone
    assert len(signals(above)) > len(signals(below[0]))


def test_curves_are_the_forces() -> None:
    actual, charts = analysis_of("yamashita-1").forces, charts_of("yamashita-1")
    force = actual.shaking_force
    for panel, values in zip(charts["force"].panels, (force.x, force.y, force.size), strict=True):
        assert has(signals(panel), values)
    assert has(places(charts["polar"].panels[0]), force.value)
    assert has(signals(charts["moment"].panels[0]), actual.shaking_moment)
    whole, causes = charts["torque"].panels
    assert has(signals(whole), actual.drive_torque)
    np.testing.assert_allclose(sum(signals(causes)), actual.drive_torque, atol=1e-12)
    pairs = zip(charts["joints"].panels, charts["joint-polars"].panels, strict=True)
    for (over, polar), joint in zip(pairs, actual.joints.values(), strict=True):
        assert has(signals(over), joint.size) and has(places(polar), joint.value)


def test_peak_and_mean_size_are_the_summary() -> None:
    reported = words(charts_of("yamashita-1")["polar"])
    size = analysis_of("yamashita-1").summary["shaking_force"]
    assert f"peak {size.peak:.4g} N at {np.degrees(size.peak_at):.1f}°" in reported
    assert f"mean magnitude {size.mean:.4g} N" in reported


def test_bars_are_the_orders() -> None:
    """Against sums over the samples, without any transform; the load sets in and ends suddenly."""
    analysis = analysis_of("quick-return").resolved
    theta, torque = analysis.crank_angle, analysis.forces.drive_torque
    shares = analysis.motion.sampling.shares
    (bars,) = charts_of("quick-return")["spectrum"].panels[3].bars
    for order, (at, size) in enumerate(zip(bars.at, bars.size, strict=True)):
        mean = abs(np.sum(shares * torque * np.exp(1j * order * theta)))
        assert size == pytest.approx(mean * (1 if order == 0 else 2), rel=1e-9)
        assert at == pytest.approx(order)


def test_rows_together() -> None:
    """Against the sum that balancing takes by orders, with offsets and phases."""
    machine = staggered()
    analysis = eq.analyze(machine, 360)
    names = ("shaking_force", "shaking_moment", "drive_torque")
    mine = {name: view.each(analysis, name)["all"] for name in names}
    phases, force = np.array([row.phase for row in machine.rows]), mine["shaking_force"]
    for output, values in (
        ("shaking_force.x", force.real),
        ("shaking_force.y", force.imag),
        ("shaking_moment", mine["shaking_moment"]),
        ("drive_torque", mine["drive_torque"]),
    ):
        read = PhasedRows(machine).signals(Objective(output))
        expected = Periodic(read.total(phases)[0, 0], read.turns).samples(360)
        np.testing.assert_allclose(values, expected, atol=1e-9 * np.max(np.abs(expected)))
    result = places(forces.polar(analysis).panels[0])
    assert has(result, force) and has(result, view.each(analysis, "shaking_force")["one"])
    assert "3 rows together" in words(forces.spectrum(analysis))


def test_what_is_rounding_is_reported_to_be_zero() -> None:
    charts = charts_of("planetary-planting-arm")
    assert "zero at every crank angle" in words(charts["moment"])
    assert "zero at every order" in words(charts["spectrum"])
    assert not any(panel.message for panel in charts["spectrum"].panels)
    piston = charts_of("slider-crank-engine")["joints"]
    assert len(piston.panels) == 4 and "piston on frame: couple on piston" in words(piston)
    opposed = replace(staggered(), rows=(Row(0.0), Row(np.pi)), planting=None)
    force = view.each(eq.analyze(opposed, 360), "shaking_force")["all"]
    orders = np.abs(np.fft.fft(force))
    assert np.max(orders[1::2]) < 1e-9 * np.max(orders) > 0
    light = eq.load("scotch-yoke")
    for link in ("crank", "block"):
        light = light.with_link(link, mass=1e-30, inertia=0.0)
    only_along = eq.analyze(light, 360)
    force = view.each(only_along, "shaking_force")["all"]
    assert np.any(force.real) and not np.any(force.imag)
    check(forces.force(only_along))
    couples = [
        value for value in forces.joints_of(eq.analyze(rotor(), 360)).values() if value.couple
    ]
    assert all(not np.any(couple.values) for couple in couples)


def test_centrodes_of_gears_are_their_pitch_circles() -> None:
    """An idler rolls on the sun gear, which stands still; no link that is pinned has centrodes."""
    idler, planet = charts_of("planetary-planting-arm")["centrodes"].panels
    assert (idler.title, planet.title) == ("idler", "planet")
    fixed, moving = places(idler)
    motion = analysis_of("planetary-planting-arm").motion
    k = clear_angle(Scene.of(motion))  # at which the machine is drawn
    sun, wheel = motion.points["A"].place[k], motion.points["B"].place[k]
    np.testing.assert_allclose(np.abs(fixed - sun), 0.03, atol=1e-12)
    np.testing.assert_allclose(np.abs(moving - wheel), 0.03, atol=1e-12)
    assert "centrodes" not in charts_of("scotch-yoke")


@pytest.mark.parametrize("name", ["yamashita-1", "quick-return", "watt-six-bar"])
def test_centrodes_roll_on_each_other(name: str) -> None:
    """The moving one is the fixed one in the link's axes, and they touch in the instant centre."""
    motion = analysis_of(name).motion
    k = clear_angle(Scene.of(motion))
    for panel in charts_of(name)["centrodes"].panels:
        link, base = motion.links[panel.title], motion.linkage.anchors[panel.title]
        rotation = np.exp(1j * (link.angle - link.angle[k]))
        place = motion.points[base].place
        center = place + 1j * motion.points[base].place_1 / link.angle_1  # where nothing moves
        fixed, moving = places(panel)
        for curve, whole in ((fixed, center), (moving, place[k] + (center - place) / rotation)):
            away = np.abs(curve[:, None] - whole)
            samples = np.min(away, axis=1)[np.isfinite(curve)] < 1e-9
            assert np.mean(samples) > 0.9  # but for the places at which curves are cut
        if (mark := panel.marks[-1]).text == "instant centre":  # it is not too far off
            touching = int(np.nanargmin(np.abs(fixed - complex(mark.x, mark.y))))
            assert fixed[touching] == pytest.approx(center[k], abs=1e-12)
            assert np.nanmin(np.abs(moving - center[k])) < 1e-12
        else:
            assert f"instant centre of {panel.title} (" in words(charts_of(name)["centrodes"])


def test_an_instant_centre_at_infinity_is_said_to_be_there() -> None:
    """Of a connecting rod that is drawn with its crank across the cylinder."""
    assert "at infinity" in words(charts_of("slider-crank-engine")["centrodes"])


def test_centrodes_are_cut_where_they_leave_a_box() -> None:
    box = (0j, 4 + 2j)
    infinite = complex(np.inf, np.inf)
    line = np.array([-1 + 1j, 1 + 1j, 2 + 1j, 2 + 3j, infinite, -50 + 1j, 3 + 1j, 3 + 0j])
    wanted = [1j, 1 + 1j, 2 + 1j, 2 + 2j, complex(np.nan, np.nan), 3 + 1j, 3 + 0j]
    np.testing.assert_allclose(cut_at(box, line), wanted)
    assert cut_at(box, line - 10).size == 0
    np.testing.assert_allclose(cut_at(box, np.array([3 + 0j, 5 + 1j])), [3, 4 + 0.5j])


@pytest.mark.parametrize(
    "name", ["class-three", "baler-pickup", "transplanter", "carton-pusher", "balance-rig"]
)
def test_a_picture_of_centrodes_has_them_and_the_whole_machine(name: str) -> None:
    """No link whose instant centres are all too far off, no soil and no support; and the machine,
    which the picture shows at one angle, takes most of it: curves that run far away are cut.
    """
    motion = analysis_of(name).motion
    scene = Scene.of(motion)
    corners = scene.corners_at(clear_angle(scene))
    size = max(np.ptp(corners.real), np.ptp(corners.imag))
    chart = charts_of(name)["centrodes"]
    for panel in chart.panels:
        curves = np.concatenate(places(panel))
        assert np.isfinite(places(panel)[0]).any()
        assert (
            max(
                np.nanmax(curves.real) - np.nanmin(curves.real),
                np.nanmax(curves.imag) - np.nanmin(curves.imag),
            )
            <= 1.5 * size
        )
        low, high = panel.always_shown or (0j, 0j)
        assert np.all((low.real <= corners.real) & (corners.real <= high.real))
        assert np.all((low.imag <= corners.imag) & (corners.imag <= high.imag))
        roles = {shape.role for shape in (*panel.ground, *panel.signs)}
        assert not roles & {"soil", "stubble", "surface", "support", "support-edge"}
    cut = name != "baler-pickup"
    assert any("far away" in text for text in chart.words) is cut


@pytest.mark.parametrize("name", ["yamashita-1", "quick-return", "planetary-planting-arm"])
def test_paths_and_hodographs_are_the_motion(name: str) -> None:
    motion = analysis_of(name).motion
    (point,) = of_motion.traced(motion)
    assert has(places(charts_of(name)["curves"].panels[0]), motion.points[point].place)
    velocity, acceleration = (places(panel)[0] for panel in charts_of(name)["hodograph"].panels)
    np.testing.assert_allclose(velocity, motion.points[point].velocity, rtol=1e-12)
    np.testing.assert_allclose(acceleration, motion.points[point].acceleration_vector, rtol=1e-12)


@pytest.mark.parametrize("name", ["sieve", "knife-drive", "cutter-bar", "watt-six-bar"])
def test_dots_leave_paths_in_sight(name: str) -> None:
    """In half of a page, too; paths that are small beside the machine are enlarged."""
    chart = of_motion.curves(analysis_of(name))
    for laid, _ in Laid.in_report(chart).panels:
        for curve in laid.panel.curves:
            marks = [m for m in laid.panel.marks if m.sign and m.role == curve.role]
            if marks:
                path = laid.places(curve.x, curve.y)
                dots = np.array([laid.places(mark.x, mark.y)[0] for mark in marks])
                away = np.min(np.linalg.norm(path[:, None] - dots, axis=2), axis=1)[1:]
                lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
                assert np.sum(lengths[away < 2.0]) < 0.7 * np.sum(lengths)  # 2 points of radius
    assert (len(chart.panels) == 2) == (name in ("sieve", "knife-drive"))
    if len(chart.panels) == 2:
        path = analysis_of(name).motion.points[of_motion.traced(analysis_of(name).motion)[0]].place
        (shown,) = places(chart.panels[1])
        np.testing.assert_allclose(np.diff(shown), np.diff(path), atol=1e-12)
        assert abs(np.max(shown.real) + np.min(shown.real)) < 1e-12


def test_points_can_be_chosen() -> None:
    analysis = analysis_of("yamashita-1")
    assert "path of B" in words(of_motion.curves(analysis, ["B"]))
    names = {curve.label for curve in of_motion.hodograph(analysis, ["B", "C"]).panels[0].curves}
    assert names == {"B", "C"}
    with pytest.raises(KeyError):
        of_motion.curves(analysis, ["X"])


def test_crank_angles_that_are_no_cycle() -> None:
    part = eq.analyze(eq.load("yamashita-1"), np.linspace(0.5, 2.0, 40))
    panel = forces.force(part).panels[0]
    assert (panel.x.low, panel.x.high) == pytest.approx((0.5, 2.0))
    assert len(panel.curves[0].x) == 40
    assert "dashed: mean" not in words(forces.torque(part))
    with pytest.raises(UsageError):
        forces.spectrum(part)


def test_a_cycle_of_several_turns_is_drawn_whole() -> None:
    figures = plant(long_cycle())
    assert figures.curve.turns == 3
    panel = planting.planting_charts(figures)["velocity"].panels[0]
    assert (panel.x.low, panel.x.high) == pytest.approx((0, 3 * tau))
    assert [angle_step(turns) for turns in (1, 2, 3, 100)] == [30, 60, 90, 3600]


# -- planting --------------------------------------------------------------------------------------


def test_names_of_planting() -> None:
    assert list(planting.planting_charts(plant(eq.load("kim-chung-a")))) == DRY
    assert list(drawn("kim-chung-a")) == [*DRY, "torque", "joints"]


def test_names_do_for_files() -> None:
    base = eq.load("kim-chung-a")
    names = {"crank": "crank", "coupler": 'a/b:"*', "rocker": "A_b_?" + "x" * 90}
    links = {names[name]: link for name, link in base.links.items()}
    result = list(planting.planting_charts(plant(replace(base, links=links))))
    assert result[1] == "ratio-a_b___" and len(result[2]) == 60
    twins = {"crank": "crank", "coupler": "a/b", "rocker": "A|b"}
    links = {twins[name]: link for name, link in base.links.items()}
    result = list(planting.planting_charts(plant(replace(base, links=links))))
    assert result[1:3] == ["ratio-a_b", "ratio-A_b-2"]


@pytest.mark.parametrize("name", BUNDLED)
def test_curves_are_the_motion(name: str) -> None:
    motion = eq.move(eq.load(name), 720)
    tip = motion.points["P"]
    expected = {
        "velocity": np.abs(tip.velocity),
        "velocity-x": tip.vx,
        "velocity-y": tip.vy,
        "acceleration": np.abs(tip.acceleration_vector),
        "acceleration-x": tip.ax,
        "acceleration-y": tip.ay,
    }
    for picture, values in expected.items():
        (curve,) = drawn(name)[picture].panels[0].curves
        np.testing.assert_allclose(
            np.interp(motion.crank_angle, curve.x, curve.y),
            values,
            atol=2e-3 * np.max(np.abs(values)),
        )


def test_torque_and_joints_are_the_forces() -> None:
    actual, planted = drawn("kim-chung-a"), read_off("kim-chung-a").forces
    assert planted is not None
    air, soil = signals(actual["torque"].panels[0])
    shown = planted.motion.sampling.curve_places  # the force sets in at the surface
    np.testing.assert_array_equal(air, planted.in_air.drive_torque[shown])
    np.testing.assert_array_equal(soil, planted.in_soil.drive_torque[shown])
    for panel, joint in zip(actual["joints"].panels, planted.in_soil.joints.values(), strict=False):
        assert has(signals(panel), joint.size[shown])


def test_values_in_air_and_soil_stand_clear_of_the_other_curve() -> None:
    """A value stands outside its own curve, or where the other one is further out, inside."""
    inside = []
    for panel in (p for name in BUNDLED for p in drawn(name)["torque"].panels):
        curves = {curve.role: curve for curve in panel.curves}
        for mark in panel.marks:
            (other,) = (curve for role, curve in curves.items() if role != mark.role)
            out = 1.0 if mark.y > np.mean(curves[mark.role].y) else -1.0
            beyond = out * (np.interp(mark.x, other.x, other.y) - mark.y)
            if beyond > 1e-9 * np.max(np.abs(other.y)):
                inside.append(mark.wish == -90.0 * out)
    assert inside and all(inside)


def test_extremes_are_the_figures() -> None:
    figures, text = read_off("kim-chung-a"), words(drawn("kim-chung-a")["velocity"])
    for which in ("max", "min"):
        value, angle = figures[f"{which}_speed.value"], figures[f"{which}_speed.crank_angle"]
        assert f"{value:.4g} at {degrees(angle):.1f}°" in text


@pytest.mark.parametrize("name", BUNDLED)
def test_the_stay_in_the_soil_is_shaded_and_its_events_reported(name: str) -> None:
    figures, panel = read_off(name), drawn(name)["velocity"].panels[0]
    assert [(band.low, band.high) for band in panel.bands] == planting.soil_spans(figures)
    share = sum(band.high - band.low for band in panel.bands)
    visits = sum((visit.exit - visit.entry) % figures.curve.period for visit in figures.visits)
    assert share == pytest.approx(visits) or share == pytest.approx(figures.curve.period - visits)
    reported = words(drawn(name)["velocity"])
    for event in ("entry", "lowest", "exit"):
        assert event in reported and f"{degrees(figures[f'{event}.crank_angle']):.1f}°" in reported


def test_ratios_and_strands_over_the_crank() -> None:
    """A ratio that varies stays between its ends; the strands of a belt differ by its pull."""
    analysis = analysis_of("elliptic-quick-return")
    (panel,) = charts_of("elliptic-quick-return")["gears-crank"].panels
    (ratio,) = (values for values in signals(panel))
    ends = analysis.machine.gears[0].ratios
    assert (ratio.min(), ratio.max()) == pytest.approx(sorted(ends), rel=1e-3)
    (belt,) = analysis_of("knife-drive").forces.belts.values()
    left, right = (next(iter(signals(p))) for p in charts_of("knife-drive")["belt-crank"].panels)
    assert has([left], belt.left)
    assert has([right], belt.right)


def test_every_cause_looks_different_and_further_signals_like_the_first() -> None:
    """Such as the tips of more planting arms than there are looks."""
    looks = [look_of(f"several {number}") for number in range(1, len(CAUSES) + 1)]
    assert all(look not in looks[:k] for k, look in enumerate(looks))
    assert all(look_of(f"several {number}") in looks for number in range(1, 40))


def test_paths_that_coincide_are_drawn_once_with_all_their_names() -> None:
    """The walkers of a straw walker stand a quarter turn apart on the same throws."""
    analysis = eq.analyze(eq.load("straw-walker"), 360)
    panel = of_motion.curves(analysis).panels[0]
    legend = [curve.label for curve in panel.curves if curve.label]
    assert legend == ["path of T1, T2, T3, T4"]
    assert len(panel.curves) == 3  # with those of the pins of both crankshafts
    assert {"F1, F2, F3, F4", "R1, R2, R3, R4"} <= {mark.text for mark in panel.marks}
    apart = of_motion.curves(eq.analyze(eq.load("yamashita-1"), 360)).panels[0]
    assert all("," not in curve.label for curve in apart.curves)


def test_hodographs_that_coincide_are_drawn_once_with_all_their_names() -> None:
    """No walker of the four is left out, and none covers another; both pistons are of one curve."""
    for name, legend in (("straw-walker", "T1, T2, T3, T4"), ("twin-engine", "C1, C2")):
        for panel in of_motion.hodograph(eq.analyze(eq.load(name), 360)).panels:
            assert [curve.label for curve in panel.curves] == [legend]


def test_what_swings_by_rounding_alone_is_a_level_line() -> None:
    """A block stands at right angles to its slot; the angle of it was drawn millions of times as
    large.
    """
    (chart,) = (
        kinematic
        for kinematic in of_motion.main_kinematics(analysis_of("quick-return"))
        if kinematic.name == "kinematics-transmission"
    )
    block, link = chart.panels
    assert np.ptp(block.curves[0].y) == 0
    assert block.curves[0].y[0] == pytest.approx(tau / 4, abs=1e-7)
    assert np.ptp(link.curves[0].y) > 0.1


def test_a_jump_at_the_beginning_of_a_cycle_stands_at_both_ends() -> None:
    """Drawn at 0, the side before it made lines run back over the picture."""
    for panel in charts_of("plunger-pump")["joints"].panels:
        for curve in panel.curves:
            assert np.all(np.diff(curve.x) >= 0) and curve.x[-1] == pytest.approx(tau)


def test_pictures_of_several_have_as_many_rows_and_say_which_joints_they_have() -> None:
    """Instead of a last one with a single joint, drawn on a scale of its own."""
    charts = charts_of("squeezing-mechanism")
    assert "(1 to 6 of 10)" in charts["joint-polars"].what
    assert "(7 to 10 of 10)" in charts["joint-polars-2"].what
    shared = [
        [len(names) for _, names, _ in groups(range(n), 10, 2)] for n in (0, 1, 10, 11, 15, 21)
    ]
    assert shared == [[], [1], [10], [6, 5], [8, 7], [8, 8, 5]]


def test_a_picture_of_one_joint_of_several_says_which() -> None:
    assert [which for *_, which in groups("abc", 2)] == [" (1 to 2 of 3)", " (3 of 3)"]


def test_an_angle_that_runs_on_has_no_extremes_and_rounding_reads_0() -> None:
    """The second crank of a straw walker turns with the first one, and both are parallel twice."""
    names = ("straw-walker", "yamashita-1")
    analyses = [eq.analyze(eq.load(name)) for name in names]
    charts, others = (
        {c.name: c for c in of_motion.main_kinematics(analysis)} for analysis in analyses
    )
    turning, *_ = charts["kinematics-rear"].panels
    assert np.ptp(turning.curves[0].y) > 6 and turning.marks == ()
    (transmission,) = charts["kinematics-transmission"].panels
    largest, smallest = (mark.text for mark in transmission.marks)
    assert largest.startswith("179.") and smallest.startswith("0 at ")
    assert len(others["kinematics-rocker"].panels[0].marks) == 2
