"""Which model answers, and what is refused, in words."""

from __future__ import annotations

from dataclasses import replace
from math import inf, nan
from typing import Literal

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import EquipoiseError, MassError, ModelError, UsageError
from equipoise.mechanism.parts.motors import Motor, MotorTable
from equipoise.mechanism.parts.support import UP
from equipoise.present.findings import Findings, find
from equipoise.present.summary import vibration_sentences
from equipoise.results.blocks import Text
from equipoise.vibration.blocks import disagreement, response_headline
from equipoise.vibration.coupled import StallError
from equipoise.vibration.exact import solve_exact
from equipoise.vibration.forced import chosen_model, respond, sweep_speed
from equipoise.vibration.linear import around
from equipoise.vibration.response import MODELS, ExcitationModel
from equipoise.vibration.simplified import linear_of
from support.chosen import few
from support.refusals import has_value, refused
from unit.vibration.build import PIVOT, SPEED, Mount, block, cart, rig, rocking, short_rig, springs

LINE = Motor(26.0, 6.0)
BARE = eq.load("yamashita-1")
DRIVEN = BARE.with_drive(motor=LINE)
GROUND = ModelError(
    "support",
    "the machine stands on solid ground; add a table [support] with its mass, mounts and gauges",
)
MOTORLESS = ModelError("drive.motor", "missing; give its no_load_speed and stall_torque")
SPACE = (
    "the {} model is for motion in the plane of the drawing; leave out sway, roll and yaw, or "
    "choose moment"
)


def swing(machine: eq.Machine, model: ExcitationModel | None) -> float:
    """What the only gauge reads from peak to peak."""
    (gauge,) = respond(machine, model=model).gauges.values()
    return float(gauge.displacement.peak_to_peak)


@pytest.mark.parametrize(
    ("machine", "drive", "model"),
    [
        (rig(), False, "moment"),
        (rocking(), False, "moment"),
        (springs(), False, "moment"),
        (cart(), False, "moment"),
        (rig().with_drive(motor=LINE), True, "exact"),
        (DRIVEN, True, "exact"),
    ],
)
def test_the_default_model(machine: eq.Machine, drive: bool, model: str) -> None:
    """Force and moment, however the support is held; the paper's models by name alone."""
    assert chosen_model(machine, None, drive) == model


def test_the_linear_system_of_a_model() -> None:
    for model, own in (("exact", "moment"), ("moment", "moment"), ("coupled", "torque")):
        assert linear_of(rig(), model).excitation.model == own
    assert linear_of(rig(), None).excitation.model == "moment"
    assert linear_of(rig(), "linear").excitation.model == "linear"


def test_a_support_that_rocks_about_the_crank_answers_to_the_moment() -> None:
    """A force through the axis has no arm, so that all that shakes this engine is its moment; a
    rig with a short arm is shaken by both.
    """
    for machine, within in ((rocking(), 5e-3), (short_rig(), 5e-3)):
        exact, default, linear = (swing(machine, model) for model in ("exact", None, "linear"))
        assert exact > 1e-5
        assert default == pytest.approx(exact, rel=within)
        assert abs(linear - exact) > 0.5 * exact


@pytest.mark.parametrize("machine", [rocking(), short_rig()], ids=["rocking", "short"])
def test_models_side_by_side_say_where_they_differ(machine: eq.Machine) -> None:
    answers = {model: respond(machine, model=model) for model in MODELS}
    (gauge,) = machine.support.gauges
    notes = "\n".join(map(str, disagreement(answers)))
    assert "the models differ" in notes and gauge in notes and "use exact" in notes
    close = {model: answers[model] for model in ("moment", "exact")}
    assert not [*disagreement(close)]
    assert not [*disagreement({"moment": answers["moment"], "exact": None})]
    (agreeing,) = disagreement(answers, "moment")
    assert has_value(agreeing, "used", "moment") and has_value(agreeing, "reference", "exact")
    assert "use exact" not in str(agreeing)
    (differing,) = disagreement(answers, "linear")
    assert str(differing) == notes
    (note,) = disagreement({**answers, "exact": None})
    assert "use moment" in str(note)


@pytest.mark.parametrize("model", MODELS)
def test_the_model_asked_for(model: str) -> None:
    for machine in (rig(), springs()):
        assert chosen_model(machine, model, False) == model


