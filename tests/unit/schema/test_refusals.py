"""What is wrong in a linkage's file is refused in one sentence, by the reader and by the schema."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping

import pytest

from equipoise.errors import ModelError
from equipoise.schema import loads
from unit.schema.samples import (
    BALANCE,
    FOUR_BAR,
    GAUGE,
    MOTOR,
    MOUNT,
    PLANTING,
    ROWS,
    SUPPORT,
    SUPPORTED,
    VALIDATOR,
)

Refusals = Mapping[str, tuple[str, str, str, str]]
"""What is replaced, by what, the place in front of which the table's name stands, what is said."""

# -- the linkage ----------------------------------------------------------------------------------

MASS, END = 'mass = "199 g"', "[assembly]"
TITLE, HERE = 'title = "Four-bar"', '["33.5 mm", "0 mm"]'
GEAR = '[[gears]]\nbetween = ["crank", "rocker"]\n'
LOAD = '[[loads]]\nlink = "crank"\n'
CRANK, PIN = "links.crank.mass", "links.crank.points.B"
OF_LINKAGES: Refusals = {
    "unknown key": (MASS, 'mas = "199 g"', "links.crank.mas", "no key is called 'mas'; did you"),
    "bare number": (MASS, "mass = 199", CRANK, "got the bare number 199; give"),
    "wrong unit": (MASS, 'mass = "1 mm"', CRANK, "got '1 mm'; mm is the unit"),
    "no space": (MASS, 'mass = "199g"', CRANK, 'put a space between number and unit: "199 g"'),
    "comma": (MASS, 'mass = "1,5 g"', CRANK, 'the decimal sign is a point, not a comma: "1.5 g"'),
    "no mass": (f"{MASS}\n", "", "links.crank", "mass missing"),
    "point of one": (HERE, '["1 mm"]', PIN, "got a list of 1; give"),
    "point of three": (HERE, '["1 mm", "0 mm", "0 mm"]', PIN, "got a list of 3; give"),
    "point in words": (HERE, '["1 mm", "x"]', f"{PIN}[2]", "got 'x'; give number"),
    "point as text": (HERE, '"1 mm"', PIN, "got '1 mm'; give [\"33.5 mm"),
    "half a point": (HERE, "{ distance = 3 }", f"{PIN}.direction", "missing; add direction"),
    "unit of a direction": (HERE, '{ distance = "1 mm", direction = "1 mm" }', f"{PIN}.direction",
                            "got '1 mm'; mm is the unit of a length; an angle is wanted"),
    "two problems of a point": (
        HERE, '{ distance = 3, direction = "1 m" }', f"{PIN}.distance",
        'got the bare number 3; give number and unit in quotes, such as "33.5 mm" (and 1 more)'),
    "speed in hertz": ('"193 rpm"', '"50 Hz"', "drive.speed", "got '50 Hz'; Hz is ambiguous"),
    "side": ('"left"', '"lft"', "assembly.C", "got 'lft'; did you mean 'left'?"),
    "title as a number": (TITLE, "title = 1", "title", "got the number 1; give text in quotes"),
    "title of no language": (TITLE, "title = {}", "title",
                             'got a table; give text in quotes, or by language: title.en = "..."'),
    "unknown language": (TITLE, 'title.jpn = "x"', "title.jpn",
                         "no language is called 'jpn'; there are 'en', 'de', 'ja', 'ko'"),
    "misspelt language": (TITLE, 'title.jaa = "x"', "title.jaa",
                          "no language is called 'jaa'; did you mean 'ja'?"),
    "empty in a language": (TITLE, 'title = { en = "x", ja = "" }', "title.ja",
                            "is empty; give text, or leave it out"),
    "number in a language": (TITLE, 'title = { en = "x", ko = 3 }', "title.ko",
                             "got the number 3; give text in quotes"),
    "table in a language": (TITLE, 'title.en.us = "x"', "title.en",
                            "got a table; give text in quotes"),
    "description of no language": (TITLE, f"{TITLE}\ndescription = {{}}", "description",
                                   "got a table; give text in quotes, or by language: desc"),
    "no title": (TITLE, "", "title", "missing; add title ="),
    "key of nothing alike": (TITLE, f"{TITLE}\nfriction = 0.1", "friction",
                             "no key is called 'friction'; there are 'schema', 'title'"),
    "point without points": ("[frame]", '[frame]\nE = ["0 mm", "0 mm"]', "frame.E",
                             "no key is called 'E'; did you mean 'points.E'?"),
    "link without links": ("[links.rocker]", "[rocker]", "rocker",
                           "no key is called 'rocker'; did you mean 'links.rocker'?"),
    "one gravity": (TITLE, f"{TITLE}\ngravity = 9.81", "gravity",
                    'give a list of two values in brackets, such as ["0 m/s^2", "-9.80665 m/s^2"]'),
    "misspelt title": (TITLE, 'titel = "x"', "titel", "no key is called 'titel'; did you mean"),
    "unknown table": ("[links.rocker]", '["li\\nks"]\n[links.rocker]', '"li\\nks"',
                      "no key is called"),
    "key of the frame": ("[frame]", "[frame]\nx = 1", "frame.x", "no key is called 'x'; there are"),
    "no version": ("schema = 1", "", "schema", "missing"),
    "newer version": ("schema = 1", "schema = 2", "schema",
                      "got the number 2; this program reads schema = 1, and the file is for a"),
    "no such version": ("schema = 1", "schema = 0", "schema",
                        "got the number 0; this program reads schema = 1"),
    "true version": ("schema = 1", "schema = true", "schema", "got true; this program reads"),
    "sliders as a table": (END, "[sliders]\n[assembly]", "sliders", "got a table; write each as a"),
    "empty slider": (END, "[[sliders]]\n[assembly]", "sliders[1].link", "missing; add link"),
    "empty planting": (END, "[planting]\n[assembly]", "planting.tip", "missing; add tip"),
    "gear alone": (END, f"{GEAR}[assembly]", "gears[1]", "give either ratio or teeth"),
    "mesh without teeth": (END, f'{GEAR}ratio = 2\nmesh = "external"\n[assembly]', "gears[1].mesh",
                           "got 'external' without teeth"),
    "ratio as text": (END, f'{GEAR}ratio = "2"\n[assembly]', "gears[1].ratio",
                      "got '2'; give a plain"),
    "no teeth": (END, f"{GEAR}teeth = [0, 2]\n[assembly]", "gears[1].teeth[1]", "got the number 0"),
    "load of nothing": (END, f"{LOAD}[assembly]", "loads[1]", "give exactly one of force, torque"),
    "half a window": (END, f'{LOAD}torque = "1 N m"\nto = "1 deg"\n[assembly]', "loads[1]",
                      "give both from and to, or neither"),
}  # fmt: skip
LINKAGES_BEYOND: Refusals = {
    "negative mass": (MASS, 'mass = "-1 g"', CRANK, "got -1 g"),
    "long in a language": (TITLE, f'title = {{ en = "x", ja = "{"y" * 201}" }}', "title.ja",
                           "201 characters; give at most 200"),
    "line break in a language": (TITLE, 'title.ko = "a\\nb"', "title.ko",
                                 "got 'a\\nb'; give printable"),
    "unknown link": ('link = "crank"', 'link = "crnk"', "drive.link",
                     "no link is called 'crnk'; did you"),
    "no ratio": (END, f"{GEAR}ratio = nan\n[assembly]", "gears[1].ratio", "got the number nan"),
    "table without a folder": (END, f'{LOAD}table = "x.csv"\n[assembly]', "loads[1].table",
                               "got 'x.csv'; a table can only"),
}  # fmt: skip

