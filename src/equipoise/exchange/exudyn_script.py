"""A linkage in Exudyn, planar: bodies by their centres of mass, joints as constraints, SI units.

Run it for one turn of the crank; or call `simulate` for more.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import exudyn
import numpy as np
from exudyn import itemInterface as item

Data = dict[str, Any]
MODEL: Data = {}


def along(way: complex, vector: complex) -> float:
    """The part of a vector along a unit vector."""
    return way.real * vector.real + way.imag * vector.imag


def on_lines(place: float, places: list[float], values: list[float]) -> float:
    """The value on lines through points, which go on beyond the first and the last."""
    k = min(max(int(np.searchsorted(places, place)), 1), len(places) - 1)
    slope = (values[k] - values[k - 1]) / (places[k] - places[k - 1])
    return values[k - 1] + slope * (place - places[k - 1])


class Build:
    """The system of Exudyn, drawn where the model is and moving as it does there."""

    def __init__(self, model: Data) -> None:
        self.model, self.container = model, exudyn.SystemContainer()
        self.system = self.container.AddSystem()
        self.ground = self.system.AddObject(item.ObjectGround())
        still = self.system.AddNode(item.NodePointGround())
        self.still = self.marker(item.MarkerNodeCoordinate(nodeNumber=still, coordinate=0))
        self.nodes: dict[str, int] = {}
        self.objects: dict[str, int] = {"ground": self.ground}
        for name, body in model["bodies"].items():
            self.body(name, **body)
        for pin in model["pins"]:
            self.add(item.ObjectJointRevolute2D(markerNumbers=self.both(pin)))
        for guide in model["sliders"]:
            kinds = {"axisMarker0": guide["axis"], "normalMarker1": guide["normal"]}
            self.add(item.ObjectJointPrismatic2D(markerNumbers=self.both(guide["ends"]), **kinds))
        for kind, put in self.elements().items():
            for element in model[kind]:
                put(**element)
        for body, coordinate in model["held"]:
            self.add(item.ObjectConnectorCoordinate(markerNumbers=self.pair("", body, coordinate)))
        self.drive = self.driven(**model["drive"])

    def elements(self) -> Data:
        """What adds each kind of element besides joints."""
        return {
            "geared": self.geared,
            "springs": self.spring,
            "dampers": self.damper,
            "torsion_dampers": self.torsion_damper,
            "bushings": self.bushing,
            "stops": self.stop,
            "resistances": self.resistance,
            "loads": self.load,
            "mounts": self.mount,
        }

    def marker(self, item: Any) -> int:
        """Add a marker."""
        return int(self.system.AddMarker(item))

    def add(self, item: Any) -> int:
        """Add an object."""
        return int(self.system.AddObject(item))

    def body(
        self, name: str, mass: float, inertia: float, pose: list[float], velocity: list[float]
    ) -> None:
        """Add a rigid body whose reference point is its centre of mass."""
        node = item.NodeRigidBody2D(referenceCoordinates=pose, initialVelocities=velocity)
        self.nodes[name] = self.system.AddNode(node)
        rigid = item.ObjectRigidBody2D(nodeNumber=self.nodes[name], mass=mass, inertia=inertia)
        self.objects[name] = self.add(rigid)
        weighed = self.marker(item.MarkerBodyMass(bodyNumber=self.objects[name]))
        weight = [*self.model["gravity"], 0]
        self.system.AddLoad(item.LoadMassProportional(markerNumber=weighed, loadVector=weight))

    def place(self, end: tuple[str, list[float]]) -> int:
        """Mark a point of a body, given relative to its centre of mass."""
        body, at = end
        rigid = item.MarkerBodyRigid(bodyNumber=self.objects[body], localPosition=[*at, 0])
        return self.marker(rigid)

    def both(self, ends: list[Any]) -> list[int]:
        """Mark both ends of a joint."""
        return [self.place(end) for end in ends]

    def coordinate(self, body: str, number: int = 2) -> int:
        """Mark a coordinate of a body, its angle if not said; of the ground, what stands still."""
        if not body:
            return self.still
        return self.marker(
            item.MarkerNodeCoordinate(nodeNumber=self.nodes[body], coordinate=number)
        )

    def pair(self, first: str, other: str, number: int = 2) -> list[int]:
        """Mark the same coordinate of two bodies."""
        return [self.coordinate(first, number), self.coordinate(other, number)]

    def geared(self, driven: str, by: str, factor: float) -> None:
        """Turn a body so many times as fast as another."""
        pair = self.pair(driven, by)
        self.add(item.ObjectConnectorCoordinate(markerNumbers=pair, factor1=factor))

    def spring(
        self, ends: list[Any], stiffness: float, length: float, preload: float = 0.0
    ) -> None:
        """Put a spring between two points; preload : its pull at the length."""
        both = self.both(ends)
        self.add(
            item.ObjectConnectorSpringDamper(
                markerNumbers=both, stiffness=stiffness, referenceLength=length, force=preload
            )
        )

    def damper(
        self,
        ends: list[Any],
        damping: float = 0.0,
        speeds: list[float] | None = None,
        forces: list[float] | None = None,
    ) -> None:
        """Put a damper between two points: linear, or by the speed with which it lengthens."""
        law: Data = {"damping": damping}
        if speeds and forces:

            def pull(_: Any, t: float, number: int, way: float, speed: float, *rest: Any) -> float:
                return on_lines(speed, speeds, forces)

            law = {"springForceUserFunction": pull}
        both = self.both(ends)
        self.add(
            item.ObjectConnectorSpringDamper(
                markerNumbers=both, stiffness=0.0, referenceLength=1.0, **law
            )
        )

    def torsion_damper(self, on: str, by: str, damping: float) -> None:
        """Resist the turning of a body against another."""
        pair = self.pair(by, on)
        self.add(
            item.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=pair, stiffness=0.0, damping=damping
            )
        )

    def pushed(self, ends: list[Any], force: Any) -> None:
        """Let a force act on a point that moves over the ground, by its place and velocity as
        complex numbers.
        """

        def push(_: Any, t: float, number: int, way: Any, speed: Any, *rest: Any) -> list[float]:
            size = force(complex(way[0], way[1]), complex(speed[0], speed[1]))
            return [-size.real, -size.imag, 0.0]

        pushed: Data = {"stiffness": [1.0] * 3, "springForceUserFunction": push}
        self.add(item.ObjectConnectorCartesianSpringDamper(markerNumbers=self.both(ends), **pushed))

    def bushing(
        self,
        ends: list[Any],
        direction: float,
        stiffness: list[float],
        damping: list[float],
        preload: list[float],
        on: str,
        turning: Data,
    ) -> None:
        """Hold a point along a direction and across it, and the angle of its body."""
        first = complex(cos(direction), sin(direction))
        laws = [*zip((first, 1j * first), preload, stiffness, damping, strict=True)]

        def force(place: complex, velocity: complex) -> complex:
            sizes = [
                (push - rate * along(line, place) - loss * along(line, velocity)) * line
                for line, push, rate, loss in laws
            ]
            return sizes[0] + sizes[1]

        self.pushed(ends, force)
        pair = self.pair("", on)
        self.add(item.ObjectConnectorCoordinateSpringDamper(markerNumbers=pair, **turning))

    def stop(self, ends: list[Any], direction: float, stiffness: float, loss: float = 0.0) -> None:
        """Push a point back where it is beyond a line; loss : of force, by speed of approach."""
        normal = complex(cos(direction), sin(direction))

        def force(place: complex, velocity: complex) -> complex:
            gap, opening = (along(normal, value) for value in (place, velocity))
            return stiffness * max(-gap, 0.0) * max(1.0 - loss * opening, 0.0) * normal

        self.pushed(ends, force)

    def resistance(
        self,
        ends: list[Any],
        direction: float | None,
        one_way: bool,
        force: float | None,
        damping: float | None,
        positions: list[float],
        forces: list[float],
        speed: float | None,
    ) -> None:
        """Resist the motion of a point: a viscous part, and a dry one, which may go by the way."""
        line = complex(cos(direction or 0.0), sin(direction or 0.0))

        def against(place: complex, velocity: complex) -> complex:
            if direction is not None:
                rate = along(line, velocity)
                velocity = (max(rate, 0.0) if one_way else rate) * line
            factor = damping or 0.0
            if speed:
                dry = force or 0.0
                if positions:
                    dry += float(np.interp(along(line, place), positions, forces))
                factor += dry / (abs(velocity) ** 2 + speed**2) ** 0.5
            return -factor * velocity

        self.pushed(ends, against)

    def load(self, end: Any, force: list[float], torque: float, turns: bool) -> None:
        """Load a body by a force at a point and a torque, always the same; turns : whether the
        force turns with the body.
        """
        at = self.place(end)
        self.system.AddLoad(
            item.LoadForceVector(markerNumber=at, loadVector=[*force, 0], bodyFixed=turns)
        )
        self.system.AddLoad(item.LoadTorqueVector(markerNumber=at, loadVector=[0, 0, torque]))

    def mount(
        self,
        body: str,
        at: list[float],
        ground: list[float],
        along: list[float],
        torsional: bool,
        rates: list[float],
        one_sided: bool,
    ) -> None:
        """Push a body along a line, or turn it: by a preload, less by way and by speed."""
        preload, stiffness, damping = rates
        if torsional:
            pair = self.pair("", body)
            rest = preload / (stiffness or 1.0)
            spring: Data = {"stiffness": stiffness, "damping": damping, "offset": rest}
            self.add(item.ObjectConnectorCoordinateSpringDamper(markerNumbers=pair, **spring))
            return
        line = np.array([*along, 0.0])

        def push(_: Any, t: float, number: int, way: Any, speed: Any, *rest: Any) -> list[float]:
            size = preload - stiffness * (line @ way) - damping * (line @ speed)
            size = max(size, 0.0) if one_sided else size
            return [float(-entry) for entry in size * line]

        ends = self.both([("ground", ground), (body, at)])
        pushed: Data = {"stiffness": [stiffness] * 3, "springForceUserFunction": push}
        self.add(item.ObjectConnectorCartesianSpringDamper(markerNumbers=ends, **pushed))

    def driven(self, body: str, on: str, speed: float, others: list[str]) -> int:
        """Turn the crank, and with it those of other rows, at constant speed against a body."""

        def turn(_: Any, t: float, number: int, offset: float) -> float:
            return speed * t

        def rate(_: Any, t: float, number: int, offset: float) -> float:
            return speed

        for other in others:
            self.add(item.ObjectConnectorCoordinate(markerNumbers=self.pair(body, other)))
        turned: Data = {"offsetUserFunction": turn, "offsetUserFunction_t": rate}
        return self.add(item.ObjectConnectorCoordinate(markerNumbers=self.pair(on, body), **turned))


def simulate(turns: float = 1.0, steps_per_turn: int = 2000, model: Data | None = None) -> Data:
    """Move for some turns of the crank; the crank angle, rad, and the drive's torque, N m, (N,);
    and of each body x, y, m, and angle, rad, from where it is drawn, (N, 3).
    """
    built = Build(MODEL if model is None else model)
    system, speed = built.system, abs(built.model["drive"]["speed"])
    kinds = exudyn.OutputVariableType
    settings: Data = {"storeInternal": True, "writeToFile": False}
    torque = item.SensorObject(objectNumber=built.drive, outputVariableType=kinds.Force, **settings)
    sensors = {"": system.AddSensor(torque)}
    for name, node in built.nodes.items():
        sensor = item.SensorNode(nodeNumber=node, outputVariableType=kinds.Coordinates, **settings)
        sensors[name] = system.AddSensor(sensor)
    system.Assemble()
    chosen = exudyn.SimulationSettings()
    chosen.solution.file.write = False
    chosen.solution.sensors.writePeriod = 2 * pi / speed / steps_per_turn
    chosen.timeIntegration.endTime = 2 * pi / speed * turns
    chosen.timeIntegration.numberOfSteps = round(turns * steps_per_turn)
    chosen.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    chosen.timeIntegration.newton.relativeTolerance = 1e-10
    chosen.timeIntegration.verboseMode = 0
    system.SolveDynamic(chosen)
    data: Data = {name: system.GetSensorStoredData(sensor) for name, sensor in sensors.items()}
    time, force = data.pop("").T
    start, rate = built.model["crank_angle"], built.model["drive"]["speed"]
    moved = {name: values[:, 1:4] for name, values in data.items()}
    return {"crank_angle": start + rate * time, "drive_torque": -force, "bodies": moved}


if __name__ == "__main__":
    samples = simulate()
    print("crank_angle [rad],drive_torque [N m]")
    for angle, torque in zip(samples["crank_angle"], samples["drive_torque"], strict=True):
        print(f"{float(angle)!r},{float(torque)!r}")
