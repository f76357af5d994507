"""Physics of a shaft in bending: balance, energy, reciprocity, symmetries, and what adds up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from equipoise.handheld.frequencies import natural_frequencies
from equipoise.handheld.layout import ShaftDeflection
from equipoise.handheld.model import Absorber, Excitation, Hand, Station, Tool
from equipoise.handheld.modes import vibrate_tool
from equipoise.handheld.response import ToolResponse, respond_tool
from equipoise.handheld.shaft import Section, Segment, Theory
from equipoise.keys import Planes, Quantity, keys_of
from laws.transforms import rescaled
from unit.handheld.samples import THEORIES, bare, both, pieces_of, random_tool, still

Array = np.ndarray[Any, Any]
SPEEDS = np.array([170.0, 455.0, 820.0])
SUBJECTS = [(theory, seed) for theory in THEORIES for seed in (21, 22)]
subjects = pytest.mark.parametrize(("theory", "seed"), SUBJECTS)


@cache
def made(theory: Theory, seed: int) -> Tool:
    return random_tool(seed, theory)


def shaken(tool: Tool, *excitations: Excitation) -> Tool:
    return replace(tool, excitations=excitations)


def integral(response: ToolResponse, function: Callable[[ShaftDeflection, Array], Array]) -> Array:
    """Of a function of the fields along the shaft, by Gauss's points between all places of note.

    function : of the fields at some places (X) and of (X, 5): EI, m, kGA and rho I, and the place.
    """
    tool = response.tool
    borders = np.cumsum([0.0, *(piece.length for piece in pieces_of(tool))])
    stops = {*borders, *(station.position for station in tool.stations)}
    every = sorted(stops | set(np.linspace(0, tool.shaft.length, 9)))
    points, weights = np.polynomial.legendre.leggauss(12)
    rows = []
    for low, high in pairwise(every):
        rows += [
            (low + (high - low) * (x + 1) / 2, w * (high - low) / 2)
            for x, w in zip(points, weights, strict=True)
        ]
    places, shares = np.array(rows).T
    parts = [pieces_of(tool)[int(np.searchsorted(borders, x)) - 1] for x in places]
    section = np.array(
        [
            (p.bending_stiffness, p.mass_per_length, p.shear_stiffness, p.rotary_inertia, x)
            for p, x in zip(parts, places, strict=True)
        ]
    )
    values = function(response.line(places), section)
    return np.asarray(np.tensordot(shares, values, 1))


def column(values: Array) -> Array:
    """Of sections (X,), beside fields (X, 2, K, S)."""
    return values[:, None, None, None]


def of(pair: tuple[float, float]) -> Array:
    """Of both planes, beside amplitudes (2, K, S)."""
    return np.array(pair)[:, None, None]


def shaking(response: ToolResponse) -> dict[str, Array]:
    """Force (2, K, S), N, that shakes at each station."""
    actual = {
        station.name: np.zeros((2, *response.frequency.shape), complex)
        for station in response.tool.stations
    }
    for shake in response.shakes:
        order = int(np.flatnonzero(response.orders == shake.order)[0])
        actual[shake.station][:, order] += shake.at(response.speed)
    return actual


def absorbed(response: ToolResponse, station: Station) -> Array:
    """Force of a station on its absorber, from the equation of the absorber's mass."""
    if station.absorber is None:
        return np.zeros((2, *response.frequency.shape))
    s = 1j * response.frequency
    link = of(station.absorber.stiffness) + of(station.absorber.damping) * s
    moved = link * response.displacement(station.name) / (link + station.absorber.mass * s**2)
    return link * (response.displacement(station.name) - moved)


# -- balance and energy ----------------------------------------------------------------------------
# 1e-9: quadrature of 12 points between stations is exact to rounding, of which a thousand meet.