# -- [planting] -----------------------------------------------------------------------------------

SPEED, DEPTH = 'forward_speed = "60 cm/s"', 'depth = "4 cm"'
OF_PLANTING: Refusals = {
    # what is replaced, by what, the place, what is said
    "no unit": (DEPTH, 'depth = "4"', ".depth", "the unit is missing; give a length"),
    "no tip": ('tip = "C"\n', "", ".tip", 'missing; add tip = "P"'),
    "travel": (DEPTH, f'{DEPTH}\ntravel = "left"', ".travel",
               "got 'left'; give 'forward' or 'backward'"),
    "units as text": (DEPTH, f'{DEPTH}\nunits_per_turn = "2"', ".units_per_turn",
                      "got '2'; give a whole number without quotes"),
    "half a unit": (DEPTH, f"{DEPTH}\nunits_per_turn = 1.5", ".units_per_turn",
                    "got the number 1.5; give a whole number"),
    "no unit a turn": (DEPTH, f"{DEPTH}\nunits_per_turn = 0", ".units_per_turn",
                       "got the number 0; give 1 or more"),
    "many units a turn": (DEPTH, f"{DEPTH}\nunits_per_turn = 2000000", ".units_per_turn",
                          "got the number 2000000; give 1000000 or less"),
    "tray with one point": (DEPTH, f'{DEPTH}\ntray = [["0 mm", "0 mm"]]', ".tray",
                            "got a list of 1; give a list of two values"),
    "tray with three points": (
        DEPTH, f'{DEPTH}\ntray = [["0 mm", "0 mm"], ["1 mm", "0 mm"], ["2 mm", "0 mm"]]', ".tray",
        "got a list of 3; give a list of two values"),
    "tray as one point": (DEPTH, f'{DEPTH}\ntray = ["0 mm", "1 mm"]', ".tray[1]",
                          "got '0 mm'; give [\"33.5 mm\", \"0 mm\"] or {"),
    "unit in the tray": (DEPTH, f'{DEPTH}\ntray = [["0 mm", "0 s"], ["1 mm", "0 mm"]]',
                         ".tray[1][2]", "s is the unit of a time; a length is wanted"),
    "soil as a force": (DEPTH, f'{DEPTH}\nsoil = "20 N"', ".soil", "got '20 N'; give a table"),
    "soil per both": (DEPTH, f'{DEPTH}\nsoil.per_depth_and_speed = "20 N s/m"',
                      ".soil.per_depth_and_speed", "a damping coefficient per length is wanted"),
    "both speeds": (DEPTH, f'{DEPTH}\nhill_spacing = "15 cm"', "",
                    "give either forward_speed or hill_spacing"),
    "no speed": (SPEED, "", "", "give either forward_speed or hill_spacing"),
    "depth and surface": (DEPTH, f'{DEPTH}\nsurface = "-1 cm"', "", "give either depth or surface"),
    "neither depth nor surface": (DEPTH, "", "", "give either depth or surface"),
}  # fmt: skip
PLANTING_BEYOND: Refusals = {
    "unknown tip": ('tip = "C"', 'tip = "Cc"', ".tip",
                    "no point of a moving link is called 'Cc'; did you mean 'C'?"),
    "negative speed": (SPEED, 'forward_speed = "-60 cm/s"', ".forward_speed",
                       'got -60 cm/s; give its size, and travel = "backward" for a machine'),
    "negative depth": (DEPTH, 'depth = "-4 cm"', ".depth", "got -4 cm; give more than"),
    "no depth": (DEPTH, 'depth = "0 cm"', ".depth", "got 0 cm; give more than 0"),
    "negative hills": (SPEED, 'hill_spacing = "-15 cm"', ".hill_spacing",
                       "got -15 cm; give more than 0"),
    "finger": (DEPTH, f'{DEPTH}\nfinger_from = "D"', ".finger_from",
               "no other point of coupler, the tip's link, is called 'D'; there are 'B'"),
    "tray of no length": (DEPTH, f'{DEPTH}\ntray = [["1 mm", "0 mm"], ["1 mm", "0 mm"]]', ".tray",
                          "its two points are the same; give both ends of the edge"),
    "empty soil": (DEPTH, f"{DEPTH}\nsoil = {{}}", ".soil", "give at least one of resistance, per"),
    "pulling soil": (DEPTH, f'{DEPTH}\nsoil.resistance = "-1 N"', ".soil.resistance",
                     "got -1 N; soil resists, give 0 or more"),
    "table without a folder": (DEPTH, f'{DEPTH}\nsoil.table = "s.csv"', ".soil.table",
                               "got 's.csv'; a table can only be read beside a file"),
}  # fmt: skip

