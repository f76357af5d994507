"""Machines of any kind, from nothing: model files that nobody has looked at, by a seed.

One half grows dyad by dyad, gear by gear: any body may carry the next, so that inner joints share
points, cranks stop and sides change.  The other half begins with a random machine of a kind of its
own (`machines`, `machines_cams`, `machines_redundant`, `machines_strokes`).  Both are given drives,
motions, motors, loads, springs, soils, supports, rows, sections, bearings, further gears whose
cycle is long, and a balance; what may stand in a table is read from a file now and then.
Most can be analysed; what cannot has to be refused in a sentence.
"""

from __future__ import annotations

import random
import tomllib
from cmath import exp, phase, pi, rect
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.models import taken_along
from support import machines, machines_cams, machines_planes, machines_redundant

Document = dict[str, Any]
Files = dict[str, str]
"""Text by name."""
LAWS = ("modified sine", "cycloidal", "3-4-5", "harmonic", "s-curve")


def mm(value: float) -> str:
    return f"{value:.9g} mm"


def deg(angle: float) -> str:
    return f"{np.degrees(angle):.6g} deg"


def pair(place: complex, unit: str = "mm") -> list[str]:
    return [f"{place.real:.9g} {unit}", f"{place.imag:.9g} {unit}"]


class Growing:
    """A linkage drawn at crank angle 0, in mm, that grows body by body.

    bodies : points by name, in the frame's axes.  far : about how far each body moves, mm.
    """

    def __init__(self, chance: random.Random) -> None:
        self.chance = chance
        size = 10 ** chance.uniform(1, 2)
        crank = rect(size, 0.0)
        self.size = size
        self.bodies: dict[str, dict[str, complex]] = {
            "frame": {"A": 0j}, "crank": {"A": 0j, "B": crank}
        }  # fmt: skip
        self.far = {"frame": 0.0, "crank": size}
        self.document: Document = {"assembly": {}, "sliders": [], "gears": [], "belts": [],
                                   "circular_slots": [], "curved_slots": []}  # fmt: skip
        self.loops = False

    # -- where the next joint is -------------------------------------------------------------------

    def body(self, moving: bool = False) -> str:
        names = [name for name in self.bodies if name != "frame" or not moving]
        return self.chance.choice(names[-4:] if self.chance.random() < 0.7 else names)

    def joint(self, body: str, others: complex = 0j) -> str:
        """A point of a body: one that there is, such as a pin, or a new one."""
        chance, points = self.chance, self.bodies[body]
        if body != "frame" and chance.random() < 0.7:
            return chance.choice([*points])
        name = f"P{sum(map(len, self.bodies.values()))}"
        way = rect(self.size * chance.uniform(1, 6), chance.uniform(-pi, pi))
        points[name] = (others if body == "frame" else next(iter(points.values()))) + way
        return name

    def link(self, kind: str, **points: complex) -> str:
        name = f"{kind} {len(self.bodies)}"
        self.bodies[name] = points
        return name

    def slide(self, link: str, point: str, on: str, through: str, angle: float) -> None:
        slider = {"link": link, "point": point, "on": on, "through": through,
                  "direction": deg(angle), "angle": deg(-angle)}  # fmt: skip
        if self.chance.random() < 0.1:
            slider["label"] = self.chance.choice(["guide", point, "mode"])
        self.document["sliders"].append(slider)

    def entry(self, joint: str, side: str) -> None:
        """A side in the table, which is left out or wrong now and then."""
        draw = self.chance.random()
        if draw > 0.05:
            wrong = {"left": "right", "forward": "backward"}
            self.document["assembly"][joint] = wrong.get(side, side) if draw > 0.97 else side

    # -- what it can grow by -----------------------------------------------------------------------

    def two_bars(self) -> None:
        single, other = self.body(moving=True), self.body()
        first, second = self.joint(single), self.joint(other)
        p, q = self.bodies[single][first], self.bodies[other][second]
        apart, far = abs(q - p), 1.2 * (self.far[single] + self.far[other])
        total = (apart + far) * self.chance.uniform(1.02, 1.7)
        difference = max(apart - far, 0.0) * self.chance.uniform(-0.9, 0.9)
        long, short = (total + difference) / 2, (total - difference) / 2
        cosine = (apart**2 + long**2 - short**2) / (2 * apart * long) if apart else 0.0
        if not apart or abs(cosine) >= 1:
            return
        sense = self.chance.choice((1, -1))
        inner = p + rect(long, phase(q - p) + sense * float(np.arccos(cosine)))
        name = f"J{len(self.bodies)}"
        self.far[self.link("bar", **{first: p, name: inner})] = far
        self.far[self.link("lever", **{second: q, name: inner})] = far
        self.entry(name, "left" if sense > 0 else "right")

    def rod_and_block(self) -> None:
        single, other = self.body(moving=True), self.body()
        first = self.joint(single)
        p, angle = self.bodies[single][first], self.chance.uniform(-pi, pi)
        through = self.joint(other, p)
        along, base = exp(1j * angle), self.bodies[other][through]
        offset = ((p - base) / along).imag
        far = 1.2 * (self.far[single] + self.far[other])
        rod = (abs(offset) + far) * self.chance.uniform(1.1, 3)
        sense = self.chance.choice((1, -1))
        way = sense * float(np.sqrt(max(rod**2 - offset**2, 0.0)))
        inner = p + along * (way - 1j * offset)
        name = f"J{len(self.bodies)}"
        self.far[self.link("rod", **{first: p, name: inner})] = far
        block = self.link("block", **{name: inner})
        self.far[block] = far
        self.slide(block, name, other, through, angle)
        self.entry(name, "forward" if sense > 0 else "backward")

    def block_on_arm(self) -> None:
        single, other = self.body(moving=True), self.body()
        first, second = self.joint(single), self.joint(other)
        p, q = self.bodies[single][first], self.bodies[other][second]
        if p == q or first == second:
            return
        angle = phase(p - q)
        block = self.link("block", **{first: p})
        arm = self.link("arm", **{second: q})
        far = 1.2 * (self.far[single] + self.far[other])
        self.far[block] = self.far[arm] = far
        if self.chance.random() < 0.7:
            self.slide(block, first, arm, second, angle)
        else:
            self.slide(arm, second, block, first, angle)
        slider = self.document["sliders"][-1]
        taken = first in self.document["assembly"] or self.chance.random() < 0.3
        own = slider.get("label") or f"{slider['link']} on {slider['on']}"
        sense = "forward" if slider["link"] == block else "backward"
        self.entry(own if taken else slider["point"], sense)

    def two_blocks(self) -> None:
        first, other = self.body(moving=True), self.body()
        angle = self.chance.uniform(-pi, pi)
        through, second = self.joint(first), self.joint(other)
        p, q = self.bodies[first][through], self.bodies[other][second]
        other_angle = angle + self.chance.uniform(0.5, 2.6)
        along, across = exp(1j * angle), exp(1j * other_angle)
        way = ((q - p) / across).imag / (along / across).imag
        name = f"J{len(self.bodies)}"
        far = 1.5 * (self.far[first] + self.far[other])
        for kind, on, base, line in (
            ("shoe", first, through, angle),
            ("block", other, second, other_angle),
        ):
            link = self.link(kind, **{name: p + along * way})
            self.far[link] = far
            self.slide(link, name, on, base, line)

    def yoke(self) -> None:
        single = self.body(moving=True)
        first = self.joint(single)
        p, angle = self.bodies[single][first], self.chance.uniform(-pi, pi)
        through = self.joint("frame")
        block, yoke = (
            self.link("block", **{first: p}),
            self.link("yoke", **{f"Y{len(self.bodies)}": p}),
        )
        self.far[block] = self.far[yoke] = self.far[single]
        (point,) = self.bodies[yoke]
        self.slide(block, first, yoke, point, angle + self.chance.uniform(0.4, 2.7))
        self.slide(yoke, point, "frame", through, angle)

    def gear(self) -> None:
        driver = self.body(moving=True)
        carrier = "frame" if self.chance.random() < 0.6 else self.body(moving=True)
        pin = self.joint(carrier)
        wheel = self.link("wheel", **{pin: self.bodies[carrier][pin]})
        self.far[wheel] = self.far[carrier]
        if driver == carrier:
            driver = "frame"
        chance = self.chance
        teeth = [chance.randint(10, 60), chance.randint(10, 60)]
        if chance.random() < 0.25:
            belt = {"between": [driver, wheel], "carrier": carrier, "teeth": teeth, "pitch": "5 mm",
                    "tension": "60 N"}  # fmt: skip
            self.document["belts"].append(belt)
            return
        size: Document = chance.choice(
            [{"teeth": teeth}, {"ratio": chance.choice([-1, -2, 0.5, -0.75])}]
        )
        gear = {"between": [driver, wheel], "carrier": carrier, **size}
        if chance.random() < 0.2:
            gear |= {"teeth": [31, 31], "shape": {"kind": "elliptic", "eccentricity": 0.3}}
            gear.pop("ratio", None)
        self.document["gears"].append(gear)

    def triad(self) -> None:
        """A plate on three bars, which no dyad solves."""
        single = self.body(moving=True)
        first, chance = self.joint(single), self.chance
        p = self.bodies[single][first]
        corners = [
            p + rect(self.size * chance.uniform(2, 4), chance.uniform(-pi, pi)) for _ in range(3)
        ]
        names = [f"{letter}{len(self.bodies)}" for letter in "KLM"]
        pins = [first, self.joint("frame", p), self.joint("frame", p)]
        ends = [p, *(self.bodies["frame"][pin] for pin in pins[1:])]
        self.far[self.link("plate", **dict(zip(names, corners, strict=True)))] = self.far[single]
        for name, corner, pin, end in zip(names, corners, pins, ends, strict=True):
            self.far[self.link("bar", **{pin: end, name: corner})] = self.far[single]
        self.loops = True

    def bar_in_slot(self) -> None:
        """A bar whose pin runs in a slot of another body, a circle, an arc or any curve round."""
        chance, single = self.chance, self.body(moving=True)
        other = "frame" if chance.random() < 0.6 else self.body()
        first, middle = self.joint(single), self.joint(other)
        p, q = self.bodies[single][first], self.bodies[other][middle]
        apart, far = abs(q - p), 1.2 * (self.far[single] + self.far[other])
        if not apart or single == other:
            return
        radius, sense = (apart + far) * chance.uniform(0.6, 1.2), chance.choice((1, -1))
        rod = (apart + far) * chance.uniform(1.1, 1.7) - chance.choice((0, 1)) * radius / 2
        cosine = (apart**2 + rod**2 - radius**2) / (2 * apart * rod)
        if abs(cosine) >= 1:
            return
        pin = p + rect(rod, phase(q - p) + sense * float(np.arccos(cosine)))
        name = f"R{len(self.bodies)}"
        bar = self.link("bar", **{first: p, name: pin})
        self.far[bar], at = far, phase(pin - q)
        slot: Document = {"link": bar, "point": name, "on": other}
        if chance.random() < 0.5:
            wide = chance.uniform(0.3, 3.1)
            arc = [deg(at - wide), deg(at + wide * chance.uniform(0.3, 1))]
            slot |= {"center": middle, "radius": mm(radius)} | chance.choice([{}, {"arc": arc}])
            self.document["circular_slots"].append(slot)
            self.entry(f"{name} in {other}", "left" if sense > 0 else "right")
            return
        slot |= {"origin": middle, "closed": chance.random() < 0.7}
        count, waves = chance.choice((4, 8, 16, 48)), chance.choice((1, 2, 3))
        wave, way = chance.uniform(0, 0.2), 2 * pi if slot["closed"] else chance.uniform(2, 6)
        angles = [way * (k / count - 0.5) for k in range(count)]
        sizes = [radius * (1 + wave * (1 - np.cos(waves * angle))) for angle in angles]
        slot["points"] = [pair(rect(r, at + a)) for r, a in zip(sizes, angles, strict=True)]
        self.document["curved_slots"].append(slot)
        self.loops = True

    def parallel_crank(self) -> None:
        """A four-bar of equal opposite sides on the crank."""
        way = rect(self.size * self.chance.uniform(1.5, 5), self.chance.uniform(-pi, pi))
        number = len(self.bodies)
        a, b, c = f"A{number}", "B", f"C{number}"
        self.bodies["frame"][a] = way
        points = self.bodies["crank"]
        self.far[self.link("coupler", **{b: points["B"], c: points["B"] + way})] = self.size
        self.far[self.link("follower", **{a: way, c: points["B"] + way})] = self.size
        self.entry(c, self.chance.choice(["left", "parallel", "parallel", "antiparallel"]))

    def grown(self) -> Document:
        """The document, with what a file says of links, frame and position."""
        chance = self.chance
        ways: list[Callable[[], None]] = [
            self.two_bars, self.two_bars, self.two_bars, self.rod_and_block, self.rod_and_block,
            self.block_on_arm, self.block_on_arm, self.two_blocks, self.yoke, self.gear, self.gear,
            self.triad, self.parallel_crank, self.bar_in_slot, self.bar_in_slot,
        ]  # fmt: skip
        for _ in range(chance.choice((1, 1, 2, 2, 3, 3, 4, 6))):
            chance.choice(ways)()
        actual = {name: part for name, part in self.document.items() if part}
        links = {name: points for name, points in self.bodies.items() if name != "frame"}
        actual["frame"] = {"points": {name: pair(at) for name, at in self.bodies["frame"].items()}}
        actual["links"] = {name: self.of_link(points) for name, points in links.items()}
        actual["drive"] = {"link": "crank"}
        if self.loops:
            known = {name: pair(at) for points in links.values() for name, at in points.items()}
            actual["position"] = {"points": known}
        return actual

    def of_link(self, points: dict[str, complex]) -> Document:
        chance = self.chance
        shift = rect(self.size, 1.0) if chance.random() < 0.2 else 0j
        center = sum(points.values()) / len(points) - shift
        mass = 10 ** chance.uniform(-1, 1)
        return {
            "points": {name: pair(at - shift) for name, at in points.items()},
            "mass": f"{mass:.4g} kg",
            "center_of_mass": pair(center),
            "inertia": f"{mass * self.size**2 * chance.uniform(0.3, 3):.4g} kg mm^2",
        }


