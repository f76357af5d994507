"""The general route: figures by their path, as the commands print them, and why there are none."""

from __future__ import annotations

import gc
import json
import re
import weakref
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.figures import REASONS
from equipoise.design.variables import Range, Variable
from equipoise.errors import ModelError, UsageError
from equipoise.quantities import SI
from equipoise.results import analysis as analysis_module
from equipoise.results.analysis import ABOUT, BESIDE_OUTPUTS, BY_ORDER, FOUR_BAR, order_values
from equipoise.results.outputs import unit_of
from equipoise.schema.template import Template
from equipoise.studies.commands import COMMANDS, dimension_of, find_outputs, read, resolve, scale
from equipoise.studies.evaluate import OneByOne
from equipoise.studies.outcomes import Outcome
from equipoise.studies.study import COMMANDS as NAMES
from equipoise.studies.study import Output, Sampling, StudiedCommand, Study
from support.chosen import EXHAUSTIVE, few
from support.refusals import refused
from surface.running import equipoise, example_text, succeeded
from unit.studies.samples import template

VALUES: dict[str, Any] = {
    "title": "A machine",
    "crank_angle": np.array([0.0, 1.0, 2.0, 3.0]),
    "table": {"a.b": {"c": 1.0}, "a": {"b.c": 2.0, "d": 3}, "piston on frame": {"normal": 4.0}},
    "wave": np.array([1.0, -3.0, 2.0, 0.0]),
    "modes": [{"hertz": 5.0, "shape": [[0.1, 0.2], [0.3, 0.4]]}, {"hertz": 6.0}],
    "by_order": {"orders": np.array([0.0, 0.5, 1.0]), "harmonics": np.array([7.0, 8.0, 9.0])},
    "short": {"wave": {"rms": 10.0}, "name": "text"},
    "none": None,
    "truth": True,
    "empty": [],
}


# -- paths -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("table.a.b.c", 1.0),
        ('table.a."b.c"', 2.0),
        ("table.a.d", 3.0),
        ("table.piston on frame.normal", 4.0),
        ('table."piston on frame".normal', 4.0),
        ("modes[2].hertz", 6.0),
        ("modes[1].shape[2][1]", 0.3),
        ("wave[2]", -3.0),
        ("wave.peak", 3.0),
        ("wave.peak_at", 1.0),
        ("wave.peak_to_peak", 5.0),
        ("wave.mean", 0.0),
        ("by_order.harmonics[order 0.5]", 8.0),
        ("by_order.harmonics[ order 1 ]", 9.0),
        ("by_order.harmonics[3]", 9.0),
        ("by_order.harmonics[order 2.5]", 0.0),
        ("truth", 1.0),
        ("none", float("nan")),
    ],
)
def test_paths(path: str, value: float) -> None:
    assert read(VALUES, resolve(VALUES, path)) == pytest.approx(value, nan_ok=True)


def test_the_short_form_goes_first() -> None:
    assert resolve(VALUES, "wave.rms", "short") == ("short", "wave", "rms")
    assert resolve(VALUES, "table.a.d", "short") == ("table", "a", "d")
    assert resolve(VALUES, "wave.rms") != ("short", "wave", "rms")


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("tabel.a", {"given": "tabel", "name": "table"}),
        ("table.x.y", {"given": "x", "path": "table.x.y"}),
        ('table."a.c".d', {"given": "a.c", "name": "a.b"}),
        ("table.a", {"path": "table.a"}),
        ("", {"by": "resolve"}),
        ("title", {"here": "A machine", "path": "title"}),
        ("table.a.d.e", {"rest": "e", "path": "table.a.d.e"}),
        ("modes[3].hertz", {"place": "[3]", "count": 2, "path": "modes[3].hertz"}),
        ("modes[0].hertz", {"place": "[0]", "count": 2, "path": "modes[0].hertz"}),
        ("modes.hertz", {"count": 2}),
        ("modes.rms", {"count": 2}),
        ("wave", {"count": 4, "path": "wave"}),
        ("wave.largest", {"count": 4, "path": "wave.largest"}),
        ("empty.rms", {"count": 0, "path": "empty.rms"}),
        ("wave[order 2]", {"path": "wave[order 2]"}),
        ("by_order.harmonics[order 0.7]", {"number": "0.7", "orders": "0, 0.5, 1, 1.5"}),
        ("by_order.harmonics[order 2.7]", {"number": "2.7", "orders": "0, 0.5, 1, 1.5"}),
    ],
)
def test_wrong_paths(path: str, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected) as caught:
        resolve(VALUES, path)
    assert str(caught.value).startswith(f"got {path!r}; ")