# -- [drive.motor] --------------------------------------------------------------------------------

QUICK = 'no_load_speed = "3000 rpm"'
OF_MOTORS: Refusals = {
    # what is replaced, by what, the place, what is said
    "half a line": (QUICK, "", "", "give either no_load_speed and stall_torque, or torque, or"),
    "line and table": (QUICK, f'{QUICK}\ntable = "motor.csv"', ".table", ""),
    "nothing": (MOTOR[MOTOR.index(QUICK):], "\n", "", "give either no_load_speed and stall_torque"),
    "ratio as text": (QUICK, f'{QUICK}\nratio = "12"', ".ratio", "got '12'; give a plain number"),
    "ratio of 0": (QUICK, f"{QUICK}\nratio = 0", ".ratio", "got 0; give more than 0"),
    "negative ratio": (QUICK, f"{QUICK}\nratio = -2", ".ratio", "got -2; give more than 0"),
    "mean speed": (QUICK, f'{QUICK}\nmean_speed = "kept"', ".mean_speed",
                   "got 'kept'; give 'held' or 'free'"),
    "table as a list": (QUICK, f"{QUICK}\ntable = [1]", ".table", "got a list of 1; give text in"),
}  # fmt: skip
MOTORS_BEYOND: Refusals = {
    "negative speed": ('"3000 rpm"', '"-1 rad/s"', ".no_load_speed", "got -1 rad/s; give"),
    "no torque": ('"2 N m"', '"0 N m"', ".stall_torque", "got 0 N m; give more than 0"),
    "negative inertia": (QUICK, f'{QUICK}\ninertia = "-1 kg m^2"', ".inertia",
                         "got -1 kg m^2; no body has a negative moment of inertia"),
}  # fmt: skip

# -- [support] and [[rows]] -----------------------------------------------------------------------