@subjects
def test_forces_and_moments_on_the_whole_tool(theory: Theory, seed: int) -> None:
    """Newton and Euler: what shakes it, less what holds it, is the change of its momentum.

    Moments are about the left end; those of rotation are of slopes.
    """
    response = respond_tool(made(theory, seed), SPEEDS)
    w2 = response.frequency**2

    def pushed(line: ShaftDeflection, part: Array) -> Array:
        return column(part[:, 1]) * line.displacement

    def turned(line: ShaftDeflection, part: Array) -> Array:
        return column(part[:, 4]) * pushed(line, part) + column(part[:, 3]) * line.slope

    force, moment = integral(response, pushed) * w2, integral(response, turned) * w2
    size = 0.0
    causes = shaking(response)
    for station in response.tool.stations:
        moved, x = response.displacement(station.name), station.position
        slope = response.line([x]).slope[0]
        held: Any = sum(response.forces(station.name).values(), np.zeros_like(moved))
        across = (
            causes[station.name] - held - absorbed(response, station) + station.mass * w2 * moved
        )
        s = 1j * response.frequency
        twist = (
            of(station.rotational_stiffness)
            + of(station.rotational_damping) * s
            - of(station.inertia) * w2
        )
        force = force + across
        moment = moment + x * across - twist * slope
        size = max(size, float(np.max(np.abs(held))), float(np.max(np.abs(causes[station.name]))))
    assert np.max(np.abs(force)) < 1e-9 * size
    assert np.max(np.abs(moment)) < 1e-9 * size * response.tool.shaft.length


@subjects
def test_power_fed_in_is_taken(theory: Theory, seed: int) -> None:
    """By hands, harness, ground and absorber, and by the shaft's material."""
    response = respond_tool(made(theory, seed), SPEEDS)
    taken = response.lost_in_shaft
    for station in response.tool.stations:
        taken = taken + sum(response.power(station.name).values(), np.zeros_like(taken))
    np.testing.assert_allclose(response.fed_in, taken, rtol=1e-9)
    for station in response.tool.stations:
        assert all(np.all(power >= 0) for power in response.power(station.name).values())
    assert np.all(response.lost_in_shaft > 0)


@subjects
def test_power_that_the_material_takes(theory: Theory, seed: int) -> None:
    """eta w / 2 times EI |theta'|^2 and kGA |w' - theta|^2, by moment and shear."""
    response = respond_tool(made(theory, seed), SPEEDS)
    loss = response.tool.shaft.loss_factor

    def strained(line: ShaftDeflection, part: Array) -> Array:
        bent = np.abs(line.moment) ** 2 / column(part[:, 0])
        return bent + np.abs(line.shear) ** 2 / column(part[:, 2])

    wanted = (
        loss / (1 + loss**2) * response.frequency / 2 * np.sum(integral(response, strained), axis=0)
    )
    np.testing.assert_allclose(response.lost_in_shaft, wanted, rtol=1e-8)


@subjects
def test_power_of_each_damper(theory: Theory, seed: int) -> None:
    """c |v|^2 / 2 of its own velocity."""
    response = respond_tool(made(theory, seed), SPEEDS)
    for station in response.tool.stations:
        velocity = np.abs(response.velocity(station.name)) ** 2 / 2
        power = response.power(station.name)
        if station.hand is not None:
            wanted = station.hand.hands * np.sum(of(station.hand.damping) * velocity, axis=0)
            np.testing.assert_allclose(power["hand"], wanted, rtol=1e-9)
        if station.harness is not None:
            wanted = np.sum(of(station.harness.damping) * velocity, axis=0)
            np.testing.assert_allclose(power["harness"], wanted, rtol=1e-9)
        if station.absorber is not None:
            own = 1j * response.frequency * absorbed(response, station)
            link = of(station.absorber.stiffness) + 1j * response.frequency * of(
                station.absorber.damping
            )
            wanted = np.sum(of(station.absorber.damping) * np.abs(own / link) ** 2 / 2, axis=0)
            np.testing.assert_allclose(power["absorber"], wanted, rtol=1e-9)
        turning = np.abs(response.line([station.position]).slope[0] * response.frequency) ** 2 / 2
        ground = np.sum(
            of(station.damping) * velocity + of(station.rotational_damping) * turning, axis=0
        )
        np.testing.assert_allclose(power.get("ground", 0 * ground), ground, rtol=1e-9)


@subjects
def test_work_of_the_forces_is_twice_the_potential_less_the_kinetic_energy(
    theory: Theory, seed: int
) -> None:
    """Without damping, at any frequency: F y = M^2 / EI + V^2 / kGA + k y^2 - w^2 (m y^2 + ...)."""
    tool = shaken(
        still(made(theory, seed)),
        Excitation("e", "rear", force=3.0),
        Excitation("f", "head", force=2.0, direction="lateral"),
    )
    response = respond_tool(tool, SPEEDS)
    potential, kinetic = energies(response)
    work = sum(
        np.real(force * response.displacement(name)) for name, force in shaking(response).items()
    )
    size = np.max(potential)
    assert np.max(np.abs(work - (potential - kinetic))) < 1e-10 * size