def test_what_another_machine_lacks_is_no_number() -> None:
    for path in ("table.a.d", "modes[2].hertz", "wave.rms", "by_order.harmonics[order 1]"):
        steps = resolve(VALUES, path)
        for lacking in ({}, {**VALUES, "table": {}, "modes": [], "wave": 1.0, "by_order": {}}):
            assert np.isnan(read(lacking, steps))


def test_errors_are_measured_by_the_signal() -> None:
    rms = float(np.sqrt(np.mean(VALUES["wave"] ** 2)))
    assert scale(VALUES, resolve(VALUES, "wave.min")) == pytest.approx(rms)
    assert scale(VALUES, resolve(VALUES, "wave.min_at")) == pytest.approx(2 * np.pi)
    assert scale(VALUES, resolve(VALUES, "table.a.d")) == 1.0


# -- the commands ----------------------------------------------------------------------------------


def study(model: Template | str, vary: str, *outputs: Output | str, **given: Any) -> Study:
    """One number of a model varies by a tenth about its own value."""
    made = template(model) if isinstance(model, str) else model
    own, dimension = made.number(vary)
    ends = sorted((0.9 * own, 1.1 * own))
    return Study(
        title="Study",
        model=made,
        vary=(Variable(vary, Range(*ends), dimension),),
        outputs=tuple(Output(output) if isinstance(output, str) else output for output in outputs),
        sampling=Sampling("sobol", 16),
        **given,
    )


def asked(of: StudiedCommand, *paths: str) -> list[Output]:
    return [Output(path, of) for path in paths]


def computed(given: Study, *values: float) -> Outcome:
    """Designs of one varied number; those of the model where none is given."""
    own = [given.model.number(path)[0] for path in given.paths]
    return OneByOne(given)(np.array(values or own, float).reshape(-1, 1))


def printed(values: Any, path: str) -> float:
    """What a command has printed at a path whose names hold no dots but in quotes."""
    for key in re.findall(r'"[^"]+"|[^.\[\]]+', path):
        at = key.strip('"')
        values = values[int(at) - 1] if isinstance(values, list) else values[at]
    return float(values)


@pytest.mark.parametrize(
    ("model", "vary", "of", "paths"),
    [
        (
            "yamashita-1",
            "links.coupler.points.C.x",
            "analyze",
            ['summary."shaking_force.y".rms', 'summary."joints.B".peak_at', "crank_angle[7]",
             "summary.four_bar.transmission_min", "summary.four_bar.condition_5", "turns",
             "joints.C.force_x[90]", "strokes.rocker.time_ratio",
             "strokes.rocker.dead_positions[2].crank_angle"],
        ),
        (
            "cam-pusher",
            "springs[1].stiffness",
            "analyze",
            ['cams."crank to pusher".lift_off_speed', 'cams."crank to pusher".least_radius',
             'summary."springs.1.pull".min'],
        ),
        (
            "yamashita-rig",
            "support.mass",
            "respond",
            ["gauges.gauge.peak_to_peak", "gauges.gauge.acceleration.rms",
             "mounts.spring.transmissibility", "modes[1].hertz", "gauges.gauge.harmonics[2]"],
        ),
        (
            "transplanter",
            "planting.depth",
            "plant",
            ["soil.hole_length", "visits[1].depth", 'clearance.tray."tip P".value', "loops[1].area",
             "tray_crossings[1]", "loops[1].in_soil"],
        ),
        (
            "balance-crank",
            "links.crank.mass",
            "balance",
            ['objectives."ripple of shaking_force.y".after', 'after."joints.A.rms"', "gap",
             "changes[1].mass", 'equivalent_speeds."shaking_force.y.rms"'],
        ),
        (
            "pole-saw",
            "shaft.stations[1].mass",
            "tool",
            ["natural_frequencies[2]", "planes.lateral.damped[3].frequency"],
        ),
    ],
)  # fmt: skip
def test_figures_are_those_that_the_command_prints(
    model: str, vary: str, of: StudiedCommand, paths: list[str]
) -> None:
    given = study(model, vary, *asked(of, *paths), angles=360 if of == "analyze" else None)
    result = computed(given)
    values = json.loads(succeeded(equipoise(of, model, "--json")))
    assert result.reason.tolist() == [0]
    wanted = [printed(values, path) for path in paths]
    assert result.figures[0] == pytest.approx(wanted, rel=1e-12, abs=0)


