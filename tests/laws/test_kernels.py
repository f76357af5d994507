"""One set of formulas for every library of numbers; derivatives and free bodies behind them."""

from __future__ import annotations

import ast
import cmath
import importlib.util
import inspect
from collections.abc import Callable, Iterator
from functools import cache
from types import ModuleType, SimpleNamespace
from typing import Any

import mpmath
import numpy as np
import pytest

from equipoise.mechanism.formulas import kernels
from laws.formulas import FORMULAS, Formula, constants, evaluate

ANGLES = np.array([0.1, 0.9, 1.7, 2.6, 3.5, 4.4, 5.8])
FUNCTIONS = {name: item for name, item in vars(kernels).items() if inspect.isfunction(item)}

every_formula = pytest.mark.parametrize("name", FORMULAS)


# -- what a kernel may contain ---------------------------------------------------------------------


def nodes(module: ModuleType) -> list[ast.stmt]:
    return ast.parse(inspect.getsource(module)).body


def bodies() -> Iterator[ast.FunctionDef]:
    return (node for node in nodes(kernels) if isinstance(node, ast.FunctionDef))


def test_kernels_import_nothing() -> None:
    parts = (part for top in nodes(kernels) for part in ast.walk(top))
    imports = [part for part in parts if isinstance(part, ast.Import | ast.ImportFrom)]
    assert [getattr(part, "module", None) for part in imports] == ["__future__"]


ARITHMETIC = (
    ast.FunctionDef, ast.arguments, ast.arg, ast.Expr, ast.Assign, ast.Return, ast.Tuple,
    ast.Name, ast.Load, ast.Store, ast.Constant, ast.BinOp, ast.UnaryOp, ast.Add, ast.Sub,
    ast.Mult, ast.Div, ast.Pow, ast.USub, ast.Attribute, ast.Call, ast.Starred,
)  # fmt: skip


@pytest.mark.parametrize("body", [*bodies()], ids=lambda body: body.name)
def test_kernel_is_arithmetic_only(body: ast.FunctionDef) -> None:
    strange = [type(node).__name__ for node in ast.walk(body) if not isinstance(node, ARITHMETIC)]
    assert not strange
    called = {ast.unparse(node.func) for node in ast.walk(body) if isinstance(node, ast.Call)}
    assert {name for name in called if not name.endswith(".conjugate")} <= {*FUNCTIONS, "abs"}
    parts = {node.attr for node in ast.walk(body) if isinstance(node, ast.Attribute)}
    assert parts <= {"real", "imag", "conjugate"}
    powers = [node.right for node in ast.walk(body)
              if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)]  # fmt: skip
    assert {ast.unparse(power) for power in powers} <= {"0.5", "3"}


def test_every_motion_kernel_is_tried() -> None:
    dyads = {"rrr", "parallelogram", "pointed", "rrp", "rpr", "prp", "rpp"}
    motion = {"point", "in_ratio", "rolled", "wound", "travelled", "apart", "railed", *dyads}
    assert {formula.kernel for formula in FORMULAS.values()} == motion
    assert motion <= FUNCTIONS.keys()


# -- the same numbers from every library -----------------------------------------------------------


def python_values(formula: Formula) -> np.ndarray:
    """Values from Python's own numbers, one row a crank angle."""
    return np.array([evaluate(formula, kernels, float(t), cmath.exp) for t in ANGLES])


def agree(got: Any, want: np.ndarray, tolerance: float = 1e-13) -> None:
    assert np.all(np.isfinite(want))
    np.testing.assert_allclose(got, want, rtol=0, atol=tolerance * np.max(np.abs(want)))


@every_formula
def test_arrays_give_what_numbers_give(name: str) -> None:
    values = evaluate(FORMULAS[name], kernels, ANGLES, np.exp)
    rows = np.stack([np.broadcast_to(value, ANGLES.shape) for value in values], axis=1)
    agree(rows, python_values(FORMULAS[name]))


