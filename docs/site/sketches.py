"""Sketches of the theory: the dyads and a pair of gears, with the letters of the formulas.

Places are complex numbers as in the theory, and each sketch is solved by its own formulas.
"""

from __future__ import annotations

import re
from cmath import exp
from dataclasses import dataclass, field
from math import sqrt, tan

SCALE = 56
"""Pixels of one unit of length."""
STYLE = """
:root{--ink:#1a1a1a;--pale:#c9cfd6;--main:#0060a8;--stress:#a83c00;background:#fff}
@media (prefers-color-scheme:dark){:root{--ink:#e8e8e8;--pale:#4a535c;--main:#62aef0;
--stress:#f29055;background:#16191d}}
.bar{stroke:var(--pale);stroke-width:11;stroke-linecap:round}
.line{stroke:var(--ink);stroke-width:1.2;fill:none}
.thin{stroke:var(--ink);stroke-width:1;stroke-dasharray:5 4}
.pin{fill:#fff;stroke:var(--ink);stroke-width:1.6}.known{fill:var(--ink)}
.block{fill:var(--pale);stroke:var(--ink);stroke-width:1.2}
.vector{stroke:var(--main);stroke-width:2;fill:none}.head{fill:var(--main)}
.force .vector{stroke:var(--stress)}.force .head{fill:var(--stress)}
text{font:italic 17px "STIX Two Math","Times New Roman",serif;fill:var(--ink)}
"""


@dataclass
class Sketch:
    """Lines, pins and vectors with letters; places in units, y upwards."""

    title: str
    parts: list[str] = field(default_factory=list)
    places: list[complex] = field(default_factory=list)

    def line(self, p: complex, q: complex, kind: str = "line") -> None:
        """A line of a kind: ``bar``, ``line`` or ``thin``."""
        self.places += [p, q]
        ends = f'x1="{_x(p)}" y1="{_y(p)}" x2="{_x(q)}" y2="{_y(q)}"'
        self.parts.append(f'<line class="{kind}" {ends}/>')

    def pin(self, p: complex, letter: str, at: complex, known: bool = False) -> None:
        """A pin, filled where its place is known, and its letter at an offset."""
        kind = "pin known" if known else "pin"
        self.parts.append(f'<circle class="{kind}" cx="{_x(p)}" cy="{_y(p)}" r="5"/>')
        self.text(p + at, letter)

    def circle(self, p: complex, radius: float) -> None:
        """A circle about a place."""
        self.places += [p + radius * (1 + 1j), p - radius * (1 + 1j)]
        self.parts.append(
            f'<circle class="line" cx="{_x(p)}" cy="{_y(p)}" r="{radius * SCALE:.1f}"/>'
        )

    def block(self, p: complex, n: complex) -> None:
        """A block on a line along the unit vector n."""
        corners = [p + n * (a + b * 1j) for a, b in ((-3, -2), (3, -2), (3, 2), (-3, 2))]
        corners = [p + (one - p) / 11 for one in corners]
        points = " ".join(f"{_x(one)},{_y(one)}" for one in corners)
        self.parts.append(f'<polygon class="block" points="{points}"/>')

    def vector(self, p: complex, q: complex, letter: str, at: complex, kind: str = "") -> None:
        """An arrow from p to q, its letter at an offset from its middle."""
        n = (q - p) / abs(q - p)
        head = [q, q - n * (0.2 + 0.075j), q - n * (0.2 - 0.075j)]
        points = " ".join(f"{_x(one)},{_y(one)}" for one in head)
        self.parts.append(f'<g class="{kind}">')
        self.line(p, q - n * 0.15, "vector")
        self.parts.append(f'<polygon class="head" points="{points}"/></g>')
        self.text((p + q) / 2 + at, letter)

    def text(self, p: complex, letter: str) -> None:
        """A letter, what follows an underscore below the line."""
        self.places.append(p)
        told = re.sub(r"_(\w)", r'<tspan dy="4" font-size="12">\1</tspan>', letter)
        place = f'x="{_x(p)}" y="{_y(p)}" dominant-baseline="central" text-anchor="middle"'
        self.parts.append(f"<text {place}>{told}</text>")

    def svg(self) -> str:
        """The sketch as a picture."""
        left, right = (f(p.real for p in self.places) * SCALE for f in (min, max))
        low, high = (f(p.imag for p in self.places) * SCALE for f in (min, max))
        wide, tall = right - left + 40, high - low + 40
        box = f'viewBox="{left - 20:.0f} {-high - 20:.0f} {wide:.0f} {tall:.0f}"'
        size = f'width="{wide:.0f}" height="{tall:.0f}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" role="img" {box} {size}>'
        return "\n".join(
            [head, f"<title>{self.title}</title><style>{STYLE}</style>", *self.parts, "</svg>\n"]
        )