def test_a_tool_of_named_speeds_needs_no_range() -> None:
    """What is asked alone is what is there beside everything else."""
    paths = ("a8", "named.working.rear-grip", "days.rear-grip.points")
    few = study("brush-cutter", "shaft.stations[1].mass", *asked("tool", *paths))
    many = study("brush-cutter", "shaft.stations[1].mass", *asked("tool", *paths, "a_hv.max"))
    result = computed(many)
    assert computed(few).figures[0] == pytest.approx(result.figures[0, :3], rel=1e-12)
    assert result.figures[0, 3] == np.max(
        json.loads(succeeded(equipoise("tool", "brush-cutter", "--json", "--exposure")))["a_hv"]
    )


# Figures of each command: `test_figures_are_those_that_the_command_prints`.
@pytest.mark.exhaustive
def test_several_commands_share_a_design() -> None:
    given = study(
        "transplanter",
        "drive.speed",
        Output("rms", "analyze", "drive_torque.rms"),
        Output("hole", "plant", "soil.hole_length"),
        Output("peak", "analyze", "drive_torque.peak"),
        angles=90,
    )
    speed = given.model.number("drive.speed")[0]
    result = computed(given, speed, 1.1 * speed)
    assert result.reason.tolist() == [0, 0]
    for row, factor in zip(result.figures, (1.0, 1.1), strict=True):
        machine = eq.load("transplanter").with_drive(speed=factor * speed)
        torque = eq.analyze(machine, 90).summary["drive_torque"]
        wanted = [torque.rms, eq.plant(machine)["soil.hole_length"], torque.peak]
        assert row == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("name", few(["transplanter", "kim-chung-b"], {"kim-chung-b"}))
def test_planting_figures_of_many_designs_are_those_of_each(name: str) -> None:
    """All but the last are computed together."""
    paths = ("curve.height", "soil.path_length_machine", "exit.ground_velocity.direction",
             "max_acceleration.value", "forward_speed")  # fmt: skip
    made, varied = template(name), "links.crank.points.B.x"
    own = made.number(varied)[0]
    some = study(made, varied, *asked("plant", *paths))
    factors = np.array([0.7, 0.9, 1.15, 5.0])
    result = computed(some, *(factors * own))
    failed = 0
    for factor, row, reason in zip(factors, result.figures, result.reason, strict=True):
        machine = made.machine({varied: factor * own})
        try:
            figures = eq.plant(machine)  # type: ignore[arg-type]
        except eq.EquipoiseError:
            assert reason != 0
            assert np.all(np.isnan(row))
            failed += 1
            continue
        assert reason == 0
        assert row == pytest.approx([figures[path] for path in paths], rel=1e-8)
    assert 0 < failed < len(factors)


# -- crank angles ----------------------------------------------------------------------------------


def test_crank_angles_double_until_figures_stand_still() -> None:
    paths = ("shaking_force.y.peak", "joints.B.rms", "points.P.y.max", "drive_torque.min",
             "by_order.shaking_moment.harmonics[order 3]", "shaking_force.y.peak_at")  # fmt: skip
    whole = eq.analyze(eq.load("yamashita-1"), 5_000)
    summary, height = whole.summary, whole.motion.points["P"].y
    exact = [summary["shaking_force.y"].peak, summary["joints.B"].rms, np.max(height),
             summary["drive_torque"].min, whole.by_order["shaking_moment"].sizes[3],
             summary["shaking_force.y"].peak_at]  # fmt: skip
    sizes = [summary["shaking_force.y"].rms, exact[1], np.sqrt(np.mean(height**2)),
             summary["drive_torque"].rms, summary["shaking_moment"].rms]  # fmt: skip
    result = computed(study("yamashita-1", "drive.speed", *paths, tolerance=1e-4))
    errors = np.abs(result.figures[0] - exact)
    assert np.all(errors[:-1] < 1e-4 * np.array(sizes))
    assert errors[-1] <= np.pi / 720  # a place is that of the nearest crank angle


# Figures beyond their tolerance fail in `test_crank_angles_double_until_figures_stand_still` too.
@EXHAUSTIVE
def test_the_tolerance_decides_how_many_crank_angles() -> None:
    """A peak at a kink lies between the crank angles, the nearer the more of them there are."""
    exact = eq.analyze(eq.load("pick-and-place"), 50_000).summary["drive_torque"]
    errors = []
    for tolerance in (1e-2, 1e-5):
        given = study("pick-and-place", "drive.speed", "drive_torque.peak", tolerance=tolerance)
        errors.append(abs(computed(given).figures[0, 0] - exact.peak) / exact.rms)
        assert errors[-1] < tolerance
    assert errors[0] > 3 * errors[1]