# -- what any machine is given ---------------------------------------------------------------------


def dress(chance: random.Random, document: Document, wanted: str) -> Files:
    """Give a linkage a drive, forces and what carries it; returns the tables that it names."""
    drive = document["drive"]
    likely = {word: chance.random() < 0.9 for word in wanted.split()}
    drive["speed"] = f"{chance.choice((1, -1)) * 10 ** chance.uniform(0.5, 3.5):.4g} rpm"
    tables = _drive(chance, drive, wanted) | _forces(chance, document)
    twist = random.Random(len(str(document)))  # of its own, so that other draws stay as they are
    if twist.random() < 0.3:
        _twisted(twist, document)
    if twist.random() < 0.3 or "friction" in wanted:
        _rubbing(twist, document)
    if "no_load_speed" in drive.get("motor", {}) and twist.random() < 0.5:
        _other_motor(twist, drive["motor"])
    if twist.random() < 0.3:
        _sections(twist, document)
    if twist.random() < 0.3:
        _bearings(twist, document)
    _damped(twist, document)
    if twist.random() < 0.05:
        document["units"] = {"length": "in", "force": "lbf", "angle": "rad", "speed": "ft/s"}
    if chance.random() < 0.3 or likely.get("planting"):
        tables |= _planting(chance, document)
    if chance.random() < 0.35 or likely.get("support"):
        _carried(chance, document)
    if chance.random() < 0.1 or likely.get("rows"):
        document["rows"] = [{}, {"phase": f"{chance.uniform(0, 360):.4g} deg"}]
    if chance.random() < 0.08:
        _long_cycle(chance, document)
    if chance.random() < 0.3:
        link = chance.choice([*document["links"]])
        at = next(iter(document["links"][link]["points"]))
        document["balance"] = {
            "masses": [{"link": link, "at": at, "radius": "80 mm", "mass": "3 kg"}],
            "objectives": [{"output": "shaking_force.y", "measure": "rms"}],
        }
    return tables


