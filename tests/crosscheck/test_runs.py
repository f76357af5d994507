"""Runs of random machines against MuJoCo in free motion, and against Exudyn with a motor and with
friction: the same trajectory by other equations, other constraints and other integrators.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import equipoise as eq
from equipoise.exchange import exudyn as exudyn_export
from equipoise.exchange import mjcf
from equipoise.exchange.formats import Job
from equipoise.mechanism import JointProperties
from equipoise.mechanism.parts.motors import Motor
from equipoise.running.run_results import DrivesRun, Run
from support.machines import make
from support.poses import Array

KINDS = ("crank_rocker", "slider_crank", "stephenson", "quick_return", "scotch_yoke",
         "geared_five_bar", "v_twin", "slider_on_rocker")  # fmt: skip
FASTER = 3.0
"""Times the drive's speed at the start, so that weight turns no machine back."""


def alone(kind: str, seed: int = 0) -> eq.Machine:
    """A random machine on which nothing acts but weight, with links that all have inertia."""
    machine = make(kind, seed).machine
    masses = [link.mass or 0.0 for link in machine.links.values()]
    least, size = 0.1 * max(masses), max(link.inertia or 0.0 for link in machine.links.values())
    links = {
        name: replace(link, mass=max(link.mass or 0.0, least),
                      inertia=max(link.inertia or 0.0, 0.1 * size))
        for name, link in machine.links.items()
    }  # fmt: skip
    drive = replace(machine.drive, acceleration=0.0, motor=None, speed=FASTER * machine.drive.speed)
    bare: eq.Machine = replace(
        machine, links=links, drive=drive, loads=(), springs=(), torsion_springs=(), support=None,
        rows=(), balance=None, run=None,
    )  # fmt: skip
    return bare


def crank_angles(run: Run, times: Array) -> Array:
    """Crank angles of a run at times, from angles and speeds at its instants."""
    time, places = np.unique(run.time, return_index=True)
    return CubicHermiteSpline(time, run.crank_angle[places], run.crank_speed[places])(times)


# -- MuJoCo ----------------------------------------------------------------------------------------

STEPS = 8000
CLOSE_FREE = 1e-6
"""rad over a turn: what is left of MuJoCo's constraints, which give way, is ten times less; a
machine whose speed follows wrong masses is off by 0.1 rad."""


