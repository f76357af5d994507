"""A drawing of lines as the skeleton of a machine: lines are links, ends that meet are pins."""

from __future__ import annotations

from cmath import phase
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from itertools import chain, combinations, pairwise
from string import ascii_uppercase

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, at_place, unknown
from equipoise.exchange.reading.imported import NoteTaker, Read, SlotLine, free, outline_of
from equipoise.i18n import Note
from equipoise.mechanism.parts.element_kinds import part_kinds
from equipoise.mechanism.parts.machine import FRAME, Machine

MOST = 1000
"""Corners of lines, and circles, beyond which a drawing is none of a skeleton."""
COINCIDENT = 1e-6
"""Distance over the size of the drawing below which ends meet, by default."""
PIVOT = 0.2
"""Radius over the size of the drawing above which a circle marks no pivot."""
NEARLY = 0.01
"""Distance over the size of the drawing below which ends that do not meet may be meant to."""
FRAMES = ("frame", "ground", "fixed", "base")
GUIDES = ("guide", "slider", "rail")
"""Default names of what stands still, and of lines on which ends slide."""
IGNORED = ("path", "part", "dimensions", "pitch", "names", *part_kinds(Machine))
"""First words of layers of what `export` draws beside the links."""
WORDS = "names"
"""Layer of names of points, among them."""
LINK = "link "
"""Before the name of a link in its layer there."""


FARTHEST = 1e9
"""m, from the origin; farther away floats are coarser than a tenth of a micrometre."""


def within_reach(place: complex) -> complex:
    """A place of a drawing, m.

    Raises
    ------
    ModelError : no machine is there, or it is no number.
    """
    if not abs(place) < FARTHEST:
        raise ModelError(
            "", Note("a line lies beyond all machines; check the drawing's coordinates")
        )
    return place


@dataclass(frozen=True)
class DrawnLine:
    """A line with corners; `closed` where it comes back.  places : m.  names : by which it goes."""

    places: tuple[complex, ...]
    names: tuple[str, ...] = ()
    closed: bool = False

    @property
    def sides(self) -> Iterator[tuple[complex, complex]]:
        yield from pairwise((*self.places, *(self.places[:1] if self.closed else ())))

    def distance(self, place: complex) -> float:
        """From a place to the nearest point of it, m."""
        return min((_distance(place, *side) for side in self.sides),
                   default=abs(place - self.places[0]))  # fmt: skip

    def holds(self, place: complex) -> bool:
        """Whether a place lies inside, as of an area."""
        x, y = place.real, place.imag
        crossed = ((a, b) for a, b in self.sides if (a.imag > y) != (b.imag > y))
        right = (x < a.real + (y - a.imag) / (b.imag - a.imag) * (b - a).real for a, b in crossed)
        return sum(right) % 2 == 1


@dataclass(frozen=True)
class Ring:
    """A circle, of a radius in m."""

    center: complex
    radius: float
    names: tuple[str, ...] = ()


