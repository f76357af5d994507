"""Support and rows of the model file: read, refused in one sentence, and written again."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from math import pi, radians
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from equipoise.errors import ModelError
from equipoise.mechanism.support import AXES, FREEDOMS, UP, Gauge, Mount, Row, Support
from equipoise.schema import dumps, json_schema, loads
from unit.schema.samples import FOUR_BAR, ROWS, SUPPORT

VALIDATOR = Draft202012Validator(json_schema())
SHORT = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm"]
inertia = "4 kg m^2"
"""
SPATIAL = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm", "-10 mm"]
inertia = ["3 kg m^2", "5 kg m^2", "4 kg m^2"]
products = ["0.1 kg m^2", "0 kg m^2", "-2000 kg cm^2"]
freedoms = ["pitch", "roll", "heave"]
"""
PIVOTED = """
[support]
mass = "60 kg"
center_of_mass = { distance = "300 mm", direction = "90 deg" }
pivot_inertia = "10 kg m^2"
pivot = ["0 mm", "-100 mm"]
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
ALL = SHORT + MOUNT + TURN + GAUGE + ROWS


def support_of(text: str) -> Support:
    support = loads(FOUR_BAR + text).support
    assert support is not None
    return support


# -- reading ---------------------------------------------------------------------------------------


def test_few_values_and_the_defaults_of_the_others() -> None:
    assert support_of(SHORT) == Support(60.0, (0.0, 0.3, 0.0), (4.0,))
    bare = loads(FOUR_BAR)
    assert (bare.support, bare.rows) == (None, ())
    assert loads(f"{FOUR_BAR}\n[[rows]]\n").rows == (Row(),)


def test_all_values_arrive_in_si_units() -> None:
    assert support_of(SPATIAL) == Support(
        60.0, (0.0, 0.3, -0.01), (3.0, 5.0, 4.0), (0.1, 0.0, -0.2),
        freedoms=("pitch", "roll", "heave"),
    )  # fmt: skip
    assert support_of(SPATIAL).coordinates == ("heave", "roll", "pitch")
    assert support_of(PIVOTED) == Support(
        60.0, (0.0, 0.3, 0.0), pivot_inertia=10.0, pivot=(0.0, -0.1)
    )
    support = support_of(SUPPORT)
    assert support.mounts == {
        "front": Mount((0.4, -0.2, 0.0), UP, 5e4, 400.0),
        "float": Mount((-0.4, -0.2, 0.03), (0.5, 2.0, 0.0), 9806.65, 0.0, 90.0, True),
        "hitch": Mount(
            axis="pitch", torsional_stiffness=500.0, torsional_damping=3.0, preload=-20.0
        ),
    }
    assert list(support.mounts) == ["front", "float", "hitch"]
    handle = support.gauges["handle"]
    assert handle.point == pytest.approx((-(0.5**0.5), 0.5**0.5, 0.0), abs=1e-15)
    assert handle.direction == pytest.approx(radians(-30), rel=1e-15)
    assert support.gauges["nod"] == Gauge(axis="pitch")
    assert loads(FOUR_BAR + ROWS).rows == (Row(0.0, -0.15), Row(pi, 0.15, (0.02, -0.005)))


TEXTS = {"short": SHORT, "spatial": SPATIAL, "pivoted": PIVOTED, "all": ALL, "sample": SUPPORT}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_schema_accepts_what_is_read(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))
    VALIDATOR.validate(tomllib.loads(dumps(loads(FOUR_BAR + text))))


# -- refusing --------------------------------------------------------------------------------------

