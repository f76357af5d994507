"""How signs look, by their role, and which covers which."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations, zip_longest

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.signals import Array
from equipoise.symbols.scene import LinkOutline, Scene
from equipoise.symbols.shapes import off_outline

Colors = Mapping[str, str]

LIGHT: Colors = {
    "paper": "#ffffff",
    "ink": "#1a1a1a",
    "lines": "#595959",
    "faint": "#a6a6a6",
    "pale": "#d9d9d9",
    "wheel": "#f1f1f1",
    "main": "#0060a8",
    "stress": "#c8500a",
    "soil": "#efe4d2",
    "earth": "#7a5c33",
}
"""Blue and vermilion keep apart for the colour-blind; in grey, width and dashes tell them apart."""
DARK: Colors = {
    "paper": "#16191d",
    "ink": "#e8e8e8",
    "lines": "#a8adb3",
    "faint": "#6c737b",
    "pale": "#3d444c",
    "wheel": "#22272d",
    "main": "#62aef0",
    "stress": "#f29055",
    "soil": "#2c261c",
    "earth": "#b0946a",
}


@dataclass(frozen=True)
class Look:
    """How a shape is drawn.

    fill, line : names of colours; none where there is none.
    width : of the line, units.  dashes : lengths of dash and gap, units.
    flat : whether the line ends where it ends, instead of in a half circle.
    """

    fill: str | None
    line: str | None
    width: float = 0.0
    dashes: tuple[float, ...] | None = None
    flat: bool = False

    def css(self, unit: float) -> str:
        """As a style sheet has it; unit : pixels."""
        fill = f"var(--{self.fill})" if self.fill else "none"
        if self.line is None:
            return f"fill:{fill}"
        caps = ";stroke-linecap:butt" if self.dashes or self.flat else ""
        if self.dashes:
            lengths = " ".join(pixels(length * unit) for length in self.dashes)
            caps += f";stroke-dasharray:{lengths}"
        width = pixels(self.width * unit)
        return f"fill:{fill};stroke:var(--{self.line});stroke-width:{width}{caps}"


EDGE, BODY = 10.4, 8.6
"""Width of a bar with and without its outline, units."""
BASE = 30.0
"""Width of the outline that a support has around its points, units."""

LOOKS = {
    "soil": Look("soil", None),
    "stubble": Look(None, "earth", 0.8),
    "surface": Look(None, "earth", 1.6, flat=True),
    "support-edge": Look("faint", "faint", BASE),
    "support": Look("wheel", "wheel", BASE - 1.6),
    "row": Look(None, "faint", 2.4),
    "rest": Look("pale", "lines", 1.2),
    "wheel": Look("wheel", "lines", 1.0),
    "pitch": Look(None, "faint", 1.2, (5.0, 3.0)),
    "spoke": Look(None, "faint", 3.0),
    "groove": Look("paper", "lines", 1.4),
    "cam": Look("wheel", "lines", 1.4),
    "path": Look("paper", "lines", 1.2),
    "path-edge": Look(None, "lines", 1.2),
    "rib": Look(None, "lines", 1.0),
    "cam-edge": Look(None, "lines", 1.4),
    "rider": Look("paper", "lines", 1.4),
    "face": Look(None, "lines", 3.0),
    "strand": Look(None, "lines", 1.6),
    "trace": Look(None, "main", 1.6),
    "force-path": Look(None, "stress", 1.1, (4.0, 3.0)),
    "solid": Look("wheel", "faint", 1.0),
    "opening": Look("paper", "faint", 1.0),
    "tie": Look(None, "faint", 3.0),
    "rail": Look(None, "lines", 1.2),
    "hatch": Look(None, "lines", 0.8),
    "edge": Look("lines", "lines", EDGE),
    "body": Look("pale", "pale", BODY),
    "rod-edge": Look(None, "lines", EDGE),
    "rod": Look(None, "pale", BODY),
    "rim": Look("pale", "lines", 1.0),
    "slot": Look("paper", "lines", 1.0),
    "block": Look("paper", "lines", 1.2),
    "spring": Look(None, "lines", 1.4),
    "spiral": Look(None, "lines", 1.4),
    "damper": Look(None, "lines", 1.4),
    "vane": Look(None, "lines", 1.4),
    "stop": Look(None, "lines", 1.4),
    "resistance": Look(None, "lines", 1.4),
    "bushing": Look(None, "lines", 1.4),
    "pull": Look(None, "lines", 1.2, (5.0, 3.0)),
    "pull-head": Look(None, "lines", 1.4),
    "constraint": Look(None, "main", 1.4),
    "missed-constraint": Look(None, "stress", 1.8, (2.4, 1.8)),
    "room": Look(None, "main", 1.2, (3.0, 2.4)),
    "planned": Look(None, "main", 1.2, (3.0, 2.4)),
    "added": Look(None, "stress", 2.2),
    "mount": Look(None, "lines", 1.4),
    "foot": Look("lines", "lines", 1.4),
    "float": Look("paper", "lines", 1.4),
    "gauge": Look("paper", "ink", 1.5),
    "needle": Look(None, "ink", 1.5),
    "needle-head": Look("ink", None),
    "tray": Look(None, "ink", 3.4),
    "stand": Look("paper", "lines", 1.2),
    "dot": Look("lines", None),
    "pin": Look("paper", "lines", 1.4),
    "mass": Look("paper", "ink", 0.9),
    "quarter": Look("ink", None),
    "tip": Look("main", "paper", 1.2),
    "piston": Look(None, "ink", 3.4),
    "barrel": Look("paper", "ink", 1.4),
    "driver": Look(None, "ink", 1.6),
    "driver-head": Look("ink", None),
    "force": Look(None, "stress", 2.6, flat=True),
    "force-head": Look("stress", None),
    "force-arc": Look(None, "stress", 1.8),
    "scale": Look(None, "ink", 1.4),
}
"""Role -> look."""

LAYERS_OF_MARKS = {
    "strand": {"springs": "strand"},
    "spiral": {"springs": "spiral"},
    "damper": {"springs": "damper"},
    "vane": {"springs": "vane"},
    "stop": {"springs": "stop"},
    "resistance": {"springs": "resistance"},
    "bushing": {"springs": "bushing"},
    "pull": {"springs": "pull"},
    "pull-head": {"springs": "pull-head"},
    "constraint": {"springs": "constraint"},
    "missed-constraint": {"springs": "missed-constraint"},
    "groove": {"wheels": "groove", "springs": "cam-edge"},
    "cam": {"wheels": "cam", "springs": "cam-edge"},
    "path": {"wheels": "path", "springs": "path-edge"},
    "path-edge": {"springs": "path-edge"},
    "rider": {"riders": "rider"},
    "face": {"riders": "face"},
}
"""Of marks that do not lie below all links: their roles by layer, so that links hide none."""


def pixels(value: float, digits: int = 2) -> str:
    """A number without needless signs."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".") if digits else f"{value:.0f}"
    return "0" if text == "-0" else text