def energies(result: ToolResponse) -> tuple[Array, Array]:
    """Twice the potential and the kinetic energy (2, K, S) of an undamped tool."""
    w2 = result.frequency**2

    def strained(line: ShaftDeflection, part: Array) -> Array:
        bent = line.moment**2 / column(part[:, 0])
        return bent + line.shear**2 / column(part[:, 2])

    def moving(line: ShaftDeflection, part: Array) -> Array:
        across = column(part[:, 1]) * line.displacement**2
        return across + column(part[:, 3]) * line.slope**2

    potential = integral(result, strained).real
    kinetic = integral(result, moving).real * w2
    for station in result.tool.stations:
        moved = result.displacement(station.name).real ** 2
        slope = result.line([station.position]).slope[0].real ** 2
        potential = (
            potential + of(station.stiffness) * moved + of(station.rotational_stiffness) * slope
        )
        kinetic = kinetic + w2 * (station.mass * moved + of(station.inertia) * slope)
        if station.hand is not None:
            potential = potential + station.hand.hands * of(station.hand.stiffness) * moved
            kinetic = kinetic + station.hand.hands * station.hand.mass * w2 * moved
        if station.harness is not None:
            potential = potential + of(station.harness.stiffness) * moved
        if station.absorber is not None:
            stretch = (absorbed(result, station) / of(station.absorber.stiffness)).real
            own = result.displacement(station.name).real - stretch
            potential = potential + of(station.absorber.stiffness) * stretch**2
            kinetic = kinetic + station.absorber.mass * w2 * own**2
    return potential, kinetic


@subjects
def test_at_a_mode_kinetic_and_potential_energy_are_the_same(theory: Theory, seed: int) -> None:
    """1e-7 beside the resonance they differ by 1e-7 of them, as the force has next to no work."""
    plain = still(made(theory, seed))
    tool = shaken(plain, Excitation("e", "rear", force=1.0))
    natural = natural_frequencies(plain, 7)[0, 1:]
    response = respond_tool(tool, natural * (1 + 1e-7))
    potential, kinetic = energies(response)
    np.testing.assert_allclose(potential[0, 0] / kinetic[0, 0], 1, atol=1e-6)


# -- reciprocity and superposition -----------------------------------------------------------------


@subjects
@pytest.mark.parametrize("direction", ["vertical", "lateral"])
def test_reciprocity(theory: Theory, seed: int, direction: str) -> None:
    """A force at one place moves another as a force there moves the one, whatever is between."""
    tool = made(theory, seed)
    rng = np.random.default_rng([seed, 4])
    places = np.sort(rng.uniform(0, tool.shaft.length, 3))
    marks = tuple(Station(f"mark {k}", float(x)) for k, x in enumerate(places))
    tool = replace(tool, stations=(*tool.stations, *marks))
    names = ["engine", "middle", "head", *(mark.name for mark in marks)]
    plane = ("vertical", "lateral").index(direction)
    answer = []
    for name in names:
        cause = Excitation("e", name, force=1.0, direction=direction)  # type: ignore[arg-type]
        response = respond_tool(shaken(tool, cause), SPEEDS)
        answer.append([response.displacement(other)[plane, 0] for other in names])
    matrix = np.array(answer)
    size = np.max(np.abs(matrix), axis=(0, 1))
    assert np.max(np.abs(matrix - np.swapaxes(matrix, 0, 1)) / size) < 1e-11


@subjects
def test_what_shakes_adds_up(theory: Theory, seed: int) -> None:
    """At one order two causes together do what each does alone; other orders know nothing of it."""
    tool = made(theory, seed)
    whole = respond_tool(tool, SPEEDS)
    total = {
        station.name: np.zeros_like(whole.displacement(station.name)) for station in tool.stations
    }
    for cause in tool.excitations:
        alone = respond_tool(shaken(tool, cause), SPEEDS)
        k = int(np.flatnonzero(whole.orders == alone.orders[0])[0])
        for name, sum_of in total.items():
            sum_of[:, k] += alone.displacement(name)[:, 0]
    for name, wanted in total.items():
        size = np.max(np.abs(wanted))
        np.testing.assert_allclose(whole.displacement(name), wanted, atol=1e-11 * size)