def in_mujoco(machine: eq.Machine, duration: float, link: str = "") -> Array:
    """Angle of a link, or of the crank, at the ends of all steps, from the exported file alone."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(mjcf.export_bytes(Job(machine)))
    step = duration / STEPS
    model.opt.timestep = step
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    model.opt.tolerance, model.opt.iterations = 1e-16, 50
    rate = 0.2 / step  # of what closes a gap, 1/s: as stiff as the steps follow
    model.eq_solref[:] = [-(rate**2), -2 * rate]
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    place = model.joint(link or machine.drive.link).qposadr[0]
    angles = [float(data.qpos[place])]
    for _ in range(STEPS):
        mujoco.mj_step(model, data)
        angles.append(float(data.qpos[place]))
    return np.array(angles) - angles[0]


@pytest.mark.parametrize("kind", KINDS)
def test_free_motion_is_that_of_mujoco(kind: str) -> None:
    machine = alone(kind)
    run = eq.run(machine, turns=1, speed=machine.drive.speed)
    assert run.end.kind == "turns" and np.ptp(run.crank_speed) > 0.01 * abs(machine.drive.speed)
    wanted = in_mujoco(machine, float(run.time[-1]))
    times = np.linspace(0.0, run.time[-1], STEPS + 1)
    np.testing.assert_allclose(crank_angles(run, times), wanted, atol=CLOSE_FREE)


def test_two_free_cranks_move_as_in_mujoco() -> None:
    """Of a five-bar, whose cranks feel each other by its arms."""
    base = eq.load("two-motor-mixer")
    (other,) = base.drives
    machine = replace(
        base, joints=(), run=None, drive=replace(base.drive, motor=None, free=True),
        drives=(replace(other, motor=None, free=True),),
    )  # fmt: skip
    duration = 0.25
    run = eq.run(machine, duration)
    assert isinstance(run, DrivesRun)
    times = np.linspace(0.0, duration, STEPS + 1)
    time, places = np.unique(run.time, return_index=True)
    for link, course in run.drives.items():
        assert np.ptp(course.speed) > 0.05 * base.drive.speed
        angles = CubicHermiteSpline(time, course.angle[places], course.speed[places])(times)
        wanted = in_mujoco(machine, duration, link)
        np.testing.assert_allclose(angles - angles[0], wanted, atol=CLOSE_FREE)


# -- Exudyn ----------------------------------------------------------------------------------------

COARSE = 4000
CLOSE_DRIVEN = 1e-6
"""Share of what the crank has turned: errors of the steps, which are as their square, are taken
out by means of steps twice as long, and leave a tenth of this."""


def in_exudyn(machine: eq.Machine, duration: float, act: Callable[[Any], None]) -> float:
    """Angle of the crank at the end, with steps extrapolated to none.

    act : called with the built system to put on it what acts beside weight and springs.
    """
    coarse, fine = (_in_exudyn(machine, duration, act, count) for count in (COARSE, 2 * COARSE))
    return fine + (fine - coarse) / 3


def _in_exudyn(
    machine: eq.Machine, duration: float, act: Callable[[Any], None], steps: int
) -> float:
    exudyn = pytest.importorskip("exudyn")
    from exudyn import itemInterface as item

    from equipoise.exchange import exudyn_script

    class Free(exudyn_script.Build):
        """The script's system without what turns its crank at constant speed.

        pins : constraints of its pins, in the order of the model.
        """

        def add(self, entry: Any) -> int:
            number = super().add(entry)
            if isinstance(entry, item.ObjectJointRevolute2D):
                self.pins = [*getattr(self, "pins", []), number]
            return number

        def driven(self, body: str, on: str, speed: float, others: list[str]) -> int:
            self.crank = body
            return 0

    built: Any = Free(exudyn_export._model(Job(machine)))
    act(built)
    settings: dict[str, Any] = {"storeInternal": True, "writeToFile": False}
    sensor = built.system.AddSensor(
        item.SensorNode(
            nodeNumber=built.nodes[built.crank],
            outputVariableType=exudyn.OutputVariableType.Coordinates,
            **settings,
        )
    )
    built.system.Assemble()
    chosen = exudyn.SimulationSettings()
    chosen.solution.file.write = False
    chosen.solution.sensors.writePeriod = duration
    chosen.timeIntegration.endTime = duration
    chosen.timeIntegration.numberOfSteps = steps
    chosen.timeIntegration.newton.relativeTolerance = 1e-10
    chosen.timeIntegration.newton.absoluteTolerance = 1e-10
    chosen.timeIntegration.generalizedAlpha.useNewmark = True
    chosen.timeIntegration.generalizedAlpha.useIndex2Constraints = True
    chosen.timeIntegration.verboseMode = 0
    built.system.SolveDynamic(chosen)
    return float(np.asarray(built.system.GetSensorStoredData(sensor))[-1, 3])


def motor_of(machine: eq.Machine) -> Motor:
    """One that would hold the drive's speed, and at rest gives a torque for which the machine needs
    some turns to change its speed.
    """
    speed = abs(machine.drive.speed)
    inertia = sum(
        (link.inertia or 0.0)
        + (link.mass or 0.0) * np.hypot(*next(iter(link.points.values()))) ** 2
        for link in machine.links.values()
    )
    return Motor(speed, float(inertia * speed**2), mean_speed="free")


def turns_crank(machine: eq.Machine, motor: Motor) -> Callable[[Any], None]:
    """What the motor does to a built system: a torque at rest, and less in proportion to the
    speed.
    """

    def act(built: Any) -> None:
        from exudyn import itemInterface as item

        sense = np.sign(machine.drive.speed)
        assert motor.stall_torque is not None and motor.no_load_speed is not None
        turning = built.coordinate(built.crank)
        torque = float(sense * motor.stall_torque)
        built.system.AddLoad(item.LoadCoordinate(markerNumber=turning, load=torque))
        built.add(
            item.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=[built.still, turning],
                stiffness=0.0,
                damping=motor.stall_torque / motor.no_load_speed,
            )
        )

    return act


@pytest.mark.parametrize("kind", ["crank_rocker", "slider_crank", "stephenson"])
def test_a_motor_turns_a_machine_as_in_exudyn(kind: str) -> None:
    machine = alone(kind)
    motor = motor_of(machine)
    driven = replace(machine, drive=replace(machine.drive, motor=motor))
    start = machine.drive.speed
    run = eq.run(driven, turns=1.5, speed=start)
    assert run.end.kind == "turns" and abs(run.work["drive"][-1]) > 0.01 * run.kinetic_energy[0]
    duration = float(run.time[-1])
    wanted = in_exudyn(machine, duration, turns_crank(machine, motor))
    turned = float(run.crank_angle[-1])
    assert turned == pytest.approx(wanted, abs=CLOSE_DRIVEN * abs(turned))


RADII, FRICTION = {"A": 0.02, "B": 0.015}, 0.2
"""Pins that turn one way all the time, so that their friction is smooth: radii, m."""


def rubbing_engine() -> eq.Machine:
    """The bundled engine without its gas, turned by a motor, with friction in two pins."""
    machine = eq.load("slider-crank-engine")
    joints = tuple(
        JointProperties(f"joints.{pin}", radius=radius, friction=FRICTION)
        for pin, radius in RADII.items()
    )
    drive = replace(machine.drive, speed=100.0, motor=Motor(200.0, 60.0, mean_speed="free"))
    engine: eq.Machine = replace(machine, loads=(), balance=None, support=None, joints=joints,
                                 run=None, drive=drive)  # fmt: skip
    return engine


def rubs(machine: eq.Machine) -> Callable[[Any], None]:
    """Friction on a built system: of each pin a torque against its turning, by what its constraint
    exerts in the same round of Exudyn's Newton method.
    """

    def act(built: Any) -> None:
        import exudyn
        from exudyn import itemInterface as item

        for number, pin in zip(built.pins, built.model["pins"], strict=True):
            (first, _), (other, _) = pin
            label = "A" if "ground" in (first, other) else "B"
            if "piston" in (first, other):
                continue

            def against(
                system: Any, t: float, itself: int, way: float, speed: float, *rest: Any,
                number: int = number, radius: float = RADII[label],
            ) -> float:  # fmt: skip
                force = system.GetObjectOutput(number, exudyn.OutputVariableType.Force)
                return float(np.sign(speed) * FRICTION * radius * np.hypot(force[0], force[1]))

            ends = [name if name != "ground" else "" for name in (first, other)]
            built.add(
                item.ObjectConnectorCoordinateSpringDamper(
                    markerNumbers=built.pair(*ends),
                    stiffness=0.0,
                    springForceUserFunction=cast(Any, against),
                )
            )

    return act


def test_friction_slows_a_machine_as_in_exudyn() -> None:
    machine = rubbing_engine()
    run = eq.run(machine, turns=1.5, speed=machine.drive.speed)
    assert abs(run.work["friction"][-1]) > 0.05 * run.kinetic_energy[0]
    motor = machine.drive.motor
    assert motor is not None

    def act(built: Any) -> None:
        turns_crank(machine, motor)(built)
        rubs(machine)(built)

    bare = replace(machine, joints=(), drive=replace(machine.drive, motor=None))
    wanted = in_exudyn(bare, float(run.time[-1]), act)
    turned = float(run.crank_angle[-1])
    assert turned == pytest.approx(wanted, abs=CLOSE_DRIVEN * abs(turned))
