"""An analysis as plain data: figures, nested lists for JSON, columns for tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from equipoise.errors import MassError, UsageError
from equipoise.mechanism.dynamics import Forces, SliderForce, VectorSignal, massless
from equipoise.mechanism.fourbar import FourBar, four_bar
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import Motion, Named
from equipoise.results.result import Result
from equipoise.signals import Figures, Periodic, figures

if TYPE_CHECKING:
    import pandas
    import xarray

Array = np.ndarray[Any, Any]
Values = dict[str, Any]

LEAST_ANGLES = 90
"""In a turn, from which harmonics are taken: those that matter end before half of it."""


@dataclass(frozen=True, eq=False, repr=False)
class Analysis(Result):
    """What a machine does over its crank angles.

    motion : always there.  solved : its forces, or None where masses are missing.
    """

    shown_in: ClassVar[str] = "results.tables"

    motion: Motion
    solved: Forces | None

    @property
    def machine(self) -> Machine:
        return self.motion.machine

    @property
    def crank_angle(self) -> Array:
        """(N,) rad."""
        return self.motion.crank_angle

    @property
    def forces(self) -> Forces:
        """Forces; raises `MassError` where masses are missing."""
        if self.solved is None:
            raise MassError(massless(self.machine))
        return self.solved

    @cached_property
    def four_bar(self) -> FourBar | None:
        """Names and figures of the four-bar at the crank, where there is one."""
        return four_bar(self.machine)

    @cached_property
    def summary(self) -> Mapping[str, Figures]:
        """Mean, RMS, peak and extremes of each output of the forces, by name."""
        signals = outputs(self).items()
        return Named("output", ((name, figures(self.crank_angle, s)) for name, s in signals))

    @property
    def has_orders(self) -> bool:
        """Whether its crank angles are such that harmonics can be taken."""
        motion = self.motion
        return motion.whole_cycle and len(self.crank_angle) >= LEAST_ANGLES * motion.turns

    @cached_property
    def by_order(self) -> Mapping[str, Periodic]:
        """Shaking force and moment, drive torque, and acceleration of the common centre of mass
        (``mass_center.ax``, ``mass_center.ay``, m/s2), by order.

        Raises
        ------
        MassError : masses are missing.
        UsageError : the crank angles are not equally spaced over the whole cycle.
        """
        found = self.forces
        if not self.motion.whole_cycle:
            raise UsageError("orders need crank angles over the whole cycle; give a number of them")
        in_a_turn = len(self.crank_angle) // self.motion.turns
        if in_a_turn < LEAST_ANGLES:
            raise UsageError(
                f"got {in_a_turn} crank angles in a turn; orders need {LEAST_ANGLES} and more, or "
                "high ones are taken for low ones"
            )
        mass = self.machine.mass
        signals = {
            "shaking_force.x": found.shaking_force.x,
            "shaking_force.y": found.shaking_force.y,
            "shaking_moment": found.shaking_moment,
            "drive_torque": found.drive_torque,
        }
        if mass:
            signals["mass_center.ax"] = -found.shaking_force.x / mass
            signals["mass_center.ay"] = -found.shaking_force.y / mass
        turns = self.motion.turns
        return Named("output", ((name, Periodic.of(s, turns)) for name, s in signals.items()))

    def to_dict(self, split: bool = False) -> Values:
        """The machine-readable output, in SI units: dicts, numbers and arrays (N,).

        split : whether to add every force by cause and by link.
        """
        return to_dict(self, split)

    def to_dataset(self) -> xarray.Dataset:
        """Every array as an `xarray.Dataset` over crank angle (rad); loads xarray."""
        import xarray

        coordinate = {"crank_angle": self.crank_angle}
        arrays = {
            name: ("crank_angle", values, {"units": unit_of(name)})
            for name, values in columns(self)
        }
        return xarray.Dataset(arrays, coordinate, attrs=_heading(self))

    def to_frame(self) -> pandas.DataFrame:
        """Every array as a column of a `pandas.DataFrame` over crank angle; loads pandas."""
        import pandas

        index = pandas.Index(self.crank_angle, name="crank_angle")
        return pandas.DataFrame(dict(columns(self)), index=index)


def outputs(analysis: Analysis) -> dict[str, Array]:
    """Scalar signals of the forces (N,), in the order in which they are printed."""
    found = analysis.solved
    if found is None:
        return {}
    result = {
        "shaking_force.x": found.shaking_force.x,
        "shaking_force.y": found.shaking_force.y,
        "shaking_force": found.shaking_force.size,
        "shaking_moment": found.shaking_moment,
        "drive_torque": found.drive_torque,
        "frame_force": found.frame_force.size,
        "frame_moment": found.frame_moment,
    }
    for name, joint in found.joints.items():
        result[f"joints.{name}"] = joint.size
        if isinstance(joint, SliderForce):
            result[f"joints.{name}.moment"] = joint.moment
    for name, mesh in found.gears.items():
        result[f"gears.{name}"] = mesh.size
    return result


def to_dict(analysis: Analysis, split: bool = False) -> Values:
    """Nested values in SI units; arrays are (N,)."""
    result = _heading(analysis)
    result["crank_angle"] = analysis.crank_angle
    result["links"] = {name: _link(link) for name, link in analysis.motion.links.items()}
    result["points"] = {name: _point(point) for name, point in analysis.motion.points.items()}
    if analysis.solved is None:
        result["missing"] = massless(analysis.machine)
    else:
        result.update(_forces(analysis.solved))
        if split:
            result.update(_split(analysis.solved))
    result["summary"] = _summary(analysis)
    return result


def order_values(analysis: Analysis, orders: int, zero: float) -> Values:
    """Outputs by order, as in `Analysis.by_order`, up to an order; SI units and rad.

    zero : rad, direction from which crank angles count.
    """
    found = {}
    for name, whole in analysis.by_order.items():
        signal = whole.shifted(zero)
        kept = slice(0, signal.count_to(orders))
        found[name] = {
            "orders": signal.orders[kept],
            "a": signal.amplitudes.real[kept],
            "b": -signal.amplitudes.imag[kept],
            "harmonics": signal.sizes[kept],
            "phases": signal.phases[kept],
        }
    return found


def columns(analysis: Analysis) -> Iterator[tuple[str, Array]]:
    """Every array (N,) of the output but the crank angle, named by its place: ``points.P.vx``."""
    values = to_dict(analysis)
    for key in ("crank_angle", "about", "summary"):
        values.pop(key, None)
    yield from _flat("", values)


UNITS = {
    "crank_angle": "rad",
    "angle": "rad",
    "angular_velocity": "rad/s",
    "angular_acceleration": "rad/s^2",
    "vx": "m/s",
    "vy": "m/s",
    "ax": "m/s^2",
    "ay": "m/s^2",
    "force_x": "N",
    "force_y": "N",
    "normal": "N",
    "tangential": "N",
    "radial": "N",
}
"""Units by the last part of a column's name, where that alone tells."""


