"""[balance] of the model file: read, and refused in one sentence."""

from __future__ import annotations

import tomllib
from math import pi, radians

import pytest
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.mechanism.balance import (
    MATERIALS,
    AddedMass,
    Balance,
    BalanceShafts,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    SpringChoice,
    Weight,
)
from equipoise.mechanism.objectives import MEASURED_IN
from equipoise.mechanism.outputs import DECLARED
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import BALANCE, FOUR_BAR, ROWS, SUPPORT

VALIDATOR = Draft202012Validator(json_schema())
BASE = FOUR_BAR + SUPPORT + ROWS
RPM = 2 * pi / 60


def balance_of(text: str) -> Balance:
    balance = loads(BASE + text).balance
    assert balance is not None
    return balance


# -- reading ---------------------------------------------------------------------------------------


def test_all_values_arrive_in_si_units() -> None:
    balance = balance_of(BALANCE)
    assert (balance.added_mass, balance.combine) == (0.5, "squares")
    assert balance.phases == Phases(radians(10))
    assert balance.moves == (CenterMove("crank", (-0.06, 0.02), (-0.03, 0.03)),)
    assert balance.masses == (
        AddedMass("crank", "A", Weight("sector", 0.06, 0.01, 0.008, 7850.0, at_most=0.8)),
        AddedMass("rocker", "D", Weight(mass=0.5)),
    )
    assert balance.geared == (
        GearedWeight("rocker", Weight(radius=0.04), (0.3, 2.0), pitch_radius=0.05,
                     direction=(0.0, 0.0),
                     gear_thickness=0.008, gear_density=7850.0, clear_of=("coupler",)),
        GearedWeight("crank", Weight("disc", 0.04, 0.0, 0.008, 7800.0), teeth=(17, 80),
                     module=0.002, axis=(0.1, 0.0), gear_thickness=0.008, gear_density=7800.0,
                     name="other"),
    )  # fmt: skip
    assert balance.shafts == (BalanceShafts(2, ((0.0, -0.06), (0.04, -0.06)), Weight(radius=0.03)),)
    assert balance.springs == (SpringChoice("rocker", "C", "A", 5000.0, (0.02, 0.12)),)
    assert balance.objectives == (
        Objective("shaking_moment", "peak", (1.0, 2.0), "D", 2.0),
        Objective("gauges.handle", speeds=(150 * RPM, 240 * RPM)),
    )
    assert balance.limits == (
        Limit(Objective("joints.B", "peak"), 120.0),
        Limit(Objective("shaking_force.x", "area"), ratio=0.8),
    )


def test_few_values_and_the_defaults_of_the_others() -> None:
    assert loads(FOUR_BAR).balance is None
    assert balance_of("[balance]\n") == Balance()
    assert balance_of("[balance.phases]\n") == Balance(phases=Phases())
    text = '[[balance.geared]]\ndriver = "rocker"\nratio = 1\npitch_radius = "1 cm"\nmass = "1 g"\n'
    assert balance_of(text).geared[0].ratio == (1.0, 1.0)


@pytest.mark.parametrize(
    ("output", "measure", "at_most", "value"),
    [
        ("shaking_force", "rms", "2 kN", 2000.0),
        ("joints.B.x", "peak_to_peak", "1 kgf", 9.80665),
        ("drive_torque", "peak", "3 N cm", 0.03),
        ("yaw_moment", "ripple", "3 N m", 3.0),
        ("drive_torque", "area", "2 kJ", 2000.0),
        ("gauges.handle", "peak", "2 mm", 0.002),
        ("gauges.nod", "peak", "180 deg", pi),
    ],
)
def test_units_of_limits(output: str, measure: str, at_most: str, value: float) -> None:
    text = f'[[balance.limits]]\noutput = "{output}"\nmeasure = "{measure}"\nat_most = "{at_most}"'
    assert balance_of(text).limits[0].at_most == pytest.approx(value, rel=1e-15)
    VALIDATOR.validate(tomllib.loads(BASE + text))
    assert loads(dumps(loads(BASE + text))) == loads(BASE + text)


@pytest.mark.parametrize("material", MATERIALS)
def test_materials(material: str) -> None:
    plate = 'shape = "disc"\nradius = "1 cm"\nthickness = "1 mm"\n'
    text = f'[[balance.masses]]\nlink = "crank"\nat = "A"\n{plate}material = "{material}"\n'
    assert balance_of(text).masses[0].weight.density == MATERIALS[material]
    assert f'material = "{material}"' in dumps(loads(BASE + text))
    VALIDATOR.validate(tomllib.loads(BASE + text))


def test_dimensions_of_limits_are_those_of_outputs() -> None:
    linear = {one.dimension for one in DECLARED.values() if not one.reason}
    assert linear | {"energy", "angle"} == {*MEASURED_IN}


