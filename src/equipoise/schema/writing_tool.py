"""From a tool to the text of its file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from equipoise.errors import ModelError
from equipoise.handheld.design_plan import KEYS, OUTPUTS, DesignLimit, DesignPlan, DesignVariable
from equipoise.handheld.model import (
    CAUSES,
    NOTHING,
    PLANES,
    Absorber,
    Both,
    Excitation,
    Hand,
    Harness,
    Operation,
    Station,
    Tool,
    Work,
)
from equipoise.handheld.shaft import Section, Segment, Shaft, Tube
from equipoise.quantities import Dimension, format_exact
from equipoise.schema import SCHEMA_VERSION
from equipoise.schema.opening import impedance_keys
from equipoise.schema.plain import listed, quantities, tidy, unless, usual_name
from equipoise.schema.tube_materials import Material, material_of


def tool_document(tool: Tool, files: Mapping[str, str]) -> dict[str, Any]:
    """Return the content of the tool's file as plain values; defaults are left out.

    Parameters
    ----------
    tool : what is to be written.
    files : name of the file for each key that names one, such as ``excitations[1].linkage``.

    Raises
    ------
    ModelError : a section has what no file can tell.
    """
    excitations = [
        _excitation(excitation, files.get(f"excitations[{number}].linkage"))
        for number, excitation in enumerate(tool.excitations, 1)
    ]
    stations = [
        _station(station, f"shaft.stations[{number}]", files)
        for number, station in enumerate(tool.stations, 1)
    ]
    operation, design = tool.operation, tool.design
    return {
        "schema": SCHEMA_VERSION,
        "title": tool.title,
        **unless(tool.description == "", description=tool.description),
        "shaft": {**_shaft(tool.shaft), **unless(not stations, stations=stations)},
        **unless(not excitations, excitations=excitations),
        **({} if operation is None else {"operation": _operation(operation)}),
        **unless(not tool.work, work=[_work(work) for work in tool.work]),
        **({} if design is None else {"design": _design(design)}),
    }


# -- shaft -----------------------------------------------------------------------------------------


def _shaft(shaft: Shaft) -> dict[str, Any]:
    segments = [
        _segment(segment, f"shaft.segments[{number}]")
        for number, segment in enumerate(shaft.segments, 1)
    ]
    return {
        "length": format_exact(shaft.length, "length"),
        **_profile(shaft.profile, "shaft"),
        **unless(shaft.loss_factor == 0, loss_factor=tidy(shaft.loss_factor)),
        **unless(shaft.theory == "euler-bernoulli", theory=shaft.theory),
        **unless(not segments, segments=segments),
    }


def _segment(segment: Segment, where: str) -> dict[str, Any]:
    return {
        "from": format_exact(segment.start, "length"),
        "to": format_exact(segment.stop, "length"),
        **_profile(segment.profile, where),
    }


def _profile(profile: Section | Tube, where: str) -> dict[str, Any]:
    if isinstance(profile, Tube):
        return {
            **quantities(profile, {"outer_diameter": "length", "inner_diameter": "length"}),
            **_made_of(Material(profile.youngs_modulus, profile.density, profile.poisson_ratio)),
            **quantities(profile, {"carried": "mass per length"}),
        }
    if profile != profile.section("euler-bernoulli"):
        raise ModelError(
            where, "a file cannot tell shear_stiffness and rotary_inertia; give a Tube instead"
        )
    return {
        "mass_per_length": format_exact(profile.mass_per_length, "mass per length"),
        "bending_stiffness": format_exact(profile.bending_stiffness, "bending stiffness"),
    }


def _made_of(material: Material) -> dict[str, Any]:
    if name := material_of(material):
        return {"material": name}
    return {
        **quantities(material, {"youngs_modulus": "modulus", "density": "density"}),
        **unless(
            material.poisson_ratio == Tube.poisson_ratio,
            poisson_ratio=tidy(material.poisson_ratio),
        ),
    }


# -- stations --------------------------------------------------------------------------------------

RATES: dict[str, Dimension] = {
    "inertia": "inertia",
    "stiffness": "stiffness",
    "damping": "damping",
    "rotational_stiffness": "torsional stiffness",
    "rotational_damping": "torsional damping",
}


def _station(station: Station, where: str, files: Mapping[str, str]) -> dict[str, Any]:
    absorber, hand, harness = station.absorber, station.hand, station.harness
    return {
        "name": station.name,
        "position": format_exact(station.position, "length"),
        **quantities(station, {"mass": "mass"}),
        **_pairs(station, *RATES),
        **({} if absorber is None else {"absorber": _absorber(absorber)}),
        **({} if hand is None else {"hand": _hand(hand, f"{where}.hand", files)}),
        **({} if harness is None else {"harness": _harness(harness)}),
    }


def _pairs(item: Any, *keys: str) -> dict[str, Any]:
    """Write those pairs of both planes that are not 0."""
    return {
        key: _planes(value, RATES[key]) for key in keys if (value := getattr(item, key)) != NOTHING
    }


def _planes(pair: Both, dimension: Dimension) -> str | dict[str, str]:
    """Write one quantity where both planes have the same, and a table where they have not."""
    texts = listed(pair, dimension)
    return texts[0] if pair[0] == pair[1] else dict(zip(PLANES, texts, strict=True))


def _absorber(absorber: Absorber) -> dict[str, Any]:
    return {
        "mass": format_exact(absorber.mass, "mass"),
        "stiffness": _planes(absorber.stiffness, "stiffness"),
        **_pairs(absorber, "damping"),
    }


def _harness(harness: Harness) -> dict[str, Any]:
    return {"stiffness": _planes(harness.stiffness, "stiffness"), **_pairs(harness, "damping")}


def _hand(hand: Hand, where: str, files: Mapping[str, str]) -> dict[str, Any]:
    names = [files[key] for key in impedance_keys(where, len(hand.impedance))]
    impedance = names[0] if len(names) == 1 else dict(zip(PLANES, names, strict=False))
    return {
        **quantities(hand, {"mass": "mass"}),
        **_pairs(hand, "stiffness", "damping"),
        **unless(not names, impedance=impedance),
        **unless(hand.hands == 1, hands=hand.hands),
    }


# -- what shakes it, and what is asked of it -------------------------------------------------------


def _excitation(excitation: Excitation, file: str | None) -> dict[str, Any]:
    cause = next(key for key in CAUSES if getattr(excitation, key) is not None)
    usual = usual_name(excitation.station, cause)
    table: dict[str, Any] = unless(excitation.name == usual, name=excitation.name)
    table["station"] = excitation.station
    if excitation.force is not None:
        table["force"] = format_exact(excitation.force, "force")
    elif excitation.unbalance is not None:
        table["unbalance"] = format_exact(excitation.unbalance, "unbalance")
    else:
        table["linkage"] = file
    return {
        **table,
        **unless(excitation.direction == "vertical", direction=excitation.direction),
        **quantities(excitation, {"phase": "angle"}),
        **unless(excitation.ratio == 1, ratio=tidy(excitation.ratio)),
    }


def _operation(operation: Operation) -> dict[str, Any]:
    return {
        "speed": format_exact(operation.speed, "angular speed"),
        **unless(not operation.speeds, speeds=listed(operation.speeds, "angular speed")),
        **quantities(operation, {"idling": "angular speed", "racing": "angular speed"}),
    }


def _work(work: Work) -> dict[str, Any]:
    return {
        "name": work.name,
        **quantities(work, {"speed": "angular speed", "duration": "time"}),
    }


def _design(design: DesignPlan) -> dict[str, Any]:
    return {
        "speeds": listed(design.speeds, "angular speed"),
        **unless(design.measure == "rms", measure=design.measure),
        **unless(not design.hands, hands=[*design.hands]),
        "variables": [_variable(variable) for variable in design.variables],
        **unless(not design.limits, limits=[_limit(limit) for limit in design.limits]),
    }


def _variable(variable: DesignVariable) -> dict[str, Any]:
    dimension: Any = KEYS[variable.key]
    low, high = listed((variable.low, variable.high), dimension)
    return {"station": variable.station, "key": variable.key, "from": low, "to": high}


def _limit(limit: DesignLimit) -> dict[str, Any]:
    dimension: Any = OUTPUTS[limit.output]
    return {
        "output": limit.output,
        **unless(limit.station is None, station=limit.station),
        "at_most": format_exact(limit.at_most, dimension),
    }