INERTIA, PLACE = 'inertia = "4 kg m^2"', 'center_of_mass = ["0 mm", "300 mm"]'
POINT, STIFF = MOUNT.splitlines()[2:4]
TURNS = 'torsional_stiffness = "500 N m/rad"'
WAY = "direction = [0, 0, 1]"
LATERAL = 'lateral = "-15 cm"'
M, T, G = "support.mounts.m", "support.mounts.t", "support.gauges.g"
THREE = '["1 kg m^2", "1 kg m^2", "1 kg m^2"]'
REFUSED = {
    # what is replaced, by what, the place, what is said
    "no mass": ('mass = "60 kg"\n', "", "support.mass", 'missing; add mass = "60 kg"'),
    "no center": (PLACE, "", "support.center_of_mass", 'missing; add center_of_mass = ["0 mm", "3'),
    "mass as a number": ('"60 kg"', "60", "support.mass", "got the bare number 60; give"),
    "mass in mm": ('"60 kg"', '"60 mm"', "support.mass", "mm is the unit of a length; a mass"),
    "unknown key": (INERTIA, f'{INERTIA}\nmas = "1 kg"', "support.mas", "did you mean 'mass'?"),
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
    "inertia as a number": (INERTIA, "inertia = 4", "support.inertia", "got the bare number 4;"),
    "inertia in kg": (INERTIA, 'inertia = "4 kg"', "support.inertia", "a moment of inertia is"),
    "one of three": (INERTIA, 'inertia = ["1 kg m^2", "x", "1 kg m^2"]', "support.inertia[2]",
                     "got 'x'; write the number"),
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
                        "got 'rol'; give 'surge', 'heave', 'sway', 'roll', 'yaw' or 'pitch'"),
    "freedom twice": (INERTIA, f'{INERTIA}\nfreedoms = ["pitch", "pitch"]', "support.freedoms[2]",
                      "'pitch' is given twice"),
    "mounts as a list": ("[support.mounts.m]", "[[support.mounts]]", "support.mounts",
                         "got a list of 1; give a table"),
    "mount as text": (INERTIA, f'{INERTIA}\nmounts.x = "1 kN/m"', "support.mounts.x",
                      "got '1 kN/m'; give a table"),
    "key of a mount": (STIFF, 'stifness = "1 kN/m"', f"{M}.stifness", "did you mean 'stiffness'?"),
    "unit of stiffness": (STIFF, 'stiffness = "20 N"', f"{M}.stiffness",
                          "N is the unit of a force; a stiffness is wanted: N/m, N/mm, kN/m"),
    "unit of damping": (STIFF, 'damping = "20 N/m"', f"{M}.damping", "a damping coefficient is"),
    "stiffness about": (TURNS, 'torsional_stiffness = "5 N/m"', f"{T}.torsional_stiffness",
                        "a torsional stiffness is wanted: N m/rad"),
    "damping about": (TURNS, 'torsional_damping = "5 N s/m"', f"{T}.torsional_damping",
                      "a torsional damping coefficient is wanted: N m s/rad"),
    "preload in kg": (STIFF, f'{STIFF}\npreload = "3 kg"', f"{M}.preload", "a force is wanted"),
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
    "preload as a force": (TURNS, f'{TURNS}\ntorsional_preload = "9 N"', f"{T}.torsional_preload",
                           "N is the unit of a force; a torque is wanted"),
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
    "direction in words": (WAY, 'direction = "up"', f"{G}.direction", "got 'up'; write the number"),
    "gauge without a place": (GAUGE[GAUGE.index("point"):], "\n", G, "give either point or axis"),
    "stiff gauge": (WAY, STIFF, f"{G}.stiffness", "no key is called 'stiffness'; there are"),
    "direction of a rotation": (GAUGE[GAUGE.index("point"):], f'axis = "roll"\n{WAY}\n',
                                f"{G}.direction", "has no place beside an axis; leave it out"),
    "phase as a length": (LATERAL, 'phase = "1 m"', "rows[1].phase", "an angle is wanted"),
    "bare lateral": (LATERAL, "lateral = 0.2", "rows[1].lateral", "got the bare number 0.2"),
    "offset of three": (LATERAL, 'offset = ["0 m", "0 m", "0 m"]', "rows[1].offset",
                        "got a list of 3; give a list of two values"),
    "key of a row": (LATERAL, 'latral = "1 m"', "rows[1].latral", "did you mean 'lateral'?"),
}  # fmt: skip
"""What both the reader and the schema refuse."""
BEYOND_THE_SCHEMA = {
    "no weight": ('"60 kg"', '"0 kg"', "support.mass", "got 0 kg; give more than 0"),
    "inertia of 0": (INERTIA, 'inertia = "0 kg m^2"', "support.inertia",
                     "got 0 kg m^2; give more than 0"),
    "one inertia for space": (INERTIA, f'{INERTIA}\nfreedoms = ["roll", "sway"]', "support.inertia",
                              "got one value, but the support can sway and roll; give three"),
    "no body": (INERTIA, 'inertia = ["1 kg m^2", "9 kg m^2", "1 kg m^2"]', "support.inertia",
                "got 9 kg m^2 beside 1 and 1; no body has one moment of inertia above the sum"),
    "large products": (INERTIA, f"inertia = {THREE}\nproducts = {THREE}", "support.products",
                       "no body has that, give smaller ones"),
    "small pivot_inertia": (INERTIA, 'pivot = ["0 m", "0 m"]\npivot_inertia = "1 kg m^2"',
                            "support.pivot_inertia",
                            "got 1 kg m^2; mass and center_of_mass alone make 5.4, give more"),
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


def complaint(text: str) -> str:
    with pytest.raises(ModelError) as caught:
        loads(FOUR_BAR + text, "model.toml")
    said = str(caught.value)
    assert said.startswith("model.toml: ")
    assert "\n" not in said
    assert len(said) < 400
    return said.removeprefix("model.toml: ")


def changed(old: str, new: str) -> str:
    assert old in ALL
    return ALL.replace(old, new, 1)


@pytest.mark.parametrize(("old", "new", "place", "said"), REFUSED.values(), ids=REFUSED)
def test_reader_and_schema_refuse(old: str, new: str, place: str, said: str) -> None:
    text = changed(old, new)
    assert complaint(text).startswith(f"{place}: ")
    assert said in complaint(text)
    assert not VALIDATOR.is_valid(tomllib.loads(FOUR_BAR + text))


@pytest.mark.parametrize(
    ("old", "new", "place", "said"), BEYOND_THE_SCHEMA.values(), ids=BEYOND_THE_SCHEMA
)
def test_the_reader_refuses(old: str, new: str, place: str, said: str) -> None:
    text = changed(old, new)
    assert complaint(text).startswith(f"{place}: ")
    assert said in complaint(text)
    VALIDATOR.validate(tomllib.loads(FOUR_BAR + text))


@pytest.mark.parametrize("number", ["nan", "inf", "1e40", "1e-40"])
def test_directions_are_finite_and_of_usual_size(number: str) -> None:
    said = complaint(changed(WAY, f"direction = [0, {number}, 1]"))
    assert said.startswith(f"{G}.direction[2]: got ")


def test_rows_as_a_table() -> None:
    assert complaint("\n[rows]\n") == "rows: got a table; write each as a table under [[rows]]"


# -- writing ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_what_is_written_is_read_again(text: str) -> None:
    machine = loads(FOUR_BAR + text)
    assert loads(dumps(machine)) == machine
    assert dumps(loads(dumps(machine))) == dumps(machine)


def test_a_support_is_written_as_people_write_it() -> None:
    text = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "300 mm"]
