"""Compiled functions of `codegen.extremes` in JavaScript, from their Python source.

They use little of Python: scalars, arrays of numbers, loops over ranges and arrays, and a few
functions.  Each of these has its counterpart here; anything else is a `TypeError`.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np

from equipoise.codegen import extremes

SIGNS: Final[Mapping[type[ast.AST], str]] = {ast.USub: "-", ast.Not: "!"}
OPERATORS: Final[Mapping[type[ast.AST], str]] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
}
COMPARISONS: Final[Mapping[type[ast.AST], str]] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "===", ast.NotEq: "!==",
}  # fmt: skip
CALLS: Final = {
    "abs": "Math.abs", "min": "Math.min", "max": "Math.max", "int": "Math.trunc",
    "smaller": "Math.min", "larger": "Math.max",
    "np.sqrt": "Math.sqrt", "np.argmax": "argmax", "np.empty": "empty",
}  # fmt: skip
LIBRARY: Final = """\
const modulo = (x, y) => ((x % y) + y) % y;
const argmax = (values) => values.indexOf(Math.max(...values));
const empty = (first, ...others) => others.length
    ? Array.from({ length: first }, () => empty(...others))
    : new Float64Array(first);"""
EXTREMES: Final = """\
function extremes(values, period, at, edges) {{
    const out = [Float64Array.of(Math.max(...values), Math.min(...values), 0, 0, 0, 0)];
    {}
    return out[0];
}}"""
CALLED: Final = {
    "grid_extremes": "grid_extremes([[values]], out, [[0, 1, 2, 3, 4, 5]], period, 0);",
    "panel_extremes": "panel_extremes([[values]], out, [[0, 1, 2, 3, 4, 5]], at, edges, period);",
}


def extremes_script(jumps: bool) -> str:
    """Source of ``extremes(values, period, at, edges)``, for one signal as a `Float64Array`.

    It gives its highest and lowest sample, its highest value and the crank angle of that, rad, and
    its lowest value and the crank angle of that, as `signals.smooth_tops` and `JumpSampling.tops`.

    jumps : values are those of a `JumpSampling`: first those shown, at crank angles `at`, then
        those of panels between `edges`; else they are equally spaced from 0 over the period, rad.
    """
    kernel = "panel_extremes" if jumps else "grid_extremes"
    needed = [*_needed(kernel)]
    constants = [
        f"const {name} = {_constant(getattr(extremes, name))};"
        for name in extremes.NUMBERS
        if name in needed
    ]
    functions = [
        script_of(item)
        for item in (*extremes.HELPERS, *extremes.KERNELS)
        if item.__name__ in needed
    ]
    wrapper = EXTREMES.format(CALLED[kernel])
    return "\n".join([LIBRARY, *constants, *functions, wrapper]) + "\n"


def _needed(name: str) -> Iterator[str]:
    """Names of a function, and of all functions and constants that it uses."""
    waiting, known = [name], {name}
    while waiting:
        item = waiting.pop()
        yield item
        value = getattr(extremes, item)
        names = value.__code__.co_names if inspect.isfunction(value) else ()
        wanted = [other for other in names if hasattr(extremes, other) and other not in known]
        known.update(wanted)
        waiting += wanted


def _constant(value: Any) -> str:
    return repr(value.tolist() if isinstance(value, np.ndarray) else value)


def script_of(function: Callable[..., Any]) -> str:
    """A function of scalars, arrays and loops in JavaScript.

    Rows of arrays are `Float64Array`, in lists where an array has several axes.

    Raises
    ------
    TypeError : it uses something of Python that has no counterpart here.
    """
    tree = ast.parse(inspect.getsource(function))
    (definition,) = tree.body
    if not isinstance(definition, ast.FunctionDef):
        raise TypeError(type(definition).__name__)
    inputs = [argument.arg for argument in definition.args.args]
    body = definition.body[1:] if ast.get_docstring(definition) is not None else definition.body
    own = dict.fromkeys(name for line in body for name in _assigned(line))
    local = [name for name in own if name not in inputs]
    lines = [f"let {', '.join(local)};"] if local else []
    lines += _block(body)
    return "\n".join(
        [f"function {definition.name}({', '.join(inputs)}) {{", *_indented(lines), "}"]
    )


def _assigned(line: ast.stmt) -> Iterator[str]:
    """Names that a statement assigns, but for the variables of loops."""
    loops = {id(item.target) for item in ast.walk(line) if isinstance(item, ast.For)}
    for item in ast.walk(line):
        if isinstance(item, ast.Name) and isinstance(item.ctx, ast.Store) and id(item) not in loops:
            yield item.id


def _indented(lines: Iterable[str]) -> Iterator[str]:
    return (f"    {line}" for line in lines)


def _block(body: Sequence[ast.stmt]) -> Iterator[str]:
    for line in body:
        yield from _statement(line)


def _statement(line: ast.stmt) -> Iterator[str]:
    match line:
        case ast.Assign(targets=[ast.Subscript(value=array, slice=ast.Slice(None, None))]):
            yield f"{_text(array)}.fill({_text(line.value)});"
        case (
            ast.Assign(targets=[target], value=value)
            | ast.AnnAssign(target=target, value=ast.expr() as value)
        ):
            yield f"{_text(target)} = {_text(value)};"
        case ast.AugAssign():
            yield f"{_text(line.target)} {_sign(OPERATORS, line.op)}= {_text(line.value)};"
        case ast.For():
            yield f"for ({_loop(line)}) {{"
            yield from _indented(_block(line.body))
            yield "}"
        case ast.If():
            yield f"if ({_text(line.test)}) {{"
            yield from _indented(_block(line.body))
            if line.orelse:
                yield "} else {"
                yield from _indented(_block(line.orelse))
            yield "}"
        case ast.Return():
            yield "return;" if line.value is None else f"return {_text(line.value)};"
        case ast.Expr(value=ast.Call()):
            yield f"{_text(line.value)};"
        case ast.Continue() | ast.Break():
            yield f"{type(line).__name__.lower()};"
        case _:
            raise TypeError(ast.unparse(line))


def _loop(line: ast.For) -> str:
    """Head of a loop over a range or the values of an array."""
    name = _text(line.target)
    match line.iter:
        case ast.Call(func=ast.Name("range"), args=args):
            begin, end, step = ("0", _text(args[0]), "1") if len(args) == 1 else (
                *map(_text, args[:2]), _text(args[2]) if args[2:] else "1"
            )  # fmt: skip
            sign = ">" if step.startswith("-") else "<"
            return f"let {name} = {begin}; {name} {sign} {end}; {name} += {step}"
        case _:
            return f"const {name} of {_text(line.iter)}"


class _Expressions(ast.NodeVisitor):
    """Expressions as text, with those within others in brackets."""

    def generic_visit(self, node: ast.AST) -> str:
        raise TypeError(ast.unparse(node))

    def visit_Constant(self, node: ast.Constant) -> str:
        if isinstance(node.value, bool) or not isinstance(node.value, int | float):
            self.generic_visit(node)
        return repr(node.value)

    def visit_Name(self, node: ast.Name) -> str:
        return node.id

    def visit_Attribute(self, node: ast.Attribute) -> str:
        return "Infinity" if ast.unparse(node) == "np.inf" else self.generic_visit(node)

    def visit_Tuple(self, node: ast.Tuple) -> str:
        return f"[{', '.join(map(self.visit, node.elts))}]"

    def visit_UnaryOp(self, node: ast.UnaryOp) -> str:
        return f"{_sign(SIGNS, node.op)}{self.visit(node.operand)}"

    def visit_BinOp(self, node: ast.BinOp) -> str:
        left, right = self.visit(node.left), self.visit(node.right)
        if isinstance(node.op, ast.Mod):
            return f"modulo({left}, {right})"
        return f"({left} {_sign(OPERATORS, node.op)} {right})"

    def visit_BoolOp(self, node: ast.BoolOp) -> str:
        sign = " && " if isinstance(node.op, ast.And) else " || "
        return f"({sign.join(map(self.visit, node.values))})"

    def visit_Compare(self, node: ast.Compare) -> str:
        """A chain of comparisons, each of which is one of two values there."""
        sides = [*map(self.visit, (node.left, *node.comparators))]
        pairs = [
            f"{left} {_sign(COMPARISONS, op)} {right}"
            for left, op, right in zip(sides, node.ops, sides[1:], strict=False)
        ]
        return f"({' && '.join(pairs)})"

    def visit_IfExp(self, node: ast.IfExp) -> str:
        return f"({self.visit(node.test)} ? {self.visit(node.body)} : {self.visit(node.orelse)})"

    def visit_Call(self, node: ast.Call) -> str:
        name, args = ast.unparse(node.func), node.args
        if node.keywords or not (name in CALLS or name == "len" or hasattr(extremes, name)):
            self.generic_visit(node)
        if name == "len":
            return f"{self.visit(args[0])}.length"
        if name == "np.empty" and isinstance(args[0], ast.Tuple):
            args = args[0].elts  # a size of each axis
        return f"{CALLS.get(name, name)}({', '.join(map(self.visit, args))})"

    def visit_Subscript(self, node: ast.Subscript) -> str:
        """An item, a row or a slice of an array, or its length along an axis."""
        match node:
            case ast.Subscript(
                value=ast.Attribute(value=array, attr="shape"), slice=ast.Constant(value=int(axis))
            ):
                return f"{self.visit(array)}{'[0]' * axis}.length"
        places = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        return "".join([self.visit(node.value), *map(self._place, places)])

    def _place(self, node: ast.expr) -> str:
        if isinstance(node, ast.UnaryOp):  # places from the end
            self.generic_visit(node)
        if not isinstance(node, ast.Slice):
            return f"[{self.visit(node)}]"
        begin = self.visit(node.lower) if node.lower else "0"
        return (
            f".subarray({begin}, {self.visit(node.upper)})" if node.upper else f".subarray({begin})"
        )


def _sign(signs: Mapping[type[ast.AST], str], operator: ast.AST) -> str:
    if type(operator) not in signs:
        raise TypeError(type(operator).__name__)
    return signs[type(operator)]


_expressions = _Expressions()


def _text(node: ast.expr) -> str:
    text: str = _expressions.visit(node)
    return text