def _x(p: complex) -> str:
    return f"{p.real * SCALE:.1f}"


def _y(p: complex) -> str:
    return f"{-p.imag * SCALE:.1f}"


# -- dyads -----------------------------------------------------------------------------------------


def rrr() -> Sketch:
    """Two links and three pins."""
    sketch = Sketch("Two links from the pins p and q meet in the pin c")
    p, d, near, far = 0j, 5 + 0.4j, 3.0, 3.9
    mu = (near**2 + far**2 - abs(d) ** 2) / (2 * near * far)
    area = near * far * sqrt(1 - mu**2)
    c = p + d / abs(d) ** 2 * ((abs(d) ** 2 + near**2 - far**2) / 2 + 1j * area)
    q = p + d
    for end in (p, q):
        sketch.line(end, c, "bar")
    sketch.vector(p, q, "d", -0.3j)
    sketch.vector(p, c, "t_p", -0.38 + 0.1j)
    sketch.vector(q, c, "t_q", 0.42 + 0.12j)
    sketch.pin(p, "p", -0.32 - 0.2j, known=True)
    sketch.pin(q, "q", 0.32 - 0.2j, known=True)
    sketch.pin(c, "c", 0.35j)
    sketch.text(c - 0.55j + 0.02, "μ")
    return sketch


def rrp() -> Sketch:
    """A pinned link and a sliding link."""
    sketch = Sketch("A link pinned at p meets in the pin c a link that slides along n from g")
    g, n, h, p, length = 0j, exp(0.12j), 0.3 + 0.9j, 1.2 + 2.9j, 3.4
    z = (p - g) / n - h
    x = z.real + sqrt(length**2 - z.imag**2)
    slider = g + n * x
    c = g + n * (x + h)
    sketch.line(g - n * 0.4, g + n * 6.4)
    sketch.line(slider, c, "bar")
    sketch.line(p, c, "bar")
    sketch.block(slider, n)
    sketch.vector(g, g + n, "n", -0.3j)
    sketch.vector(g + n * 1.25, slider - n * 0.35, "x", -0.3j)
    sketch.vector(slider, c, "h", 0.35 + 0j)
    sketch.vector(p, c, "t_p", 0.3 + 0.25j)
    sketch.pin(g, "g", 0.3j, known=True)
    sketch.pin(p, "p", -0.3 + 0.15j, known=True)
    sketch.pin(c, "c", 0.35 + 0.1j)
    return sketch


def rpr() -> Sketch:
    """A pinned block on a pinned guide."""
    sketch = Sketch("A block pinned at p slides on a link pinned at q")
    q, d, k = 0j, 4.2 + 1.9j, 0.8
    rho = sqrt(abs(d) ** 2 - k**2)
    n = d / (rho + 1j * k)
    p, foot = q + d, q + n * rho
    sketch.line(q + n * k * 1j - n * 0.2, q + n * (6 + k * 1j), "bar")
    sketch.line(q, q + n * 1j * k, "bar")
    sketch.line(q, q + n * 6, "thin")
    sketch.block(p, n)
    sketch.vector(q, p, "d", 0.34j - 0.1)
    sketch.vector(q, q + n, "n", -0.3j)
    sketch.vector(foot, p, "k", 0.3 + 0j)
    sketch.text(foot * 0.62 - 0.32j, "ρ")
    sketch.pin(q, "q", -0.3 - 0.15j, known=True)
    sketch.pin(p, "p", -0.1 + 0.42j, known=True)
    return sketch