@every_formula
def test_arrays_of_any_shape_are_kept(name: str) -> None:
    grid = ANGLES[:6].reshape(2, 3)
    values = evaluate(FORMULAS[name], kernels, grid, np.exp)
    flat = evaluate(FORMULAS[name], kernels, grid.ravel(), np.exp)
    for value, row in zip(values, flat, strict=True):
        np.testing.assert_array_equal(np.ravel(value), np.ravel(row))


@every_formula
def test_fifty_digits_give_what_numbers_give(name: str) -> None:
    with mpmath.workdps(50):
        rows = [
            [
                complex(v)
                for v in evaluate(FORMULAS[name], kernels, mpmath.mpf(float(t)), mpmath.exp)
            ]
            for t in ANGLES
        ]
    agree(rows, python_values(FORMULAS[name]))


@cache
def compiled() -> SimpleNamespace:
    """Load the kernels a second time and compile every one of them by Numba."""
    numba = pytest.importorskip("numba")
    spec = importlib.util.spec_from_file_location("compiled_kernels", inspect.getfile(kernels))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name in FUNCTIONS:  # each calls those before it, which are compiled by then
        setattr(module, name, numba.njit(getattr(module, name)))
    return SimpleNamespace(**{name: getattr(module, name) for name in FUNCTIONS})


@every_formula
def test_compiled_kernels_give_what_numbers_give(name: str) -> None:
    rows = [evaluate(FORMULAS[name], compiled(), float(t), cmath.exp) for t in ANGLES]
    agree(rows, python_values(FORMULAS[name]))


# -- derivatives -----------------------------------------------------------------------------------

STEP, DIGITS = mpmath.mpf(10) ** -12, 1e-20


def differences(values: Callable[[Any], Any], t: Any) -> tuple[Any, Any]:
    """First and second central difference."""
    before, here, after = values(t - STEP), values(t), values(t + STEP)
    return (after - before) / (2 * STEP), (after - 2 * here + before) / STEP**2


def from_rotation(u: Any, first: Any, second: Any) -> tuple[Any, Any]:
    """Derivatives of an angle from those of u = exp(i angle)."""
    w = first / (1j * u)
    return w, (second / u + w * w) / 1j


@every_formula
@pytest.mark.parametrize("t", ANGLES[::2])
def test_derivatives_against_differences(name: str, t: float) -> None:
    formula = FORMULAS[name]
    with mpmath.workdps(50):
        theta = mpmath.mpf(float(t))
        values = evaluate(formula, kernels, theta, mpmath.exp)
        for k, kind in enumerate(formula.results):
            place = 3 * k

            def value(at: Any, place: int = place) -> Any:
                return evaluate(formula, kernels, at, mpmath.exp)[place]

            result = differences(value, theta)
            if kind == "link":
                result = from_rotation(values[place], *result)
            for got, want in zip(values[place + 1 : place + 3], result, strict=True):
                assert abs(got - want) < DIGITS * (1 + abs(want)), (kind, k)


# -- geometry --------------------------------------------------------------------------------------


def moved(name: str) -> tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]]:
    """Moving inputs, parameters and results of a formula."""
    formula = FORMULAS[name]
    moving = formula.moving(ANGLES, np.exp)
    return moving, constants(formula, np.exp), evaluate(formula, kernels, ANGLES, np.exp)


def zero(gap: Any) -> None:
    assert np.max(np.abs(gap)) < 1e-13


@pytest.mark.parametrize("name", ["parallel", "antiparallel"])
def test_opposite_sides_are_equal(name: str) -> None:
    (p, _, _, q, *_), (arm_p, arm_q, side), (*_, c, _, _, sine2) = moved(name)
    zero(abs(c - p) - abs(arm_p))
    zero(abs(c - q) - abs(arm_q))
    a = moved(name)[0][6]
    zero(kernels.cross(c - p, q - a) if side > 0 else kernels.cross(c - a, q - p))
    zero(np.sin(np.angle((c - p) / (c - q))) ** 2 - sine2)