@pytest.mark.parametrize(
    ("machine", "model", "drive", "error"),
    [
        (rig(), "whole", False,
         UsageError("got the model 'whole'; give one of linear, torque, moment, coupled, exact")),
        (BARE, None, False, GROUND),
        (DRIVEN, "exact", False, GROUND),
        (rig(), None, True, MOTORLESS),
        (BARE, None, True, MOTORLESS),
        (rig().with_drive(motor=LINE), "linear", True,
         UsageError("the speed follows from the motor in the exact model, not in linear")),
        (cart(), "exact", False, ModelError("support.freedoms", SPACE.format("exact"))),
        (cart(), "coupled", False, ModelError("support.freedoms", SPACE.format("coupled"))),
        (cart().with_drive(motor=LINE), None, True,
         ModelError("support.freedoms", SPACE.format("exact"))),
    ],
)  # fmt: skip
def test_refusals(
    machine: eq.Machine, model: str | None, drive: bool, error: EquipoiseError
) -> None:
    with pytest.raises(type(error)) as caught:
        respond(machine, SPEED, model, drive)  # type: ignore[arg-type]
    assert str(caught.value) == str(error)


@pytest.mark.parametrize("model", MODELS)
def test_a_crank_that_stands_still(model: ExcitationModel) -> None:
    with refused(UsageError, by="steady_speed"):
        respond(rig(), 0.0, model)
    with refused(ModelError, "drive.speed"):
        respond(rig().with_drive(speed=0.0), None, model)


def test_a_speed_that_the_motor_sets_itself() -> None:
    free = rig().with_drive(motor=replace(LINE, mean_speed="free"))
    for call in (
        lambda: respond(free, 20.0, drive=True),
        lambda: eq.simulate(free, 1.0, 20.0, drive=True),
        lambda: sweep_speed(free, 10.0, 20.0, drive=True),
    ):
        with refused(ModelError, "drive.motor.mean_speed"):
            call()


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("speed", [nan, inf, -inf])
def test_speeds_that_are_no_numbers(model: str, speed: float) -> None:
    with refused(UsageError, speed=repr(speed)):
        respond(rig(), speed, model)  # type: ignore[arg-type]


def test_speed_of_the_machine_is_the_usual_one() -> None:
    assert respond(rig()).speed == rig().drive.speed
    assert respond(rig(), 7.0).speed == 7


def test_missing_masses_are_all_named() -> None:
    links = {name: eq.Link(dict(link.points)) for name, link in BARE.links.items()}
    machine = replace(rig(), links=links)
    for call in (
        lambda: respond(machine),
        lambda: respond(machine, model="exact"),
        lambda: sweep_speed(machine, 3.0, 9.0),
        lambda: eq.simulate(machine, 1.0),
    ):
        with pytest.raises(MassError) as caught:
            call()
        for name in links:
            assert name in str(caught.value)


def test_mounts_that_do_not_hold_the_machine() -> None:
    machine = springs(mounts={"a": Mount((0.0, 0.0, 0.0), direction=0.0, stiffness=1e3)})
    for model in MODELS:
        with refused(ModelError, "support.mounts", loose="heave"):
            respond(machine, SPEED, model)


def test_a_motor_that_is_too_weak_says_so() -> None:
    weak = rig().with_drive(motor=Motor(26.0, 6.0, mean_speed="free"))
    assert respond(weak, drive=True).speed > 0
    table = MotorTable((0.0, 30.0), (1.0, 2.0))
    rising = eq.Drive("crank", SPEED, motor=Motor(table=table))
    with refused(EquipoiseError, torque=-4.934e-18):
        respond(replace(rig(), drive=rising), drive=True)


@pytest.mark.parametrize("model", MODELS)
def test_every_model_answers_for_a_support_without_linkage(model: ExcitationModel) -> None:
    """Links that weigh nothing shake nothing."""
    feet = {
        name: Mount((x, 0.0, 0.0), stiffness=5e3, damping=9.0) for name, x in (("a", -1), ("b", 1))
    }
    side = Mount((0.0, 0.0, 0.0), direction=0.0, stiffness=5e3, damping=9.0)
    response = respond(block(mounts={**feet, "side": side}), SPEED, model)
    for gauge in response.gauges.values():
        assert float(gauge.displacement.peak_to_peak) < 1e-12