INERTIA, PLACE = 'inertia = "4 kg m^2"', 'center_of_mass = ["0 mm", "300 mm"]'
POINT, STIFF = MOUNT.splitlines()[2:4]
TURNS = 'torsional_stiffness = "500 N m/rad"'
WAY = "direction = [0, 0, 1]"
LATERAL = 'lateral = "-15 cm"'
M, T, G = "support.mounts.m", "support.mounts.t", "support.gauges.g"
THREE = '["1 kg m^2", "1 kg m^2", "1 kg m^2"]'
OF_SUPPORTS: Refusals = {
    # what is replaced, by what, the place, what is said
    "no mass": ('mass = "60 kg"\n', "", "support.mass", 'missing; add mass = "60 kg"'),
    "no center": (PLACE, "", "support.center_of_mass", 'missing; add center_of_mass = ["0 mm", "3'),
    "center as text": (PLACE, 'center_of_mass = "0 mm"', "support.center_of_mass",
                       "got '0 mm'; give [\"0 mm\", \"300 mm\"], or with z [\"0 mm\", \"300 mm\","),
    "center of one": (PLACE, 'center_of_mass = ["0 mm"]', "support.center_of_mass",
                      "got a list of 1; give [\"0 mm\", \"300 mm\"], or with z"),
    "center of four": (PLACE, 'center_of_mass = ["0 m", "0 m", "0 m", "0 m"]',
                       "support.center_of_mass", "got a list of 4; give [\"0 mm\", \"300 mm\"]"),
    "unit in the center": (PLACE, 'center_of_mass = ["0 m", "0 s"]', "support.center_of_mass[2]",
                           "s is the unit of a time; a length is wanted"),
    "z in the center": (PLACE, 'center_of_mass = ["0 m", "0 m", 0]', "support.center_of_mass[3]",
                        "got the bare number 0; give number and unit"),
    "half a polar center": (PLACE, 'center_of_mass = { distance = "1 m" }',
                            "support.center_of_mass.direction", "missing; add direction"),
    "two inertias": (INERTIA, 'inertia = ["1 kg m^2", "1 kg m^2"]', "support.inertia",
                     "got a list of 2; give one moment of inertia, or a list of three, about x, y"),
    "one of three": (INERTIA, 'inertia = ["1 kg m^2", "x", "1 kg m^2"]', "support.inertia[2]",
                     "got 'x'; give number and unit"),
    "no inertia": (INERTIA, "", "support", "give either inertia or pivot_inertia"),
    "both": (INERTIA, f'{INERTIA}\npivot = ["0 m", "0 m"]\npivot_inertia = "40 kg m^2"', "support",
             "give either inertia or pivot_inertia"),
    "pivot_inertia alone": (INERTIA, 'pivot_inertia = "40 kg m^2"', "support.pivot_inertia",
                            "there is no pivot; give inertia, about the centre of mass"),
    "pivot_inertia and products": (
        INERTIA, f'pivot_inertia = "40 kg m^2"\npivot = ["0 m", "0 m"]\nproducts = {THREE}',
        "support.products", "goes with an inertia of three values"),
    "products alone": (INERTIA, f"{INERTIA}\nproducts = {THREE}", "support.products",
                       "goes with an inertia of three values"),
    "one product": (INERTIA, f'inertia = {THREE}\nproducts = "0.1 kg m^2"', "support.products",
                    "got '0.1 kg m^2'; give a list of three, of x y, y z and z x"),
    "two products": (INERTIA, f'inertia = {THREE}\nproducts = ["0 kg m^2", "0 kg m^2"]',
                     "support.products", "got a list of 2; give a list of three, of x y, y z and"),
    "pivot in space": (INERTIA, f'{INERTIA}\npivot = ["0 m", "0 m", "0 m"]', "support.pivot",
                       "got a list of 3; give a list of two values"),
    "freedom as text": (INERTIA, f'{INERTIA}\nfreedoms = "pitch"', "support.freedoms",
                        "got 'pitch'; give a list such as [\"heave\", \"pitch\"]; leave it out"),
    "no freedom": (INERTIA, f"{INERTIA}\nfreedoms = []", "support.freedoms",
                   "got a list of 0; give a list such as"),
    "unknown freedom": (INERTIA, f'{INERTIA}\nfreedoms = ["pitch", "rol"]', "support.freedoms[2]",
                        "got 'rol'; did you mean 'roll'?"),
    "freedom twice": (INERTIA, f'{INERTIA}\nfreedoms = ["pitch", "pitch"]', "support.freedoms[2]",
                      "'pitch' is given twice"),
    "mounts as a list": ("[support.mounts.m]", "[[support.mounts]]", "support.mounts",
                         "got a list of 1; write each as a table [support.mounts.NAME]"),
    "mount as text": (INERTIA, f'{INERTIA}\nmounts.x = "1 kN/m"', "support.mounts.x",
                      "got '1 kN/m'; give a table"),
    "unit of stiffness": (STIFF, 'stiffness = "20 N"', f"{M}.stiffness",
                          "N is the unit of a force; a stiffness is wanted: N/m, N/mm, kN/m"),
    "one-sided as text": (STIFF, f'{STIFF}\none_sided = "yes"', f"{M}.one_sided",
                          "got 'yes'; give true or false without quotes"),
    "neither point nor axis": (POINT, "", M, "give either point or axis"),
    "point and axis": (POINT, f'{POINT}\naxis = "roll"', M, "give either point or axis"),
    "unknown axis": ('axis = "pitch"', 'axis = "heave"', f"{T}.axis",
                     "got 'heave'; give 'roll', 'yaw' or 'pitch'"),
    "only a place": (STIFF, "", M, "give at least one of stiffness and damping"),
    "only an axis": (TURNS, "", T, "give at least one of torsional_stiffness and torsional_"),
    "torsional key at a point": (STIFF, f'{STIFF}\ntorsional_damping = "0 N m s/rad"',
                                 f"{M}.torsional_damping", "has no place beside a point; leave it"),
    "torsional preload at a point": (STIFF, f'{STIFF}\ntorsional_preload = "9 N m"',
                                     f"{M}.torsional_preload", "has no place beside a point"),
    "stiffness about an axis": (TURNS, f"{TURNS}\n{STIFF}", f"{T}.stiffness",
                                "has no place beside an axis; leave it out"),
    "direction of an axis": (TURNS, f'{TURNS}\ndirection = "90 deg"', f"{T}.direction",
                             "has no place beside an axis; leave it out"),
    "preload about an axis": (TURNS, f'{TURNS}\npreload = "9 N"', f"{T}.preload", "has no place"),
    "one-sided axis": (TURNS, f"{TURNS}\none_sided = false", f"{T}.one_sided", "has no place"),
    "direction of two": (WAY, "direction = [0, 1]", f"{G}.direction",
                         'got a list of 2; give an angle such as "90 deg", or three plain numbers'),
    "bare direction": (WAY, "direction = 90", f"{G}.direction",
                       'got the number 90; give an angle such as "90 deg", or three plain numbers'),
    "direction with units": (WAY, 'direction = ["0 m", "1 m", "0 m"]', f"{G}.direction[1]",
                             "got '0 m'; give a plain number without unit and quotes"),
    "direction in words": (WAY, 'direction = "up"', f"{G}.direction",
                           "got 'up'; did you mean \"90 deg\"?"),
    "gauge without a place": (GAUGE[GAUGE.index("point"):], "\n", G, "give either point or axis"),
    "stiff gauge": (WAY, STIFF, f"{G}.stiffness", "no key is called 'stiffness'; there are"),
    "direction of a rotation": (GAUGE[GAUGE.index("point"):], f'axis = "roll"\n{WAY}\n',
                                f"{G}.direction", "has no place beside an axis; leave it out"),
    "offset of three": (LATERAL, 'offset = ["0 m", "0 m", "0 m"]', "rows[1].offset",
                        "got a list of 3; give a list of two values"),
}  # fmt: skip
SUPPORTS_BEYOND: Refusals = {
    "no weight": ('"60 kg"', '"0 kg"', "support.mass", "got 0 kg; give more than 0"),
    "inertia of 0": (INERTIA, 'inertia = "0 kg m^2"', "support.inertia",
                     "got 0 kg m^2; give more than 0"),
    "one inertia for space": (INERTIA, f'{INERTIA}\nfreedoms = ["roll", "sway"]', "support.inertia",
                              "got one value, but the support can sway and roll; give three"),
    "no body": (INERTIA, 'inertia = ["1 kg m^2", "9 kg m^2", "1 kg m^2"]', "support.inertia",
                "got 9 kg m^2 beside 1 kg m^2 and 1 kg m^2; no body has one moment of inertia"),
    "large products": (INERTIA, f"inertia = {THREE}\nproducts = {THREE}", "support.products",
                       "no body has that, give smaller ones"),
    "small pivot_inertia": (INERTIA, 'pivot = ["0 m", "0 m"]\npivot_inertia = "1 kg m^2"',
                            "support.pivot_inertia",
                            "got 1 kg m^2; mass and center_of_mass alone make 5.4 kg m^2, give"),
    "negative stiffness": (STIFF, 'stiffness = "-1 N/m"', f"{M}.stiffness",
                           "got -1 N/m; give 0 or more"),
    "soft mount": (STIFF, 'stiffness = "0 N/m"', M, "give at least one of stiffness and damping"),
    "no direction": (WAY, "direction = [0, 0, 0]", f"{G}.direction",
                     "got [0, 0, 0]; give a direction"),
    "mount without a name": ("[support.mounts.m]", "[support.mounts.' ']", "support.mounts",
                             "got the name ' '; give another"),
    "contact without stiffness": (STIFF, 'damping = "1 N s/m"\npreload = "1 N"\none_sided = true',
                                  f"{M}.one_sided", "a contact without stiffness carries nothing"),
}  # fmt: skip

