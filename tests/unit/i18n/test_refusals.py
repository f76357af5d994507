"""Every sentence for a reader is a template with its values, so that each language has it whole."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

import pytest

import equipoise
from equipoise import errors
from equipoise.errors import CallError, EquipoiseError, ModelError, UsageError
from equipoise.i18n import Note
from support.refusals import refused
from support.syntax import nodes, tree_of

SOURCES = Path(equipoise.__file__).parent
FILES = sorted(SOURCES.rglob("*.py"))
SAID_BY = {"Notes", "at_place", "FileError", "StoppedError"}
"""What else takes sentences."""
FOR_PROGRAMMERS = {CallError.__name__}
"""Errors that no file and no command can cause, which are in English alone."""
WORD = r"(?<![\w.\-/\[])[A-Za-z]{2,}(?![\w.\-/=(\[])"
TWO_WORDS = re.compile(rf"{WORD}.*\s{WORD}", re.DOTALL)
"""Not those of options, paths and keys."""
THREE_WORDS = re.compile(r"[A-Za-z]{2,},? [a-z]{2,},? [a-z]{2,}")


@cache
def error_classes() -> frozenset[str]:
    """Names of all classes below `EquipoiseError`."""
    bases = {
        node.name: {getattr(base, "id", getattr(base, "attr", "")) for base in node.bases}
        for file in FILES
        for node in nodes(file)
        if isinstance(node, ast.ClassDef)
    }
    known = {EquipoiseError.__name__}
    while more := {name for name, above in bases.items() if above & known} - known:
        known |= more
    return frozenset(known)


def name_of(function: ast.expr) -> str:
    return getattr(function, "id", getattr(function, "attr", ""))


def literals(node: ast.expr) -> Iterator[str]:
    """Texts that stand in an expression as they are, but for those that a call gets."""
    if isinstance(node, ast.Constant):
        yield from [node.value] if isinstance(node.value, str) else []
    elif isinstance(node, ast.Call):
        if isinstance(node.func, ast.Attribute) and node.func.attr in ("format", "join"):
            yield from literals(node.func.value)
    elif isinstance(node, ast.JoinedStr):
        yield "".join(part.value if isinstance(part, ast.Constant) else "0" for part in node.values)
    else:
        for inner in ast.iter_child_nodes(node):
            if isinstance(inner, ast.expr):
                yield from literals(inner)


@cache
def assigned(within: ast.AST) -> Mapping[str, list[ast.expr]]:
    """What names are given in a function, or in a module."""
    values = defaultdict[str, list[ast.expr]](list)
    for node in ast.walk(within):
        for target in node.targets if isinstance(node, ast.Assign) else ():
            if isinstance(target, ast.Name):
                values[target.id].append(node.value)
    return values


def plain(node: ast.expr, scope: ast.AST, words: re.Pattern[str]) -> bool:
    """Whether an expression is plain English, also by way of a variable of its function."""
    if any(words.search(text) for text in literals(node)):
        return True
    if not isinstance(node, ast.Name):
        return False
    return any(
        words.search(text) for value in assigned(scope).get(node.id, ()) for text in literals(value)
    )


def calls(module: ast.Module) -> Iterator[tuple[ast.AST, ast.Call]]:
    """Calls with the function around them, the innermost."""

    def visit(node: ast.AST, scope: ast.AST) -> Iterator[tuple[ast.AST, ast.Call]]:
        for inner in ast.iter_child_nodes(node):
            if isinstance(inner, ast.Call):
                yield scope, inner
            own = isinstance(inner, ast.FunctionDef | ast.Lambda)
            yield from visit(inner, inner if own else scope)

    return visit(module, module)


def sentences(call: ast.Call, refusing: frozenset[str]) -> list[ast.expr]:
    """What a call says to a reader; the place of an error in a file is none of it."""
    name = name_of(call.func)
    given = [*call.args, *(keyword.value for keyword in call.keywords)]
    if name in ("ModelError", "at_place"):
        return given[1:2]
    return given if name in refusing else []


def untranslated_lines(module: ast.Module) -> list[int]:
    """Lines on which a refusal or a note is made of plain English."""
    refusing = (error_classes() | SAID_BY) - FOR_PROGRAMMERS
    lines = []
    for scope, call in calls(module):
        if any(plain(sentence, scope, TWO_WORDS) for sentence in sentences(call, refusing)):
            lines.append(call.lineno)
        if name_of(call.func) == "Note" and any(
            plain(keyword.value, scope, THREE_WORDS) for keyword in call.keywords
        ):
            lines.append(call.lineno)
    return lines


def test_no_refusal_and_no_note_is_plain_english() -> None:
    actual = {
        f"{file.relative_to(SOURCES)}:{line}"
        for file in FILES
        for line in untranslated_lines(tree_of(file))
    }
    assert actual == set()


@pytest.mark.parametrize(
    "made",
    [
        'raise UsageError("the list is empty")',
        'raise UsageError(f"--turns: got {turns:g}; give {least}")',
        'raise UsageError(f"got {count}; give at least one")',
        'raise ModelError("links", "got %d; give more than one" % count)',
        'raise ModelError(where, "got " + text + "; give another name")',
        'raise UsageError("got {}; give another name".format(text))',
        'def f():\n what = f"got {count}; give more than one"\n raise UsageError(what)',
        'yield Notes(("one sentence of plain English",))',
        'Note("got {text}; {right}", text=text, right="give one or more names")',
        'def f():\n right = "give one or more"\n raise UsageError(Note("x {right}", right=right))',
    ],
)
def test_plain_english_is_found(made: str) -> None:
    assert untranslated_lines(ast.parse(made)) != []


@pytest.mark.parametrize(
    "made",
    [
        'raise UsageError(Note("got {count}; give at least one", count=count))',
        'raise ModelError("the place", Note("got {count}; give at least one", count=count))',
        'raise UsageError(at_place(option, unknown(name, known, "layer of it")))',
        'raise CallError(f"{name} takes a machine and a speed")',
        'raise ValueError("which is what the caller finds")',
    ],
)
def test_templates_are_let_be(made: str) -> None:
    assert untranslated_lines(ast.parse(made)) == []


LITERAL_WORDS = re.compile(r"(?<![\w.\-/\[{])[A-Za-z]{2,}(?![\w.\-/=(\[{])")
COMMAND = re.compile(r"(equipoise|respond|pip) ")
"""What is to be typed."""
OTHER_TEXTS = {
    "codegen/": "source of programs",
    "dataclass.py": "source of programs, and errors of Python",
    "guarding.py": "errors of calls, which only programmers cause",
    "i18n/languages.py": "errors of a catalogue, which only programmers cause",
    "mechanism/dynamics/reactions.py": "errors of attributes, which only programmers cause",
    "schema/files.py": "errors of types, which only programmers cause",
    "atomic_files.py": "marks of files",
    "exchange/": "files of other programs, which are read by these",
    "mechanism/assembly/loopgroup.py": "names of loops, inside",
    "mechanism/assembly/reach.py": "lines of a file",
    "mechanism/kinematics/motion.py": "what Python shows of an object",
    "mechanism/parts/circular_slots.py": "names of points inside",
    "mechanism/parts/balance.py": "names of objectives in files",
    "mechanism/parts/bodies.py": "meanings of keys, which are translated as a whole",
    "mechanism/parts/couplings.py": "meanings of keys, which are translated as a whole",
    "mechanism/parts/machine.py": "places in a machine",
    "keys/declaring.py": "meanings of keys, which are translated as a whole",
    "exposure/daily.py": "meanings of outputs in the documentation, which is English",
    "balancing/patterns.py": "names of patterns in files",
    "cli/explaining.py": "help, which is English",
    "cli/options.py": "help, which is English",
    "schema/schemas.py": "descriptions of a JSON Schema, which are English",
    "schema/writing.py": "tables of the documentation, which is English",
    "figures/animation.py": "SVG and CSS",
    "figures/vector.py": "SVG and CSS",
    "symbols/looks.py": "CSS",
    "present/pages.py": "SVG",
    "web/site.py": "HTML and metadata of packages",
    "planting/names.py": "regular expressions",
    "schema/records.py": "regular expressions",
    "quantities/expressions.py": "regular expressions",
    "quantities/reading.py": "regular expressions",
    "figures/style.py": "names of styles",
    "figures/tool_charts.py": "names of styles",
}
"""Files or folders with f-strings of words that no reader gets as a sentence, and why."""


def spelled_sentences(module: ast.Module) -> list[int]:
    """Lines on which words of English are joined with values without a template."""
    texts = (
        (node, *literals(node)) for node in ast.walk(module) if isinstance(node, ast.JoinedStr)
    )
    return [
        node.lineno
        for node, text in texts
        if len(LITERAL_WORDS.findall(text)) > 1 and not COMMAND.match(text)
    ]


def test_no_sentence_is_spelled_out_around_its_values() -> None:
    """Nor is one that goes into a result, a note or a line of a command."""
    lines: dict[str, list[int]] = {}
    for file in FILES:
        if spelled := spelled_sentences(tree_of(file)):
            lines[file.relative_to(SOURCES).as_posix()] = spelled
    given = {
        name: spelled for name, spelled in lines.items() if not name.startswith((*OTHER_TEXTS,))
    }
    assert given == {}
    idle = {place for place in OTHER_TEXTS if not any(name.startswith(place) for name in lines)}
    assert idle == set(), "their reason is gone"


@pytest.mark.parametrize(
    ("line", "is_spelled"),
    [
        ('f"the mass of {link} is missing"', True),
        ('f"{count} designs of {size} numbers"', True),
        ('f"equipoise sweep {file} -o designs.zarr"', False),
        ('f"links.{name}.mass"', False),
        ('f"{value} deg"', False),
        ('say("the mass of {link} is missing", link=link)', False),
    ],
)
def test_what_is_spelled_out(line: str, is_spelled: bool) -> None:
    assert bool(spelled_sentences(ast.parse(line))) == is_spelled


def test_a_refusal_of_other_values_or_at_another_place_is_another() -> None:
    error = ModelError(
        "links.crank.mass", Note("got {mass}; give {least} or more", mass=-1.5, least=0)
    )
    with refused(ModelError, "links.crank.mass", mass=-1.5, least=0):
        raise error
    for where, values in (("links.rod.mass", {}), (None, {"mass": -2.5}), (None, {"most": 0})):
        with pytest.raises(AssertionError), refused(ModelError, where, **values):
            raise error


def test_errors_take_no_plain_text() -> None:
    """By their types, so that a function that makes its sentence elsewhere is found too."""
    declared = [
        node
        for node in ast.walk(ast.parse(Path(errors.__file__).read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef) and node.name in error_classes() - FOR_PROGRAMMERS
    ]
    said = [
        ast.unparse(parameter.annotation)
        for node in declared
        for function in node.body
        if isinstance(function, ast.FunctionDef) and function.name == "__init__"
        for parameter in (*function.args.args, *function.args.kwonlyargs)
        if parameter.arg in ("message", "what", "reason") and parameter.annotation is not None
    ]
    assert len(said) > 5
    assert {*said} == {"Note", "Note | None"}


def test_what_is_wrong_with_a_call_is_reported_as_other_refusals_are() -> None:
    error = CallError("balance: got 3 for machine")
    assert isinstance(error, UsageError)
    assert error.message("ja") == "英語のまま：balance: got 3 for machine"
