"""The steps of one linkage in C: ``state`` and the kernels that it calls, of complex numbers.

Kernels are arithmetic only, so that each of their expressions has one in C99.  Every value is a
``double complex`` there, whose real part is meant where Python has a real number.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from functools import cache
from itertools import chain

import numpy as np

from equipoise.codegen.source import KERNELS, Row, Source
from equipoise.errors import UsageError
from equipoise.mechanism.assembly.linkage import Linkage

OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
LIBRARY = {"abs": "cabs({})", "angle_of": "carg({})", "rotation": "cexp(_Complex_I * {})"}
PARTS = {"real": "creal", "imag": "cimag"}


def in_c(source: Source, linkage: Linkage) -> str:
    """C of ``state(theta, speed, acceleration, found)``, which fills in the signals in their order.

    Raises
    ------
    UsageError : a group of loops goes from one crank angle to the next, or a load changes over the
        crank angle.
    """
    if source.carried:
        raise UsageError("loops that no dyads solve cannot be written in C; give another format")
    tree = ast.parse(source.text)
    (state,) = (
        one for one in tree.body if isinstance(one, ast.FunctionDef) and one.name == "state"
    )
    known = _kernels()
    used = _used(state, known)
    parts = [_function(one, known) for name, one in known.items() if name in used]
    inputs = ("speed", "acceleration")
    given = [f"v_{one.name} = {_of_angle(one)};" for one in source.rows]
    given += [
        f"v_{slot.name} = {_number(complex(slot.read(linkage)))};"
        for slot in source.slots
        if slot.name not in inputs
    ]
    declared = [f"    const complex_t {line}" for line in given]
    arguments = ["double theta", *(f"complex_t v_{one}" for one in inputs), "complex_t *out"]
    head = f"static void state({', '.join(arguments)})"
    body = [*declared, *_lines(state, known)]
    top = ["#include <complex.h>", "#include <math.h>", "typedef double complex complex_t;"]
    return "\n\n".join(["\n".join(top), *parts, "\n".join([head, "{", *body, "}"])]) + "\n"


def _of_angle(row: Row) -> str:
    """What depends on the crank angle, or does not but might."""
    first, *others = row.values(np.linspace(0.0, 6.0, 7)).tolist()
    if row.formula or others != [first] * len(others):
        return row.formula or _none(row.name.replace("_", " "))
    return _number(complex(first))


def _none(what: str) -> str:
    raise UsageError(f"{what} changes over the crank angle in a way that has no formula in C")


def _number(value: complex) -> str:
    if not value.imag:
        return repr(value.real)
    return f"({value.real!r} + {value.imag!r} * _Complex_I)"


@cache
def _kernels() -> dict[str, ast.FunctionDef]:
    """Every kernel by name, those before that others call."""
    lines = chain.from_iterable(ast.parse(inspect.getsource(one)).body for one in KERNELS)
    return {one.name: one for one in lines if isinstance(one, ast.FunctionDef)}


def _used(function: ast.FunctionDef, known: dict[str, ast.FunctionDef]) -> set[str]:
    """Kernels that a function calls, and those that these call."""
    calls = (one.func for one in ast.walk(function) if isinstance(one, ast.Call))
    names = {one.id for one in calls if isinstance(one, ast.Name) and one.id in known}
    return names.union(*(_used(known[name], known) for name in names))


def _results(function: ast.FunctionDef) -> int:
    """How many values it returns in a tuple; 0 of a single one."""
    value = function.body[-1].value if isinstance(function.body[-1], ast.Return) else None
    return len(value.elts) if isinstance(value, ast.Tuple) else 0


def _function(function: ast.FunctionDef, known: dict[str, ast.FunctionDef]) -> str:
    several = _results(function)
    arguments = [f"complex_t v_{one.arg}" for one in function.args.args]
    arguments += ["complex_t *out"] if several else []
    kind = "void" if several else "complex_t"
    head = f"static {kind} k_{function.name}({', '.join(arguments)})"
    return "\n".join([head, "{", *_lines(function, known), "}"])


def _lines(function: ast.FunctionDef, known: dict[str, ast.FunctionDef]) -> Iterator[str]:
    """The statements of a function; a name is declared where it is first given a value."""
    seen = {one.arg for one in function.args.args}
    for number, line in enumerate(function.body):
        if isinstance(line, ast.Return):
            assert line.value is not None
            if isinstance(line.value, ast.Tuple):
                for k, value in enumerate(line.value.elts):
                    yield f"    out[{k}] = {_told(value)};"
            else:
                yield f"    return {_told(line.value)};"
        elif isinstance(line, ast.Assign):
            yield from _assigned(line.targets[0], line.value, number, seen, known)


def _assigned(
    target: ast.expr,
    value: ast.expr,
    number: int,
    seen: set[str],
    known: dict[str, ast.FunctionDef],
) -> Iterator[str]:
    """One assignment: of one value, of several, or of what a kernel returns in a tuple."""
    if isinstance(target, ast.Name):
        yield f"    {_new(target, seen)} = {_told(value)};"
        return
    assert isinstance(target, ast.Tuple)
    if isinstance(value, ast.Tuple):
        temporary = [f"t{number}_{k}" for k in range(len(value.elts))]
        for name, one in zip(temporary, value.elts, strict=True):
            yield f"    const complex_t {name} = {_told(one)};"
    else:
        assert isinstance(value, ast.Call) and isinstance(value.func, ast.Name)
        count = _results(known[value.func.id])
        temporary = [f"t{number}[{k}]" for k in range(count)]
        given = ", ".join(map(_told, value.args))
        yield f"    complex_t t{number}[{count}];"
        yield f"    k_{value.func.id}({given}, t{number});"
    for one, name in zip(target.elts, temporary, strict=True):
        yield f"    {_new(one, seen)} = {name};"


def _new(target: ast.expr, seen: set[str]) -> str:
    assert isinstance(target, ast.Name)
    kind = "" if target.id in seen else "complex_t "
    seen.add(target.id)
    return f"{kind}v_{target.id}"


def _told(node: ast.expr) -> str:
    """An expression."""
    match node:
        case ast.Name():
            found = f"v_{node.id}"
        case ast.Constant(value=complex() | float() | int() as value):
            found = _number(complex(value))
        case ast.UnaryOp(op=ast.USub()):
            found = f"(-{_told(node.operand)})"
        case ast.BinOp(op=ast.Pow()):
            found = f"cpow({_told(node.left)}, {_told(node.right)})"
        case ast.BinOp():
            found = f"({_told(node.left)} {OPERATORS[type(node.op)]} {_told(node.right)})"
        case ast.Attribute(attr="real" | "imag" as part):
            found = f"{PARTS[part]}({_told(node.value)})"
        case ast.Call(func=ast.Attribute(attr="conjugate", value=value)):
            found = f"conj({_told(value)})"
        case ast.Call(func=ast.Name(id=name), args=arguments):
            inner = ", ".join(map(_told, arguments))
            found = LIBRARY.get(name, f"k_{name}({{}})").format(inner)
        case _:
            raise UsageError(f"{ast.unparse(node)} cannot be written in C")
    return found