@pytest.mark.parametrize(("name", "sign"), [("rrr left", 1), ("rrr right", -1)])
def test_rrr_closes_on_its_side(name: str, sign: int) -> None:
    (p, _, _, q, *_), (arm_p, arm_q, _), (u_p, _, _, u_q, _, _, c, _, _, number) = moved(name)
    zero(p + u_p * arm_p - c)
    zero(q + u_q * arm_q - c)
    assert np.all(sign * kernels.cross(q - p, c - p) > 0)
    transmission = np.angle((c - p) / (c - q))
    np.testing.assert_allclose(number, np.sin(transmission) ** 2, atol=1e-14)


@pytest.mark.parametrize(("name", "sign"), [("rrp forward", 1), ("rrp backward", -1)])
def test_rrp_closes_on_its_side(name: str, sign: int) -> None:
    (p, _, _, g, _, _, u, *_), (arm, along, shift, turn, _), actual = moved(name)
    u_p, _, _, u_s, _, _, c, _, _, number = actual
    n = u * along
    zero(p + u_p * arm - c)
    zero(u_s - n * turn)
    zero(((c - n * shift - g) / n).imag)
    assert np.all(sign * ((c - p) / n).real > 0)
    np.testing.assert_allclose(number, ((c - p) / n).real ** 2 / abs(arm) ** 2, atol=1e-14)


@pytest.mark.parametrize(("name", "sign"), [("rpr forward", 1), ("rpr backward", -1)])
def test_rpr_closes_on_its_side(name: str, sign: int) -> None:
    (p, _, _, q, *_), (offset, turn, back, small, _), (u_block, _, _, u_guide, _, _, number) = (
        moved(name)
    )
    n = u_block / turn
    zero(u_guide / back - n)
    zero(abs(n) - 1)
    zero(((p - q) / n).imag - offset)
    assert np.all(sign * ((p - q) / n).real > 0)
    want = ((p - q) / n).real ** 2 / (abs(p - q) ** 2 + small)
    np.testing.assert_allclose(number, want, atol=1e-14)


def test_prp_meets_on_both_lines() -> None:
    (g, _, _, u, _, _, h, _, _, v, *_), parameters, actual = moved("prp")
    along_g, shift_g, turn_g, along_h, shift_h, turn_h = parameters
    u_g, _, _, u_h, _, _, c, *_ = actual
    n, m = u * along_g, v * along_h
    zero(((c - n * shift_g - g) / n).imag)
    zero(((c - m * shift_h - h) / m).imag)
    zero(u_g - n * turn_g)
    zero(u_h - m * turn_h)


def test_rpp_slides_on_both_lines() -> None:
    (p, _, _, g, _, _, u, *_), (along, turn, inner, inner_turn, shift), actual = moved("rpp")
    u_first, _, _, u_second, _, _, s, *_ = actual
    n = u * along
    zero(((s - g) / n).imag)
    zero(((p + n * shift - s) / (n * inner)).imag)
    zero(u_first - n * inner_turn)
    zero(u_second - n * turn)


def test_a_dyad_out_of_reach_reports_so_by_its_number() -> None:
    with np.errstate(all="ignore"):
        q = np.array([1.0 + 0j, 5.0 + 0j])
        *_, number = kernels.rrr(0j, 0j, 0j, q, 1j, 0j, 1 + 0j, 1 + 0j, 1.0)
    assert number[0] > 0 > number[1]


@pytest.mark.parametrize("x", [-2.0, 0.0, 3.5])
def test_positive_part(x: float) -> None:
    assert kernels.positive(x) == max(x, 0.0)


def test_products_of_vectors() -> None:
    a, b = 3 + 4j, -1 + 2j
    assert kernels.cross(a, b) == 3 * 2 - 4 * -1
    assert kernels.dot(a, b) == 3 * -1 + 4 * 2


# -- forces: free bodies solved directly -----------------------------------------------------------

