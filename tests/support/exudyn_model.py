"""The bundled `exudyn-slider-crank` as a model of the multibody program Exudyn.

Masses, lengths and mounts come from the model file.  Torque, time, steps and tolerances are those
of the example geneticOptimizationSliderCrank.py of Exudyn (J. Gerstmayr).
"""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn import itemInterface as item

import equipoise as eq

MACHINE = eq.load("exudyn-slider-crank")
CRANK, ROD = (MACHINE.links[name].points[end][0] for name, end in (("crank", "B"), ("rod", "C")))
"""Lengths, m."""
LINKS = {name: (link.mass, link.inertia) for name, link in MACHINE.links.items()}
FRAME = (MACHINE.support.mass, MACHINE.support.inertia[-1])
"""Masses, kg, and moments of inertia about the centres of mass, kg m2."""
MOUNTS = MACHINE.support.mounts
TORQUE = 0.1
"""On the crank, N m, at every time and speed."""
DURATION, STEP, SAMPLING = 3.0, 0.002, 0.01
"""Of the example: of the run-up, of the integration, and of the frame's motion as told, s."""

Centers = tuple[float, float]
Masses = tuple[float, float]


@dataclass(frozen=True)
class Shaking:
    """Displacement of the frame against time: s and m."""

    time: np.ndarray
    x: np.ndarray
    y: np.ndarray

    @property
    def residual(self) -> float:
        """Largest displacement along x plus largest displacement along y, m."""
        return float(np.max(np.abs(self.x)) + np.max(np.abs(self.y)))


def shake(
    centers: Centers,
    speed: float | None = None,
    duration: float = DURATION,
    step: float = STEP,
    sampling: float = SAMPLING,
) -> Shaking:
    """Simulate the machine with the centres of mass of crank and rod at these distances, m.

    speed : of the crank, which it has and keeps from the start, rad/s; None for the torque, from
        standstill.
    """
    built = Build(centers, speed or 0.0)
    if speed is None:
        built.system.AddLoad(item.LoadCoordinate(markerNumber=built.turning, load=TORQUE))
    else:
        built.hold(built.turning, rate=speed)
    sensor = built.system.AddSensor(
        item.SensorNode(
            nodeNumber=built.frame_node,
            storeInternal=True,
            writeToFile=False,
            outputVariableType=exudyn.OutputVariableType.Position,
        )
    )
    built.system.Assemble()
    built.system.SolveDynamic(settings(duration, step, sampling))
    time, x, y = built.system.GetSensorStoredData(sensor)[:, :3].T
    return Shaking(time, x, y)


def settings(duration: float, step: float, sampling: float) -> exudyn.SimulationSettings:
    """Newmark's method (trapezoidal rule) with constraints on velocities, as in the example."""
    chosen = exudyn.SimulationSettings()
    chosen.solution.file.write = False
    chosen.solution.sensors.writePeriod = sampling
    chosen.timeIntegration.endTime = duration
    chosen.timeIntegration.numberOfSteps = round(duration / step)
    chosen.timeIntegration.newton.useModifiedNewton = True
    chosen.timeIntegration.newton.relativeTolerance = 1e-8
    chosen.timeIntegration.newton.absoluteTolerance = 1e-8
    chosen.timeIntegration.generalizedAlpha.useNewmark = True
    chosen.timeIntegration.generalizedAlpha.useIndex2Constraints = True
    return chosen


class Build:
    """Bodies, joints and mounts, drawn at crank angle 0 with the crank turning at a speed."""

    def __init__(self, centers: Centers, speed: float) -> None:
        self.container = exudyn.SystemContainer()
        self.system = self.container.AddSystem()
        ground = self.system.AddNode(item.NodePointGround())
        self.ground = self.coordinate(ground, 0)
        crank, rod = centers
        tip = speed * CRANK
        spin = -tip / ROD
        frame = self.body(FRAME, 0.0)
        first = self.body(LINKS["crank"], crank, (0, speed * crank, speed))
        second = self.body(LINKS["rod"], CRANK + rod, (0, tip + spin * rod, spin))
        slider = self.body(LINKS["slider"], CRANK + ROD)
        self.pin((frame, 0.0), (first, -crank))
        self.pin((first, CRANK - crank), (second, -rod))
        self.pin((second, ROD - rod), (slider, 0.0))
        self.guide((frame, CRANK + ROD), (slider, 0.0))
        self.frame_node = frame[0]
        self.turning = self.coordinate(first[0], 2)
        self.hold(self.coordinate(frame[0], 2))
        for freedom, mount in enumerate(("along", "across")):
            self.mount(self.coordinate(frame[0], freedom), MOUNTS[mount])

    def body(
        self, masses: Masses, x: float, velocity: tuple[float, ...] = (0, 0, 0)
    ) -> tuple[int, int]:
        """Add a rigid body with its centre of mass at (x, 0); its node and itself."""
        node = self.system.AddNode(
            item.NodeRigidBody2D(
                referenceCoordinates=[x, 0, 0],
                initialVelocities=list(map(float, velocity)),
            )
        )
        mass, inertia = masses
        body = item.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia)
        return node, self.system.AddObject(body)

    def place(self, at: tuple[tuple[int, int], float]) -> int:
        """Mark a point of a body, by its distance along x from the centre of mass."""
        (_, body), x = at
        return self.system.AddMarker(item.MarkerBodyRigid(bodyNumber=body, localPosition=[x, 0, 0]))

    def coordinate(self, node: int, number: int) -> int:
        """Mark a coordinate of a node: x, y or angle."""
        marker = item.MarkerNodeCoordinate(nodeNumber=node, coordinate=number)
        return self.system.AddMarker(marker)

    def pin(self, *at: tuple[tuple[int, int], float]) -> None:
        """Join two bodies by a pin."""
        markers = [self.place(entry) for entry in at]
        self.system.AddObject(item.ObjectJointRevolute2D(markerNumbers=markers))

    def guide(self, *at: tuple[tuple[int, int], float]) -> None:
        """Let the second body slide along x on the first, without turning in it."""
        markers = [self.place(entry) for entry in at]
        self.system.AddObject(item.ObjectJointPrismatic2D(markerNumbers=markers))

    def hold(self, marker: int, rate: float | None = None) -> None:
        """Hold a coordinate where it is, or at a rate."""
        self.system.AddObject(
            item.ObjectConnectorCoordinate(
                markerNumbers=[self.ground, marker],
                velocityLevel=rate is not None,
                offset=rate or 0.0,
            )
        )

    def mount(self, marker: int, mount: eq.Mount) -> None:
        """Put a coordinate of the frame on a spring and damper."""
        self.system.AddObject(
            item.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=[self.ground, marker],
                stiffness=mount.stiffness,
                damping=mount.damping,
            )
        )