def columns(
    chance: random.Random, header: str, end: float, *, rises: bool = True, **size: float
) -> str:
    """A CSV file of the columns of its header: the first rises, or falls, the others are random.

    end : of the first column.  size : by the place of a column, ``c1``, about how large it is.
    """
    count, others = chance.choice((2, 3, 4, 7, 7, 40)), header.count(",")
    first = sorted(chance.uniform(0, end) for _ in range(count))
    rows = [
        [at, *(size.get(f"c{k}", 1.0) * chance.uniform(-1, 1) for k in range(1, others + 1))]
        for at in (first if rises else first[::-1])
    ]
    lines = [",".join(f"{cell:.6g}" for cell in row) for row in rows]
    return "\n".join([header, *lines]) + "\n"


LIKELY = {"even": "plain", "motor": "motor"}
"""Kinds of drives by what is wanted."""


def _drive(chance: random.Random, drive: Document, wanted: str) -> Files:
    pushes = drive.keys() & {"motion", "stroke", "between", "slider"}
    if chance.random() < 0.3:
        drive["acceleration"] = f"{chance.uniform(-20, 20):.4g} rad/s^2"
    if pushes:
        return {}
    kinds = ["plain", "plain", "plain", "motor", "flywheel", "sine", "segments", "spline", "motion"]
    likely = [kind for word, kind in LIKELY.items() if word in wanted]
    match chance.choice(likely if likely and chance.random() < 0.8 else [*kinds, "curve"]):
        case "motor":
            table = {"no_load_speed": f"{10 ** chance.uniform(2, 4):.4g} rpm",
                     "stall_torque": f"{10 ** chance.uniform(-2, 2):.4g} N m",
                     "ratio": round(chance.uniform(1, 30), 2), "inertia": "400 g cm^2"}  # fmt: skip
            drive["motor"] = table | chance.choice([{}, {"mean_speed": "free"}])
        case "flywheel":
            drive["flywheel"] = "0.1 kg m^2"
        case "sine":
            low = chance.uniform(-180, 150)
            ends = [f"{low:.4g} deg", f"{low + chance.uniform(5, 90):.4g} deg"]
            drive["motion"] = {"between": ends, "phase": f"{chance.uniform(0, 360):.4g} deg"}
        case "segments":
            parts = [f"{chance.uniform(-60, 60):.4g} deg" for _ in range(2)]
            drive["motion"] = {"start": parts[0], "segments": [
                {"over": "120 deg", "to": parts[1], "law": chance.choice(LAWS)},
                {"over": "60 deg", "to": parts[1]},
                {"over": "180 deg", "to": parts[0], "law": chance.choice(LAWS)},
            ]}  # fmt: skip
        case "spline":
            values = [f"{chance.uniform(-30, 30):.4g} deg" for _ in range(4)]
            angles = ["0 deg", "80 deg", "170 deg", "260 deg"]
            drive["motion"] = {"crank_angles": angles, "values": values}
        case "motion":
            turns = chance.choice((1, 1, 2, 5))
            splines = ("cubic", "quintic")
            drive["motion"] = {
                "table": "motion.csv", "turns": turns, "spline": chance.choice(splines)
            }  # fmt: skip
            header = "crank_angle [deg],angle [deg]"
            return {"motion.csv": columns(chance, header, 359.0 * turns, c1=40.0)}
        case "curve":
            drive["motor"] = {"table": "motor.csv", "ratio": 5}
            return {"motor.csv": columns(chance, "speed [rpm],torque [N m]", 3000.0, c1=5.0)}
    return {}