def test_an_unbalance_grows_with_the_square_of_its_own_speed() -> None:
    """Beside a force of the same amplitude: u (r speed)^2."""
    tool = made("timoshenko", 21)
    unbalance = respond_tool(
        shaken(tool, Excitation("e", "head", unbalance=2e-4, ratio=0.4)), SPEEDS
    )
    force = respond_tool(
        shaken(tool, Excitation("e", "head", force=2e-4, direction="rotating", ratio=0.4)), SPEEDS
    )
    for name in ("engine", "rear"):
        np.testing.assert_allclose(
            unbalance.displacement(name),
            force.displacement(name) * (0.4 * SPEEDS) ** 2,
            rtol=1e-12,
        )


# -- the same described otherwise ------------------------------------------------------------------


def mirrored(tool: Tool) -> Tool:
    """The tool seen from the other side: its right end is the left one."""
    length = tool.shaft.length
    segments = tuple(
        replace(segment, start=length - segment.stop, stop=length - segment.start)
        for segment in tool.shaft.segments
    )
    stations = tuple(
        replace(station, position=length - station.position) for station in tool.stations
    )
    return replace(tool, shaft=replace(tool.shaft, segments=segments), stations=stations)


def swapped(tool: Tool) -> Tool:
    """Vertical for lateral: each pair the other way round, and each force along the other axis."""

    def turn(part: Any) -> Any:
        if part is None:
            return None
        kinds = {name: value.kind for name, value in keys_of(type(part)).items()}
        pairs = {
            name: getattr(part, name)[::-1]
            for name, kind in kinds.items()
            if isinstance(kind, Planes) and isinstance(kind.item, Quantity)
        }
        return replace(part, **pairs)

    stations = tuple(
        replace(
            turn(station),
            hand=turn(station.hand),
            harness=turn(station.harness),
            absorber=turn(station.absorber),
        )
        for station in tool.stations
    )
    return replace(tool, stations=stations)


@subjects
def test_mirror_image(theory: Theory, seed: int) -> None:
    """It moves alike; slope and shear change their signs.  Where a station is, sides change too."""
    tool = made(theory, seed)
    actual, wanted = respond_tool(mirrored(tool), SPEEDS), respond_tool(tool, SPEEDS)
    for station in tool.stations:
        moved = wanted.displacement(station.name)
        size = np.max(np.abs(moved))
        np.testing.assert_allclose(actual.displacement(station.name), moved, atol=1e-10 * size)
    x = np.linspace(0.013, 0.987, 25) * tool.shaft.length
    here, there = wanted.line(x), actual.line(tool.shaft.length - x)
    for name, sign in (("displacement", 1), ("slope", -1), ("moment", 1), ("shear", -1)):
        station, other = getattr(here, name), getattr(there, name)
        np.testing.assert_allclose(sign * other, station, atol=1e-10 * np.max(np.abs(station)))
    np.testing.assert_allclose(
        natural_frequencies(mirrored(tool), 8), natural_frequencies(tool, 8), rtol=3e-9
    )


@subjects
def test_planes_change_places(theory: Theory, seed: int) -> None:
    """What is vertical here is lateral there, frequencies, eigenvalues and motion."""
    up = shaken(made(theory, seed), Excitation("e", "rear", force=1.0))
    across = shaken(swapped(up), Excitation("e", "rear", force=1.0, direction="lateral"))
    single, other = (respond_tool(tool, SPEEDS).displacement("head") for tool in (up, across))
    np.testing.assert_allclose(single, other[::-1], atol=1e-12 * np.max(np.abs(single)))
    np.testing.assert_allclose(
        natural_frequencies(up, 6), natural_frequencies(across, 6)[::-1], rtol=3e-9
    )
    here, there = (vibrate_tool(tool, 5).planes for tool in (up, across))
    for first, second in zip(here, there[::-1], strict=True):
        np.testing.assert_allclose(
            [mode.eigenvalue for mode in first.damped],
            [mode.eigenvalue for mode in second.damped],
            rtol=1e-10,
        )


