"""The shape of the package: imports go one way, files and functions keep to one concept."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import equipoise
from equipoise.mechanism import Machine
from equipoise.mechanism.parts.element_kinds import part_kinds
from support.syntax import nodes, text_of, tree_of

ROOT = Path(equipoise.__file__).parent
FILES = sorted(ROOT.rglob("*.py"))
TOP = Path(__file__).parents[2]
PAGES = [*sorted((TOP / "docs").glob("*.md")), TOP / "README.md", TOP / "CONTRIBUTING.md"]
FILE, FUNCTION = 800, 60
"""Most lines in a file and in a function.

A file is one concept. The limit catches those that became two; nothing is cut to stay below it."""


def named(file: Path) -> str:
    parts = file.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


def imported(file: Path) -> Iterator[str]:
    """Every module that a file imports from, for annotations and inside of functions too."""
    for node in nodes(file):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.module and not node.level, f"{file}: import by the whole name"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
            yield node.module


# `make lint` says the same: the contract of siblings in pyproject.toml.
@pytest.mark.exhaustive
def test_no_module_imports_itself_by_way_of_others() -> None:
    modules = {named(file): file for file in FILES}
    graph = {
        name: {other for other in imported(file) if other in modules and other != name}
        for name, file in modules.items()
    }
    for name, others in graph.items():  # of a package only what lies in it, where that is meant
        graph[name] = {o for o in others if not any(p.startswith(f"{o}.") for p in others)}
    assert len(tuple(TopologicalSorter(graph).static_order())) == len(modules)


def test_modules_are_imported_by_statements() -> None:
    """An import by a text is seen by no contract: results draw and print themselves by it, keys,
    formats, signs and tables of kinds of parts are declared as texts, and nothing else may.
    """
    names = {
        file.relative_to(ROOT).as_posix() for file in FILES if "import_module" in text_of(file)
    }
    assert names == {"errors.py", "guarding.py", "displays.py",
                     "exchange/export.py", "keys/kinds.py",
                     "mechanism/parts/element_kinds.py"}  # fmt: skip


def test_a_file_is_one_concept() -> None:
    assert [named(file) for file in FILES if len(text_of(file).splitlines()) > FILE] == []


def test_functions_are_read_without_scrolling() -> None:
    long = []
    for file in FILES:
        for node in nodes(file):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                said = ast.get_docstring(node, clean=False) or ""
                assert node.end_lineno is not None
                if node.end_lineno - node.lineno + 1 - len(said.splitlines()) > FUNCTION:
                    long.append(f"{named(file)}.{node.name}")
    assert long == []


NUMBERED = ("balancing", "design", "handheld", "planting", "studies", "vibration")
"""Rooms whose results hang on tolerances and limits of methods."""
NUMBER = ast.Constant | ast.Tuple | ast.BinOp | ast.UnaryOp | ast.Name | ast.operator | ast.unaryop


def without_reason(file: Path) -> Iterator[str]:
    """Numbers of a module, settings of a method, with neither a text nor a comment behind them."""
    body, lines = tree_of(file).body, text_of(file).splitlines()
    for node, after in zip(body, [*body[1:], None], strict=True):
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        parts = [*ast.walk(node.value)]
        numbers = [part for part in parts if isinstance(part, ast.Constant)]
        plain = all(isinstance(part, NUMBER | ast.expr_context) for part in parts)
        said = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        if plain and any(isinstance(number.value, float | int) for number in numbers) and not said:
            line = lines[node.lineno - 1]
            if "  # " not in line and "[" not in line.partition("=")[0]:
                yield line


@pytest.mark.parametrize("room", NUMBERED)
def test_numbers_that_decide_have_a_reason(room: str) -> None:
    files = sorted((ROOT / room).glob("*.py"))
    assert [line for file in files for line in without_reason(file)] == []


SMALLEST = 1e-2
"""Numbers below it are tolerances or shares; those of formulas are larger."""


def test_tolerances_of_balancing_have_a_name() -> None:
    """So that each has its reason, which a number in the middle of a function has not."""
    unnamed = [
        f"{named(file)}:{item.lineno}"
        for file in sorted((ROOT / "balancing").glob("*.py"))
        for function in nodes(file)
        if isinstance(function, ast.FunctionDef)
        for item in ast.walk(function)
        if isinstance(item, ast.Constant)
        and isinstance(item.value, float)
        and 0 < abs(item.value) < SMALLEST
    ]
    assert unnamed == []


def aliases_of(file: Path) -> Iterator[str]:
    """Names of types that a module declares beside its classes, such as ``Kind = Literal[...]``."""
    body = [*tree_of(file).body]
    for node in body:
        if isinstance(node, ast.If):  # one for the checker, one for the command line
            body += [*node.body, *node.orelse]
            continue
        target = node.targets[0] if isinstance(node, ast.Assign) else None
        target = node.target if isinstance(node, ast.AnnAssign) else target
        if isinstance(target, ast.Name):
            name = target.id.lstrip("_")
            variable = ast.unparse(node).partition("= ")[2].startswith("TypeVar(")
            if name[:1].isupper() and not name.isupper() and not variable:
                yield target.id


def test_a_class_name_means_one_thing() -> None:
    """And so does that of a type that has a name of its own."""
    names = [node.name for file in FILES for node in nodes(file) if isinstance(node, ast.ClassDef)]
    assert {name for name, count in Counter(names).items() if count > 1} == set()
    names += [name for file in FILES for name in {*aliases_of(file)}]
    shared = {name for name, count in Counter(names).items() if count > 1}
    assert shared == set()


VAGUE = frozenset(
    [
        "beside",
        "drawn",
        "found",
        "heard",
        "held",
        "kept",
        "made",
        "missed",
        "more",
        "near",
        "one",
        "said",
        "seen",
        "shaken",
        "together",
        "told",
    ]
)
"""Words that say what was done to a thing, or where it is, and not what it is."""


def test_names_say_what_a_thing_is() -> None:
    """Of modules, and of classes, functions and methods in them."""
    named_by = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    places = [(file.stem, named(file)) for file in FILES]
    places += [
        (node.name, f"{named(file)}.{node.name}")
        for file in FILES
        for node in nodes(file)
        if isinstance(node, named_by)
    ]
    assert [place for name, place in places if name.strip("_").lower() in VAGUE] == []


def test_the_documentation_reports_these_sizes() -> None:
    text = (TOP / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert f"at most {FILE} lines; a function at most {FUNCTION} without its docstring" in text
    assert f"at most {FILE} lines long" in (TOP / "docs/architecture.md").read_text("utf-8")
    sizes = [
        node.end_lineno - node.lineno + 1
        for file in FILES
        for node in nodes(file)
        if isinstance(node, ast.FunctionDef) and node.end_lineno is not None
    ]
    assert sum(size < 10 for size in sizes) > len(sizes) / 2, "most have fewer than 10"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_that_the_documentation_names_are_there(page: Path) -> None:
    """By their path from the top, from the package, or by their name alone."""
    named = re.findall(r"`([\w/]+\.(?:py|ts))`", page.read_text(encoding="utf-8"))
    actual = [
        file for folder in ("src", "tests", "page/src") for file in (TOP / folder).rglob("*.*")
    ]
    names = {file.name for file in actual}
    for name in named:
        assert name in names or (TOP / name).exists() or (ROOT / name).exists(), name


@cache
def words_of_all() -> frozenset[str]:
    """All names in code, and those of its files and folders."""
    places = ("src", "tests", "page/src", "docs", "benchmarks")
    files = [path for place in places for path in (TOP / place).rglob("*.*")]
    words = {file.stem for file in files} | {file.parent.name for file in files}
    for item in (*files, TOP / "conftest.py", TOP / "hatch_build.py"):
        if item.suffix in (".py", ".ts"):
            words.update(re.findall(r"\w+", item.read_text(encoding="utf-8")))
    return frozenset(words)


@pytest.mark.parametrize("page", ["CONTRIBUTING.md", "docs/architecture.md"])
def test_names_that_developers_look_for_are_there(page: str) -> None:
    """Functions, classes and modules in code, by the last part of their names."""
    text = re.sub(r"```.*?```", "", (TOP / page).read_text(encoding="utf-8"), flags=re.DOTALL)
    named = re.findall(r"`([A-Za-z_][\w.]*)(?:\([^`]*\))?`", text)
    of_numba = {"prange"}  # which is not used, and why not is said
    assert {*(item.rstrip(".").rpartition(".")[2] for item in named)} - words_of_all() <= of_numba


def test_decompositions_are_asked_for_in_one_place() -> None:
    """Which keeps numbers from LAPACK of which it writes to standard output."""
    printing = re.compile(r"linalg\.(lstsq|svd|svdvals|pinv|cond|matrix_rank)\(|\bpolyfit\(")
    printing_files = {file.name for file in FILES if printing.search(text_of(file))}
    assert printing_files == {"decompositions.py"}


def test_nothing_is_written_into_objects_past_their_fields() -> None:
    """What is kept of a frozen value stands in its `memory`; fields of a new one are set by
    ``object.__setattr__``.
    """
    written = re.compile(r"__dict__(\[[^]]*\] *=[^=]|\.(update|pop|setdefault|clear)\()")
    assert {named(file) for file in FILES if written.search(text_of(file))} == set()


BY_KIND = {
    "balancing/design_variables.py": "springs that balancing adds",
    "balancing/geared.py": "counterweights on gears that balancing adds",
    "design/lifts.py": "parameters of the gears of a planting arm",
    "exchange/reading/imported.py": "gears of imported files",
    "planting": "arms on a carrier, which gears turn",
}
"""Files beside those that kinds of parts name, in which lists of one kind are read, and why."""


def test_lists_of_kinds_are_read_by_what_belongs_to_the_kind() -> None:
    """All else goes through every kind that a machine has, so that a new one is not forgotten."""
    kinds = part_kinds(Machine)
    classes = {of for kind in kinds.values() for of in kind.__mro__}
    values = [value for of in classes for value in vars(of).values()]
    texts = [text for value in values if isinstance(value, dict) for text in value.values()]
    own = {text.partition(":")[0] for text in (*values, *texts) if isinstance(text, str)}
    own |= {kind.__module__ for kind in kinds.values()}
    names = "|".join(kind.__name__ for kind in kinds.values())
    read = re.compile(rf"\bmachine\.(?:{'|'.join(kinds)})\b|isinstance\([\w.]+, (?:{names})\)")
    files = {file for file in FILES if read.search(text_of(file))}
    others = {file.relative_to(ROOT).as_posix() for file in files if named(file) not in own}
    assert {name for name in others if not name.startswith((*BY_KIND,))} == set()
    idle = {place for place in BY_KIND if not any(name.startswith(place) for name in others)}
    assert idle == set(), "their reason is gone"