def _second_motor(chance: random.Random, document: Document) -> None:
    """An arm on the frame with a motor of its own, or free, that a spring ties to another link."""
    pins = [*document["frame"]["points"]]
    if "slider" in document["drive"] or "arm" in document["links"] or not pins:
        return
    name, link = chance.choice([*document["links"].items()])
    size, mass = 10 ** chance.uniform(1, 2), 10 ** chance.uniform(-2, 1)
    document["links"]["arm"] = {
        "points": {chance.choice(pins): ["0 mm", "0 mm"], "E9": [mm(size), "0 mm"]},
        "mass": f"{mass:.4g} kg", "center_of_mass": [mm(size * chance.uniform(-0.5, 1)), "0 mm"],
        "inertia": f"{mass * size**2 * chance.uniform(0.1, 3):.4g} kg mm^2",
    }  # fmt: skip
    if chance.random() < 0.7:
        document.setdefault("springs", []).append({
            "link": "arm", "point": "E9", "on": name, "to": chance.choice([*link["points"]]),
            "stiffness": f"{10 ** chance.uniform(0, 4):.4g} N/m",
        })  # fmt: skip
    motor = {"no_load_speed": f"{10 ** chance.uniform(2, 4):.4g} rpm",
             "stall_torque": f"{10 ** chance.uniform(-2, 1):.4g} N m"}  # fmt: skip
    if chance.random() < 0.5:
        _other_motor(chance, motor)
    moved = {"motor": motor} if chance.random() < 0.8 else {"free": True}
    drive = {"link": "arm", "ratio": chance.choice((1, -1, 2, -3, 0.5))} | moved
    document["drives"] = [*document.get("drives", ()), drive]