def scaled(tool: Tool, length: float, stiffness: float, mass: float) -> tuple[Tool, float]:
    """The tool with lengths, EI and mass per length so many times as large, and its time scale.

    Whatever has no unit stays as it is.
    """
    rate = np.sqrt(stiffness / mass) / length**2
    spring = stiffness / length**3
    factors = {
        **dict.fromkeys(("position", "start", "stop", "length"), length),
        "mass": mass * length,
        "inertia": mass * length**3,
        "stiffness": spring,
        "damping": spring / rate,
        "rotational_stiffness": spring * length**2,
        "rotational_damping": spring * length**2 / rate,
        "bending_stiffness": stiffness,
        "mass_per_length": mass,
        "shear_stiffness": stiffness / length**2,
        "rotary_inertia": mass * length**2,
    }

    def plain(part: Any) -> Any:
        return replace(part, profile=part.profile.section(tool.shaft.theory))

    shaft = replace(plain(tool.shaft), segments=tuple(map(plain, tool.shaft.segments)))
    return replace(
        tool,
        shaft=rescaled(shaft, factors),
        stations=rescaled(tool.stations, factors),
    ), float(rate)


@pytest.mark.exhaustive(but=["euler-bernoulli-21"])
@subjects
def test_scale(theory: Theory, seed: int) -> None:
    """Frequencies as sqrt(EI / m) / L^2, and the motion under a force as F L^3 / EI."""
    tool = shaken(
        made(theory, seed),
        Excitation("e", "rear", force=1.0),
        Excitation("f", "head", force=1.0, direction="lateral"),
    )
    for numbers in ((2.0, 1.0, 1.0), (1.0, 5.0, 1.0), (1.0, 1.0, 0.3), (0.37, 11.0, 2.3)):
        other, rate = scaled(tool, *numbers)
        actual, wanted = (
            natural_frequencies(other, 7),
            rate * natural_frequencies(tool, 7),
        )
        np.testing.assert_allclose(actual, wanted, rtol=3e-9)
        softer = numbers[0] ** 3 / numbers[1]
        here = respond_tool(tool, SPEEDS).displacement("front")
        there = respond_tool(other, rate * SPEEDS).displacement("front")
        np.testing.assert_allclose(there, softer * here, atol=1e-10 * softer * np.max(np.abs(here)))


@subjects
def test_stations_with_nothing_and_borders_between_equals_change_nothing(
    theory: Theory, seed: int
) -> None:
    """More nodes at random places, and each segment told in two parts of its own section."""
    tool = made(theory, seed)
    rng = np.random.default_rng(seed)
    nothing = tuple(
        Station(f"nothing {k}", float(x))
        for k, x in enumerate(rng.uniform(0, tool.shaft.length, 4))
    )
    halves = []
    for item in tool.shaft.segments:
        middle = item.start + 0.3 * (item.stop - item.start)
        halves += [replace(item, stop=middle), replace(item, start=middle)]
    first = min(segment.start for segment in tool.shaft.segments)
    halves.append(Segment(0.2 * first, 0.7 * first, tool.shaft.profile))
    other = replace(
        tool,
        shaft=replace(tool.shaft, segments=tuple(halves)),
        stations=(*tool.stations, *nothing),
    )
    actual, wanted = respond_tool(other, SPEEDS), respond_tool(tool, SPEEDS)
    x = np.linspace(0.01, 0.99, 12) * tool.shaft.length
    for item, exact in zip(actual.line(x), wanted.line(x), strict=True):
        np.testing.assert_allclose(item, exact, atol=1e-11 * np.max(np.abs(exact)))
    np.testing.assert_allclose(
        natural_frequencies(other, 8), natural_frequencies(tool, 8), rtol=3e-9
    )


def test_order_of_the_stations_changes_nothing() -> None:
    tool = made("timoshenko", 22)
    other = replace(tool, stations=tool.stations[::-1])
    for name in ("engine", "front", "head"):
        actual, wanted = (respond_tool(item, SPEEDS).displacement(name) for item in (other, tool))
        np.testing.assert_allclose(actual, wanted, rtol=1e-12)


