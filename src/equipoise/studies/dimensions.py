"""What kind of quantity a figure of a command is, told by its path; nothing is computed for it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from equipoise.planting.names import dimension_of as of_planting
from equipoise.results.analysis import unit_of
from equipoise.studies.figures import OF_LISTS, PLACES

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.mechanism.support import Support

OF_UNITS = {
    "rad": "angle",
    "rad/s": "angular speed",
    "rad/s^2": "angular acceleration",
    "m": "length",
    "m/s": "speed",
    "m/s^2": "acceleration",
    "N": "force",
    "N m": "torque",
}
OF_BARS = {
    **dict.fromkeys("abcd", "length"),
    **dict.fromkeys(("transmission_min", "transmission_max", "swing"), "angle"),
}
"""Figures of a four-bar."""
OF_TOOLS = {
    "acceleration": "a_hv a8 acceleration acceleration_vertical acceleration_lateral a_hw_vertical "
    "a_hw_lateral",
    "frequency": "natural_frequencies frequency",
    "angular speed": "speed quiet_speeds quiet_speeds_lateral",
    "angle": "phase phase_lateral",
    "length": "position displacement place places nodes",
    "speed": "velocity",
    "torque": "moment",
    "time": "duration time_to_action time_to_limit japanese_limit_time japanese_time",
}
OF_LAST = {name: kind for kind, names in OF_TOOLS.items() for name in names.split()}

_INDEX = re.compile(r"\[[^\]]*\]")


def dimension_of(model: Machine | Tool, of: str, value: str) -> str | None:
    """Dimension of the figure at a path in what a command gives; None of plain and unknown ones.

    model : the one of the study, which knows what its gauges and mounts read.
    of : the command.  value : the path, as in a study file.
    """
    path = _INDEX.sub("", value).replace('"', "")
    if of == "tool":
        return _of_tool(path)
    if of == "plant":
        return _of_plant(path)
    if of == "balance":
        return _of_balance(model, path)
    if of == "respond":
        return _of_respond(model, path)
    return _of_analysis(path)


def _of_analysis(path: str) -> str | None:
    path = path.removeprefix("summary.")
    first, _, rest = path.partition(".")
    if first == "four_bar":
        return OF_BARS.get(rest)
    if path in ("speed", "acceleration", "turns"):
        return {"speed": "angular speed", "acceleration": "angular acceleration"}.get(path)
    if first == "by_order":
        return _by_order(rest)
    if first in ("by_cause", "by_link"):
        return _signal(rest.removesuffix(f".{_last(rest)}"), rest)
    if _last(path) in PLACES:
        return "angle"
    name = path.removesuffix(f".{_last(path)}") if _last(path) in OF_LISTS else path
    return _signal(name, path)


def _signal(name: str, path: str) -> str | None:
    """Of a signal of forces, or of an array."""
    first = name.partition(".")[0]
    if first in ("links", "points", "crank_angle", "about"):
        return "length" if first == "about" else OF_UNITS.get(unit_of(name))
    if name.endswith((".moment", "_moment", "drive_torque")) or "_moment." in path:
        return "torque"
    if first == "drive_torque":
        return "torque"
    if first in ("joints", "gears", "shaking_force", "weight", "frame_force"):
        return "force"
    return None


def _by_order(rest: str) -> str | None:
    name, _, last = rest.rpartition(".")
    if last in OF_LISTS:
        name, _, last = name.rpartition(".")
    if last == "phases":
        return "angle"
    if last == "orders":
        return None
    return "acceleration" if name.startswith("mass_center.") else _signal(name, name)


def _of_plant(path: str) -> str | None:
    first, _, rest = path.partition(".")
    last = _last(path)
    if first in ("cusps", "tray_crossings"):
        return "angle"
    if first == "visits":
        return "length" if rest == "depth" else "angle"
    if first == "loops":
        kinds = {"y": "length", "height": "length", "width": "length", "area": None}
        return kinds.get(rest, "angle") if rest != "in_soil" else None
    if first == "forces":
        name = rest.removesuffix(f".{last}").removesuffix(".in_air").removesuffix(".in_soil")
        return "angle" if last in PLACES else _signal(name, name)
    return of_planting(path)


def _of_respond(model: Machine | Tool, path: str) -> str | None:
    first, _, rest = path.partition(".")
    last = _last(path)
    if last in ("phases", "orders", "transmissibility", "transmissibility_by_order", "lifts_off"):
        return "angle" if last == "phases" else None
    support: Support | None = getattr(model, "support", None)
    if first == "gauges" and support is not None:
        return _of_gauge(support, rest)
    if first == "mounts" and support is not None:
        mount = next((m for n, m in support.mounts.items() if rest.startswith(f"{n}.")), None)
        return None if mount is None else "force" if mount.axis is None else "torque"
    kinds = {
        "speed": "angular speed",
        "drive.torque": "torque",
        "drive.speed": "angular speed",
        "energy": "energy",
        "joints": "force",
        "modes.natural_frequency": "angular speed",
        "modes.damped_frequency": "angular speed",
        "modes.hertz": "frequency",
    }
    return next((kind for name, kind in kinds.items() if f"{path}.".startswith(f"{name}.")), None)


def _of_gauge(support: Support, rest: str) -> str | None:
    names = [name for name in support.gauges if rest.startswith(f"{name}.")]
    if not names:
        return None
    name = max(names, key=len)
    turns = support.gauges[name].axis is not None
    if rest.startswith(f"{name}.velocity."):
        return "angular speed" if turns else "speed"
    if rest.startswith(f"{name}.acceleration."):
        return "angular acceleration" if turns else "acceleration"
    return "angle" if turns else "length"


def _of_balance(model: Machine | Tool, path: str) -> str | None:
    first, _, rest = path.partition(".")
    if first in ("speed", "equivalent_speeds"):
        return "angular speed"
    if path in ("added_mass", "before.mass", "after.mass"):
        return "mass"
    if first not in ("before", "after") or _last(path) == "area":
        return None
    kind, _, name = rest.partition(".")
    if kind == "rows":
        return "torque" if "moment" in name else "force"
    if kind == "planting":
        return of_planting(name)
    found = _of_respond(model, rest) if kind == "gauges" else None
    return found or _signal(rest.removesuffix(f".{_last(path)}"), rest)


def _of_tool(path: str) -> str | None:
    parts = path.split(".")
    while len(parts) > 1 and parts[-1] in OF_LISTS:
        parts.pop()
    if parts[-1] in PLACES:
        return "angular speed"
    if parts[0] in ("equivalents", "named"):
        return "acceleration"
    for kind, dimension in (("forces", "force"), ("power", "power")):
        if len(parts) > 3 and parts[0] == "stations" and parts[-2] == kind:
            return dimension
    return OF_LAST.get(parts[-1])


def _last(path: str) -> str:
    return path.rpartition(".")[2]