# -- [balance] ------------------------------------------------------------------------------------

X = 'x = ["-60 mm", "20 mm"]'
SECTOR = 'shape = "sector"'
PLATE = 'thickness = "8 mm"\nmaterial = "steel"'
RATIO = "ratio = [0.3, 2]"
TEETH = 'teeth = [17, 80]\nmodule = "2 mm"'
AXIS = 'axis = ["100 mm", "0 mm"]'
ORDER = "order = 2"
SPEEDS = 'speeds = ["150 rpm", "240 rpm"]'
LIMIT = 'at_most = "120 N"'
MOVE, FIRST, GEARED, OTHER = ("balance.moves[1]", "balance.masses[1]", "balance.geared[1]",
                              "balance.geared[2]")  # fmt: skip
SHAFT, SPRING, WISH, KEEP = ("balance.shafts[1]", "balance.springs[1]", "balance.objectives[1]",
                             "balance.limits[1]")  # fmt: skip
OF_BALANCES: Refusals = {
    # what is replaced, by what, the place, what is said
    "combine": ('"squares"', '"max"', "balance.combine", "got 'max'; give 'sum' or 'squares'"),
    "table for a list": ("[[balance.moves]]", "[balance.moves]", "balance.moves",
                         "got a table; write each as a table under [[balance.moves]]"),
    "list for a table": ("[balance.phases]", "[[balance.phases]]", "balance.phases",
                         "got a list of 1; give a table"),
    "one x": (X, 'x = "20 mm"', f"{MOVE}.x", "got '20 mm'; give a list of two values"),
    "three x": (X, 'x = ["0 m", "0 m", "0 m"]', f"{MOVE}.x", "got a list of 3; give a list of two"),
    "circle without radius": (X, 'center = ["0 m", "0 m"]', MOVE,
                              "give both center and radius of a circle, or neither"),
    "box and circle": (X, f'{X}\ncenter = ["0 m", "0 m"]\nradius = "1 m"', MOVE,
                       "give either x and y, or center and radius"),
    "shape": (SECTOR, 'shape = "wedge"', f"{FIRST}.shape",
              "got 'wedge'; give 'any', 'point', 'disc', 'ring' or 'sector'"),
    "plate of a point": (SECTOR, 'shape = "point"', f"{FIRST}.thickness",
                         "goes with a disc, ring or sector; leave it out"),
    "hole of a disc": (SECTOR, 'shape = "disc"', f"{FIRST}.inner_radius",
                       "goes with a ring or sector, got shape 'disc'"),
    "no thickness": ('thickness = "8 mm"\nmaterial', "material", f"{FIRST}.thickness",
                     "missing; a sector is cut from a plate, give its thickness"),
    "no material": (PLATE, 'thickness = "8 mm"', f"{FIRST}.material",
                    "missing; a sector is cut from a plate, give a material such as"),
    "unknown material": (PLATE, 'thickness = "8 mm"\nmaterial = "stel"', f"{FIRST}.material",
                         "no material is called 'stel'; did you mean 'steel'? (density stands for "
                         "any other)"),
    "American material": (PLATE, 'thickness = "8 mm"\nmaterial = "aluminum"', f"{FIRST}.material",
                          "no material is called 'aluminum'; did you mean 'aluminium'?"),
    "material and density": (PLATE, f'{PLATE}\ndensity = "7 g/cm^3"', FIRST,
                             "give either material or density"),
    "mass and at_most": ('at_most = "800 g"', 'at_most = "800 g"\nmass = "1 g"', FIRST,
                         "give either mass or at_most"),
    "no limit": ('mass = "500 g"\n\n', 'at_most = "500 g"\n\n', "balance.masses[2]",
                 "nothing limits it; give the radius of its room, or its mass"),
    "ratio as text": (RATIO, 'ratio = "2"', f"{GEARED}.ratio",
                      "got '2'; give a plain number, or the least and the most such as [0.3, 2]"),
    "ratio in text": (RATIO, 'ratio = ["1", "2"]', f"{GEARED}.ratio[1]",
                      "got '1'; give a plain number without unit and quotes"),
    "true ratio": (RATIO, "ratio = true", f"{GEARED}.ratio", "got true; give a plain number"),
    "three ratios": (RATIO, "ratio = [1, 2, 3]", f"{GEARED}.ratio",
                     "got a list of 3; give a plain number, or the least and the most"),
    "ratio of 0": (RATIO, "ratio = [0, 2]", f"{GEARED}.ratio", "got 0; give a size above 0"),
    "no ratio": (RATIO, "", GEARED, "give either ratio or teeth"),
    "ratio and teeth": (RATIO, f"{RATIO}\n{TEETH}", GEARED, "give either ratio or teeth"),
    "no module": (TEETH, "teeth = [17, 80]", f"{OTHER}.module", "missing; with teeth give it"),
    "half a tooth": (TEETH, TEETH.replace("17", "17.5"), f"{OTHER}.teeth[1]",
                     "got the number 17.5; give a whole number"),
    "no pitch radius": ('pitch_radius = "50 mm"\n', "", f"{GEARED}.pitch_radius",
                        "missing; give that of the driver's gear, or the shaft's axis"),
    "axis and direction": (AXIS, f'{AXIS}\ndirection = "0 deg"', f"{OTHER}.direction",
                           "the axis determines it already; leave it out"),
    "gears of no material": ('gear_material = "steel"\n', "", GEARED,
                             "give both gear_thickness and gear_material (or gear_density), or"),
    "gears of two": ('gear_material = "steel"', 'gear_material = "lead"\ngear_density = "1 g/cm^3"',
                     GEARED, "give either gear_material or gear_density"),
    "gears of wood": ('gear_material = "steel"', 'gear_material = "wood"',
                      f"{GEARED}.gear_material", "(gear_density stands for any other)"),
    "clear of text": ('["coupler"]', '"coupler"', f"{GEARED}.clear_of",
                      "got 'coupler'; give a list of names such as [\"coupler\"]"),
    "clear of numbers": ('["coupler"]', "[1]", f"{GEARED}.clear_of[1]",
                         "got the number 1; give text in quotes"),
    "third order": (ORDER, "order = 3", f"{SHAFT}.order", "got the number 3; give 1 or 2"),
    "ring on a shaft": (ORDER, f'{ORDER}\nshape = "ring"\n{PLATE}', f"{SHAFT}.shape",
                        "a ring has no unbalance; give one of any, point, disc and sector"),
    "one axis": ('axes = [["0 mm", "-60 mm"], ["40 mm", "-60 mm"]]', 'axes = [["0 m", "0 m"]]',
                 f"{SHAFT}.axes", "got a list of 1; give a list of two values"),
    "measure": ('measure = "peak"\norders', 'measure = "mean"\norders', f"{WISH}.measure",
                "got 'mean'; give 'rms', 'ripple', 'peak', 'peak_to_peak' or 'area'"),
    "one order": ("orders = [1, 2]", "orders = 1", f"{WISH}.orders",
                  "got the number 1; give a list of numbers such as [1, 2]"),
    "negative order": ("orders = [1, 2]", "orders = [1, -2]", f"{WISH}.orders[2]",
                       "got -2; give 0 or more"),
    "weight of 0": ("weight = 2", "weight = 0", f"{WISH}.weight", "got 0; give more than 0"),
    "one speed": (SPEEDS, 'speeds = "150 rpm"', "balance.objectives[2].speeds",
                  "got '150 rpm'; give a list such as [\"150 rpm\", \"240 rpm\"]"),
    "bare limit": (LIMIT, "at_most = 120", f"{KEEP}.at_most",
                   'got the number 120; give number and unit in quotes, such as "120 N", or a '
                   'share of the value before, such as "80 %"'),
    "share without a space": (LIMIT, 'at_most = "80%"', f"{KEEP}.at_most",
                              "got '80%'; give a number, a space and %, such as \"80 %\""),
    "endless share": (LIMIT, f'at_most = "{"8" * 90}%"', f"{KEEP}.at_most", "...'; give a number"),
    "no limit given": (LIMIT, "", f"{KEEP}.at_most", 'missing; add at_most = "120 N"'),
    "weight of a limit": (LIMIT, f"{LIMIT}\nweight = 2", f"{KEEP}.weight", "no key is called"),
}  # fmt: skip
BALANCES_BEYOND: Refusals = {
    "two problems": ('"-60 mm", "20 mm"', '"0 mm", "-1 mm"', f"{MOVE}.x",
                     "got 0 mm to -1 mm; give the smaller one first"),
    "unit of a limit": (LIMIT, 'at_most = "120 N m"', f"{KEEP}.at_most",
                        "N m is the unit of a torque; a force is wanted: N, kN"),
    "limit of 0": (LIMIT, 'at_most = "0 N"', f"{KEEP}.at_most", "got 0 N; give more"),
    "share of 0": (LIMIT, 'at_most = "0 %"', f"{KEEP}.at_most", "got 0 %; give more than 0"),
    "area under a force": ('at_most = "80 %"', 'at_most = "3 N"', "balance.limits[2].at_most",
                           "there is no unit for the area under shaking_force.x; give a share"),
    "limit of nothing": ('"joints.B"', '"joints.Q"', f"{KEEP}.output", "no joint is called 'Q'"),
    "area of a vector": ('output = "joints.B"\nmeasure = "peak"',
                         'output = "joints.B"\nmeasure = "area"', f"{KEEP}.output",
                         "joints.B is a vector, which has no area; give .x or .y"),
    "unknown point": ('at = "D"', 'at = "B"', "balance.masses[2].at",
                      "no point of rocker is called 'B'; there are 'D', 'C'"),
    "too heavy": ('at_most = "800 g"', 'mass = "800 g"', f"{FIRST}.mass",
                  "a sector of 800 g and 8 mm steel needs, even as a full ring, a radius of"),
}  # fmt: skip

