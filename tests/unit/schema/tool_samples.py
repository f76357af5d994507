"""Files of tools for the tests of reading and writing."""

TOOL = """\
schema = 1
title = "Tool"

[shaft]
length = "1.5 m"
mass_per_length = "2.3 kg/m"
bending_stiffness = "980 N m^2"

[[shaft.stations]]
name = "engine"
position = "0 mm"
mass = "3.6 kg"

[[shaft.stations]]
name = "handle"
position = "550 mm"
hand.stiffness = "8000 N/m"

[[excitations]]
station = "engine"
force = "100 N"
"""

EVERY_TOOL = """\
schema = 1
title = "All"
description = "x"

[shaft]
length = "2.7 m"
outer_diameter = "30 mm"
inner_diameter = "27 mm"
youngs_modulus = "70 GPa"
density = "2.7 g/cm^3"
poisson_ratio = 0.33
carried = "350 g/m"
loss_factor = 0.01
theory = "timoshenko"

[[shaft.segments]]
from = "1.3 m"
to = "1.5 m"
outer_diameter = "30 mm"
inner_diameter = "23 mm"
material = "aluminium"

[[shaft.segments]]
from = "1.5 m"
to = "2.7 m"
outer_diameter = "26 mm"
material = "magnesium"

[[shaft.stations]]
name = "engine"
position = "0 mm"
mass = "3.6 kg"
inertia = { vertical = "20000 kg mm^2", lateral = "24000 kg mm^2" }

[[shaft.stations]]
name = "post"
position = "10 cm"
stiffness = "2 kgf/cm"
damping = { vertical = "3 N s/m", lateral = "0 N s/m" }
rotational_stiffness = "50 N m/rad"
rotational_damping = "3 N m s/rad"

[[shaft.stations]]
name = "belt"
position = "320 mm"
harness = { stiffness = "1500 N/m", damping = { vertical = "60 N s/m", lateral = "40 N s/m" } }

[[shaft.stations]]
name = "handle"
position = "550 mm"
mass = "350 g"
absorber = { mass = "100 g", stiffness = "61.7 kN/m", damping = "4 N s/m" }

[shaft.stations.hand]
mass = "150 g"
stiffness = { vertical = "9 kN/m", lateral = "7 kN/m" }
damping = "90 N s/m"
hands = 2

[[shaft.stations]]
name = "saw"
position = "2.7 m"
mass = "1.2 kg"

[[excitations]]
station = "engine"
linkage = "slider-crank-engine"
phase = "30 deg"

[[excitations]]
name = "blade"
station = "saw"
unbalance = "150 g mm"
ratio = -0.75

[[excitations]]
station = "saw"
force = "12 N"
direction = "rotating"

[operation]
speed = "7500 rpm"
speeds = ["6000 rpm", "9000 rpm"]
idling = "2800 rpm"
racing = "9500 rpm"

[[work]]
name = "mowing"
speed = "7500 rpm"
duration = "2.5 h"

[[work]]
name = "walking"
speed = "2800 rpm"
duration = "30 min"

[design]
speeds = ["7000 rpm", "8000 rpm"]
measure = "peak"
hands = ["handle"]

[[design.variables]]
station = "belt"
key = "position"
from = "250 mm"
to = "420 mm"

[[design.variables]]
station = "handle"
key = "absorber.damping"
from = "0 N s/m"
to = "40 N s/m"

[[design.limits]]
output = "force"
station = "belt"
at_most = "60 N"

[[design.limits]]
output = "acceleration"
station = "handle"
at_most = "2.5 m/s^2"

[[design.limits]]
output = "added_mass"
at_most = "100 g"
"""

IMPEDANCE = """\
frequency [Hz],resistance [N s/m],reactance [N s/m]
20,120,-80
40,150,10
"""