def unit_of(name: str) -> str:
    """SI unit of a column, such as ``points.P.vx``."""
    first, _, last = name.rpartition(".")
    if last in UNITS:
        return UNITS[last]
    if last in ("x", "y"):
        return "m" if first.startswith("points.") else "N"
    return "N m"


def _flat(prefix: str, values: Values) -> Iterator[tuple[str, Array]]:
    for key, value in values.items():
        name = f"{prefix}.{key}" if prefix else key
        if isinstance(value, dict):
            yield from _flat(name, value)
        elif isinstance(value, np.ndarray):
            yield name, value


def _heading(analysis: Analysis) -> Values:
    motion = analysis.motion
    heading: Values = {
        "title": analysis.machine.title,
        "speed": motion.speed,
        "acceleration": motion.acceleration,
    }
    if motion.whole_cycle:
        heading["turns"] = motion.turns
    return heading


def _link(link: Any) -> Values:
    keys = ("angle", "angular_velocity", "angular_acceleration")
    return {key: getattr(link, key) for key in keys}


def _point(point: Any) -> Values:
    return {key: getattr(point, key) for key in ("x", "y", "vx", "vy", "ax", "ay")}


def _vector(signal: VectorSignal) -> Values:
    return {"x": signal.x, "y": signal.y}


def _forces(found: Forces) -> Values:
    joints: Values = {}
    for name, joint in found.joints.items():
        joints[name] = {"on": joint.on, "by": joint.by, "force_x": joint.x, "force_y": joint.y}
        if isinstance(joint, SliderForce):
            joints[name].update(normal=joint.normal, moment=joint.moment)
    gears = {
        name: {
            "on": mesh.on,
            "by": mesh.by,
            "force_x": mesh.x,
            "force_y": mesh.y,
            "tangential": mesh.tangential,
            "radial": mesh.radial,
        }
        for name, mesh in found.gears.items()
    }
    return {
        "joints": joints,
        "gears": gears,
        "about": {"x": found.about.real, "y": found.about.imag},
        "shaking_force": _vector(found.shaking_force),
        "shaking_moment": found.shaking_moment,
        "weight": _vector(found.weight),
        "weight_moment": found.weight_moment,
        "frame_force": _vector(found.frame_force),
        "frame_moment": found.frame_moment,
        "drive_torque": found.drive_torque,
    }


def _split(found: Forces) -> Values:
    """Every force by cause, and by link: output -> cause or link -> array, or x and y."""
    split = found.split
    names = ["shaking_force", "shaking_moment", "frame_force", "frame_moment", "drive_torque"]
    result: Values = {}
    for key, parts in (("by_cause", split.by_cause), ("by_link", split.by_link)):
        result[key] = {name: _parts(parts(name)) for name in names}
        result[key]["joints"] = {n: _parts(parts(f"joints.{n}")) for n in split.joints}
        result[key]["gears"] = {n: _parts(parts(f"gears.{n}")) for n in split.gears}
    return result


def _parts(parts: Mapping[str, Array]) -> Values:
    return {
        name: _vector(VectorSignal(part)) if np.iscomplexobj(part) else part
        for name, part in parts.items()
    }


def _summary(analysis: Analysis) -> Values:
    summary: Values = {
        name: {**asdict(figure), "peak_to_peak": figure.peak_to_peak}
        for name, figure in analysis.summary.items()
    }
    if analysis.four_bar is not None:
        summary["four_bar"] = asdict(analysis.four_bar)
    return summary
