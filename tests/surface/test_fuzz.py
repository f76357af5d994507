"""Random model files and arguments: a command does its work or says in one sentence why not.

Set EQUIPOISE_FUZZ to a number of examples to search longer, and at random.
"""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Callable, Iterator
from copy import deepcopy
from datetime import date
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from support.chosen import drawn
from surface.running import EXAMPLES, Result, equipoise, example, example_text, no_constant, refused
from unit.schema.samples import BALANCE, ROWS, SUPPORT

SEARCH = int(os.environ.get("EQUIPOISE_FUZZ", "0"))
Draw = Callable[..., Any]
Document = dict[str, Any]


def fuzz(examples: int) -> settings:
    return settings(
        max_examples=SEARCH or drawn(examples),
        deadline=None,
        derandomize=not SEARCH,
        database=None,
        suppress_health_check=list(HealthCheck),
    )


# -- the property ----------------------------------------------------------------------------------


def checked(result: Result, is_json: bool = False) -> None:
    if result.status:
        assert len(refused(result)) < 3000
    elif is_json:
        json.loads(result.out, parse_constant=no_constant)


COMMANDS = (
    ("analyze", "--json", "--angles", "5"),
    ("analyze", "--json", "--split", "--angles", "0 deg, -400 deg"),
    ("analyze", "--angles", "4", "--csv", "result.csv"),
    ("check",),
    ("respond", "--json"),
    ("respond", "--json", "--model", "torque", "--speed", "20:300 rpm", "--speeds", "2"),
    ("modes", "--json"),
    ("modes",),
)
commands = st.sampled_from(COMMANDS)


def try_bytes(content: bytes, words: tuple[str, ...]) -> None:
    Path("model.toml").write_bytes(content)
    checked(equipoise(words[0], "model.toml", *words[1:]), "--json" in words)


# -- junk ------------------------------------------------------------------------------------------

UNITS = ("mm", "m", "km", "deg", "rad", "g", "kg", "kg mm^2", "kg m^2", "rpm", "rad/s", "N", "N m",
         "N/m", "N s/m", "N m/rad", "rad/s^2", "m/s^2", "Hz", "mm mm", "", "µm", "%")  # fmt: skip
NUMBERS = ("0", "-0", "1", "-1", "90", "180", "360", "1e-29", "1e-31", "1e-15", "1e15", "-1e20",
           "1e29", "1e31", "1e999", "nan", "-inf", "1,5", "0x1", "1_0", "٣", ".5", "")  # fmt: skip
WORDS = ("", " ", "frame", "crank", "A", "a.b", "links[1]", "[bold]", "[/]", "[/bold]", "{0}",
         "{x}", "{", "%s", "\x1b[31m", "\x00", "\x7f", "\r\n", "a\nb", "\u202eb", "\ufeff", "né",
         "机", "\U0001f469\u200d\U0001f467", "'", '"', "\\", "left", "forward", "external", "/",
         "..", "x" * 500, "to", "on")  # fmt: skip

quantities = st.builds("{} {}".format, st.sampled_from(NUMBERS), st.sampled_from(UNITS))
names = st.sampled_from(WORDS) | st.text(max_size=4)
numbers = st.sampled_from(
    (0, 1, -1, 2**63 - 1, 10**40, 0.0, -0.0, 1e-320, 1e308, float("nan"), float("inf"))
)
junk = st.recursive(
    names | quantities | numbers | st.booleans() | st.just(date(2000, 1, 1)),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(names, inner, max_size=3),
    max_leaves=5,
)


# -- mutations of valid documents ------------------------------------------------------------------