RNG = np.random.default_rng(17)


def vectors(count: int) -> list[complex]:
    return [complex(*RNG.normal(size=2)) for _ in range(count)]


def units(count: int) -> list[complex]:
    return [cmath.exp(1j * angle) for angle in RNG.uniform(0, 6.28, count)]


def rows(force: complex, moment: float) -> list[float]:
    return [force.real, force.imag, moment]


def solve(columns: list[list[float]], demand: list[float]) -> np.ndarray:
    """Strengths of unknown wrenches, each a column of its force and moment on every body."""
    return np.linalg.solve(np.array(columns).T, demand)


def on_first(force: complex, at: complex, anchor: complex, couple: float = 0.0) -> list[float]:
    return [*rows(force, kernels.cross(at - anchor, force) + couple), 0.0, 0.0, 0.0]


def on_second(force: complex, at: complex, anchor: complex, couple: float = 0.0) -> list[float]:
    return [0.0, 0.0, 0.0, *rows(force, kernels.cross(at - anchor, force) + couple)]


def between(force: complex, at: complex, anchors: tuple[complex, complex], couple: float = 0.0,
            ) -> list[float]:  # fmt: skip
    """A wrench on the second body and its opposite on the first."""
    second = on_second(force, at, anchors[1], couple)
    first = on_first(-force, at, anchors[0], -couple)
    return [a + b for a, b in zip(first, second, strict=True)]


def close(got: tuple[Any, ...], want: list[Any]) -> None:
    np.testing.assert_allclose(got, want, rtol=1e-12, atol=1e-12)


repeated = pytest.mark.parametrize("trial", range(4))


@repeated
def test_rrr_forces(trial: int) -> None:
    p, q, c, force_p, force_q = vectors(5)
    moment_p, moment_q = RNG.normal(size=2)
    columns = [on_first(1, p, p), on_first(1j, p, p), on_second(1, q, q), on_second(1j, q, q),
               between(1, c, (p, q)), between(1j, c, (p, q))]  # fmt: skip
    x = solve(columns, [*rows(force_p, moment_p), *rows(force_q, moment_q)])
    got = kernels.rrr_forces(p, q, c, force_p, moment_p, force_q, moment_q)
    close(got, [complex(*x[0:2]), complex(*x[2:4]), complex(*x[4:6])])


@repeated
def test_rrp_forces(trial: int) -> None:
    p, c, force_p, force_s = vectors(4)
    u, along = units(2)
    moment_p, moment_s = RNG.normal(size=2)
    normal = 1j * u * along
    columns = [on_first(1, p, p), on_first(1j, p, p), on_second(normal, c, c),
               on_second(0, c, c, 1.0), between(1, c, (p, c)), between(1j, c, (p, c))]  # fmt: skip
    x = solve(columns, [*rows(force_p, moment_p), *rows(force_s, moment_s)])
    got = kernels.rrp_forces(p, c, u, force_p, moment_p, force_s, moment_s, along)
    close(got, [complex(*x[0:2]), normal * x[2], x[3], complex(*x[4:6])])


@repeated
def test_rpr_forces(trial: int) -> None:
    p, q, force_p, force_q = vectors(4)
    u, back = units(2)
    moment_p, moment_q = RNG.normal(size=2)
    normal = 1j * u * back
    # the guide, second body, acts on the block, first body
    columns = [on_first(1, p, p), on_first(1j, p, p), on_second(1, q, q), on_second(1j, q, q),
               between(-normal, p, (p, q)), between(0, p, (p, q), -1.0)]  # fmt: skip
    x = solve(columns, [*rows(force_p, moment_p), *rows(force_q, moment_q)])
    got = kernels.rpr_forces(p, q, u, force_p, moment_p, force_q, moment_q, back)
    close(got, [complex(*x[0:2]), complex(*x[2:4]), normal * x[4], x[5]])


