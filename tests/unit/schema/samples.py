"""Model files for the tests of reading and writing, and what each of them has to keep."""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from jsonschema import Draft202012Validator

from equipoise.mechanism.parts.machine import Machine
from equipoise.schema import dumps, json_schema, loads

VALIDATOR = Draft202012Validator(json_schema())


def survives(machine: Machine) -> str:
    """The text of a machine, which the schema accepts and which is read as the same machine."""
    text = dumps(machine)
    VALIDATOR.validate(tomllib.loads(text))
    assert loads(text) == machine
    return text


def changed(value: Any, draw: Callable[[str, float], float], name: str = "") -> Any:
    """The same structure with other numbers, drawn by the name of their field and the old one."""
    if isinstance(value, float):
        return draw(name, value)
    if isinstance(value, Mapping):
        return {key: changed(item, draw, name) for key, item in value.items()}
    if isinstance(value, tuple):
        return tuple(changed(item, draw, name) for item in value)
    if is_dataclass(value) and not isinstance(value, type | Machine):
        new = {f.name: changed(getattr(value, f.name), draw, f.name) for f in fields(value)}
        return replace(value, **new)
    return value


def changed_machine(machine: Machine, draw: Callable[[str, float], float]) -> Machine:
    """A machine with other numbers; those inside of a tool are left by `changed`."""
    new = {f.name: changed(getattr(machine, f.name), draw, f.name) for f in fields(machine)}
    return replace(machine, **new)


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
PLANTING = '\n[planting]\ntip = "C"\nforward_speed = "60 cm/s"\ndepth = "4 cm"\n'
MOTOR = '\n[drive.motor]\nno_load_speed = "3000 rpm"\nstall_torque = "2 N m"\n'
BODY = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm"]
inertia = "4 kg m^2"
"""
MOUNT = """
[support.mounts.m]
point = ["100 mm", "0 mm"]
stiffness = "20 kN/m"
"""
TURN = """
[support.mounts.t]
axis = "pitch"
torsional_stiffness = "500 N m/rad"
"""
GAUGE = """
[support.gauges.g]
point = ["100 mm", "0 mm"]
direction = [0, 0, 1]
"""
SUPPORTED = BODY + MOUNT + TURN + GAUGE + ROWS
BALANCE = """
[balance]
added_mass = "500 g"
combine = "squares"

[balance.phases]
step = "10 deg"

[[balance.moves]]
link = "crank"
x = ["-60 mm", "20 mm"]
y = ["-30 mm", "30 mm"]

[[balance.masses]]
link = "crank"
at = "A"
shape = "sector"
radius = "60 mm"
inner_radius = "10 mm"
thickness = "8 mm"
material = "steel"
at_most = "800 g"

[[balance.masses]]
link = "rocker"
at = "D"
mass = "500 g"

[[balance.geared]]
driver = "rocker"
ratio = [0.3, 2]
pitch_radius = "50 mm"
direction = "0 deg"
gear_thickness = "8 mm"
gear_material = "steel"
clear_of = ["coupler"]
radius = "40 mm"

[[balance.geared]]
driver = "crank"
teeth = [17, 80]
module = "2 mm"
axis = ["100 mm", "0 mm"]
gear_thickness = "8 mm"
gear_density = "7800 kg/m^3"
shape = "disc"
radius = "40 mm"
thickness = "8 mm"
density = "7800 kg/m^3"
name = "other"

[[balance.shafts]]
order = 2
axes = [["0 mm", "-60 mm"], ["40 mm", "-60 mm"]]
radius = "30 mm"

[[balance.springs]]
link = "rocker"
point = "C"
to = "A"
stiffness = "5000 N/m"
free_length = ["20 mm", "120 mm"]

[[balance.objectives]]
output = "shaking_moment"
measure = "peak"
orders = [1, 2]
about = "D"
weight = 2

[[balance.objectives]]
output = "gauges.handle"
speeds = ["150 rpm", "240 rpm"]

[[balance.limits]]
output = "joints.B"
measure = "peak"
at_most = "120 N"

[[balance.limits]]
output = "shaking_force.x"
measure = "area"
at_most = "80 %"
"""
"""Needs the gauges of SUPPORT and the rows of ROWS."""
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

[[springs]]
link = "coupler"
point = "C"
to = "A"
stiffness = "2 kN/m"
free_length = "80 mm"

[[springs]]
link = "crank"
point = "B"
to = "D"
stiffness = "1 kgf/mm"

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
    + BALANCE
)
