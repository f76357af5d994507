"""SVG of parts to be cut: outlines and holes at 1:1 in mm, below one another."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from equipoise.exchange.formats import Job
from equipoise.exchange.parts import BulgedCorner, parts

MM = 1e3
"""mm in a metre."""
MARGIN, LETTER = 10.0, 4.0
"""Around each part, and the height of its name, mm."""
LINE = {"fill": "none", "stroke": "black", "stroke-width": "0.1"}


def export_bytes(job: Job) -> str:
    """The file's text."""
    root = ET.Element("svg", xmlns="http://www.w3.org/2000/svg")
    ET.SubElement(root, "title").text = str(job.machine.title)
    width, below = 0.0, MARGIN
    for part in parts(job):
        low, high = (MM * corner for corner in part.box)
        ways = [_way(edges, complex(MARGIN - low.real, below + high.imag)) for edges in part.edges]
        group = ET.SubElement(root, "g", id=part.name)
        ET.SubElement(group, "title").text = part.title
        ET.SubElement(group, "path", LINE, d=" ".join(ways))
        for place, radius in part.thread_circles:
            x, y = MARGIN + (MM * place - low).real, below + (high - MM * place).imag
            circle = {"cx": repr(x), "cy": repr(y), "r": repr(MM * radius)}
            ET.SubElement(group, "circle", {**LINE, **circle})
        below += (high - low).imag + LETTER + MARGIN
        words = {"x": str(MARGIN), "y": repr(below - MARGIN), "font-size": str(LETTER)}
        ET.SubElement(group, "text", words).text = part.title
        width = max(width, (high - low).real, len(part.title) * LETTER)
    root.set("width", f"{width + 2 * MARGIN!r}mm")
    root.set("height", f"{below!r}mm")
    root.set("viewBox", f"0 0 {width + 2 * MARGIN!r} {below!r}")
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _way(edges: tuple[BulgedCorner, ...], shift: complex) -> str:
    """A closed outline as the data of a path; y points down there."""
    words = []
    for number, (corner, _) in enumerate((*edges, edges[0])):
        place = f"{(MM * corner + shift).real!r} {(shift.imag - MM * corner.imag)!r}"
        before, bulge = edges[number - 1]
        if number == 0:
            words.append(f"M {place}")
        elif bulge:
            radius = MM * abs(corner - before) * (1 + bulge**2) / (4 * abs(bulge))
            words.append(f"A {radius!r} {radius!r} 0 0 {int(bulge < 0)} {place}")
        else:
            words.append(f"L {place}")
    return " ".join([*words, "Z"])