def prp() -> Sketch:
    """Two sliding links joined by a pin."""
    sketch = Sketch("Two links that slide along n and along m meet in the pin c")
    g, h, n, m = 0j, 5.4 - 0.3j, exp(0.15j), exp(1.9j)
    up, left = 0.9j, 0.7j  # from the sliding points to c, in axes along the lines
    d = h + m * left - g - n * up
    cross = (n.conjugate() * m).imag
    x, y = (d.conjugate() * m).imag / cross, (d.conjugate() * n).imag / cross
    first, second, c = g + n * x, h + m * y, g + n * (x + up)
    for start, along, slider in ((g, n, first), (h, m, second)):
        sketch.line(start - along * 0.4, start + along * 5)
        sketch.line(slider, c, "bar")
        sketch.block(slider, along)
    sketch.vector(g, g + n, "n", -0.3j)
    sketch.vector(h, h + m, "m", 0.35 + 0j)
    sketch.vector(first, c, "h_g", -0.38 + 0j)
    sketch.vector(second, c, "h_h", 0.08 - 0.32j)
    sketch.text(g + n * (x / 2 + 0.5) - 0.3j, "x")
    sketch.text(h + m * (y / 2 + 0.5) + 0.3, "y")
    sketch.pin(g, "g", 0.3j, known=True)
    sketch.pin(h, "h", -0.32 + 0.1j, known=True)
    sketch.pin(c, "c", -0.1 + 0.36j)
    return sketch


def rpp() -> Sketch:
    """A pinned link on a sliding link."""
    sketch = Sketch("A link pinned at p slides along κ of a link that slides along n from g")
    g, n, kappa, p = 0j, exp(0.06j), exp(1.2j), 3.6 + 2.3j
    z = (p - g) / n
    x = z.real - kappa.real / kappa.imag * z.imag
    slider = g + n * x
    sketch.line(g - n * 0.4, g + n * 6)
    sketch.line(slider, slider + n * kappa * 3.6, "bar")
    sketch.block(slider, n)
    sketch.block(p, n * kappa)
    sketch.vector(g, g + n, "n", -0.3j)
    sketch.vector(g + n * 1.25, slider - n * 0.35, "x", -0.3j)
    sketch.vector(slider, slider + n * kappa, "κ", 0.32 + 0j)
    sketch.vector(g, p, "z", 0.3j - 0.1)
    sketch.pin(g, "g", 0.3j - 0.1, known=True)
    sketch.pin(p, "p", 0.45 + 0j, known=True)
    return sketch


def gears() -> Sketch:
    """A pair of gears and the force between them."""
    sketch = Sketch("The force R on the driven gear at the pitch point, at the lever λ")
    driven, driver, rho, alpha = 0j, 3.6 + 0j, -0.6, 0.35
    k = driver - driven
    lever = k / (1 - rho)
    pitch, unit = driven + lever, lever / abs(lever)
    force = (1j + tan(alpha)) * unit * 1.4
    sketch.circle(driven, abs(lever))
    sketch.circle(driver, abs(k - lever))
    sketch.line(pitch - 1.7j, pitch + 1.7j, "thin")
    sketch.vector(driven, driver, "k", 0.8 - 0.28j)
    sketch.vector(driven, pitch, "λ", 0.28j)
    sketch.vector(pitch, pitch + force, "R", 0.35 + 0j, "force")
    sketch.text(pitch + 0.2 + 1.05j, "α")
    sketch.pin(driven, "", 0j, known=True)
    sketch.pin(driver, "", 0j, known=True)
    return sketch


SKETCHES = {one.__name__: one for one in (rrr, rrp, rpr, prp, rpp, gears)}