def _other_motor(chance: random.Random, motor: Document) -> None:
    """One of another kind in the place of a straight line, some too weak to start."""
    del motor["no_load_speed"], motor["stall_torque"]
    size = 10 ** chance.uniform(-2, 2)
    direct = {"voltage": f"{chance.choice((12, 24, 230))} V", "resistance": f"{1 / size:.4g} ohm",
              "torque_constant": f"{10 ** chance.uniform(-2, 0):.4g} N m/A"}  # fmt: skip
    alternating = {"synchronous_speed": f"{chance.choice((750, 1500, 3000))} rpm",
                   "breakdown_torque": f"{size:.4g} N m",
                   "breakdown_slip": round(chance.uniform(0.02, 0.9), 3)}  # fmt: skip
    controlled = {"speed": f"{chance.choice((750, 1500, 3000))} rpm",
                  "torque_limit": f"{size:.4g} N m",
                  "speed_gain": f"{size / 10 ** chance.uniform(0, 2):.4g} N m s/rad"}  # fmt: skip
    motor |= chance.choice(
        [
            {"torque": f"{size:.4g} N m"},
            {"dc": direct},
            {"dc": direct | {"inductance": f"{10 ** chance.uniform(-2, 2):.4g} mH"}},
            {"induction": alternating},
            {"servo": controlled},
            {
                "servo": controlled
                | {
                    "acceleration": f"{10 ** chance.uniform(1, 4):.4g} rad/s^2",
                    "angle_gain": f"{size:.4g} N m/rad",
                }
            },
        ]
    )


def _sections(chance: random.Random, document: Document) -> None:
    """Cross-sections of some links, some of which have no line, or no room for the wall."""
    strengths = {"elastic_modulus": "206 GPa", "yield_strength": "355 MPa",
                 "fatigue_limit": "180 MPa", "knee_cycles": 2e6, "slope": 6,
                 "stress_concentration": 1.8, "effective_length": 0.7}  # fmt: skip
    for link in document["links"].values():
        points = [*link["points"]]
        if chance.random() < 0.4 or (len(points) < 2 and chance.random() < 0.95):
            continue
        size = 10 ** chance.uniform(0.3, 1.7)
        section: Document = chance.choice(
            [{"height": mm(size), "width": mm(size / 2)}, {"diameter": mm(size)}]
        )
        if len(points) != 2 or chance.random() < 0.3:
            section["between"] = chance.sample(points, min(2, len(points)))
        if chance.random() < 0.3:
            section["wall"] = mm(size * chance.uniform(0.02, 0.26))
        elif "height" in section and size > 20:
            section |= {"web": mm(size / 8), "flange": mm(size / 10)}
        section |= dict(chance.sample([*strengths.items()], chance.randint(0, len(strengths))))
        if "fatigue_limit" in section and chance.random() < 0.5:
            section["tensile_strength"] = "510 MPa"
        if "fatigue_limit" in section and "slope" in section:  # by chance, but without one more
            section["life"] = "2000 h"
        link["section"] = section


def _bearings(chance: random.Random, document: Document) -> None:
    """Rolling and plain bearings in some pins, some of which a pin in a slot cannot have."""
    held = [name for part in (*document["links"].values(), document["frame"])
            for name in part["points"]]  # fmt: skip
    joints = {item["joint"]: item for item in document.get("joints", ())}
    rating = 10 ** chance.uniform(0, 2)
    more = {"static_rating": f"{0.6 * rating:.4g} kN", "kind": chance.choice(("ball", "roller")),
            "load_factor": 1.3, "life": "25000 h", "reliability": 0.95}  # fmt: skip
    for point in sorted({name for name in held if held.count(name) > 1}):
        name = f"joints.{point}"
        if chance.random() < 0.4:
            continue
        first = joints.setdefault(name, {"joint": name})
        if chance.random() < 0.5:
            chosen = chance.sample([*more.items()], chance.randint(0, len(more)))
            first["bearing"] = {"dynamic_rating": f"{rating:.4g} kN"} | dict(chosen)
        else:
            first |= {
                "radius": first.get("radius", "5 mm"),
                "width": mm(10 ** chance.uniform(0, 2)),
            }
    if joints:
        document["joints"] = [*joints.values()]


LAID = "crank_angle [deg],force_x [N],force_y [N]", "crank_angle [deg],torque [N m]"


def _axes(chance: random.Random, document: Document, link: str) -> str:
    """Those of a slider, of which some links have none."""
    slides = any(slider["link"] == link for slider in document.get("sliders", ()))
    return chance.choice(("link", "slider")) if slides or chance.random() < 0.05 else "link"


def _forces(chance: random.Random, document: Document) -> Files:
    loads, tables = document.setdefault("loads", []), Files()
    if chance.random() < 0.25:
        link = chance.choice([*document["links"]])
        point = chance.choice([*document["links"][link]["points"]])
        load: Document = {"link": link, "table": "load.csv", "outside": chance.choice(
            ["zero", "hold", "wrap"])}  # fmt: skip
        header = chance.choice(LAID)
        load |= {"point": point} if "force" in header else {}
        if "force" in header and chance.random() < 0.4:
            load["axes"] = _axes(chance, document, link)
        loads.append(load)
        end = 360.0 * chance.choice((1, 1, 2, 3, 12))
        tables["load.csv"] = columns(
            chance, header, end, rises=chance.random() < 0.95, c1=300.0, c2=90.0
        )
    for _ in range(chance.choice((0, 0, 1, 2))):
        link = chance.choice([*document["links"]])
        point = chance.choice([*document["links"][link]["points"]])
        size = 10 ** chance.uniform(0, 4)
        force = pair(rect(size, chance.uniform(-pi, pi)), "N")
        load = {"link": link} | chance.choice(
            [{"point": point, "force": force}, {"torque": f"{size / 50:.4g} N m"}]
        )
        if chance.random() < 0.5:
            start = chance.uniform(-360, 720)
            load |= {"from": f"{start:.5g} deg", "to": f"{start + chance.uniform(1, 359):.5g} deg"}
        if chance.random() < (0.4 if "force" in load else 0.03):
            load["axes"] = _axes(chance, document, link)
        loads.append(load)
    tables |= _gas(random.Random(str(loads)), document)
    springs = document.setdefault("springs", [])
    fixed = {*document["frame"]["points"]}
    moving = [
        (link, point)
        for link, part in document["links"].items()
        for point in part["points"]
        if point not in fixed or chance.random() < 0.02  # where a spring does nothing
    ]
    if moving and chance.random() < 0.25:
        link, point = chance.choice(moving)
        hook = f"S{len(springs)}"
        document["frame"]["points"][hook] = pair(rect(300, chance.uniform(-pi, pi)))
        spring = {"link": link, "point": point, "to": hook}
        laws: list[Document] = [
            {"stiffness": "2 N/mm"},
            {"stiffness": "2 N/mm", "free_length": "50 mm"},
            {"stiffness": "2 N/mm", "free_length": "50 mm", "preload": "30 N"},
            {"lengths": ["10 mm", "60 mm", "90 mm"], "forces": ["-20 N", "0 N", "50 N"]},
        ]
        springs.append(spring | chance.choice(laws))
    return tables


