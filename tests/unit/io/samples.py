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

SUPPORT = """
[support]
mass = "60 kg"
center_of_mass = ["10 mm", "0.3 m"]
inertia = "4 kg m^2"
freedoms = ["heave", "pitch"]

[support.mounts.front]
point = ["400 mm", "-200 mm"]
stiffness = "50 kN/m"
damping = "400 N s/m"

[support.mounts.float]
point = ["-400 mm", "-20 cm", "30 mm"]
direction = [0.5, 2, 0]
stiffness = "1 kgf/mm"
preload = "90 N"
one_sided = true

[support.mounts.hitch]
axis = "pitch"
torsional_stiffness = "500 N m/rad"
torsional_damping = "3 N m s/rad"
torsional_preload = "-20 N m"

[support.gauges.handle]
point = { distance = "1 m", direction = "135 deg" }
direction = "-30 deg"

[support.gauges.nod]
axis = "pitch"
"""
ROWS = """
[[rows]]
lateral = "-15 cm"

[[rows]]
phase = "180 deg"
lateral = "150 mm"
offset = ["20 mm", "-5 mm"]
"""
EVERYTHING = (
    FOUR_BAR.replace(
        '"Four-bar"\n', '"All"\ndescription = "x"\ngravity = ["1 gn", "0 m/s^2"]\n'
    ).replace('"193 rpm"\n', '"193 rpm"\nacceleration = "2 rad/s^2"\nflywheel = "2 kg cm^2"\n')
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

[drive.motor]
no_load_speed = "3000 rpm"
stall_torque = "2 N m"
ratio = 12.5
inertia = "80 g cm^2"
mean_speed = "free"
"""
    + SUPPORT
    + ROWS
)