def test_two_hands_are_twice_one() -> None:
    """Twice its mass, spring and damper."""
    tool = made("euler-bernoulli", 21)
    hand = Hand(0.2, (5e3, 7e3), (30.0, 40.0), hands=2)
    first = tool.with_station("rear", hand=hand)
    other = tool.with_station("rear", hand=Hand(0.4, (1e4, 1.4e4), (60.0, 80.0)))
    actual, wanted = (respond_tool(each, SPEEDS) for each in (first, other))
    for name in ("rear", "front"):
        np.testing.assert_allclose(actual.displacement(name), wanted.displacement(name), rtol=1e-12)
    np.testing.assert_allclose(actual.forces("rear")["hand"], wanted.forces("rear")["hand"])


# -- limits ----------------------------------------------------------------------------------------


def test_a_hard_absorber_is_a_mass_and_a_soft_one_is_nothing() -> None:
    """Their difference falls with k and rises with it: ten times as far, a tenth of it is left."""
    tool = made("timoshenko", 21).with_station("middle", absorber=None)
    mass = tool.with_station("middle", mass=tool.station("middle").mass + 0.3)

    def moved(item: Tool) -> Array:
        return respond_tool(item, SPEEDS).displacement("head")

    def away(stiffness: float, limit: Tool) -> float:
        absorber = Absorber(0.3, both(stiffness))
        return float(
            np.max(np.abs(moved(tool.with_station("middle", absorber=absorber)) - moved(limit)))
        )

    for limit, stiffnesses in ((mass, (1e9, 1e10)), (tool, (1e-2, 1e-3))):
        far, near = (away(stiffness, limit) for stiffness in stiffnesses)
        assert far / near == pytest.approx(10, rel=0.01)
        assert far < 1e-3 * np.max(np.abs(moved(tool)))


def test_stiff_in_shear_is_the_plain_beam() -> None:
    """Its difference falls as 1 / kGA and as rho I."""
    stations = made("euler-bernoulli", 21).stations
    frequency = [
        natural_frequencies(
            Tool(
                "t",
                replace(
                    bare(theory=theory, section=Section(1000.0, 2.0, shear, rotary)).shaft,
                    length=made("euler-bernoulli", 21).shaft.length,
                ),
                stations,
            ),
            6,
        )
        for theory, shear, rotary in (
            ("euler-bernoulli", np.inf, 0.0),
            ("timoshenko", 1e7, 1e-6),
            ("timoshenko", 1e8, 1e-7),
        )
    ]
    far, near = (np.max(np.abs(frequency[k] / frequency[0] - 1)) for k in (1, 2))
    assert 0 < far < 0.01
    assert far / near == pytest.approx(10, rel=0.01)


# -- natural frequencies ---------------------------------------------------------------------------


@pytest.mark.exhaustive(
    but=[
        "mass-euler-bernoulli-21",
        "inertia-timoshenko-21",
        "rotational_stiffness-euler-bernoulli-21",
        "stiffness-euler-bernoulli-21",
    ]
)
@subjects
@pytest.mark.parametrize("what", ["mass", "inertia", "stiffness", "rotational_stiffness"])
def test_frequencies_fall_with_mass_and_rise_with_stiffness(
    theory: Theory, seed: int, what: str
) -> None:
    """And no further than to the next: one number more is of rank one (Rayleigh).

    2e-9 is what a frequency is good to.
    """
    tool = made(theory, seed)
    before = natural_frequencies(tool, 9)
    for name in ("engine", "middle", "head"):
        first = tool.station(name)
        by = 3 * {"mass": 1.0, "inertia": 0.05, "stiffness": 1e4}.get(what, 500.0)
        value: Any = getattr(first, what)
        value = tuple(part + by for part in value) if isinstance(value, tuple) else value + by
        after = natural_frequencies(tool.with_station(name, **{what: value}), 9)
        low, high = (after, before) if what in ("mass", "inertia") else (before, after)
        assert np.all(low <= high * (1 + 2e-9))
        assert np.all(high[:, :-1] <= low[:, 1:] * (1 + 2e-9))
        assert np.max(high / low) > 1 + 1e-4


