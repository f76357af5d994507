"""The expression graph: each term exists once, zeros fall away, and the numbers are the same."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from equipoise.codegen import terms
from equipoise.codegen.source import PYTHON, Lines, boundary, on_arrays
from equipoise.codegen.terms import ANGLE, BOTH, DESIGN, Graph, Term, VectorTerm

NAMES = ("a", "b", "c")


def arguments(mask: int = BOTH) -> list[Term]:
    graph = Graph()
    return [graph.argument(name, mask) for name in NAMES]


def test_terms_exist_once() -> None:
    a, b, _ = arguments()
    assert a + b is b + a
    assert a * b is b * a
    assert (a - b) is -(b - a)
    assert (-a) * b is -(a * b)
    assert 2.0 * (3.0 * a) is 6.0 * a


def test_what_is_nothing_falls_away() -> None:
    a, b, _ = arguments()
    assert a + 0 is a and a - 0.0 is a and 1 * a is a and -1.0 * a is -a
    assert terms.negative(-a) is a
    assert 0j * VectorTerm(a, b) != 0 and (0.0 * a, a - a) == (0.0, 0.0)
    assert np.float64(1.0) * a is a
    vector = (1 + 0j) * VectorTerm(a, b)
    assert vector.real is a and vector.imag is b


def test_plain_numbers_are_computed_at_once() -> None:
    assert terms.root(4.0) == 2.0
    assert math.isnan(terms.root(-1.0))
    assert terms.select(2.0, 1.0, 5.0, 6.0) == 5.0
    assert terms.angle_of(1j) == pytest.approx(np.pi / 2)
    assert terms.inverse(0.0) == math.inf


def test_masks_report_what_a_term_depends_on() -> None:
    graph = Graph()
    a, d = graph.argument("a", ANGLE), graph.argument("d", DESIGN)
    total = a * a + (d * d) * a
    assert (a * a).mask == ANGLE and (d * d).mask == DESIGN and total.mask == BOTH
    assert boundary([total], ANGLE) == [a, a * a]
    assert boundary([total], DESIGN) == [d * d]


OPERATIONS: list[Callable[[Any, Any], Any]] = [
    operator.add, operator.sub, operator.mul, lambda x, y: x - (-y), lambda x, y: -x * y + 2.0,
    lambda x, y: x / (2.0 + y * y), lambda x, y: (x * x + 0.5) ** 0.5, lambda x, y: abs(x) - 3 * y,
    lambda x, y: x.real - x.imag + y.conjugate().real, lambda x, y: 1 - x * 0.5,
]  # fmt: skip


@settings(max_examples=150, deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, len(OPERATIONS) - 1), st.integers(0, 30), st.integers(0, 30)),
        min_size=1, max_size=40,
    ),
    st.lists(st.floats(-2, 2), min_size=3, max_size=3),
)  # fmt: skip
def test_random_programs_give_the_same_numbers(
    program: list[tuple[int, int, int]], numbers: list[float]
) -> None:
    """Against the operations carried out one after the other on the numbers themselves."""
    values: list[Any] = [*arguments()]
    plain: list[Any] = [*map(np.float64, numbers)]
    for number, i, j in program:
        x, y = plain[i % len(plain)], plain[j % len(plain)]
        if abs(result := OPERATIONS[number](x, y)) < 1e6:
            x, y = values[i % len(plain)], values[j % len(plain)]
            plain.append(result)
            values.append(OPERATIONS[number](x, y))
    computed = on_arrays(values[3:])
    used = {item.args[0] for item in terms.reached(values[3:]) if item.op == "argument"}
    got = computed(**{k: v for k, v in zip(NAMES, numbers, strict=True) if k in used})
    scale = max(map(abs, plain))
    assert np.allclose(
        np.array(got, float), np.array(plain[3:], float), rtol=1e-9, atol=1e-9 * scale
    )


def test_vectors_are_complex_numbers() -> None:
    a, b, c = arguments()
    z, w = VectorTerm(a, b), VectorTerm(c, 1.0)
    results = [z * w, z + w, z - 2j, 1j * z, z / c, z / w, 1 / w, -z, z.conjugate() * w, abs(z) * w]
    flat = [part for result in results for part in (result.real, result.imag)]
    x, y, u = 0.3, -1.2, 0.7
    p, q = complex(x, y), complex(u, 1.0)
    known = [p * q, p + q, p - 2j, 1j * p, p / u, p / q, 1 / q, -p, p.conjugate() * q, abs(p) * q]
    got = on_arrays(flat)(a=x, b=y, c=u)
    assert np.allclose(np.array(got).reshape(-1, 2) @ [1, 1j], known, rtol=1e-15)


def test_numpy_functions_record_themselves() -> None:
    a, b, _ = arguments()
    results = [np.hypot(a, b), np.maximum(a, np.float64(0.1)), np.cos(a), np.arctan2(b, a), a**3]
    x, y = 0.4, -0.3
    known = [np.hypot(x, y), 0.4, np.cos(x), np.arctan2(y, x), x**3]
    assert on_arrays(results)(a=x, b=y) == pytest.approx(known, rel=1e-15)
    turned = np.exp(1j * a)
    assert on_arrays([turned.real, turned.imag])(a=x) == pytest.approx([np.cos(x), np.sin(x)])
    with pytest.raises(TypeError):
        np.exp(a)
    with pytest.raises(TypeError):
        np.arccosh(a)


def test_long_expressions_are_cut() -> None:
    """So that Python finds none nested too deep."""
    graph = Graph()
    total: Any = 0.0
    for k in range(500):
        total = total + graph.argument(f"x{k}", BOTH) * float(k + 1)
    lines = [*Lines([total], PYTHON).write((BOTH,), [total])]
    assert max(line.count("(") for line in lines) < 30
    got = on_arrays([total])(**{f"x{k}": 1.0 for k in range(500)})
    assert got[0] == 500 * 501 / 2


def test_comparisons_are_those_of_the_base() -> None:
    graph = Graph()
    a, b = graph.argument("a", DESIGN), graph.argument("b", DESIGN)
    with pytest.raises(TypeError, match="no number"):
        assert a < b
    graph.base |= {"a": 3.0, "b": 4.0}
    assert a < b and not a * a >= b * b and (a * a + b * b) ** 0.5 <= 5.0 and b - a > 0.5