@repeated
def test_prp_forces(trial: int) -> None:
    force_g, force_h = vectors(2)
    u, v, along_g, along_h = units(4)
    moment_g, moment_h = RNG.normal(size=2)
    n, m = 1j * u * along_g, 1j * v * along_h
    columns = [on_first(n, 0, 0), on_first(0, 0, 0, 1.0), on_second(m, 0, 0),
               on_second(0, 0, 0, 1.0), between(1, 0, (0, 0)), between(1j, 0, (0, 0))]  # fmt: skip
    x = solve(columns, [*rows(force_g, moment_g), *rows(force_h, moment_h)])
    got = kernels.prp_forces(u, v, force_g, moment_g, force_h, moment_h, along_g, along_h)
    close(got, [n * x[0], x[1], m * x[2], x[3], complex(*x[4:6])])


@repeated
def test_rpp_forces(trial: int) -> None:
    p, s, force_p, force_s = vectors(4)
    u, along, inner = units(3)
    moment_p, moment_s = RNG.normal(size=2)
    n, m = 1j * u * along, 1j * u * along * inner
    # the second body acts on the first
    columns = [on_first(1, p, p), on_first(1j, p, p), on_second(n, s, s), on_second(0, s, s, 1.0),
               between(-m, p, (p, s)), between(0, p, (p, s), -1.0)]  # fmt: skip
    x = solve(columns, [*rows(force_p, moment_p), *rows(force_s, moment_s)])
    got = kernels.rpp_forces(p, s, u, force_p, moment_p, force_s, moment_s, along, inner)
    close(got, [complex(*x[0:2]), n * x[2], x[3], m * x[4], x[5]])


@repeated
@pytest.mark.parametrize("radial", [-0.36, 0.0, 0.36])
def test_flank_forces(trial: int, radial: float) -> None:
    """Of a gear, whose tooth force acts at the pitch point, and not at its pin."""
    force, lever = vectors(2)
    (u,) = units(1)
    moment = float(RNG.normal())
    (sense,) = kernels.flank(moment)
    assert sense == pytest.approx(np.sign(moment))
    outward = u * lever / abs(lever)
    line = 1j * outward + radial * sense * outward
    columns = [rows(1, 0.0), rows(1j, 0.0), rows(line, kernels.cross(u * lever, line))]
    x = np.linalg.solve(np.array(columns).T, rows(force, moment))
    got = kernels.flank_forces(force, moment, u, sense, lever, -radial)
    close(got, [complex(*x[0:2]), line * x[2], x[2]])


def test_flank_without_load() -> None:
    assert kernels.flank(0.0) == (0.0,)


@repeated
def test_inertia_demand_is_newton_and_euler(trial: int) -> None:
    p1, p2, arm = vectors(3)
    (u,) = units(1)
    w, a, speed, acceleration, mass, own = RNG.normal(size=6)
    alpha = a * speed**2 + w * acceleration
    r = u * arm
    center = p2 * speed**2 + p1 * acceleration + (1j * alpha - (w * speed) ** 2) * r
    got = kernels.inertia_demand(p1, p2, u, w, a, speed**2, acceleration, mass, mass * arm,
                                 own + mass * abs(arm) ** 2)  # fmt: skip
    close(got, [mass * center, own * alpha + kernels.cross(r, mass * center)])


@repeated
def test_inertia_about_another_point_is_steiner(trial: int) -> None:
    arm, shift = vectors(2)
    mass, own = RNG.normal(size=2)
    got = kernels.about(mass, mass * arm, own + mass * abs(arm) ** 2, shift)
    close(got, [mass, mass * (arm - shift), own + mass * abs(arm - shift) ** 2])


@repeated
def test_demands_of_weight_and_load(trial: int) -> None:
    arm, gravity, anchor, at, force = vectors(5)
    (u,) = units(1)
    mass, torque = RNG.normal(size=2)
    got = kernels.weight_demand(u, mass, mass * arm, gravity)
    close(got, [-mass * gravity, -kernels.cross(u * arm, mass * gravity)])
    got = kernels.load_demand(anchor, at, force, torque)
    close(got, [-force, -kernels.cross(at - anchor, force) - torque])