@dataclass
class Drawing(NoteTaker):
    """What is drawn: lines, circles and points, hatched areas, and words where they are."""

    title: str
    strokes: list[DrawnLine] = field(default_factory=list)
    rings: list[Ring] = field(default_factory=list)
    areas: list[DrawnLine] = field(default_factory=list)
    words: list[tuple[complex, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Marks:
    """How a drawing is to be taken.

    frame, guide : names of what stands still and of lines to slide on; the usual ones if empty.
    link : names, what is drawn under each of which is one link.
    tolerance : distance below which ends meet, m; 0 for a millionth of the drawing.
    """

    frame: tuple[str, ...] = ()
    guide: tuple[str, ...] = ()
    link: tuple[str, ...] = ()
    tolerance: float = 0.0


def skeleton(drawing: Drawing, marks: Marks) -> Read:
    """The machine of a drawing.

    Raises
    ------
    ModelError : there is no line, or a name that is given is in none of them.
    """
    if not drawing.strokes:
        raise ModelError("", Note("there is no line in it that could be a link"))
    _check(drawing, marks)
    return _Skeleton(drawing, marks).read()


def _check(drawing: Drawing, marks: Marks) -> None:
    every: list[DrawnLine | Ring] = [*drawing.strokes, *drawing.rings, *drawing.areas]
    known = dict.fromkeys(name for item in every for name in item.names)
    for option in ("frame", "guide", "link"):
        for name in getattr(marks, option):
            if name.casefold() not in {item.casefold() for item in known}:
                raise ModelError(
                    "",
                    at_place(
                        f"--{option}",
                        unknown(name, known, "layer, colour or group"),
                    ),
                )


def _distance(place: complex, start: complex, end: complex) -> float:
    way = end - start
    length = abs(way) ** 2
    share = ((place - start) * way.conjugate()).real / length if length else 0.0
    return abs(place - start - min(max(share, 0.0), 1.0) * way)


def _named(item: DrawnLine | Ring, names: Iterable[str]) -> bool:
    own = {part for name in item.names for part in (name.casefold(), _first(name))}
    return any(name.casefold() in own for name in names)


def _first(name: str) -> str:
    """The first word of a name."""
    return name.casefold().partition(" ")[0]


class _Skeleton:
    def __init__(self, drawing: Drawing, marks: Marks) -> None:
        self.drawing, self.marks = drawing, marks
        frames, guides = marks.frame or FRAMES, marks.guide or GUIDES
        every: list[DrawnLine | Ring] = [*drawing.strokes, *drawing.rings]
        self.grounds = [item for item in every if _named(item, frames)]
        self.guides = [stroke for stroke in drawing.strokes if _named(stroke, guides)]
        taken = {id(ground) for ground in (*self.grounds, *self.guides)}
        ignored = [item for item in every if _first((*item.names, "")[0]) in IGNORED]
        if ignored:
            drawing.note(
                Note(
                    "{count} lines and circles on layers without links or guides are left out",
                    count=len(ignored),
                )
            )
        taken |= {id(item) for item in ignored}
        lines = [stroke for stroke in drawing.strokes if id(stroke) not in taken]
        rings = [ring for ring in drawing.rings if ring not in ignored]
        corners = sum(len(line.places) for line in (*lines, *self.grounds, *self.guides)
                      if isinstance(line, DrawnLine))  # fmt: skip
        if max(corners, len(rings)) > MOST:
            raise ModelError(
                "",
                Note(
                    "it has more than {most} corners of lines, or circles; give a skeleton",
                    most=MOST,
                ),
            )
        places = [place for stroke in drawing.strokes for place in stroke.places]
        xs, ys = zip(*((place.real, place.imag) for place in places), strict=True)
        self.size = max(max(xs) - min(xs), max(ys) - min(ys))
        self.tolerance = marks.tolerance or COINCIDENT * self.size
        self.pivots = self._pivots(rings, lines)
        self.joints: list[complex] = [pivot.center for pivot in self.pivots]
        self.bodies = [*self._bodies(lines)]

    def read(self) -> Read:
        if not self.bodies:
            raise ModelError(
                "", Note("all its lines are of the frame or guides; none is left for a link")
            )
        points = self._points()
        names = self._names([strokes for strokes, _ in self.bodies])
        links = {name: [points[corner] for corner in corners]
                 for name, (_, corners) in zip(names, self.bodies, strict=True)}  # fmt: skip
        places = {name: self.joints[number] for number, name in points.items()}
        frame = [points[point] for point in points if self._still(point)]
        slots = []
        for guide in self.guides:
            on = self._carrier(guide, links)
            own = frame if on == FRAME else links[on]
            start, end = guide.places[0], guide.places[-1]
            on_guide = (
                point for point in points if guide.distance(self.joints[point]) <= self.tolerance
            )
            sliding = [points[item] for item in on_guide if points[item] not in own]
            if sliding:
                through = free("G", places)
                places[through] = start
                own.append(through)
                slots += [SlotLine(point, on, through, phase(end - start)) for point in sliding]
        outline = outline_of(self.drawing.title, places, links, frame, slots)
        return Read(
            outline, notes=tuple(self.drawing.notes), hints=tuple(self._hints(links, frame))
        )

    def _hints(self, links: Mapping[str, Sequence[str]], frame: Sequence[str]) -> Iterator[str]:
        """Ends that nearly meet, and links that are joined to nothing."""
        ends = sorted({number for _, corners in self.bodies for number in corners})
        gaps = (abs(self.joints[end] - self.joints[other]) for end, other in combinations(ends, 2))
        gap = min((gap for gap in gaps if self.tolerance < gap < NEARLY * self.size), default=0.0)
        if gap:
            wide = float(f"{2e3 * gap:.1g}")
            yield Note(
                "two ends nearly meet, {gap} mm apart; --tolerance '{wide} mm' would join them",
                gap=f"{1e3 * gap:.2g}",
                wide=f"{wide:g}",
            )
        holders = Counter(chain(frame, *links.values()))
        for name, points in links.items():
            if all(holders[point] == 1 for point in points):
                yield Note(
                    "{name!r} is joined to nothing; leave it out of the drawing, or join it",
                    name=name,
                )

    def _carrier(self, guide: DrawnLine, links: Iterable[str]) -> str:
        """Body with a guide: the link that its name has behind "on", else the frame."""
        for name in guide.names:
            _, word, on = name.rpartition(" on ")
            if on in links:
                return on
            if word and on.casefold() not in (self.marks.frame or FRAMES):
                self.drawing.note(
                    Note(
                        "{name!r} is taken to stand still: no link is called {on!r}",
                        name=name,
                        on=on,
                    )
                )
        return FRAME

    # -- lines and corners ---------------------------------------------------------------------

    def _pivots(self, rings: Iterable[Ring], lines: Sequence[DrawnLine]) -> list[Ring]:
        """Circles that mark pivots: small ones, the largest of those about one place, and none
        about another pivot, such as a gear, or about a whole link that begins in its middle, such
        as a flywheel.
        """
        items: list[Ring] = []
        for ring in sorted(rings, key=lambda circle: circle.radius):
            if not 0 < ring.radius < PIVOT * self.size:
                continue
            inside = [item for item in items if abs(item.center - ring.center) <= ring.radius]
            apart = any(abs(item.center - ring.center) > self.tolerance for item in inside)
            if not apart and not any(self._swallows(ring, line) for line in lines):
                items = [*(item for item in items if item not in inside), ring]
        return items

    def _swallows(self, ring: Ring, line: DrawnLine) -> bool:
        off = [abs(place - ring.center) for place in line.places]
        return min(off) <= self.tolerance and max(off) <= max(1.01 * ring.radius, self.tolerance)

    def _bodies(self, lines: Sequence[DrawnLine]) -> Iterator[tuple[list[DrawnLine], list[int]]]:
        """Strokes of each link, and the numbers of its corners; a line drawn twice is one."""
        groups = [[line for line in lines if _named(line, [name])] for name in self.marks.link]
        grouped = {id(item) for group in groups for item in group}
        groups += [[line] for line in lines if id(line) not in grouped]
        used = set()
        for group in groups:
            corners = [*dict.fromkeys(self._joint(z) for item in group for z in item.places)]
            on = (
                number
                for number, ring in enumerate(self.pivots)
                if any(item.distance(ring.center) <= self.tolerance for item in group)
            )
            corners = [*dict.fromkeys((*corners, *on))]
            if len(corners) < 2:
                self.drawing.note(Note("lines that lie wholly in a circle of a pivot are left out"))
            elif frozenset(corners) not in used:
                used.add(frozenset(corners))
                yield group, corners

    def _joint(self, place: complex) -> int:
        """The number of a corner; ends in a circle go to its centre."""
        for number, ring in enumerate(self.pivots):
            if abs(place - ring.center) <= max(1.01 * ring.radius, self.tolerance):
                return number
        known = (n for n, other in enumerate(self.joints) if abs(place - other) <= self.tolerance)
        count = next(known, None)
        if count is None:
            self.joints.append(place)
            count = len(self.joints) - 1
        return count

    def _points(self) -> dict[int, str]:
        """Names of the corners that links have: the word that stands there, else A to Z, then P1
        and so on.
        """
        used = dict.fromkeys(number for _, corners in self.bodies for number in corners)
        texts: dict[int, str] = {}
        for place, word in self.drawing.words:
            close = (item for item in used if abs(self.joints[item] - place) <= self.tolerance)
            if (at := next(close, None)) is not None and word not in texts.values():
                texts.setdefault(at, word)
        names = (*ascii_uppercase, *(f"P{number}" for number in range(1, len(used) + 1)))
        free_names = (name for name in names if name not in texts.values())
        return {item: texts.get(item) or next(free_names) for item in used}

    def _names(self, links: Sequence[Sequence[DrawnLine]]) -> Iterator[str]:
        """The first name that is that of one link alone, or a number."""
        own = [dict.fromkeys(name.removeprefix(LINK) for stroke in strokes for name in stroke.names)
               for strokes in links]  # fmt: skip
        taken: set[str] = {FRAME}
        for names in own:
            alone = (name for name in names if sum(name in other for other in own) == 1
                     and name not in taken and name.isprintable() and len(name) < 60)  # fmt: skip
            name = next(alone, "") or free("link", taken)
            taken.add(name)
            yield name

    # -- what stands still ---------------------------------------------------------------------

    def _still(self, number: int) -> bool:
        """Whether a corner lies on the frame: on what is named so, in a hatching, or, where
        nothing marks the frame, in a circle at the end of one link only.
        """
        place = self.joints[number]
        for ground in self.grounds:
            off = (
                abs(place - ground.center) - ground.radius
                if isinstance(ground, Ring)
                else ground.distance(place)
            )
            if off <= self.tolerance:
                return True
        if any(
            area.holds(place) or area.distance(place) <= self.tolerance
            for area in self.drawing.areas
        ):
            return True
        links = sum(number in corners for _, corners in self.bodies)
        return not (self.grounds or self.drawing.areas) and number < len(self.pivots) and links == 1