@pytest.mark.parametrize("model", MODELS)
def test_reported_values(model: str) -> None:
    values = respond(rig(), SPEED, model).to_dict()  # type: ignore[arg-type]
    assert values["model"] == model
    assert values["speed"] == SPEED
    assert set(values["gauges"]) == {"gauge"}
    assert set(values["mounts"]) == {"spring"}
    gauge = values["gauges"]["gauge"]
    assert gauge["max"] - gauge["min"] == pytest.approx(gauge["peak_to_peak"])
    assert len(gauge["orders"]) == len(gauge["harmonics"]) == len(gauge["phases"])
    assert ("multipliers" in values) == (model in {"coupled", "exact"})
    assert ("energy" in values) == ("joints" in values) == (model == "exact")


def test_stability() -> None:
    """Damping makes disturbances die out; without any they neither grow nor die."""
    assert respond(rig(), SPEED, "linear").stable is None
    assert respond(rig(), SPEED, "exact").stable is True
    spring = {"s": Mount(axis="pitch", torsional_stiffness=3250.0)}
    undamped = respond(rig(mounts=spring), SPEED, "exact")
    (note,) = undamped.notes
    assert str(note) == "a disturbance neither grows nor dies out: something is undamped"


@pytest.mark.exhaustive(
    but=["0.0-freedoms1-coupled", "-9.81-freedoms0-exact", "-9.80665-freedoms0-coupled"]
)
@pytest.mark.parametrize("model", ["coupled", "exact"])
@pytest.mark.parametrize("freedoms", [("surge", "heave"), ("surge", "heave", "pitch")])
@pytest.mark.parametrize("gravity", [-9.81, -9.80665, 0.0])
def test_a_coordinate_that_nothing_moves(
    model: str, freedoms: tuple[str, ...], gravity: float
) -> None:
    """A yoke without other masses shakes along x alone: heave and pitch stay where they are."""
    machine = replace(eq.load("scotch-yoke"), gravity=(0.0, gravity))
    for link in ("crank", "block"):
        machine = machine.with_link(link, mass=0.0, inertia=0.0)
    mounts = {
        name: Mount((x, 0.0, 0.0), direction, stiffness=4e3, damping=20.0)
        for name, x, direction in (("l", -0.5, UP), ("r", 0.5, UP), ("a", 0.0, 0.0))
    }
    values = {"mass": 10.0, "center_of_mass": (0.0, 0.0, 0.0), "inertia": (0.5,)}
    machine = machine.with_support(**values, mounts=mounts, freedoms=freedoms)
    gauges = respond(machine, 13.0, model).gauges  # type: ignore[arg-type]
    assert gauges["surge"].displacement.peak_to_peak > 1e-3
    assert gauges["heave"].displacement.peak_to_peak < 1e-3


@pytest.mark.parametrize("mean_speed", ["held", "free"])
@pytest.mark.parametrize("stall_torque", [6.0, 20.0, 60.0])
def test_on_solid_ground_with_a_motor(
    mean_speed: Literal["held", "free"], stall_torque: float
) -> None:
    """Without a support there is the crank's speed alone, and one multiplier.

    Nothing is lost: free, the motor runs at its no-load speed but for the curve of its torque.
    """
    motor = Motor(26.0, stall_torque, mean_speed=mean_speed, inertia=0.02)
    response = respond(BARE.with_drive(motor=motor), drive=True)
    wanted = {"held": pytest.approx(SPEED), "free": pytest.approx(26.0, rel=1e-2)}
    assert response.speed == wanted[mean_speed]
    assert response.drive.speed is not None
    assert response.drive.fluctuation > 0.01
    assert (response.gauges, response.mounts, response.modes) == ({}, {}, ())
    assert response.multipliers is not None
    assert response.multipliers.shape == (1,)
    assert solve_exact(DRIVEN, SPEED, True).system.free == ()


def test_a_motor_drives_the_way_that_is_asked_for() -> None:
    """Whether the speed is the machine's own or given: a motor runs either way."""
    machine = rig().with_drive(motor=LINE)
    wanted = respond(machine.with_drive(speed=-17.0), drive=True)
    response = respond(machine, -17.0, drive=True)
    assert response.speed == pytest.approx(-17)
    assert response.drive.fluctuation == pytest.approx(wanted.drive.fluctuation)


