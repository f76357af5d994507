"""The public names: all there, all documented, and light to import."""

from __future__ import annotations

import inspect
import pickle
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from pkgutil import resolve_name
from types import ModuleType
from typing import Any

import pytest

import equipoise as eq
from equipoise import cli

PAGE = Path(__file__).parents[2] / "docs" / "python.md"
HEAVY = ("numpy", "pandas", "xarray", "pint", "pydantic", "rich", "scipy", "numba", "cyclopts")
ROOMS = ("", *(name for name in eq.__all__ if isinstance(getattr(eq, name), ModuleType)))


def room(name: str) -> ModuleType:
    return import_module(f"equipoise.{name}") if name else eq


def public(name: str) -> list[str]:
    """What a room offers, but for rooms of its own."""
    names = getattr(room(name), "__all__", [])
    return [item for item in names if not isinstance(getattr(room(name), item), ModuleType)]


NAMES = {
    f"{name}.{item}".lstrip("."): getattr(room(name), item)
    for name in ROOMS
    for item in public(name)
}


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_there_and_documented(name: str) -> None:
    actual: Any = NAMES[name]
    assert actual.__name__ == name.rpartition(".")[2]
    assert actual.__module__.startswith("equipoise.")
    assert actual.__doc__
    assert not actual.__doc__.startswith(f"{actual.__name__}("), (
        "a docstring that dataclass made up"
    )


def methods() -> Iterator[tuple[str, Any]]:
    for name, actual in NAMES.items():
        if inspect.isclass(actual):
            members = vars(actual).items()
            functions = ((key, first) for key, first in members if inspect.isfunction(first))
            yield from ((f"{name}.{key}", first) for key, first in functions if key[0] != "_")


@pytest.mark.parametrize(("key", "function"), [*methods()])
def test_every_method_is_documented(key: str, function: Any) -> None:
    assert function.__doc__, key


def test_a_name_means_one_thing() -> None:
    """Rooms may offer what the package does, as the same."""
    actual: dict[str, Any] = {}
    for name, value in NAMES.items():
        assert actual.setdefault(name.rpartition(".")[2], value) is value, name


COMMANDS = ("analyze", "balance", "export", "modes", "plant", "report", "respond", "run",
            "search", "simulate", "sweep", "tolerance")  # fmt: skip


def test_what_a_command_does_is_found_under_its_name() -> None:
    """Who knows the command line looks for it at the top, and for nothing but that: what is there
    beside are files, and the parts of a machine.
    """
    assert {*COMMANDS} <= {*cli.COMMANDS}
    assert {*COMMANDS} <= {*eq.__all__}


@pytest.mark.parametrize("name", ROOMS)
def test_the_page_lists_what_a_room_offers(name: str) -> None:
    """One row of the table a room, with every name and no other."""
    table = PAGE.read_text(encoding="utf-8").partition("## Every name")[2]
    head = f"| `eq.{name}` |" if name else "| `eq` |"
    (row,) = (line for line in table.splitlines() if line.startswith(head))
    assert sorted(re.findall(r"`(\w+)`", row.removeprefix(head))) == sorted(public(name))


def test_names_of_modules_in_the_documentation_are_there() -> None:
    """Those in running text, beside what is public."""
    pages = (page.read_text(encoding="utf-8") for page in PAGE.parent.glob("*.md"))
    names = {name for page in pages for name in re.findall(r"`(equipoise(?:\.\w+)+)", page)}
    assert len(names) > 4 and [*map(resolve_name, names)]


def test_all_and_dir_agree() -> None:
    assert sorted(dir(eq)) == sorted(eq.__all__)
    assert len(set(eq.__all__)) == len(eq.__all__)


def test_version() -> None:
    from importlib.metadata import version

    assert eq.__version__ == version("equipoise")
    cited = (PAGE.parents[1] / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {eq.__version__}\n" in cited


def test_unknown_names() -> None:
    with pytest.raises(AttributeError, match="equipoise attribute analyse"):
        _ = eq.analyse


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=300
    )
    return done.stdout.strip()