def test_modes_share_no_momentum() -> None:
    """Between any two of a tool of masses and springs: by Simpson's rule between 401 places."""
    stations = (
        Station("a", 0.0, mass=1.2, stiffness=both(900.0)),
        Station("b", 0.75, mass=0.4, hand=Hand(0.3, both(5e3))),
        Station("c", 1.5, mass=0.7),
    )
    vibration = vibrate_tool(bare(*stations, section=Section(1000.0, 2.0)), 7)
    shapes, places = vibration.planes[0].shapes, vibration.places
    simpson = np.array([1.0, *([4.0, 2.0] * 200)[:-1], 1.0]) * (places[1] / 3)
    momentum = 2.0 * (shapes * simpson) @ shapes.T
    for station, mass in zip(stations, (1.2, 0.7, 0.7), strict=True):
        here = shapes[:, int(np.argmin(np.abs(places - station.position)))]
        momentum = momentum + mass * np.outer(here, here)
    own = np.sqrt(np.diag(momentum))
    np.testing.assert_allclose(momentum / np.outer(own, own), np.eye(7), atol=1e-6)


def modal(tool: Tool) -> tuple[Array, Array, Array]:
    """Frequency, displacement at each station and modal mass of the vertical modes of masses."""
    vibration = vibrate_tool(tool, 6)
    shapes, places = vibration.planes[0].shapes, vibration.places
    simpson = np.array([1.0, *([4.0, 2.0] * 200)[:-1], 1.0]) * (places[1] / 3)
    mass = 2.0 * shapes**2 @ simpson
    at = [int(np.argmin(np.abs(places - station.position))) for station in tool.stations]
    for item, k in zip(tool.stations, at, strict=True):
        mass = mass + item.mass * shapes[:, k] ** 2
    return vibration.planes[0].frequency, shapes[:, at], mass


def masses_and_springs(damping: float = 0.0, loss: float = 0.0) -> Tool:
    """Make a tool whose stations are at places of 401, without inertia."""
    stations = (
        Station("a", 0.0, mass=1.2, stiffness=both(900.0), damping=both(damping)),
        Station("b", 0.75, mass=0.7, stiffness=both(5e3)),
        Station("c", 1.2, mass=0.4, damping=both(2 * damping)),
    )
    return bare(*stations, section=Section(1000.0, 2.0), loss_factor=loss)


def test_near_a_resonance_the_answer_is_that_of_one_mode() -> None:
    """(w_k^2 - w^2) y on both sides of it goes to phi_a phi_b / m_k; what others add cancels."""
    tool = masses_and_springs()
    frequency, shapes, mass = modal(tool)
    cause = Excitation("e", "a", force=1.0)
    for k, natural in enumerate(frequency):
        beside = natural * np.array([1 - 1e-5, 1 + 1e-5])
        response = respond_tool(shaken(tool, cause), beside)
        for j, station in enumerate(tool.stations):
            moved = response.displacement(station.name)[0, 0].real
            residue = np.mean(moved * (natural**2 - beside**2))
            wanted = shapes[k, 0] * shapes[k, j] / mass[k]
            largest = np.max(np.abs(shapes[k])) ** 2 / mass[k]
            assert residue == pytest.approx(wanted, abs=2e-5 * largest)


def test_little_damping_takes_from_each_mode_what_its_shape_reports() -> None:
    """Re s = -sum c phi^2 / (2 m_k), but for the square of the damping."""
    frequency, shapes, mass = modal(masses_and_springs())
    away = []
    for damping in (1e-2, 1e-3):
        reported = vibrate_tool(masses_and_springs(damping), 6).planes[0].damped
        values = np.array([mode.eigenvalue for mode in reported])
        wanted = -damping * (shapes[:, 0] ** 2 + 2 * shapes[:, 2] ** 2) / (2 * mass)
        np.testing.assert_allclose(values.real, wanted, rtol=1e-5)
        away.append(np.max(np.abs(values.imag / frequency - 1)))
    assert away[0] < 1e-6


def test_little_hysteresis_takes_from_each_mode_its_share_of_bending() -> None:
    """Re s = -eta w / 2 times the share of the shaft in the potential energy of the mode."""
    plain = masses_and_springs()
    loss = 1e-5
    natural = natural_frequencies(plain, 6)[0]
    tool = shaken(plain, Excitation("e", "a", force=1.0))
    near = respond_tool(tool, natural * (1 + 1e-8))
    whole = energies(near)[0][0, 0]
    bent = integral(near, lambda line, part: line.moment**2 / column(part[:, 0])).real[0, 0]
    reported = vibrate_tool(masses_and_springs(0.0, loss), 6).planes[0].damped
    values = np.array([mode.eigenvalue.real for mode in reported])
    np.testing.assert_allclose(values, -loss * natural / 2 * bent / whole, rtol=1e-5)