# -- all of them -----------------------------------------------------------------------------------

TABLES = (
    # text before the table, the table, the name in front of the places, of both, of the reader
    ("", FOUR_BAR, "", OF_LINKAGES, LINKAGES_BEYOND),
    (FOUR_BAR, PLANTING, "planting", OF_PLANTING, PLANTING_BEYOND),
    (FOUR_BAR, MOTOR, "drive.motor", OF_MOTORS, MOTORS_BEYOND),
    (FOUR_BAR, SUPPORTED, "", OF_SUPPORTS, SUPPORTS_BEYOND),
    (FOUR_BAR + SUPPORT + ROWS, BALANCE, "", OF_BALANCES, BALANCES_BEYOND),
)


def cases() -> Iterator[object]:
    """Text, place, what is said, and whether the schema refuses it too."""
    for before, table, name, both, beyond in TABLES:
        for schema_too, refusals in ((True, both), (False, beyond)):
            for case, (old, new, place, said) in refusals.items():
                assert old in table
                text = before + table.replace(old, new, 1)
                first = re.search(r"\[(.+)\]", table)
                where = f"{name or (first and first[1])}: {case}"
                yield pytest.param(text, name + place, said, schema_too, id=where)


def complaint(text: str) -> str:
    """What is said of a text, behind the name of its file."""
    with pytest.raises(ModelError) as caught:
        loads(text, "model.toml")
    said = str(caught.value)
    assert said.startswith("model.toml: ")
    assert "\n" not in said
    assert len(said) < 400
    return said.removeprefix("model.toml: ")