# -- refusing --------------------------------------------------------------------------------------

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
REFUSED = {
    # what is replaced, by what, the place, what is said
    "unknown key": ("combine =", "combin =", "balance.combin", "did you mean 'combine'?"),
    "combine": ('"squares"', '"max"', "balance.combine", "got 'max'; give 'sum' or 'squares'"),
    "bare mass": ('added_mass = "500 g"', "added_mass = 500", "balance.added_mass",
                  "got the bare number 500; give number and unit in quotes"),
    "table for a list": ("[[balance.moves]]", "[balance.moves]", "balance.moves",
                         "got a table; write each as a table under [[balance.moves]]"),
    "list for a table": ("[balance.phases]", "[[balance.phases]]", "balance.phases",
                         "got a list of 1; give a table"),
    "unit of the step": ('"10 deg"', '"10 mm"', "balance.phases.step", "an angle is wanted"),
    "no link": ('link = "crank"\n', "", f"{MOVE}.link", 'missing; add link = "coupler"'),
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
                         "no material is called 'stel'; there are 'steel', 'cast iron', 'brass', "
                         "'lead', 'tungsten alloy', 'aluminium', or give density"),
    "material and density": (PLATE, f'{PLATE}\ndensity = "7 g/cm^3"', FIRST,
                             "give either material or density"),
    "unit of density": (PLATE, 'thickness = "8 mm"\ndensity = "7 kg"', f"{FIRST}.density",
                        "kg is the unit of a mass; a density is wanted: kg/m^3, g/cm^3"),
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
                      f"{GEARED}.gear_material", "or give gear_density"),
    "clear of text": ('["coupler"]', '"coupler"', f"{GEARED}.clear_of",
                      "got 'coupler'; give a list of names such as [\"coupler\"]"),
    "clear of numbers": ('["coupler"]', "[1]", f"{GEARED}.clear_of[1]",
                         "got the number 1; give text in quotes"),
    "third order": (ORDER, "order = 3", f"{SHAFT}.order", "got the number 3; give 1 or 2"),
    "no order": (ORDER, "", f"{SHAFT}.order", "missing; add order = 2"),
    "ring on a shaft": (ORDER, f'{ORDER}\nshape = "ring"\n{PLATE}', f"{SHAFT}.shape",
                        "a ring has no unbalance; give one of any, point, disc and sector"),
    "one axis": ('axes = [["0 mm", "-60 mm"], ["40 mm", "-60 mm"]]', 'axes = [["0 m", "0 m"]]',
                 f"{SHAFT}.axes", "got a list of 1; give a list of two values"),
    "unit of stiffness": ('"5000 N/m"', '"5000 N"', f"{SPRING}.stiffness", "a stiffness is wanted"),
    "measure": ('measure = "peak"\norders', 'measure = "mean"\norders', f"{WISH}.measure",
                "got 'mean'; give 'rms', 'ripple', 'peak', 'peak_to_peak' or 'area'"),
    "no output": ('output = "shaking_moment"\n', "", f"{WISH}.output",
                  'missing; add output = "shaking_moment"'),
    "one order": ("orders = [1, 2]", "orders = 1", f"{WISH}.orders",
                  "got the number 1; give a list of numbers such as [1, 2]"),
    "negative order": ("orders = [1, 2]", "orders = [1, -2]", f"{WISH}.orders[2]",
                       "got -2; give 0 or more"),
    "weight as text": ("weight = 2", 'weight = "2"', f"{WISH}.weight",
                       "got '2'; give a plain number without unit and quotes"),
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
"""What both the reader and the schema refuse."""
BEYOND_THE_SCHEMA = {
    "two problems": ('"-60 mm", "20 mm"', '"0 mm", "-1 mm"', f"{MOVE}.x",
                     "got 0 to -1 mm; give the smaller one first"),
    "unit of a limit": (LIMIT, 'at_most = "120 N m"', f"{KEEP}.at_most",
                        "N m is the unit of a torque; a force is wanted: N, kN"),
    "limit of 0": (LIMIT, 'at_most = "0 N"', f"{KEEP}.at_most", "got 0 in SI units; give more"),
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


def complaint(text: str) -> str:
    with pytest.raises(ModelError) as caught:
        loads(BASE + text, "model.toml")
    said = str(caught.value)
    assert said.startswith("model.toml: ")
    assert "\n" not in said
    assert len(said) < 400
    return said.removeprefix("model.toml: ")


def changed(old: str, new: str) -> str:
    assert old in BALANCE
    return BALANCE.replace(old, new, 1)


@pytest.mark.parametrize(("old", "new", "place", "said"), REFUSED.values(), ids=REFUSED)
def test_reader_and_schema_refuse(old: str, new: str, place: str, said: str) -> None:
    text = changed(old, new)
    assert complaint(text).startswith(f"{place}: ")
    assert said in complaint(text)
    assert not VALIDATOR.is_valid(tomllib.loads(BASE + text))


@pytest.mark.parametrize(
    ("old", "new", "place", "said"), BEYOND_THE_SCHEMA.values(), ids=BEYOND_THE_SCHEMA
)
def test_the_reader_refuses(old: str, new: str, place: str, said: str) -> None:
    text = changed(old, new)
    assert complaint(text).startswith(f"{place}: ")
    assert said in complaint(text)
    VALIDATOR.validate(tomllib.loads(BASE + text))


def test_other_forms_of_the_table() -> None:
    assert complaint("[[balance]]\n") == "balance: got a list of 1; give a table"
    said = complaint('[balance]\nadded_mass = 1\ncombine = "x"\n')
    assert said.startswith("balance.added_mass: ")
    assert said.endswith(" (and 1 more)")