def test_a_coarser_analysis_is_gone_before_the_next_finer_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Analyses refer to themselves, so that all of them would lie in memory at once."""
    analyses: list[weakref.ref[eq.Analysis]] = []
    of = analysis_module.analyze

    def noted(machine: eq.Machine, angles: int) -> eq.Analysis:
        if angles > 8000:
            assert all(item() is None for item in analyses)
        analyses.append(weakref.ref(result := of(machine, angles)))
        return result

    monkeypatch.setattr(analysis_module, "analyze", noted)
    gc.disable()
    try:
        restless = study("quick-return", "drive.speed", "transmission.F.max", tolerance=1e-12)
        (reason,) = computed(restless).reason
    finally:
        gc.enable()
    assert len(analyses) > 6
    assert REASONS[reason] == "figures do not stand still"


def test_a_fixed_number_of_crank_angles() -> None:
    result = computed(study("yamashita-1", "drive.speed", "shaking_force.y.peak", angles=90))
    wanted = eq.analyze(eq.load("yamashita-1"), 90).summary["shaking_force.y"].peak
    assert result.figures[0, 0] == wanted


def test_rounding_stands_still() -> None:
    """Signals that are zero but for rounding are not asked for more."""
    paths = ("joints.piston on frame.moment.max", "points.C.x.peak_to_peak", "shaking_force.x.mean")
    result = computed(study("slider-crank-engine", "links.rod.mass", *paths))
    assert result.reason.tolist() == [0]
    assert np.all(np.abs(result.figures) < 1e-9)


# -- why there are no figures ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        ("links.rocker.points.C.x", 0.08, "computed"),
        ("links.rocker.points.C.x", 0.5, "does not assemble"),
        ("links.rocker.points.C.x", 0.03, "does not turn fully"),
        ("links.rocker.points.C.x", 0.05, "change point"),  # 88 + 33.5 = 71.5 + 50
        ("links.rocker.points.C.x", 0.0, "not a machine"),
        ("links.rocker.mass", -0.1, "not a machine"),
    ],
)
def test_reasons_of_an_analysis(path: str, value: float, reason: str) -> None:
    result = computed(study("yamashita-1", path, "drive_torque.rms", angles=90), value)
    assert REASONS[int(result.reason[0])] == reason
    assert np.isnan(result.figures[0, 0]) == (reason != "computed")


def test_the_tip_never_reaches_the_soil() -> None:
    given = study("transplanter", "planting.depth", *asked("plant", "soil.depth"), "turns")
    result = computed(given, 0.05, -0.01, 0.6)
    assert [REASONS[k] for k in result.reason.tolist()] == [
        "computed", "not a machine", "no such figure",
    ]  # fmt: skip
    assert result.figures[2, 1] == 1  # what can be told is told


TRAY, ROD = "planting.tray[2].y", "links.rod.mass"
HIGH = template("transplanter").number(TRAY)[0]


@pytest.mark.parametrize(
    ("given", "values", "reasons"),
    [
        pytest.param(
            study("transplanter", TRAY, *asked("plant", "pick_up.velocity.size")),
            (HIGH, HIGH + 10.0), ["computed", "no such figure"], id="a tip that does not reach",
        ),
        pytest.param(
            study("yamashita-rig", "drive.speed", *asked("respond", "gauges.gauge.rms")),
            (20.0, 0.0), ["computed", "cannot be computed"], id="a crank that stands still",
        ),
    ],
)  # fmt: skip
def test_other_reasons(given: Study, values: tuple[float, ...], reasons: list[str]) -> None:
    assert [REASONS[k] for k in computed(given, *values).reason.tolist()] == reasons


# -- before anything is run ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        (
            "shaking_force.z.rms",
            {"place": "outputs[2].value", "given": "z", "path": "shaking_force.z.rms"},
        ),
        ("joints.A.biggest", {"place": "outputs[2].value", "given": "biggest"}),
        (
            "joints.A.force_z.rms",
            {"place": "outputs[2].value", "given": "force_z", "name": "force_y"},
        ),
        (
            "four_bar.type",
            {"place": "outputs[2].value", "here": "crank-rocker", "path": "four_bar.type"},
        ),
        ("shaking_force.y", {"place": "outputs[2].value", "count": 360, "path": "shaking_force.y"}),
        ("shaking_force.y[1]", {"place": "outputs[2].value", "value": "shaking_force.y[1]"}),
    ],
)
def test_outputs_that_lead_nowhere(path: str, expected: dict[str, Any]) -> None:
    given = study("yamashita-1", "drive.speed", "drive_torque.rms", path)
    with refused(ModelError, **expected) as caught:
        find_outputs(given)
    assert str(caught.value).startswith(f"outputs[2].value: got {path!r}")


def test_without_masses() -> None:
    text = re.sub(r"(?m)^(mass|center_of_mass|inertia) = .*$", "", example_text("yamashita-1"))
    given = study(Template(text), "drive.speed", "turns", "drive_torque.rms")
    with refused(
        ModelError, "outputs[2].value", given="drive_torque.rms", links="crank, coupler, rocker"
    ):
        find_outputs(given)


def test_a_model_that_cannot_be_computed() -> None:
    given = study("yamashita-1", "drive.speed", "turns", *asked("balance", "gap"))
    with refused(ModelError, "outputs[2].of", command="balance"):
        find_outputs(given)


def test_a_model_that_fails_stands_back_for_designs_that_do_not() -> None:
    text = example_text("transplanter")
    depth = Template(text).number("planting.depth")[0]
    broken = Template(re.sub(r"(?m)^depth = .*$", 'depth = "2 m"', text))
    with pytest.raises(ModelError):
        eq.plant(broken.base())  # type: ignore[arg-type]
    given = study(broken, "planting.depth", *asked("plant", "soil.depth"))
    given = replace(given, vary=(Variable("planting.depth", Range(0.5 * depth, depth), "length"),))
    assert computed(given, depth).figures[0, 0] == pytest.approx(depth, rel=1e-9)


# -- dimensions ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["yamashita-1", "slider-crank-engine", "quick-return"])
def test_dimensions_of_an_analysis(name: str) -> None:
    """The units of the CSV file and of the summary are those of the dimensions."""
    analysis = eq.analyze(eq.load(name), 90)
    for column in (array.name for array in analysis.outputs.arrays):
        if column not in ("shaking_force.x", "shaking_force.y"):  # those of the summary go first
            dimension = dimension_of(analysis.machine, "analyze", f"{column}.rms")
            assert dimension is not None
            assert SI[dimension] == unit_of(column), column
    for signal in analysis.summary:
        dimension = dimension_of(analysis.machine, "analyze", f"summary.{signal}.peak")
        assert dimension == analysis.outputs[signal].dimension, signal
        assert dimension_of(analysis.machine, "analyze", f"{signal}.max_at") == "angle"


@pytest.mark.parametrize(
    ("model", "of", "path", "dimension"),
    [
        ("yamashita-1", "analyze", "four_bar.transmission_min", "angle"),
        ("yamashita-1", "analyze", "four_bar.a", "length"),
        ("yamashita-1", "analyze", "four_bar.time_ratio", None),
        ("yamashita-1", "analyze", "turns", None),
        ("yamashita-1", "analyze", "strokes.rocker.stroke", "angle"),
        ("yamashita-1", "analyze", "strokes.rocker.dwell", "angle"),
        ("yamashita-1", "analyze", "strokes.rocker.time_ratio", None),
        ("yamashita-1", "analyze", "strokes.rocker.dead_positions[1].place", "angle"),
        ("yamashita-1", "analyze", "outputs.centers.coupler/frame.x.max", "length"),
        ("quick-return", "analyze", "strokes.ram on frame.stroke", "length"),
        ("quick-return", "analyze", "strokes.ram on frame.dead_positions[1].place", "length"),
        ("quick-return", "analyze", "strokes.ram on frame.lowest_at", "angle"),
        ("cam-pusher", "analyze", "cams.crank to pusher.lift_off_speed", "angular speed"),
        ("cam-pusher", "analyze", 'cams."crank to pusher".least_radius', "length"),
        ("cam-pusher", "analyze", "cams.crank to pusher.normal.min", "force"),
        ("cam-pusher", "analyze", "springs.1.length.max", "length"),
        ("yamashita-1", "analyze", "by_order.mass_center.ax.harmonics[order 1]", "acceleration"),
        ("yamashita-1", "analyze", "by_order.shaking_moment.phases[2]", "angle"),
        ("yamashita-1", "analyze", "by_order.shaking_force.x.harmonics[order 1]", "force"),
        ("yamashita-1", "analyze", "by_link.shaking_force.crank.x.rms", "force"),
        ("yamashita-1", "analyze", "by_cause.drive_torque.weight.rms", "torque"),
        ("yamashita-1", "analyze", "by_cause.drive_torque.weight.peak_at", "angle"),
        ("transplanter", "plant", "cusps.max", "angle"),
        ("yamashita-rig", "respond", "gauges.gauge.phases.max", "angle"),
        ("transplanter", "plant", "soil.hole_length", "length"),
        ("transplanter", "plant", "entry.velocity.size", "speed"),
        ("transplanter", "plant", "visits[1].depth", "length"),
        ("transplanter", "plant", "visits[1].entry", "angle"),
        ("transplanter", "plant", "loops[1].area", None),
        ("transplanter", "plant", "forces.drive_torque.in_air.rms", "torque"),
        ("transplanter", "plant", "forces.joints.A.in_soil.peak", "force"),
        ("transplanter", "plant", "forces.joints.A.in_soil.peak_at", "angle"),
        ("yamashita-rig", "respond", "gauges.gauge.peak_to_peak", "length"),
        ("yamashita-rig", "respond", "gauges.gauge.acceleration.rms", "acceleration"),
        ("yamashita-rig", "respond", "gauges.gauge.harmonics[order 1]", "length"),
        ("yamashita-rig", "respond", "mounts.spring.rms", "force"),
        ("yamashita-rig", "respond", "mounts.spring.transmissibility", None),
        ("yamashita-rig", "respond", "modes[1].hertz", "frequency"),
        ("yamashita-rig", "respond", "modes[1].natural_frequency", "angular speed"),
        ("yamashita-rig", "respond", "drive.torque.rms", "torque"),
        ("balance-crank", "balance", "added_mass", "mass"),
        ("balance-crank", "balance", "after.shaking_force.y.rms", "force"),
        ("balance-crank", "balance", "after.shaking_moment.area", None),
        ("balance-crank", "balance", "equivalent_speeds.shaking_force.rms", "angular speed"),
        ("balance-crank", "balance", "gap", None),
        ("brush-cutter", "tool", "a8", "acceleration"),
        ("brush-cutter", "tool", "natural_frequencies[1]", "frequency"),
        ("brush-cutter", "tool", "stations.belt.forces.harness.max", "force"),
        ("brush-cutter", "tool", "stations.belt.power.harness.max", "power"),
        ("brush-cutter", "tool", "stations.head.displacement.max", "length"),
        ("brush-cutter", "tool", "stations.head.displacement.max_at", "angular speed"),
        ("brush-cutter", "tool", "largest_moment.moment.max", "torque"),
        ("brush-cutter", "tool", "named.working.rear-grip", "acceleration"),
        ("brush-cutter", "tool", "days.rear-grip.points", None),
        ("brush-cutter", "tool", "transmission.belt.ratio.max", None),
    ],
)
def test_dimensions(model: str, of: str, path: str, dimension: str | None) -> None:
    assert dimension_of(template(model).base(), of, path) == dimension


def test_figures_of_cams_stand_still_to_a_share_of_themselves() -> None:
    """A lift-off speed is hundreds of rad/s, and to 1e-4 rad/s it never stands still."""
    content = eq.analyze(eq.load("cam-pusher")).to_dict()
    steps = resolve(content, "cams.crank to pusher.lift_off_speed")
    assert scale(content, steps) == read(content, steps) > 50


def test_what_an_analysis_has_beside_outputs_is_declared() -> None:
    """Of each number that it gives a study knows the dimension from the declaration."""
    analysis = eq.analyze(eq.load("yamashita-1"))
    values = analysis.to_dict()
    of_one = {*values["summary"]["four_bar"]}
    assert of_one == {*FOUR_BAR} and {*values["about"]} == set(ABOUT["about"].of or ())
    assert {*order_values(analysis, 3, 0.0)["shaking_force.x"]} == {*BY_ORDER}
    for key, value in BESIDE_OUTPUTS.items():
        assert key in values or key in values["summary"]
        if value.of is None:
            assert dimension_of(analysis.machine, "analyze", key) == value.dimension
    for key, value in FOUR_BAR.items():
        result = dimension_of(analysis.machine, "analyze", f"summary.four_bar.{key}")
        assert result == value.dimension, key


def test_every_command_of_a_study_is_declared() -> None:
    """`analyze` stands apart, for its crank angles."""
    assert {"analyze", *COMMANDS} == {*NAMES}
    for declare in COMMANDS.values():
        outputs = declare()
        assert callable(outputs.compute) and all(outputs.declared)