def _gas(chance: random.Random, document: Document) -> Files:
    """Pressure on what slides, of every third; chance : of its own, so that machines stay."""
    if not (sliders := document.get("sliders")) or chance.random() > 0.3:
        return Files()
    slider = chance.choice(sliders)
    load = {"link": slider["link"], "point": slider["point"], "axes": "slider", "bore": "40 mm",
            "gas": "gas.csv", "outside": chance.choice(["zero", "hold", "wrap"])}  # fmt: skip
    load |= chance.choice([{}, {"back_pressure": "1 bar"}, {"side": "behind"}])
    bearers = [{}, {"reaction": "frame"}]
    bearers += [{"reaction": name} for name in document["links"] if name != load["link"]]
    document["loads"].append(load | chance.choice(bearers))
    end = 360.0 * chance.choice((1, 2))
    return Files({"gas.csv": columns(chance, "crank_angle [deg],pressure [bar]", end, c1=12.0)})


def _planting(chance: random.Random, document: Document) -> Files:
    """A tip in the field, above soil whose resistance may stand in a table."""
    ends = {name: [*link["points"]] for name, link in document["links"].items()}
    tip = chance.choice([point for points in ends.values() for point in points])
    planting: Document = {"tip": tip, "depth": f"{10 ** chance.uniform(0, 2):.4g} mm"}
    planting |= chance.choice(
        [{"forward_speed": "0.4 m/s"}, {"hill_spacing": "15 cm"}, {"forward_speed": "0 m/s"}]
    )
    planting |= chance.choice([{}, {"release": "200 deg", "travel": "backward"}])
    parts = {"resistance": "5 N", "per_depth": "300 N/m", "per_speed": "2 N s/m",
             "table": "soil.csv"}  # fmt: skip
    planting["soil"] = dict(chance.sample([*parts.items()], chance.choice((1, 2, 4))))
    document["planting"] = planting
    deep = columns(chance, "depth [mm],resistance [N]", 80.0, c1=30.0)
    return {"soil.csv": deep.replace(",-", ",")} if "table" in planting["soil"] else {}


def _twisted(chance: random.Random, document: Document) -> None:
    """Torsion springs and properties of joints, some of which no machine can have."""
    bodies = [*document["links"], "frame"]
    link, on = chance.choice(bodies[:-1]), chance.choice(bodies)
    laws: list[Document] = [
        {"stiffness": "3 N m/rad", "angle": deg(chance.uniform(-pi, pi)), "preload": "1 N m"},
        {"angles": ["-40 deg", "5 deg", "60 deg"], "torques": ["9 N m", "0 N m", "-20 N m"]},
    ]
    spring = {"link": link} | ({} if on == "frame" else {"on": on}) | chance.choice(laws)
    if link != on:
        document["torsion_springs"] = [spring]
    if chance.random() < 0.5:
        point = chance.choice([*document["links"][link]["points"]])
        document["joints"] = [{"joint": f"joints.{point}", "radius": "4 mm"}]


def _damped(chance: random.Random, document: Document) -> None:
    """Of a fifth, dampers, stops and others, between links or a link and the frame."""
    bodies = {name: link["points"] for name, link in document["links"].items()}
    bodies["frame"] = document["frame"]["points"]
    link, on = chance.choice([*bodies][:-1]), chance.choice([*bodies])
    if link == on or chance.random() >= 0.2:
        return
    ends: Document = {"link": link} | ({} if on == "frame" else {"on": on})
    held = ends | {"point": chance.choice([*bodies[link]]), "to": chance.choice([*bodies[on]])}
    if chance.random() < 0.5:
        laws: list[Document] = [
            {"damping": "40 N s/m"},
            {"speeds": ["-1 m/s", "0 m/s", "2 m/s"], "forces": ["-20 N", "0 N", "90 N"]},
        ]
        document["dampers"] = [held | chance.choice(laws)]
    if chance.random() < 0.5:
        laws = [
            {"damping": "0.2 N m s/rad"},
            {"speeds": ["-9 rad/s", "0 rad/s", "9 rad/s"], "torques": ["-1 N m", "0 N m", "3 N m"]},
        ]
        document["torsion_dampers"] = [ends | chance.choice(laws)]
    if chance.random() < 0.5:
        law: Document = {"stiffness": "20 N/mm", "direction": deg(chance.uniform(-pi, pi))}
        law |= chance.choice([{}, {"restitution": 0.6, "speed": "0.5 m/s"}])
        document["stops"] = [held | law]
    if chance.random() < 0.5:
        law = chance.choice(
            [
                {"force": "80 N", "speed": "10 mm/s"},
                {"damping": "30 N s/m"},
                {"force": "50 N", "damping": "9 N s/m", "speed": "2 mm/s", "direction": "20 deg"},
                {"positions": ["-20 mm", "5 mm", "30 mm"], "forces": ["0 N", "400 N", "20 N"],
                 "speed": "5 mm/s", "direction": deg(chance.uniform(-pi, pi)), "one_way": True},
            ]
        )  # fmt: skip
        document["resistances"] = [held | law]
    _bushed(random.Random(str(held)), document, held)


