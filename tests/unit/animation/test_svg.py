"""Moving pictures, read back as a browser would and held to the motion they show."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import combinations, pairwise
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures.animation import _sizes_where_narrow, animated_svg, laid_out
from equipoise.figures.motion import followed
from equipoise.figures.stage import ForceArrow, width_of
from equipoise.figures.swing import swinging
from equipoise.i18n import speaking
from equipoise.symbols.scene import Scene
from support.refusals import refused
from unit.animation.samples import analyzed, of_three_turns, prepared, shown

NAME = "{http://www.w3.org/2000/svg}"
STEP = re.compile(
    r"([\d.]+)%\{transform:translate\(([-\d.]+)px,([-\d.]+)px\)rotate\(([-\d.]+)deg\)"
    r"(?:scale\(([-\d.]+),1\))?\}"
)
ROUNDED = 0.1
"""Pixels: places and angles have two decimals, and an angle acts over up to 600 pixels."""


class Picture:
    """What a browser makes of an animation: places of shapes at the instants of its keyframes."""

    def __init__(self, text: str) -> None:
        self.root = ElementTree.fromstring(text)
        style = self.root.findtext(f"{NAME}style") or ""
        self.style = style
        self.moves = {}
        for number, steps in re.findall(r"@keyframes e\w+-(\d+)\{(.*)\}", style):
            rows = [[float(v or 1) for v in row] for row in STEP.findall(steps)]
            assert len(rows) == steps.count("%")
            self.moves[number] = np.array(rows).T

    def groups(self) -> Iterator[tuple[ElementTree.Element, np.ndarray | None]]:
        for group in self.root.iter(f"{NAME}g"):
            match = re.search(r"m(\d+)", group.get("class", ""))
            yield group, None if match is None else self.moves[match[1]]

    def circles(self, look: str) -> list[np.ndarray]:
        """Place of each circle of a look at each instant, pixels; (1,) where it stands still."""
        actual = []
        for group, move in self.groups():
            for circle in group.iter(f"{NAME}circle"):
                if circle.get("class") == look:
                    own = complex(float(circle.get("cx")), float(circle.get("cy")))
                    actual.append(np.array([own]) if move is None else placed(move, own))
        return actual

    def ends(self, look: str) -> list[np.ndarray]:
        """The same of the points of each path of a look, (points, instants)."""
        actual = []
        for group, move in self.groups():
            for path in group.iter(f"{NAME}path"):
                if path.get("class") == look and move is not None:
                    numbers = re.findall(r"(-?[\d.]+) (-?[\d.]+)", path.get("d"))
                    own = [complex(float(x), float(y)) for x, y in numbers]
                    actual.append(np.array([placed(move, z) for z in own]))
        return actual


def placed(move: np.ndarray, own: complex) -> np.ndarray:
    _, x, y, angle, stretch = move
    return x + 1j * y + (own.real * stretch + 1j * own.imag) * np.exp(1j * np.radians(angle))


def pixels(picture: Picture, scene: Scene, item: str, other: str):
    """Pixels of a place in m, as two pivots have them."""
    still = [circle[0] for circle in picture.circles("pin") if len(circle) == 1]
    held = scene.pins.union(to for _, to in scene.springs)
    at = dict(zip([name for name in scene.frame if name in held], still, strict=True))
    first, second = scene.places[item][0], scene.places[other][0]
    turn = (at[other] - at[item]) / np.conj(second - first)
    assert abs(turn.imag) < 1e-3 * turn.real
    return lambda place: at[item] + np.conj(place - first) * turn


CASES = [("watt-six-bar", "A", "G"), ("geared-counterweight", "O2", "E"), ("yamashita-1", "A", "D")]


@pytest.mark.parametrize(("name", "pin", "other"), [*CASES, ("quick-return", "A", "D")])
def test_pins_are_where_the_motion_has_them(name: str, pin: str, other: str) -> None:
    _, scene, _ = analyzed(name)
    picture = Picture(animated_svg(scene, title=name, frames=40))
    to_pixels = pixels(picture, scene, pin, other)
    circles = [circle for circle in picture.circles("pin") if len(circle) > 1]
    moving = [name for name in scene.pins if name not in scene.frame]
    assert len(circles) == len(moving)
    every = [to_pixels(shown(scene, scene.places[name], 40)) for name in moving]
    for circle in circles:
        off = [abs(circle[:-1] - place).max() for place in every]
        assert min(off) < ROUNDED
        assert circle[0] == pytest.approx(circle[-1], abs=ROUNDED)


@pytest.mark.parametrize(("name", "pin", "other"), CASES)
def test_links_reach_from_pin_to_pin(name: str, pin: str, other: str) -> None:
    _, scene, _ = analyzed(name)
    picture = Picture(animated_svg(scene, title=name, frames=30))
    to_pixels = pixels(picture, scene, pin, other)
    places = {key: to_pixels(shown(scene, place, 30)) for key, place in scene.places.items()}
    drawn = [corner[:-1] for corners in picture.ends("body") for corner in corners]
    for body in scene.bodies:
        for point in body.outline if len(body.outline) > 1 else ():
            assert min(abs(corner - places[point]).max() for corner in drawn) < ROUNDED


def test_the_arrow_ends_on_the_curve_of_the_force_and_is_in_its_direction() -> None:
    actual, scene, arrow = analyzed("yamashita-1")
    picture = Picture(animated_svg(scene, title="", frames=40, arrow=arrow))
    (shaft,), (head,) = picture.ends("force"), picture.ends("force-head")
    force = np.conj(shown(scene, actual.forces.shaking_force.value, 40))
    reach = (head[0] - shaft[0])[:-1]
    per_newton = abs(reach[0]) / abs(force[0])
    np.testing.assert_allclose(reach, force * per_newton, atol=2 * ROUNDED)
    assert abs(shaft[1] - head[0]).max() < 13  # it ends within its head


def test_a_spring_hangs_between_its_ends() -> None:
    _, scene, _ = analyzed("spring-balanced-crank")
    picture = Picture(animated_svg(scene, title="", frames=40))
    to_pixels = pixels(picture, scene, "A", "D")
    (spring,) = picture.ends("spring")
    for end, name in zip((spring[0], spring[-1]), scene.springs[0], strict=True):
        place = to_pixels(shown(scene, scene.places[name], 40))
        assert abs(end[:-1] - place).max() < 0.3  # its stretch has four decimals


def test_blocks_stay_in_their_slots() -> None:
    _, scene, _ = analyzed("scotch-yoke")
    picture = Picture(animated_svg(scene, title="", frames=40))
    slot, *blocks = (box.mean(axis=0) for box in picture.ends("slot") + picture.ends("block"))
    outline = picture.ends("slot")[0]
    half = [abs(outline[k + 1] - outline[k]) / 2 for k in (0, 1)]
    way = (outline[1] - outline[0]) / abs(outline[1] - outline[0])
    aside = (blocks[0] - slot) / way
    assert abs(aside.imag).max() < ROUNDED
    assert np.all(abs(aside.real) < half[0])


def test_wheels_of_many_turns_turn_on_and_end_as_they_began() -> None:
    _, scene, _ = prepared(of_three_turns(720))
    text = animated_svg(scene, title="", frames=40, seconds=2.0)
    picture = Picture(text)
    assert "animation-duration:6s" in text
    for times, *_, angle, _ in picture.moves.values():
        assert times[0] == 0 and times[-1] == 100 and len(times) == 3 * 40 + 1
        whole = (angle[-1] - angle[0]) / 360
        assert whole == pytest.approx(round(whole), abs=1e-3)
        assert abs(np.diff(angle)).max() < 60
    assert max(abs(angle[-1] - angle[0]) for _, _, _, angle, _ in picture.moves.values()) >= 3 * 360


def test_part_of_a_turn_goes_there_and_back() -> None:
    motion = eq.move(eq.load("yamashita-1"), np.radians(np.linspace(20, 140, 121)))
    text = animated_svg(Scene.of(motion), title="", frames=60, seconds=3)
    assert "animation-direction:alternate" in text
    assert "animation-duration:1s" in text
    place = next(iter(Picture(text).moves.values()))
    assert len(place[0]) == 21


def test_pictures_on_one_page_do_not_disturb_each_other() -> None:
    texts = []
    for name in ("yamashita-1", "yamashita-2"):
        _, scene, arrow = analyzed(name, 90)
        texts.append(animated_svg(scene, title='<"one" & two>', traced=["P"], arrow=arrow))
        assert texts[-1] == animated_svg(scene, title='<"one" & two>', traced=["P"], arrow=arrow)
    marks = []
    for text in texts:
        root = ElementTree.fromstring(text)
        assert not any(element.get("id") for element in root.iter())
        assert root.findtext(f"{NAME}title") == '<"one" & two>'
        assert root.get("role") == "img"
        assert "<script" not in text and text.count("http") == 1  # the name of SVG itself
        (mark,) = set(re.findall(r"@keyframes (e\w+)-", text))
        marks.append(mark)
        style = root.findtext(f"{NAME}style") or ""
        rules = re.sub(r"@keyframes .*|@media[^{]*\{", "", style)
        assert all(mark in rule for rule in re.findall(r"[^{}]+(?=\{)", rules))
        for media in ("prefers-reduced-motion:reduce", "print"):
            assert re.search(rf"@media \(?{media}\)?\{{\.{mark} \.m\{{animation:none\}}\}}", style)
    assert len(set(marks)) == 2


def test_a_six_bar_is_small_and_speaks_the_language_of_the_reader() -> None:
    _, scene, arrow = analyzed("watt-six-bar")
    with speaking("ja"):
        text = animated_svg(scene, title="ワット", arrow=arrow)
    assert len(text.encode()) < 60_000
    assert "起振力" in text


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"traced": ["Q"]}, {"given": "Q"}),
        ({"traced": ["A"]}, {"name": "A"}),
        ({"seconds": 0.0}, {"most_seconds": 600, "seconds": 0.0}),
        ({"width": 4000}, {"low": 100, "width": 4000}),
    ],
)
def test_what_cannot_be_drawn_is_reported(
    options: dict[str, object], expected: dict[str, Any]
) -> None:
    _, scene, _ = analyzed("yamashita-1", 90)
    with refused(UsageError, **expected):
        animated_svg(scene, title="", **options)


def test_one_crank_angle_does_not_move() -> None:
    scene = Scene.of(eq.move(eq.load("yamashita-1"), [0.3]))
    with refused(UsageError, by="laid_out"):
        animated_svg(scene, title="")


def test_what_is_said_of_a_support_fits_where_the_picture_is_narrow() -> None:
    """Letters are larger there; lines of the strip neither touch nor run out of the picture."""
    rig = eq.load("yamashita-rig")
    moving = swinging(Scene.of(eq.move(rig, 720)), eq.respond(rig), factor=2.0)
    picture = Picture(animated_svg(moving, title="rig"))
    narrow = picture.style.partition("@media (max-width:")[2]
    size = float(re.findall(r"text\.strip\{font-size:([\d.]+)px\}", narrow)[0])
    strip = [item for item in picture.root.iter(f"{NAME}text") if "strip" in item.get("class", "")]
    assert len(strip) > 1 and size >= 12
    places = sorted({float(item.get("y", "")) for item in strip})  # the lowest beside the ruler
    assert min(b - a for a, b in pairwise(places)) > size
    assert all(width_of(item.text or "", size) <= float(item.get("x", "")) for item in strip)


def test_texts_lie_apart_and_inside_where_the_picture_is_narrow() -> None:
    """Names beside the machine, the ruler's length, and lines of the strip: none on another."""
    for name in ("sieve", "yamashita-rig", "riding-transplanter"):
        machine = eq.load(name)
        analysis, response = eq.analyze(machine), eq.respond(machine)
        scene = swinging(Scene.of(analysis.motion).with_rows(analysis.motion), response)
        moving = laid_out(scene, (), width=440, arrow=ForceArrow.of(analysis))
        larger, strip = _sizes_where_narrow(moving.stage)
        boxes = [label.box(strip if label.in_strip else larger) for label in moving.labels]
        assert all(left >= 0 and right <= moving.stage.width for left, _, right, _ in boxes)
        for a, b in combinations(boxes, 2):
            beside = a[2] <= b[0] or b[2] <= a[0]
            above = min(a[3], b[3]) - max(a[1], b[1]) <= 0.25 * strip  # of letters without tails
            assert beside or above, name