def test_importing_is_light() -> None:
    code = f"import sys, equipoise; print(*(m for m in {HEAVY} if m in sys.modules))"
    assert run(code) == ""


@pytest.mark.parametrize("name", ["Machine", "EquipoiseError"])
def test_values_need_no_numpy(name: str) -> None:
    """A machine can be described, and an error caught, without any library."""
    code = f"import sys, equipoise; equipoise.{name}; print('numpy' in sys.modules)"
    assert run(code) == "False"


def test_mechanics_need_only_numpy() -> None:
    code = (
        "import sys, equipoise as eq; eq.analyze; eq.mechanism.base_parameters; "
        f"eq.mechanism.four_bar; print(*(m for m in {HEAVY} if m in sys.modules))"
    )
    assert run(code) == "numpy"


def test_star_import() -> None:
    names: dict[str, Any] = {}
    exec("from equipoise import *", names)
    assert {*eq.__all__} <= names.keys()


# -- wrong arguments -------------------------------------------------------------------------------

MODEL = eq.load("yamashita-1")
WRONG: dict[str, tuple[Callable[[], object], str]] = {
    "file for machine": (
        lambda: eq.analyze("a.toml"),  # type: ignore[arg-type]
        "analyze: machine: got 'a.toml'; give a Machine, which load reads from a file",
    ),
    "unit for keyword": (
        lambda: MODEL.with_drive(rpm=300),
        "Drive: no parameter is called 'rpm'; ",
    ),
    "keyword of a link": (
        lambda: MODEL.with_link("crank", mas=1),
        "Link: no parameter is called 'mas'; did you mean 'mass'?",
    ),
    "keyword of a constructor": (
        lambda: eq.Link(point={}),  # type: ignore[call-arg]
        "Link: no parameter is called 'point'; did you mean 'points'?",
    ),
    "misspelt": (
        lambda: eq.analyze(MODEL, sped=1),  # type: ignore[call-arg]
        "analyze: no parameter is called 'sped'; did you mean 'speed'?",
    ),
    "too few": (eq.analyze, "analyze: missing a required argument: 'machine'; it takes machine,"),
    "text for number": (
        lambda: eq.mechanism.Gear("a", "b", "3"),  # type: ignore[arg-type]
        "ratio: got '3'; give a number",
    ),
    "unit of another kind": (
        lambda: eq.simulate(MODEL, "1 kg"),
        "duration: got '1 kg'; kg is the unit of a mass; a time is wanted: s, ms, min, h",
    ),
    "unit of a key": (
        lambda: MODEL.with_link("crank", mass="1 mm"),
        "links.crank.mass: got '1 mm'; mm is the unit of a length; a mass is wanted",
    ),
    "machine for study": (
        lambda: eq.studies.sweep(MODEL, "x"),  # type: ignore[arg-type]
        "sweep: study: got one of the type Machine; give a Study",
    ),
    "swapped": (lambda: eq.save("a.toml", MODEL), "save: model: got 'a.toml'; give a Machine or"),  # type: ignore[arg-type]
    "no list": (lambda: MODEL.with_springs(5), "with_springs: springs: got 5; give a list"),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_arguments_are_reported_in_a_sentence(name: str) -> None:
    call, words = WRONG[name]
    with pytest.raises(eq.EquipoiseError) as caught:
        call()
    assert str(caught.value).startswith(words)


FUNCTIONS = {
    name: value
    for name, value in NAMES.items()
    if inspect.isfunction(value) and not name.startswith("signals.")  # no room, but a module
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_refuses_what_is_nothing_of_the_kind(name: str) -> None:
    """Whatever is given first, and under a keyword that nobody has."""
    for given, more in (((object(),), {}), ((), {"no_such": 1})):
        with pytest.raises(eq.EquipoiseError):
            FUNCTIONS[name](*given, **more)


def test_guarded_functions_are_still_what_they_were() -> None:
    """The same wherever they are offered, for workers too, and with their signature."""
    for name, value in FUNCTIONS.items():
        assert pickle.loads(pickle.dumps(value)) is value, name
        assert inspect.signature(value) == inspect.signature(inspect.unwrap(value))