inertia = "4 kg m^2"

[support.mounts.front]
point = ["400 mm", "-200 mm", "1 m"]
direction = [0, 1, -0.5]
stiffness = "500 N/m"
preload = "0 N"
one_sided = true

[support.mounts."rear axle"]
axis = "pitch"
torsional_damping = "3 N m s/rad"
torsional_preload = "0 N m"

[support.gauges.handle]
point = ["0 mm", "1 m"]
direction = "45 deg"

[[rows]]
lateral = "-150 mm"

[[rows]]
phase = "180 deg"
lateral = "150 mm"
offset = ["20 mm", "0 mm"]
"""
    assert dumps(loads(FOUR_BAR + text)) == FOUR_BAR + text


size = st.floats(1e-20, 1e20)
number = st.just(0.0) | size | size.map(lambda x: -x)
place = st.tuples(number, number, number)
direction = st.just(UP) | st.floats(1e-9, 20) | st.tuples(number, number, number).filter(any)
names = st.text(min_size=1, max_size=8).filter(lambda name: name.isprintable() and name.strip())
positive = st.just(0.0) | size
at_a_point = st.builds(
    Mount,
    point=place,
    direction=direction,
    stiffness=size,
    damping=positive,
    preload=st.none() | number,
    one_sided=st.booleans(),
)
about_an_axis = st.builds(
    Mount,
    axis=st.sampled_from(AXES),
    torsional_stiffness=positive,
    torsional_damping=size,
    preload=st.none() | number,
)
gauges = st.builds(Gauge, point=place, direction=direction) | st.builds(
    Gauge, axis=st.sampled_from(AXES)
)
rows = st.builds(Row, phase=number, lateral=number, offset=st.tuples(number, number))


@st.composite
def bodies(draw: Any) -> dict[str, Any]:
    """Inertia, pivot and freedoms that go together."""
    pivot = draw(st.none() | st.tuples(number, number))
    left = FREEDOMS if pivot is None else AXES  # a pin leaves rotations only
    spatial = st.lists(st.sampled_from(left), unique=True).map(tuple)
    if draw(st.booleans()):
        moment = draw(size)
        products = draw(st.just(()) | st.tuples(*[st.floats(1e-3, 0.3)] * 3))
        return {
            "inertia": (moment, 1.5 * moment, moment),
            "products": tuple(moment * share for share in products),
            "pivot": pivot,
            "freedoms": draw(spatial),
        }
    return {"inertia": (draw(size),), "pivot": pivot, "freedoms": draw(st.just(("pitch",)))}


@given(
    size,
    place,
    bodies(),
    st.dictionaries(names, at_a_point | about_an_axis, max_size=3),
    st.dictionaries(names, gauges, max_size=3),
    st.lists(rows, max_size=3).map(tuple),
)
def test_random_supports_survive(
    mass: float,
    center: Any,
    body: dict[str, Any],
    mounts: dict[str, Mount],
    gauges: dict[str, Gauge],
    rows: tuple[Row, ...],
) -> None:
    support = Support(mass, center, mounts=mounts, gauges=gauges, **body)
    machine = replace(loads(FOUR_BAR), support=support, rows=rows)
    text = dumps(machine)
    try:
        text.encode()
    except UnicodeEncodeError:  # half of a surrogate pair is no text
        return
    VALIDATOR.validate(tomllib.loads(text))
    assert loads(text) == machine
    assert list(loads(text).support.mounts) == list(mounts)  # type: ignore[union-attr]


@given(size, st.tuples(number, number))
def test_random_pivots_survive(mass: float, pivot: Any) -> None:
    machine = loads(FOUR_BAR).with_support(
        mass=mass, center_of_mass=(*pivot, 0.0), pivot=pivot, pivot_inertia=1e20
    )
    assert loads(dumps(machine)) == machine