def test_links_that_cover_each_other_move_in_turn() -> None:
    """Each walker by itself, below the one before, and what is not a walker in each."""
    scene = Scene.of(eq.move(eq.load("straw-walker"), 90))
    root = ElementTree.fromstring(animated_svg(scene, title="walkers", traced=("T1", "T2")))
    parts = root.findall(f"{NAME}svg")
    assert [part.findtext(f"{NAME}title") for part in parts] == [
        f"walker-{number}" for number in (1, 2, 3, 4)
    ]
    tops = [float(part.get("y", "nan")) for part in parts]
    heights = [float(part.get("height", "nan")) for part in parts]
    assert tops == [sum(heights[:number]) for number in range(4)]
    assert float(root.get("height", "nan")) == sum(heights)
    texts = [{text.text for text in part.iter(f"{NAME}text")} for part in parts]
    assert [sorted(each & {"T1", "T2"}) for each in texts] == [["T1"], ["T2"], [], []]
    styles = [part.findtext(f"{NAME}style") for part in parts]
    assert len({re.findall(r"@keyframes (e\w+)-1", str(style))[0] for style in styles}) == 4


def test_names_lie_over_the_links_that_pass_them() -> None:
    """The crank of `lee-kim-c` and its counterweight sweep over the name of their pivot."""
    scene = Scene.of(eq.move(eq.load("lee-kim-c"), 90))
    moving = laid_out(scene)
    (pivot,) = (label for label in moving.labels if label.text == "O2")
    left, top, right, bottom = pivot.box(moving.stage.size_of_type)
    x, y = moving.stage.links.real, moving.stage.links.imag
    assert np.any((left < x) & (x < right) & (top < y) & (y < bottom))
    picture = ElementTree.fromstring(animated_svg(scene, title="c"))
    kinds = [part.tag.removeprefix(NAME) for part in picture]
    assert kinds.index("text") > max(k for k, kind in enumerate(kinds) if kind == "g")
    assert "paint-order:stroke;stroke:var(--paper)" in str(picture.findtext(f"{NAME}style"))


def test_each_walker_has_the_path_of_its_end() -> None:
    analysis = eq.analyze(eq.load("straw-walker"), 90)
    names = followed(analysis.motion)
    text = animated_svg(Scene.of(analysis.motion), title="walkers", traced=names)
    parts = ElementTree.fromstring(text).findall(f"{NAME}svg")
    shown = [{word.text for word in part.iter(f"{NAME}text")} for part in parts]
    assert [f"T{number}" in each for number, each in enumerate(shown, 1)] == [True] * 4
    assert all(part.find(f".//{NAME}path[@class='trace']") is not None for part in parts)