COVERED = 0.25
"""Share of a link's outline that another one hides, from which both are not read together."""
ALIKE = 1e-6
"""rad within which links turn alike: others part as the crank goes on."""
SAMPLES = 16
"""Places on an edge."""


def in_turn(scene: Scene, k: int) -> list[tuple[tuple[str, ...], Scene]]:
    """The scene; or, where links of one shape that turn alike cover each other at the k-th crank
    angle, scenes of which each has some of these, whose names come with it, and all other links.
    """
    stacks = _stacks(scene, k)
    if not stacks:
        return [((), scene)]
    covering = {name for stack in stacks for name in stack}
    stacked = [tuple(filter(None, names)) for names in zip_longest(*stacks)]
    return [(names, _without(scene, covering - {*names})) for names in stacked]


def _stacks(scene: Scene, k: int) -> list[list[str]]:
    """Names of links that cover each other, directly or by others between them."""
    bodies = [body for body in scene.bodies if len(body.outline) > 1]
    stacks = {body.name: [body.name] for body in bodies}
    for item, other in combinations(bodies, 2):
        if stacks[item.name] is not stacks[other.name] and _covers(scene, item, other, k):
            stacks[item.name] += stacks[other.name]
            for name in stacks[other.name]:
                stacks[name] = stacks[item.name]
    by_name = {id(stack): stack for stack in stacks.values() if len(stack) > 1}
    return [*by_name.values()]


def _covers(scene: Scene, outline: LinkOutline, other: LinkOutline, k: int) -> bool:
    """Whether links of one shape that turn alike cover each other."""
    turned = scene.angles[outline.name] - scene.angles[other.name]
    if len(outline.outline) != len(other.outline) or np.ptp(turned) > ALIKE:
        return False
    outlines = [np.array([complex(scene.places[name][k]) for name in body.outline])
                for body in (outline, other)]  # fmt: skip
    shift = outlines[1] - outlines[0]
    if np.ptp(shift.real) + np.ptp(shift.imag) > scene.unit:
        return False
    off = [off_outline(_along(first), second[:, None])
           for first, second in (outlines, outlines[::-1])]  # fmt: skip
    return float(np.mean(np.array(off) < EDGE * scene.unit)) >= COVERED


def _along(corners: Array) -> Array:
    """Places on the edges of an outline."""
    share = np.arange(SAMPLES) / SAMPLES
    edges = np.roll(corners, -1) - corners
    return np.asarray((corners[:, None] + edges[:, None] * share).ravel())


def _without(scene: Scene, hidden: set[str]) -> Scene:
    """A scene without some links, and what only they have."""
    bodies = tuple(body for body in scene.bodies if body.name not in hidden)
    shared = {name for body in bodies for name in body.points}
    dropped = {name for body in scene.bodies if body.name in hidden for name in body.points}
    gone = dropped - shared - {*scene.frame}
    return replace(
        scene,
        bodies=bodies,
        places={name: place for name, place in scene.places.items() if name not in gone},
        pins=scene.pins - gone,
        pin_radii={name: size for name, size in scene.pin_radii.items() if name not in gone},
        mass_centers={
            name: place for name, place in scene.mass_centers.items() if name not in hidden
        },
        wheels=tuple(wheel for wheel in scene.wheels if wheel.link not in hidden),
        guides=tuple(
            guide for guide in scene.guides if guide.point not in gone and guide.on not in hidden
        ),
        springs=tuple(ends for ends in scene.springs if not {*ends} & gone),
        planned=tuple(ends for ends in scene.planned if not {*ends} & gone),
        marks=tuple(
            mark
            for mark in scene.marks
            if mark.body not in hidden and not {mark.point, mark.to} & {*gone}
        ),
    )
