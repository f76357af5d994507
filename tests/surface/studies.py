"""Study files for the commands: small ones of a four-bar, changed piece by piece."""

from __future__ import annotations

from surface import running

LENGTHS = """
schema = 1
title = "Lengths of type I"
model = "yamashita-1"

[[vary]]
path = "links.coupler.points.C.x"
range = ["38 mm", "80 mm"]

[[vary]]
path = "links.crank.mass"
list = ["199 g", "0.4 kg"]

[sampling]
method = "sobol"
designs = 200

[[outputs]]
name = "vertical"
value = "shaking_force.y.rms"
at_most = "13000 mN"
make = "smallest"

[[outputs]]
name = "torque"
value = "drive_torque.peak"
"""

TOLERANCES = """
schema = 1
title = "Tolerances of type I"
model = "yamashita-1"

[[vary]]
path = "links.coupler.mass"
normal = { deviation = "15 g", cut = 3 }

[[vary]]
path = "links.coupler.inertia"
normal = { deviation = "40 kg mm^2" }

[[vary]]
path = "links.coupler.center_of_mass.x"
uniform = { half_width = "2 mm" }

[[vary]]
path = "links.crank.points.B.x"
normal = { deviation = "0.01 mm" }

[[correlations]]
between = ["links.coupler.mass", "links.coupler.inertia"]
coefficient = 0.8

[sampling]
method = "sobol"
designs = 2048

[[outputs]]
name = "vertical"
value = "shaking_force.y.peak"
at_most = "23.5 N"
"""


def written(text: str, *pairs: tuple[str, str], name: str = "study.toml") -> str:
    """Name of a study file here, with pieces of its text replaced."""
    return running.written(text, *pairs, to=name)