def _bushed(chance: random.Random, document: Document, held: Document) -> None:
    """A bushing of every second; chance : of its own, so that machines of seeds stay."""
    if chance.random() < 0.5:
        stiff = {"stiffness": ["20 N/mm", "5 N/mm"], "direction": deg(chance.uniform(-pi, pi))}
        about = {"torsional_stiffness": "3 N m/rad", "angle": deg(chance.uniform(-pi, pi))}
        laws = [
            stiff,
            stiff | {"damping": ["20 N s/m", "0 N s/m"], "preload": ["-30 N", "5 N"]},
            {"damping": ["9 N s/m", "4 N s/m"], "torsional_damping": "0.1 N m s/rad"},
            stiff | about | {"torque": "0.4 N m"},
        ]
        document["bushings"] = [held | chance.choice(laws)]


def _rubbing(chance: random.Random, document: Document) -> None:
    """Friction, damping, drag and stiffness of some joints, some of which lock a machine."""
    holders = [*document["links"].values(), document["frame"]]
    held = [name for part in holders for name in part["points"]]
    pins = sorted({name for name in held if held.count(name) > 1})
    slides = [
        slider.get("label") or f"{slider['link']} on {slider['on']}"
        for slider in document.get("sliders", ())
    ]
    slots = (*document.get("circular_slots", ()), *document.get("curved_slots", ()))
    runs = [slot.get("label") or f"{slot['point']} in {slot['on']}" for slot in slots]
    taken = {joint["joint"] for joint in document.get("joints", ())}
    for name in chance.sample([*pins, *slides, *runs], chance.randint(0, len(pins + slides))):
        part: Document = {"joint": f"joints.{name}"}
        if part["joint"] in taken and chance.random() < 0.95:
            continue
        given: Document = {"friction": chance.choice((0.05, 0.1, 0.1, 0.2, 0.7))}
        if chance.random() < 0.03:  # most machines leave no joint force open
            given["stiffness"] = f"{10 ** chance.uniform(2, 5):.4g} kN/m"
        if name in pins:
            given |= {"torsional_damping": "0.01 N m s/rad", "drag_torque": "0.05 N m"}
        elif name in slides:
            given |= {"damping": "3 N s/m", "drag_force": "2 N",
                      "guide_length": mm(10 ** chance.uniform(1, 2.5))}  # fmt: skip
        if name not in runs or chance.random() < 0.05:
            part |= dict(chance.sample([*given.items()], chance.randint(1, len(given))))
        if "guide_length" in part:
            part["friction"] = 0.1
        if name not in slides:
            part["radius"] = mm(10 ** chance.uniform(0, 1.3))
        if "friction" in part and chance.random() < 0.4:
            part |= {"static_friction": 0.3 + part["friction"], "stribeck_speed": "5 mm/s"}
        document["joints"] = [*document.get("joints", ()), part]
    meshes = [f"{kind}.{' to '.join(item['between'])}" for kind in ("gears", "belts")
              for item in document.get(kind, ()) if "shape" not in item]  # fmt: skip
    if meshes and len(held) % 3 == 0:  # no further chance is taken, so that other parts stay
        loss: Document = {"joint": meshes[0], "mesh_loss": 0.02}
        document["joints"] = [*document.get("joints", ()), loss]


def _carried(chance: random.Random, document: Document) -> None:
    stiffness = [f"{10 ** chance.uniform(3, 6):.4g} N/m" for _ in range(3)]
    mounts: Document = {
        name: {"point": pair(complex(x, -200)), "stiffness": k, "damping": "200 N s/m"}
        for name, x, k in (("left", -400, stiffness[0]), ("right", 500, stiffness[1]))
    }
    mounts["along"] = {
        "point": ["0 mm", "-200 mm"], "direction": "0 deg", "stiffness": stiffness[2]
    }  # fmt: skip
    if chance.random() < 0.2:
        mounts["left"]["one_sided"] = True
    document["support"] = {
        "freedoms": chance.choice([["surge", "heave", "pitch"], ["heave"], ["pitch"], ["surge"]]),
        "mass": "60 kg",
        "center_of_mass": ["0 mm", "100 mm"],
        "inertia": "4 kg m^2",
        "mounts": mounts,
        "gauges": {"handle": {"point": ["-900 mm", "700 mm"], "exposure": "2 h"}},
    }


def _long_cycle(chance: random.Random, document: Document) -> None:
    """A train of gears that comes back after up to 60 turns."""
    turns = chance.choice((7, 12, 23, 41, 60))
    document["frame"]["points"]["long"] = ["777 mm", "13 mm"]
    link = {"points": {"long": ["0 mm", "0 mm"]}, "mass": "1 kg", "inertia": "0.01 kg m^2",
            "center_of_mass": ["10 mm", "0 mm"]}  # fmt: skip
    document["links"]["long wheel"] = link
    gear = {"between": [document["drive"]["link"], "long wheel"], "teeth": [turns + 1, turns]}
    document["gears"] = [*document.get("gears", ()), gear]