@pytest.mark.parametrize(("text", "place", "said", "schema_too"), [*cases()])
def test_refused(text: str, place: str, said: str, schema_too: bool) -> None:
    line = complaint(text)
    assert line.startswith(f"{place}: ")
    assert said in line
    assert VALIDATOR.is_valid(tomllib.loads(text)) is not schema_too


FLYWHEEL = FOUR_BAR.replace("[frame]", "flywheel = @\n[frame]")
BODILESS = "no body has a negative moment of inertia"
OTHERS = {
    # text, with what the sentence begins
    "flywheel": (FLYWHEEL.replace("@", '"-2 kg m^2"'),
                 f"drive.flywheel: got -2 kg m^2; {BODILESS}"),
    "flywheel in kg": (FLYWHEEL.replace("@", '"2 kg"'), "drive.flywheel: got '2 kg'; kg is the "
                       "unit of a mass; a moment of inertia is wanted"),
    "motor as text": (FOUR_BAR.replace("[frame]", 'motor = "2 N m"\n[frame]'),
                      "drive.motor: got '2 N m'; give a table"),
    "motor's table": (f'{FOUR_BAR}[drive.motor]\ntable = "motor.csv"', "drive.motor.table: got "
                      "'motor.csv'; a table can only be read beside a file"),
    "rows as a table": (f"{FOUR_BAR}\n[rows]\n",
                        "rows: got a table; write each as a table under [[rows]]"),
    "balance as a list": (f"{FOUR_BAR}[[balance]]\n", "balance: got a list of 1; give a table"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "said"), OTHERS.values(), ids=OTHERS)
def test_other_forms(text: str, said: str) -> None:
    assert complaint(text).startswith(said)


def test_two_problems() -> None:
    said = complaint(f'{FOUR_BAR}[balance]\nadded_mass = 1\ncombine = "x"\n')
    assert said.startswith("balance.added_mass: ")
    assert said.endswith(" (and 1 more)")


@pytest.mark.parametrize("number", ["nan", "inf", "1e40", "1e-40"])
def test_directions_are_finite_and_of_usual_size(number: str) -> None:
    text = SUPPORTED.replace(WAY, f"direction = [0, {number}, 1]")
    assert complaint(FOUR_BAR + text).startswith(f"{G}.direction[2]: got ")