@repeated
def test_transfer_moves_a_reaction_to_an_anchor(trial: int) -> None:
    force, anchor, at, reaction = vectors(4)
    moment, couple = RNG.normal(size=2)
    turned = moment + kernels.cross(at - anchor, reaction)
    close(kernels.transfer(force, moment, anchor, at, reaction), [force + reaction, turned])
    got = kernels.transfer_couple(force, moment, anchor, at, reaction, couple)
    close(got, [force + reaction, turned + couple])


# -- forces from every library ---------------------------------------------------------------------

SIGNATURES = {
    "about": "rcrc",
    "along_line": "cccurr",
    "slid": "cccurrrrr",
    "inertia_demand": "ccurrrrrcr",
    "weight_demand": "urcc",
    "load_demand": "cccr",
    "spring": "ccrr",
    "pulled": "ccr",
    "drive_torque": "crcr",
    "transfer": "crccc",
    "transfer_couple": "crcccr",
    "rrr_forces": "ccccrcr",
    "rrp_forces": "ccucrcru",
    "rpr_forces": "ccucrcru",
    "prp_forces": "uucrcruu",
    "rpp_forces": "ccucrcruu",
    "flank": "r",
    "flank_forces": "crurcr",
    "strand_forces": "crurrcc",
    "flank_ahead": "cuu",
    "sliding_forces": "crccurur",
    "pitch_slope": "rr",
    "pitch_place": "cuc",
    "slant": "rrr",
    "rolling_forces": "crurcrr",
    "round_contact": "ccr",
    "flat_contact": "ccru",
    "round_curvature": "ccc",
    "flat_radius": "cccrru",
    "lifted": "rrrrrcccurruur",
    "swung": "rrrrrrrrrr",
    "rate_lifted": "uru",
    "rate_swung": "ccrr",
    "forth_lifted": "uu",
    "forth_swung": "ccr",
    "touch_round": "cccr",
    "touch_flat": "cccurur",
    "lifted_forces": "crccuuu",
    "swung_forces": "crccu",
    "piece_value": "rrrrrrrrrrrrr",
    "plane_piece": "rcccccc",
    "on_track": "cccurrccccrr",
    "half_angle": "urrrr",
    "unit": "c",
    "series_term": "rrrurrr",
    "followed": "rrrrrr",
}
"""Arguments of all other kernels: c a vector, u a rotation, r a real number."""


def arguments(name: str) -> list[Any]:
    rng = np.random.default_rng([3, *name.encode()])
    make = {
        "c": lambda: complex(*rng.normal(size=2)),
        "u": lambda: cmath.exp(1j * rng.uniform(0, 6.28)),
        "r": lambda: float(rng.normal()),
    }
    return [make[kind]() for kind in SIGNATURES[name]]


TOOLS = {"cross", "dot", "positive", "length", "inverse", "inverse_or_zero", "turning"}
"""Of vectors, on which the formulas stand."""


def test_every_force_kernel_is_tried() -> None:
    motion = {formula.kernel for formula in FORMULAS.values()}
    assert FUNCTIONS.keys() - motion - {*TOOLS} == SIGNATURES.keys()


@pytest.mark.parametrize("name", SIGNATURES)
def test_force_kernels_on_every_kind_of_number(name: str) -> None:
    given = arguments(name)
    want = np.atleast_1d(FUNCTIONS[name](*given))
    arrays = np.atleast_2d(FUNCTIONS[name](*[np.full(3, value) for value in given]))
    agree(arrays, np.repeat(want[:, None], 3, axis=1))
    with mpmath.workdps(50):
        exact = np.atleast_1d(FUNCTIONS[name](*[mpmath.mpmathify(value) for value in given]))
    agree([complex(value) for value in exact], want)
    agree(np.atleast_1d(getattr(compiled(), name)(*given)), want)