def amplified(machine: eq.Machine, speed: float) -> float:
    """Force of the rig's spring in order 1 over what it would be if the rig turned endlessly slowly
    under the same moment about O, from which the spring is 1.35 m away.
    """
    force = respond(machine, speed).mounts["spring"].force.sizes[1]
    moment = eq.analyze(machine, 720, speed, about=PIVOT).forces.frame_moment
    return float(force / (2 * np.abs(np.fft.fft(moment))[1] / 720 / 1.35))


@pytest.mark.parametrize("model", few(MODELS, ("linear", "exact")))
def test_what_the_frame_bears_itself_shakes_no_mount(model: ExcitationModel) -> None:
    """Nor do rocking moments where the support moves in the plane alone."""
    machine = eq.load("yamashita-rig")
    load = eq.Load(
        "rocker", next(iter(machine.links["rocker"].points)), (30.0, -20.0), start=1.0, stop=3.0
    )
    bare, inner, outer = (
        respond(replace(machine, loads=loads), None, model).gauges
        for loads in ((), (replace(load, reaction="frame"),), (load,))
    )
    for name, gauge in bare.items():
        want, size = gauge.displacement.sizes[1:6], gauge.displacement.sizes[1]
        assert inner[name].displacement.sizes[1:6] == pytest.approx(want, abs=1e-7 * size)
        assert outer[name].displacement.sizes[1] != pytest.approx(size, rel=1e-3)


def test_rocking_moments_need_a_support_that_rolls() -> None:
    apart = eq.load("yamashita-rig").with_link("rocker", plane=0.05)
    assert (
        "rocking moments have no effect: the support can neither roll nor yaw"
        in respond(apart).notes
    )


SPEEDS = (80, 95, 98, 118.5, 135, 139, 193)


@pytest.mark.exhaustive(but=["95"])
@pytest.mark.parametrize("rpm", few(SPEEDS, (95, 118.5)))
def test_a_speed_within_a_resonance_says_so(rpm: float) -> None:
    """As the report does: where the swing is more than three times that under a standing force."""
    machine = eq.load("yamashita-rig")
    speed = rpm * np.pi / 30
    texts = [str(note) for note in respond(machine, speed).notes if "to be avoided" in str(note)]
    assert len(texts) == (amplified(machine, speed) > 3)
    assert [str(n) for n in respond(machine, speed, "exact").notes if "avoided" in str(n)][
        :1
    ] == texts
    place = find("yamashita-rig", speed=speed)
    assert isinstance(place, Findings)
    summary = [line for line in vibration_sentences(place) if "to be avoided" in line]
    assert summary == [f"T{line[1:]}." for line in texts]


def test_a_sweep_covers_the_speeds_at_which_the_machine_runs() -> None:
    machine = eq.load("yamashita-rig").with_drive(speeds=(1.0, 80.0))
    assert around(machine.drive, 20.0) == (1.0, 80.0)
    assert around(machine.drive, -20.0) == (-1.0, -80.0)
    assert around(eq.load("yamashita-rig").drive, 20.0) == (4.0, 40.0)


@pytest.mark.parametrize("mean_speed", ["held", "free"])
def test_no_curve_goes_on_past_standstill(mean_speed: Literal["held", "free"]) -> None:
    """The mean is beyond the torque at standstill, where the line would go backwards."""
    machine = eq.load("quick-return")
    mean = abs(eq.analyze(machine).summary["drive_torque"].mean)
    weak = Motor(80.0, 0.8 * mean, mean_speed=mean_speed)
    with pytest.raises(StallError) as error:
        respond(machine.with_drive(motor=weak), drive=True)
    assert f"has {0.8 * mean:.4g} N m" in str(error.value)


def test_a_motor_on_solid_ground_has_its_speed_first_and_no_other_speeds_to_look_at() -> None:
    rig = eq.load("yamashita-rig")
    machine = replace(rig, support=None, balance=None)
    response = eq.respond(machine, drive=True)
    assert response.drive.fluctuation > 0
    first, *_, last = [block.text for block in response_headline(response, alone=True)
                       if isinstance(block, Text)]  # fmt: skip
    assert f"{100 * response.drive.fluctuation:.3g} %" in first
    assert "respond" not in last
    (on_mounts,) = [block.text for block in response_headline(eq.respond(rig), alone=True)
                    if isinstance(block, Text) and "respond --speed" in block.text]  # fmt: skip
    assert on_mounts
