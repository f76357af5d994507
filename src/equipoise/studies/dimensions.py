"""What kind of quantity a figure of a command is, told by its path; nothing is computed for it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from equipoise.mechanism.outputs import declared
from equipoise.planting.goals import dimension_of as of_planting
from equipoise.studies.figures import OF_LISTS, PLACES

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.mechanism.support import Support

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
        return _of_part(rest)
    if _last(path) in PLACES:
        return "angle"
    return _of_output(path.removesuffix(f".{_last(path)}") if _last(path) in OF_LISTS else path)


def _of_output(name: str) -> str | None:
    """Of an output, or of what stands beside them."""
    if name == "crank_angle" or name.startswith("about."):
        return "angle" if name == "crank_angle" else "length"
    found = declared(name)
    return None if found is None else found[0].dimension


def _of_part(path: str) -> str | None:
    """Of what a cause or link adds to an output, which stands first."""
    words = path.split(".")
    names = (".".join(words[:count]) for count in range(len(words), 0, -1))
    return next((found[0].dimension for found in map(declared, names) if found), None)


def _by_order(rest: str) -> str | None:
    name, _, last = rest.rpartition(".")
    if last in OF_LISTS:
        name, _, last = name.rpartition(".")
    if last == "phases":
        return "angle"
    if last == "orders":
        return None
    return _of_output(name)


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
        return "angle" if last in PLACES else _of_output(name)
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
    if kind == "planting":
        return of_planting(name)
    found = _of_respond(model, rest) if kind == "gauges" else None
    return found or _of_output(rest.removesuffix(f".{_last(path)}"))


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
