"""Hand-held tools, and their pictures."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from equipoise.figures import tool_charts, tool_side
from equipoise.handheld.hand_exposure import expose_tool
from equipoise.handheld.model import Absorber, Excitation, Hand, Station, Tool, Work
from equipoise.handheld.modes import determinant_chart, vary_tool, vibrate_tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.sweep import transmit
from equipoise.results.charts import Chart
from equipoise.schema.models import load_tool

Drawn = dict[str, Chart]
SPEEDS = np.linspace(105.0, 942.0, 60)
"""rad/s."""


def paper() -> Tool:
    """The machine of Nagamine and Irie, damped a little and shaken by two unbalances."""
    tool = load_tool("nagamine-irie")
    hand = Hand(stiffness=(50014.0, 50014.0), damping=(60.0, 60.0), hands=2)
    shakes = (
        Excitation("engine", "engine", unbalance=1e-3),
        Excitation("cutter", "cutter", unbalance=3e-4, ratio=0.737),
    )
    return replace(
        tool.with_station("handle", hand=hand),
        shaft=replace(tool.shaft, loss_factor=0.01),
        excitations=shakes,
        work=(Work("cutting", 733.0, 2 * 3600.0), Work("idling", 280.0, 1800.0)),
    )


def cutter() -> Tool:
    """Both planes are different there, and two stations are held by a hand."""
    return replace(load_tool("brush-cutter"), design=None)


def crowded() -> Tool:
    """More stations than there is room for, seven more of them with a hand."""
    hand = Hand(stiffness=(9e3, 9e3), damping=(90.0, 90.0))
    stations = [
        Station(
            f"station number {k}",
            0.3 + 0.008 * k,
            mass=0.02,
            hand=hand if k % 4 == 0 else None,
        )
        for k in range(26)
    ]
    return replace(paper(), title="Crowded", stations=(*paper().stations, *stations))


def close_together() -> Tool:
    """Some stations at one end, two of them at the same place."""
    names = ("throttle lever", "rear handle", "stop switch", "fuel tank", "muffler", "starter")
    places = (0.01, 0.03, 0.03, 0.05, 0.07, 0.08)
    stations = [Station(*each, mass=0.1) for each in zip(names, places, strict=True)]
    return replace(paper(), stations=(*paper().stations, *stations))


def odd_names() -> Tool:
    names = {
        "engine": "$x_1$ " + "long " * 30,
        "harness": "ベルト 100 % <b>'\"</b>",
        "handle": "손잡이",
        "cutter": "a/b",
    }
    tool = paper()
    stations = tuple(replace(station, name=names[station.name]) for station in tool.stations)
    shakes = tuple(
        replace(excitation, station=names[excitation.station]) for excitation in tool.excitations
    )
    title = r"刈払機 예초기 costs $5 and \alpha_{1}^2 <b>'\"</b> " + "long " * 20
    return replace(tool, title=title, stations=stations, excitations=shakes)


def loose() -> Tool:
    """Nothing holds it, and only up and down is it shaken; with an absorber."""
    tool = paper()
    stations = [
        replace(station, hand=None, harness=None, absorber=Absorber(0.1, (1e4, 2e4)))
        if station.name == "handle"
        else replace(station, harness=None)
        for station in tool.stations
    ]
    force = Excitation("force", "engine", force=10.0)
    return replace(tool, stations=tuple(stations), excitations=(force,), operation=None, work=())


MACHINES = {
    "paper": paper,
    "cutter": cutter,
    "crowded": crowded,
    "close together": close_together,
    "odd names": odd_names,
    "loose": loose,
}
VARIED = {"cutter": ("front-handle", "absorber.stiffness")}


@cache
def machine(kind: str) -> Tool:
    return MACHINES[kind]()


@cache
def pictures(kind: str) -> Drawn:
    """All pictures of a tool but that of a design."""
    return drawn_anew(kind)


def drawn_anew(kind: str) -> Drawn:
    """The same, not those drawn before."""
    tool = machine(kind)
    modes = vibrate_tool(tool, 8 if kind == "cutter" else 5)
    drawn = {"side": tool_side.side(tool), **tool_side.side_mode_charts(modes)}
    if kind == "close together":
        return drawn | tool_charts.response_charts(respond_tool(tool, 700.0))
    highest = 1.3 * float(modes.planes[0].parameter[-1])
    drawn |= tool_charts.determinant_charts(determinant_chart(tool, highest, 300), modes)
    station, key = VARIED.get(kind, (tool.stations[0].name, "mass"))
    values = np.geomspace(1e3, 1e5, 9) if "stiffness" in key else np.linspace(0.0, 0.8, 9)
    drawn |= tool_charts.variation_charts(vary_tool(tool, station, key, values, 6))
    if tool.grips:
        drawn |= tool_charts.transmission_charts(transmit(tool, SPEEDS), modes)
        drawn |= tool_charts.exposure_charts(expose_tool(tool, SPEEDS))
    return drawn | tool_charts.response_charts(respond_tool(tool, SPEEDS))