def places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Every table with its keys and every list with its positions."""
    keys = list(value) if isinstance(value, dict) else range(len(value))
    for key in keys:
        yield value, key
        if isinstance(value[key], dict | list):
            yield from places(value[key])


def scaled(draw: Draw, value: Any) -> Any:
    """A quantity in another size, or something else where it is none."""
    number, _, unit = str(value).partition(" ")
    try:
        factor = draw(st.sampled_from((-1, 0, 1e-9, 0.5, 0.999999, 1, 1.5, 10, 1e9, 1e20)))
        return f"{float(number) * factor!r} {unit}"
    except ValueError:
        return draw(junk)


def mutate(draw: Draw, document: Document) -> None:
    everything = list(places(document))
    if not everything:
        return
    table, key = draw(st.sampled_from(everything))
    other, other_key = draw(st.sampled_from(everything))
    match draw(st.sampled_from(("delete", "junk", "scale", "scale", "copy", "rename", "add"))):
        case "delete":
            del table[key]
        case "junk":
            table[key] = draw(junk)
        case "scale":
            table[key] = scaled(draw, table[key])
        case "copy":
            table[key] = deepcopy(other[other_key])
        case "rename" if isinstance(table, dict):
            table[draw(names | st.just(str(other_key)))] = table.pop(key)
        case "add" if isinstance(table, dict):
            table[draw(names)] = deepcopy(other[other_key])
        case _:
            table.append(draw(junk)) if isinstance(table, list) else None


CARRIED = tomllib.loads(SUPPORT + ROWS)
BALANCED = tomllib.loads(BALANCE)
MOTOR = {"no_load_speed": "3000 rpm", "stall_torque": "2 N m", "ratio": 12.5}


@st.composite
def mutated_of(draw: Draw, documents: list[Document]) -> Document:
    """One of some documents with pieces of it lost, put elsewhere and replaced."""
    document = deepcopy(draw(st.sampled_from(documents)))
    for _ in range(draw(st.integers(1, 3))):
        mutate(draw, document)
    return document


@st.composite
def mutated(draw: Draw) -> Document:
    document = deepcopy(example(draw(st.sampled_from(EXAMPLES))))
    if draw(st.booleans()):
        document |= deepcopy(CARRIED)
        document["drive"] |= {"flywheel": "2 kg cm^2", "motor": dict(MOTOR)}
    if draw(st.integers(0, 3)) == 0:  # of a four-bar, by the names that most examples have
        document |= deepcopy(BALANCED)
    return draw(mutated_of([document]))


@given(mutated(), commands)
@fuzz(120)
def test_mutated_documents(document: Document, words: tuple[str, ...]) -> None:
    try_bytes(tomli_w.dumps(document).encode(), words)


@st.composite
def garbled(draw: Draw, bundled: tuple[str, ...] = EXAMPLES) -> bytes:
    """The text of an example with lines lost, doubled and swapped, and with noise in it."""
    lines = example_text(draw(st.sampled_from(bundled))).splitlines()
    for _ in range(draw(st.integers(1, 3))):
        at, to = (draw(st.integers(0, len(lines) - 1)) for _ in range(2))
        match draw(st.sampled_from(("delete", "double", "swap"))):
            case "delete" if len(lines) > 1:
                del lines[at]
            case "swap":
                lines[at], lines[to] = lines[to], lines[at]
            case _:
                lines.insert(to, lines[at])
    content = "\n".join(lines).encode()
    place = draw(st.integers(0, len(content)))
    noise = draw(st.binary(max_size=3) | names.map(str.encode))
    return content[:place] + noise + content[place + draw(st.integers(0, 3)) :]


@given(garbled(), commands)
@fuzz(60)
def test_garbled_text(content: bytes, words: tuple[str, ...]) -> None:
    try_bytes(content, words)


# -- linkages from a grammar -----------------------------------------------------------------------

lengths = st.sampled_from((0, 1, 10, 10, 25, 50, 80, 80, 100, 100, 120, 200, -60))
coordinates = st.tuples(lengths, lengths).map(lambda xy: [f"{xy[0]} mm", f"{xy[1]} mm"])
right_angles = st.sampled_from(("0 deg", "90 deg", "45 deg", "-180 deg", "1 turn", "17 deg"))
sides = st.sampled_from(("left", "right", "forward", "backward"))
forces = st.sampled_from(("0 N", "30 N", "-1e9 N", "1e-9 N"))


class Draft:
    """A linkage that grows at random, mostly by what a linkage can be made of."""

    def __init__(self, draw: Draw) -> None:
        self.draw = draw
        self.points: dict[str, dict[str, list[str]]] = {
            "frame": {"A": ["0 mm", "0 mm"]},
            "crank": {"A": ["0 mm", "0 mm"], "B": [f"{draw(lengths)} mm", "0 mm"]},
        }
        self.sliders: list[Document] = []
        self.gears: list[Document] = []
        self.assembly: dict[str, str] = {}

    def body(self) -> str:
        return self.draw(st.sampled_from(list(self.points)))

    def place(self, body: str) -> str:
        """A point of a body, old or new."""
        old = list(self.points[body])
        if old and self.draw(st.integers(0, 3)):
            return self.draw(st.sampled_from(old))
        name = f"P{sum(map(len, self.points.values()))}"
        self.points[body][name] = self.draw(coordinates)
        return name

    def link(self, *points: str) -> str:
        name = f"link {len(self.points)}"
        self.points[name] = {point: self.draw(coordinates) for point in points}
        return name

    def slide(self, link: str, on: str) -> None:
        self.sliders.append(
            {
                "link": link,
                "point": self.place(link),
                "on": on,
                "through": self.place(on),
                "direction": self.draw(right_angles),
                "angle": self.draw(right_angles),
            }
        )

    def mesh(self, driver: str, driven: str, carrier: str) -> None:
        sizes = st.sampled_from(({"ratio": -2}, {"ratio": 0.3}, {"teeth": [20, 35]}))
        gear = {"between": [driver, driven], "carrier": carrier, "start": self.draw(right_angles)}
        self.gears.append({**gear, **self.draw(sizes)})

    def grow(self) -> None:
        inner = f"J{len(self.points)}"
        single, other = self.body(), self.body()
        match self.draw(st.sampled_from("ppppssrrggxy")):
            case "p":  # a dyad of two links
                self.link(self.place(single), inner)
                self.link(self.place(other), inner)
                self.assembly[inner] = self.draw(sides)
            case "s":  # a rod and a block
                self.link(self.place(single), inner)
                self.slide(self.link(inner), other)
                self.assembly[inner] = self.draw(sides)
            case "r":  # a block on a link
                link = self.link(self.place(single))
                self.slide(link, self.link(self.place(other)))
            case "g":  # a geared link
                self.mesh(single, self.link(self.place(other)), other)
            case "x":  # anything
                self.link(*(self.place(self.body()) for _ in range(self.draw(st.integers(0, 3)))))
            case _:
                self.slide(single, other)

    def masses(self) -> Document:
        if self.draw(st.integers(0, 4)) == 0:
            return {}
        mass = self.draw(st.sampled_from((0, 1, 1, 1, 1e-20, 1e25)))
        return {
            "mass": f"{mass} kg",
            "center_of_mass": self.draw(coordinates),
            "inertia": f"{mass * self.draw(st.sampled_from((0, 500, 1e20)))} kg mm^2",
        }

    def load(self) -> Document:
        link = self.body()
        load: Document = {"link": link}
        if self.draw(st.booleans()):
            load |= {"point": self.place(link), "force": [self.draw(forces), self.draw(forces)]}
        else:
            load["torque"] = f"{self.draw(lengths)} N m"
        if self.draw(st.booleans()):
            load |= {"from": self.draw(right_angles), "to": self.draw(right_angles)}
        return load

    def document(self) -> Document:
        draw = self.draw
        for _ in range(draw(st.integers(0, 4))):
            self.grow()
        loads = [self.load() for _ in range(draw(st.integers(0, 2)))]
        joints = list(self.assembly)
        if joints and draw(st.integers(0, 3)) == 0:
            del self.assembly[draw(st.sampled_from(joints))]
        position: Document = {}
        if draw(st.integers(0, 2)) == 0:
            known = sorted({point for points in self.points.values() for point in points})
            chosen = draw(st.lists(st.sampled_from(known), unique=True))
            position["position"] = {"points": {point: draw(coordinates) for point in chosen}}
        speeds = ("100 rpm", "-3000 rpm", "0 rpm", "1e25 rpm", "1e-20 rad/s")
        return {
            "schema": 1,
            "title": "random",
            "drive": {
                "link": "crank",
                "speed": draw(st.sampled_from(speeds)),
                "acceleration": draw(st.sampled_from(("0 rad/s^2", "1e9 rad/s^2"))),
            },
            "frame": {"points": self.points["frame"]},
            "links": {
                name: {"points": points, **self.masses()}
                for name, points in self.points.items()
                if name != "frame"
            },
            "assembly": self.assembly,
            "sliders": self.sliders,
            "gears": self.gears,
            "loads": loads,
            **position,
        }


@st.composite
def linkages(draw: Draw) -> Document:
    return Draft(draw).document()


@given(linkages(), commands)
@fuzz(200)
def test_random_linkages(document: Document, words: tuple[str, ...]) -> None:
    try_bytes(tomli_w.dumps(document).encode(), words)


# -- arguments -------------------------------------------------------------------------------------

# No slash: what is written stays in the folder of the test.
harmless = st.text(st.characters(exclude_characters="/", exclude_categories=[]), max_size=5)
OPTIONS = ("--angles", "--speed", "--acceleration", "--about", "--csv", "--json", "--split",
           "--help", "--version", "-h", "--", "-", "--no-json", "--FILE", "--angles=",
           "--speed=1 rpm", "--json=1")  # fmt: skip
VALUES = ("7", "0", "-1", "1e9", "1 deg", "-1 deg, 2 turn", "1e29 deg", "1e18 deg", "-5 rpm", "",
          "1e29 rpm", "0 rpm", "A", "Q", "1 mm, -2 mm", "1e29 m, 0 mm", ",", "new.toml", "..",
          "x" * 300, "--json")  # fmt: skip
words = st.sampled_from(OPTIONS) | st.sampled_from(VALUES) | st.sampled_from(VALUES) | harmless
first = st.sampled_from(("analyze", "analyze", "check", "new", "examples", "schema", "analyse"))
vectors = st.tuples(
    first.map(lambda word: [word]) | st.just([]),
    st.sampled_from(EXAMPLES).map(lambda word: [word]) | st.just([]),
    st.lists(words, max_size=6),
).map(lambda parts: [word for part in parts for word in part])


@given(vectors)
@fuzz(120)
def test_random_arguments(arguments: list[str]) -> None:
    checked(equipoise(*arguments))


def some_of(options: dict[str, tuple[str, ...]]) -> st.SearchStrategy[list[str]]:
    """Any of some options, each with one of its values."""
    drawn = (
        st.just([]) | st.sampled_from([[option, value] for value in values])
        for option, values in options.items()
    )
    return st.tuples(*drawn).map(lambda parts: [word for part in parts for word in part])


EXTREME = {
    "--angles": ("3", "1e29 deg", "-1e17 deg", "1e-29 rad", "0 deg, 0 deg", "1e12 turn"),
    "--speed": ("1e29 rad/s", "-1e-29 rad/s", "0 rpm"),
    "--acceleration": ("1e29 rad/s^2", "-1e-29 rad/s^2"),
    "--about": ("1e29 m, 1e29 m", "1e-29 m, 0 m"),
}


# Arguments at random, and values one by one, are tried on every change.
@pytest.mark.exhaustive
@given(
    st.sampled_from(EXAMPLES),
    some_of(EXTREME),
    st.sampled_from(((), ("--json",), ("--json", "--split"))),
)
@fuzz(40)
def test_extreme_arguments(name: str, words: list[str], output: tuple[str, ...]) -> None:
    checked(equipoise("analyze", name, *words, *output), bool(output))


SPEEDS = {
    "--speed": ("1e29 rpm", "-1e-29 rpm", "0 rpm", "1e-29:1e29 rpm", "-3:-300 rpm", "9:8 rpm",
                "1:2:3 rpm", "5:6", ":", "x", ""),
    "--speeds": ("0", "2", "-1", "9", "1e9", "20001", "x"),
    "--model": ("linear", "torque", "moment", "best", ""),
    "--units": ("", "um, rad/s", "kg", ",", "mm, mm", "[bold]"),
    "--csv": ("result.csv", "", "."),
}  # fmt: skip
CARRIED_ONES = ("yamashita-rig", "walking-transplanter", "riding-transplanter", "lee-kim-a")


@given(st.sampled_from(CARRIED_ONES), some_of(SPEEDS))
@fuzz(60)
def test_extreme_speeds(name: str, words: list[str]) -> None:
    result = equipoise("respond", name, *words, "--json")
    if result.err != "wrote result.csv\n":
        checked(result, True)


# -- sizes -----------------------------------------------------------------------------------------

OF_UNIT = {"mm": "length", "m": "length", "g": "mass", "kg": "mass", "kg mm^2": "inertia",
           "kg m^2": "inertia", "rpm": "speed", "N": "force", "N m": "force"}  # fmt: skip
FACTORS = {
    "length": (1e-25, 1e-12, 1e-6, 1, 1, 1e6, 1e15, 1e30),
    "mass": (0, 1e-25, 1, 1, 1e15, 1e30),
    "inertia": (0, 1e-20, 1, 1, 1e20, 1e32),
    "speed": (0, -1e-25, 1, 1, 1e10, 1e28),
    "force": (1e-20, 1, 1e28),
}


def resized(value: Any, factors: dict[str, float]) -> Any:
    if isinstance(value, dict):
        return {key: resized(item, factors) for key, item in value.items()}
    if isinstance(value, list):
        return [resized(item, factors) for item in value]
    number, _, unit = str(value).partition(" ")
    if unit not in OF_UNIT or not isinstance(value, str):
        return value
    return f"{float(number) * factors[OF_UNIT[unit]]!r} {unit}"


@given(
    st.sampled_from(EXAMPLES),
    st.fixed_dictionaries({key: st.sampled_from(values) for key, values in FACTORS.items()}),
    commands,
)
@fuzz(40)
def test_machines_of_every_size(
    name: str, factors: dict[str, float], words: tuple[str, ...]
) -> None:
    try_bytes(tomli_w.dumps(resized(example(name), factors)).encode(), words)


# -- what the search has found ---------------------------------------------------------------------

STANDING = """
schema = 1
title = "A crank, and a dyad that stands still"
drive = {{ link = "crank", speed = "100 rpm" }}
frame.points.A = ["0 mm", "0 mm"]
frame.points.G = ["100 mm", "0 mm"]
links.crank.points.A = ["0 mm", "0 mm"]
links.one.points = {{ A = ["0 mm", "0 mm"], J = ["{0} mm", "0 mm"] }}
links.other.points = {{ {1} = ["0 mm", "0 mm"], J = ["50 mm", "0 mm"] }}
assembly.J = "left"
"""
GEARED = """
links.wheel.points.G = ["0 mm", "0 mm"]
[[gears]]
between = ["one", "wheel"]
ratio = -2
"""
FOUND = {
    "both links on one pin": STANDING.format(50, "A"),
    "stretched out": STANDING.format(50, "G"),
    "geared to a link that stands still": STANDING.format(80, "G") + GEARED,
}


@pytest.mark.parametrize("text", FOUND.values(), ids=FOUND)
@pytest.mark.parametrize("words", COMMANDS)
def test_dyads_that_stand_still(text: str, words: tuple[str, ...]) -> None:
    try_bytes(text.encode(), words)