# -- a machine by its seed -------------------------------------------------------------------------

STROKED = 40
"""One in so many is pushed by a cylinder, which takes longest to be drawn."""


def of_kind(chance: random.Random) -> tuple[Document, Files]:
    """A machine of a kind, as its file, and the tables that it names."""
    seed = chance.randrange(2**31)
    if chance.randrange(STROKED) == 0:
        machine = _pushed(chance, seed)
    else:
        plain_kinds = [kind for kind in machines.KINDS if not kind.startswith("torsion_")]
        kinds = (plain_kinds, machines_cams.ALL, machines_redundant.REDUNDANT)
        machine = machines.make(chance.choice([*chance.choice(kinds)]), seed).machine
    plain = {load for load in machine.loads if load.table is not None}
    machine = replace(machine, loads=tuple(x for x in machine.loads if x not in plain))
    if chance.random() < 0.2:
        machine = machines_planes.set_apart(machine, np.random.default_rng(seed))
    return with_tables(machine)


def _pushed(chance: random.Random, seed: int) -> Machine:
    """A machine that is pushed; the next one where nothing pushes the one of this seed."""
    from support import machines_strokes as strokes

    while True:
        kind = chance.choice([*strokes.TOGETHER, *strokes.TURNING, *strokes.SLIDING])
        try:
            if kind in strokes.TOGETHER:
                return strokes.together(kind, seed).machine
            by_slider = chance.random() < 0.5 and kind in strokes.SLIDING
            return strokes.stroked(kind, seed, by_slider).machine
        except strokes.CannotBePushed:
            seed += 1


def with_tables(machine: Machine) -> tuple[Document, Files]:
    """A machine as its file, and the tables that it names."""
    text, tables = taken_along(machine, "model.toml")
    return tomllib.loads(text), tables


def files(seed: int, wanted: str = "") -> tuple[Document, Files]:
    """The model file of a machine and the tables that it names, the same at every call.

    wanted : words for what it most likely has: ``motor``, ``motors`` (two of them), ``planting``,
        ``rows``, ``support``, or a crank that turns ``even``ly.
    """
    chance = random.Random(seed)
    grown = chance.random() < 0.6
    document, tables = (Growing(chance).grown(), Files()) if grown else of_kind(chance)
    tables |= dress(chance, document, wanted)
    named = parameters_of(random.Random(f"parameters of {seed}"), document)
    beside = named | beside_the_machine(random.Random(f"beside {seed}"), document)
    second = random.Random(f"second {seed}")
    if second.random() < 0.1 or "motors" in wanted:
        _second_motor(second, document)
    return {"schema": 1, "title": f"Machine {seed}"} | beside | document, tables


def beside_the_machine(chance: random.Random, document: Document) -> Document:
    """Now and then constraints, which mostly do not hold, a run, loads over its time, and states
    of its duty.

    Drawn by themselves, so that the machine is what it would be without.
    """
    actual: Document = {}
    bodies = [[*body["points"]] for body in (document["frame"], *document["links"].values())]
    lines = [points for points in bodies if len(points) > 1]
    if len(lines) > 1 and chance.random() < 0.15:
        first, other = chance.sample(lines, 2)
        line, to = chance.sample(first, 2), chance.sample(other, 2)
        if {*line} != {*to}:
            actual["constraints"] = [{"kind": "equal", "line": line, "to": to}]
    if chance.random() < 0.15:
        turns = chance.choice((0.4, 2, 7))
        actual["run"] = {"turns": turns, "speed": f"{chance.choice((-1, 0, 1, 9)) * 10} rpm"}
        if chance.random() < 0.3:
            actual["run"] |= {"angle": "40 deg", "off_turns": turns / 2}
            if "support" in document:
                actual["run"]["support"] = True
    if any("bearing" in item for item in document.get("joints", ())) and chance.random() < 0.5:
        actual["duty"] = [{"share": 2}, {"share": 0.3, "speed": "31 rpm", "load_factor": 0.6}]
    if chance.random() < 0.15:
        name, link = chance.choice([*document["links"].items()])
        load: Document = {"link": name, "times": ["0 s", "0.3 s"], "factors": [0, 1.5]}
        if chance.random() < 0.5:
            force = {"point": chance.choice([*link["points"]]), "force": ["4 N", "-3 N"]}
            load |= force | chance.choice(({}, {"axes": "link"}))
        else:
            load["torque"] = "0.2 N m"
        others = [other for other in document["links"] if other != name]
        if others and chance.random() < 0.5:
            load["on"] = chance.choice(others)
        actual["timed_loads"] = [load]
    return actual


def parameters_of(chance: random.Random, document: Document) -> Document:
    """Now and then a table of parameters, from which the speed and a mass are worked out.

    Drawn by itself, so that the machine is what it would be without.
    """
    masses = [value for value in document["links"].values() if isinstance(value.get("mass"), str)]
    speed = document["drive"].get("speed")
    if not masses or not isinstance(speed, str) or chance.random() > 0.15:
        return {}
    link = chance.choice(masses)
    actual = {"speed": speed, "weight": link["mass"], "half": "=weight/2"}
    document["drive"]["speed"], link["mass"] = "=speed", "=2*half"
    return {"parameters": actual}
