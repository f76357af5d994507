"""Model files for the tests of reading and writing."""

FOUR_BAR = """\
schema = 1
title = "Four-bar"

[drive]
link = "crank"
speed = "193 rpm"

[frame]
points.A = ["0 mm", "0 mm"]
points.D = { distance = "88 mm", direction = "-83 deg" }

[links.crank]
points.A = ["0 mm", "0 mm"]
points.B = ["33.5 mm", "0 mm"]
mass = "199 g"
center_of_mass = ["12 mm", "0 mm"]
inertia = "30 kg mm^2"

[links.coupler]
points.B = ["0 mm", "0 mm"]
points.C = ["71.5 mm", "0 mm"]

[links.rocker]
points.D = ["0 mm", "0 mm"]
points.C = ["80 mm", "0 mm"]

[assembly]
C = "left"
"""

EVERYTHING = (
    FOUR_BAR.replace(
        '"Four-bar"\n', '"All"\ndescription = "x"\ngravity = ["1 gn", "0 m/s^2"]\n'
    ).replace('"193 rpm"\n', '"193 rpm"\nacceleration = "2 rad/s^2"\n')
    + """
[links.piston]
points.C = ["0 mm", "0 mm"]

[links.wheel]
points.D = ["0 mm", "0 mm"]

[[sliders]]
link = "piston"
point = "C"
on = "frame"
through = "A"
direction = "10 deg"
angle = "5 deg"

[[gears]]
between = ["crank", "wheel"]
teeth = [20, 41]
mesh = "internal"
start = "7 deg"
pressure_angle = "25 deg"

[[gears]]
between = ["crank", "wheel"]
carrier = "rocker"
ratio = -2

[[loads]]
link = "coupler"
point = "C"
force = ["1 N", "-2 kgf"]
from = "350 deg"
to = "10 deg"

[[loads]]
link = "rocker"
torque = "1.5 N m"

[position]
crank_angle = "30 deg"
points.B = ["1 mm", "2 mm"]
angles.coupler = "12 deg"
"""
)
