"""Charts of whatever outputs are declared, over crank angle, and of all motion that there is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from equipoise.figures.analysis import ALL, angle_axis, over, title
from equipoise.figures.crank import compared
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.outputs import joint_named
from equipoise.results.charts import Chart

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis
    from equipoise.results.outputs import Output

MOST_LINKS = 3
"""Links whose motion stands in a report."""
FORBIDDEN = str.maketrans(dict.fromkeys(' /\\:*?"<>|', "-"))
"""What a file may not have in its name."""


def outputs_chart(
    analysis: Analysis, names: Sequence[str], name: str = "outputs", what: str = ""
) -> Chart:
    """Outputs over crank angle, below each other, with their extremes.

    what : that is shown; the labels of the outputs where not given.

    Raises
    ------
    UsageError : there is no output of a name.
    """
    ones = [analysis.outputs[one] for one in names]
    x = angle_axis(analysis)
    panels = []
    for one in ones:
        drawn = {ALL: over(analysis, one.values)}
        panel = compared(x, "", one.dimension, drawn, angles=len(ones) < 4)
        panels.append(replace(panel, title=replace(panel.y, label=one.label()).text))
    told = what or say(", ").join(one.label() for one in ones)
    return Chart(name, analysis.machine.title, title(analysis, told), tuple(panels))


def kinematics(analysis: Analysis) -> Iterator[Chart]:
    """Motion of every slider, link and moving point, and all transmission angles."""
    yield from _each(analysis, "sliders")
    angles = [one.name for one in analysis.outputs if one.group == "transmission"]
    if angles:
        what = say("Transmission angles")
        yield outputs_chart(analysis, angles, "kinematics-transmission", what)
    yield from _each(analysis, "links")
    yield from _each(analysis, "points")


def main_kinematics(analysis: Analysis) -> list[Chart]:
    """Those that matter most: of sliders, or driven links, on the frame; transmission angles."""
    machine = analysis.machine
    driven = [
        link
        for link, body in machine.links.items()
        if link != machine.drive.link and set(body.points) & set(machine.frame)
    ]
    wanted = [slider.name for slider in machine.sliders if slider.on == FRAME]
    wanted += driven[:MOST_LINKS] if not wanted else []
    names = {"kinematics-transmission", *map(_name, wanted)}
    return [chart for chart in kinematics(analysis) if chart.name in names]


def _each(analysis: Analysis, group: str) -> Iterator[Chart]:
    """A chart of each member of a group; components are told, and the sizes of vectors are not."""
    members: dict[str, list[Output]] = {}
    still = analysis.machine.frame if group == "points" else ()
    for one in analysis.outputs:
        if one.group == group and one.declared.array and one.item not in still:
            members.setdefault(one.item, []).append(one)
    for item, ones in members.items():
        what = say("Motion of {name}", name=short(joint_named(item), 24))
        yield outputs_chart(analysis, [one.name for one in ones], _name(item), what)


def _name(item: str) -> str:
    return f"kinematics-{item.translate(FORBIDDEN)}"
