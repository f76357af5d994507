"""Equipoise: how a planar linkage moves, what that does to its frame, and what to change.

>>> import equipoise as eq
>>> analysis = eq.analyze(eq.load("yamashita-1"))
>>> round(analysis.summary["shaking_force.y"].peak, 1)
23.1
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "Absorber": "handheld.model",
    "AddedMass": "mechanism.balance",
    "Analysis": "results.analysis",
    "Balance": "mechanism.balance",
    "BalanceShafts": "mechanism.balance",
    "Balanced": "balancing.balanced",
    "BaseParameters": "mechanism.parameters",
    "Best": "studies.selection",
    "CenterMove": "mechanism.balance",
    "Choices": "studies.design_space",
    "Conditions": "balancing.linear_conditions",
    "Correlation": "studies.design_space",
    "Decay": "measured.decay",
    "DesignLimit": "handheld.design_plan",
    "DesignPlan": "handheld.design_plan",
    "DesignVariable": "handheld.design_plan",
    "Drive": "mechanism.model",
    "EquipoiseError": "errors",
    "Excitation": "handheld.model",
    "Exposure": "exposure.daily",
    "Figures": "signals",
    "Fit": "planting.search",
    "Forces": "mechanism.dynamics",
    "FourBar": "mechanism.assessment",
    "FreeVibration": "vibration.free",
    "Front": "balancing.pareto",
    "Gauge": "mechanism.support",
    "Gear": "mechanism.model",
    "GearedWeight": "mechanism.balance",
    "Goal": "planting.goals",
    "Hand": "handheld.model",
    "Harness": "handheld.model",
    "Impedance": "handheld.model",
    "Landscape": "studies.objective_map",
    "Limit": "mechanism.balance",
    "Link": "mechanism.model",
    "Linkage": "mechanism.linkage",
    "Load": "mechanism.model",
    "LoadTable": "mechanism.model",
    "Machine": "mechanism.model",
    "Motion": "mechanism.motion",
    "Motor": "mechanism.force_elements",
    "MotorTable": "mechanism.force_elements",
    "Mount": "mechanism.support",
    "Normal": "studies.design_space",
    "Objective": "mechanism.balance",
    "Operation": "handheld.model",
    "Output": "studies.design_space",
    "Periodic": "signals",
    "Phases": "mechanism.balance",
    "Phasing": "balancing.phase_search",
    "Planting": "mechanism.field",
    "PlantingFigures": "planting.summary",
    "Position": "mechanism.model",
    "Range": "studies.design_space",
    "Record": "measured.record",
    "Regressor": "mechanism.parameters",
    "Response": "vibration.response",
    "Row": "mechanism.support",
    "Sampling": "studies.design_space",
    "Searched": "studies.search",
    "Section": "handheld.section",
    "Segment": "handheld.shaft",
    "Shaft": "handheld.shaft",
    "Slider": "mechanism.model",
    "Soil": "mechanism.field",
    "SoilTable": "mechanism.field",
    "Spring": "mechanism.force_elements",
    "SpringChoice": "mechanism.balance",
    "Station": "handheld.model",
    "Store": "studies.store",
    "Study": "studies.study",
    "Support": "mechanism.support",
    "Sweep": "vibration.sweep",
    "Task": "exposure.daily",
    "Template": "schema.template",
    "Tolerances": "studies.tolerances",
    "Tool": "handheld.model",
    "ToolDesign": "handheld.design",
    "ToolExposure": "handheld.exposed",
    "ToolModes": "handheld.modes",
    "ToolResponse": "handheld.response",
    "ToolSweep": "handheld.sweep",
    "Transient": "vibration.transient",
    "Transmissions": "handheld.transmission",
    "Tube": "handheld.section",
    "Uniform": "studies.design_space",
    "Vary": "studies.design_space",
    "Weight": "mechanism.balance",
    "Weighted": "exposure.weighting",
    "Work": "handheld.model",
    "analyze": "results.analysis",
    "arranged": "balancing.patterns",
    "assemble": "mechanism.linkage",
    "balance": "balancing.optimisation",
    "base_parameters": "mechanism.parameters",
    "best": "studies.selection",
    "choose_phases": "balancing.phase_search",
    "conditions": "balancing.linear_conditions",
    "daily_exposure": "exposure.daily",
    "design_tool": "handheld.design",
    "dumps": "schema.models",
    "examples": "schema.models",
    "export": "studies.table_files",
    "expose_tool": "handheld.exposed",
    "feasibility": "balancing.physical_consistency",
    "fit_planting": "planting.search",
    "forces": "mechanism.dynamics",
    "four_bar": "mechanism.assessment",
    "from_rest": "vibration.transient",
    "harmonics": "signals",
    "identify_decay": "measured.decay",
    "json_schema": "schema.models",
    "landscape": "studies.objective_map",
    "least_moments": "balancing.least_norm",
    "load": "schema.models",
    "load_study": "schema.studies",
    "load_tool": "schema.models",
    "loads": "schema.models",
    "loads_tool": "schema.models",
    "machine_of": "schema.study_units",
    "move": "mechanism.motion",
    "open_store": "studies.store",
    "plant": "planting.summary",
    "read_accelerations": "schema.records",
    "read_record": "schema.records",
    "regressor": "mechanism.parameters",
    "respond": "vibration.forced",
    "respond_tool": "handheld.response",
    "resume": "schema.study_units",
    "run_study": "studies.run",
    "save": "schema.models",
    "search_designs": "studies.search",
    "sensitivities": "balancing.sensitivity",
    "simulate_decay": "measured.record",
    "sweep_speed": "vibration.sweep",
    "sweep_tool": "handheld.sweep",
    "tolerance": "studies.tolerances",
    "tool_sensitivities": "handheld.exposed",
    "trade_off": "balancing.pareto",
    "transmit": "handheld.transmission",
    "vary_tool": "handheld.studies",
    "vibrate_freely": "vibration.free",
    "vibrate_tool": "handheld.modes",
    "view": "web.widget",
    "weigh_orders": "exposure.spectra",
    "weigh_signal": "exposure.spectra",
    "weigh_spectrum": "exposure.spectra",
    "write_report": "present.composition",
}
"""Public names and where they live; each is imported when it is first used."""

__all__ = ["__version__", *_HOMES]  # noqa: PLE0604

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced as Balanced
    from equipoise.balancing.least_norm import least_moments as least_moments
    from equipoise.balancing.linear_conditions import Conditions as Conditions
    from equipoise.balancing.linear_conditions import conditions as conditions
    from equipoise.balancing.optimisation import balance as balance
    from equipoise.balancing.pareto import Front as Front
    from equipoise.balancing.pareto import trade_off as trade_off
    from equipoise.balancing.patterns import arranged as arranged
    from equipoise.balancing.phase_search import Phasing as Phasing
    from equipoise.balancing.phase_search import choose_phases as choose_phases
    from equipoise.balancing.physical_consistency import feasibility as feasibility
    from equipoise.balancing.sensitivity import sensitivities as sensitivities
    from equipoise.errors import EquipoiseError as EquipoiseError
    from equipoise.exposure.daily import Exposure as Exposure
    from equipoise.exposure.daily import Task as Task
    from equipoise.exposure.daily import daily_exposure as daily_exposure
    from equipoise.exposure.spectra import weigh_orders as weigh_orders
    from equipoise.exposure.spectra import weigh_signal as weigh_signal
    from equipoise.exposure.spectra import weigh_spectrum as weigh_spectrum
    from equipoise.exposure.weighting import Weighted as Weighted
    from equipoise.handheld.design import ToolDesign as ToolDesign
    from equipoise.handheld.design import design_tool as design_tool
    from equipoise.handheld.design_plan import DesignLimit as DesignLimit
    from equipoise.handheld.design_plan import DesignPlan as DesignPlan
    from equipoise.handheld.design_plan import DesignVariable as DesignVariable
    from equipoise.handheld.exposed import ToolExposure as ToolExposure
    from equipoise.handheld.exposed import expose_tool as expose_tool
    from equipoise.handheld.exposed import tool_sensitivities as tool_sensitivities
    from equipoise.handheld.model import Absorber as Absorber
    from equipoise.handheld.model import Excitation as Excitation
    from equipoise.handheld.model import Hand as Hand
    from equipoise.handheld.model import Harness as Harness
    from equipoise.handheld.model import Impedance as Impedance
    from equipoise.handheld.model import Operation as Operation
    from equipoise.handheld.model import Station as Station
    from equipoise.handheld.model import Tool as Tool
    from equipoise.handheld.model import Work as Work
    from equipoise.handheld.modes import ToolModes as ToolModes
    from equipoise.handheld.modes import vibrate_tool as vibrate_tool
    from equipoise.handheld.response import ToolResponse as ToolResponse
    from equipoise.handheld.response import respond_tool as respond_tool
    from equipoise.handheld.section import Section as Section
    from equipoise.handheld.section import Tube as Tube
    from equipoise.handheld.shaft import Segment as Segment
    from equipoise.handheld.shaft import Shaft as Shaft
    from equipoise.handheld.studies import vary_tool as vary_tool
    from equipoise.handheld.sweep import ToolSweep as ToolSweep
    from equipoise.handheld.sweep import sweep_tool as sweep_tool
    from equipoise.handheld.transmission import Transmissions as Transmissions
    from equipoise.handheld.transmission import transmit as transmit
    from equipoise.measured.decay import Decay as Decay
    from equipoise.measured.decay import identify_decay as identify_decay
    from equipoise.measured.record import Record as Record
    from equipoise.measured.record import simulate_decay as simulate_decay
    from equipoise.mechanism.assessment import FourBar as FourBar
    from equipoise.mechanism.assessment import four_bar as four_bar
    from equipoise.mechanism.balance import AddedMass as AddedMass
    from equipoise.mechanism.balance import Balance as Balance
    from equipoise.mechanism.balance import BalanceShafts as BalanceShafts
    from equipoise.mechanism.balance import CenterMove as CenterMove
    from equipoise.mechanism.balance import GearedWeight as GearedWeight
    from equipoise.mechanism.balance import Limit as Limit
    from equipoise.mechanism.balance import Objective as Objective
    from equipoise.mechanism.balance import Phases as Phases
    from equipoise.mechanism.balance import SpringChoice as SpringChoice
    from equipoise.mechanism.balance import Weight as Weight
    from equipoise.mechanism.dynamics import Forces as Forces
    from equipoise.mechanism.dynamics import forces as forces
    from equipoise.mechanism.field import Planting as Planting
    from equipoise.mechanism.field import Soil as Soil
    from equipoise.mechanism.field import SoilTable as SoilTable
    from equipoise.mechanism.force_elements import Motor as Motor
    from equipoise.mechanism.force_elements import MotorTable as MotorTable
    from equipoise.mechanism.force_elements import Spring as Spring
    from equipoise.mechanism.linkage import Linkage as Linkage
    from equipoise.mechanism.linkage import assemble as assemble
    from equipoise.mechanism.model import (
        Drive as Drive,
    )
    from equipoise.mechanism.model import (
        Gear as Gear,
    )
    from equipoise.mechanism.model import (
        Link as Link,
    )
    from equipoise.mechanism.model import (
        Load as Load,
    )
    from equipoise.mechanism.model import (
        LoadTable as LoadTable,
    )
    from equipoise.mechanism.model import (
        Machine as Machine,
    )
    from equipoise.mechanism.model import (
        Position as Position,
    )
    from equipoise.mechanism.model import (
        Slider as Slider,
    )
    from equipoise.mechanism.motion import Motion as Motion
    from equipoise.mechanism.motion import move as move
    from equipoise.mechanism.parameters import (
        BaseParameters as BaseParameters,
    )
    from equipoise.mechanism.parameters import (
        Regressor as Regressor,
    )
    from equipoise.mechanism.parameters import (
        base_parameters as base_parameters,
    )
    from equipoise.mechanism.parameters import (
        regressor as regressor,
    )
    from equipoise.mechanism.support import Gauge as Gauge
    from equipoise.mechanism.support import Mount as Mount
    from equipoise.mechanism.support import Row as Row
    from equipoise.mechanism.support import Support as Support
    from equipoise.planting.goals import Goal as Goal
    from equipoise.planting.search import Fit as Fit
    from equipoise.planting.search import fit_planting as fit_planting
    from equipoise.planting.summary import PlantingFigures as PlantingFigures
    from equipoise.planting.summary import plant as plant
    from equipoise.present.composition import write_report as write_report
    from equipoise.results.analysis import Analysis as Analysis
    from equipoise.results.analysis import analyze as analyze
    from equipoise.schema.models import dumps as dumps
    from equipoise.schema.models import examples as examples
    from equipoise.schema.models import json_schema as json_schema
    from equipoise.schema.models import load as load
    from equipoise.schema.models import load_tool as load_tool
    from equipoise.schema.models import loads as loads
    from equipoise.schema.models import loads_tool as loads_tool
    from equipoise.schema.models import save as save
    from equipoise.schema.records import read_accelerations as read_accelerations
    from equipoise.schema.records import read_record as read_record
    from equipoise.schema.studies import load_study as load_study
    from equipoise.schema.study_units import machine_of as machine_of
    from equipoise.schema.study_units import resume as resume
    from equipoise.schema.template import Template as Template
    from equipoise.signals import Figures as Figures
    from equipoise.signals import Periodic as Periodic
    from equipoise.signals import harmonics as harmonics
    from equipoise.studies.design_space import Vary as Vary
    from equipoise.studies.objective_map import Landscape as Landscape
    from equipoise.studies.objective_map import landscape as landscape
    from equipoise.studies.run import run_study as run_study
    from equipoise.studies.search import Searched as Searched
    from equipoise.studies.search import search_designs as search_designs
    from equipoise.studies.selection import Best as Best
    from equipoise.studies.selection import best as best
    from equipoise.studies.store import Store as Store
    from equipoise.studies.store import open_store as open_store
    from equipoise.studies.study import Study as Study
    from equipoise.studies.table_files import export as export
    from equipoise.studies.tolerances import Tolerances as Tolerances
    from equipoise.studies.tolerances import tolerance as tolerance
    from equipoise.vibration.forced import respond as respond
    from equipoise.vibration.free import FreeVibration as FreeVibration
    from equipoise.vibration.free import vibrate_freely as vibrate_freely
    from equipoise.vibration.response import Response as Response
    from equipoise.vibration.sweep import Sweep as Sweep
    from equipoise.vibration.sweep import sweep_speed as sweep_speed
    from equipoise.vibration.transient import Transient as Transient
    from equipoise.vibration.transient import from_rest as from_rest
    from equipoise.web.widget import view as view


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'equipoise' has no attribute {name!r}")
    value = getattr(import_module(f"equipoise.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
