"""Loops that run: compiled or by NumPy alike, from files that are written once and by anyone."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen import backends
from equipoise.codegen.backends import NOTICE, engine, run_loop
from equipoise.codegen.batch import Batch, all_angles, designs_of, grid_of
from equipoise.codegen.emit import emit
from equipoise.codegen.extremes import GridTops
from equipoise.codegen.figures import Gathered
from equipoise.codegen.source import TermSource, on_arrays, pick_from, without_calls
from equipoise.codegen.terms import BOTH, Graph, VectorTerm, angle_of, reached, rotation
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.machine import Machine
from support.batches import by_numpy, every_dyad, wanted_of
from support.chosen import EXHAUSTIVE
from support.designs import Array, drawn, numbers_of, paths_of
from unit.mechanism.build import four_bar, machine

CRANK = machine({"A": (0.0, 0.0)}, {"crank": eq.Link({"A": (0.0, 0.0), "B": (1.0, 0.0)})})
"""The smallest machine: its loop is compiled soonest."""
WANTED = wanted_of(["points.B.x"], "rms")


def source_of(base: Machine, *signals: str) -> TermSource:
    return emit(assemble(base), Gathered.of(wanted_of(signals)))


def tables_of(base: Machine, source: TermSource, count: int, share: float = 0.02) -> Array:
    numbers = numbers_of(base, share)
    values = drawn(numbers, count, 1)
    designs = designs_of(source, assemble(base), paths_of(numbers), values)
    assert not designs.refused.any()
    return designs.table


# -- the same by NumPy -----------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["four-bar", "planets"])
@pytest.mark.parametrize(
    ("base", "signals", "turns"),
    [
        pytest.param(every_dyad(), ("shaking_force", "joints.standing on frame"), 2, id="dyads"),
        pytest.param(four_bar(3, 1, 3, 2.5), ("drive_torque", "joints.C"), 1, id="four-bar"),
        pytest.param(eq.load("planetary-planting-arm"), ("drive_torque",), 1, id="planets"),
    ],
)
def test_numpy_gathers_the_same(base: Machine, signals: tuple[str, ...], turns: int) -> None:
    """But for rounding, which grows where a dyad is weak: sums are in another order."""
    assert assemble(base).cycle.turns == turns
    source = source_of(base, *signals)
    table, grid = tables_of(base, source, 30), grid_of(source, all_angles(90, turns))
    tops = GridTops(2 * np.pi * turns)
    got = run_loop(source, table, grid, tops)
    with tempfile.TemporaryDirectory() as folder, by_numpy(Path(folder)):
        reported = run_loop(source, table, grid, tops)
    own = len(set(source.watched))
    weakest, compiled = (
        f[:, source.weakest][:, :own].min(axis=1, initial=1.0) for f in (reported, got)
    )
    assert np.array_equal(weakest < 0, compiled < 0)
    moved = weakest > 1e-3
    assert moved.sum() > 15
    places = {column: k for k, column in enumerate(source.gathered.columns)}
    for (signal, kind), k in places.items():
        if kind.endswith("_at"):  # of two equal extremes either may be told
            continue
        apart, size = np.abs(got - reported)[moved, k], np.abs(reported[moved, k]).max()
        near = apart * weakest[moved] <= 1e-12 * size
        if kind == "dip":  # of a size near zero, its square is what is computed
            whole = np.abs(reported[moved, places[signal, "highest"]]).max()
            near |= apart * np.abs(reported[moved, k]) * weakest[moved] <= 1e-13 * whole**2
        assert np.all(near), kind


def test_numpy_takes_designs_in_pieces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = source_of(every_dyad(), "shaking_force")
    table, grid = tables_of(every_dyad(), source, 9), grid_of(source, all_angles(30, 2))
    with by_numpy(tmp_path):
        whole = run_loop(source, table, grid)
        for size in (1, 100, 240):
            monkeypatch.setattr(backends, "AT_A_TIME", size)
            assert np.array_equal(run_loop(source, table, grid), whole, equal_nan=True)


def test_angles_and_rotations_without_calls() -> None:
    """The polynomials are exact as far as a link may be from where that of the base is."""
    rng, graph = np.random.default_rng(1), Graph()
    x, y, angle = (graph.argument(name, BOTH) for name in ("x", "y", "angle"))
    outputs = without_calls([angle_of(VectorTerm(x, y)), *parts_of(rotation(angle))])
    assert not {"angle", "cos", "sin"} & {term.op for term in reached(outputs)}
    near, any_angle = rng.uniform(-2 * pi / 3, 2 * pi / 3, 5000), rng.uniform(-100, 100, 5000)
    given = {"x": np.cos(near), "y": np.sin(near), "angle": any_angle}
    angles, *turned = on_arrays(outputs)(**given)
    assert np.max(np.abs(angles - near)) < 2e-15
    # of the angle's own digits
    assert np.max(np.abs(turned[0] + 1j * turned[1] - np.exp(1j * any_angle))) < 3e-14


def parts_of(vector: VectorTerm) -> tuple[Any, Any]:
    return vector.real, vector.imag


def test_functions_of_loops() -> None:
    """Numbers of a table are picked, and chosen, compiled as by NumPy, whatever the place."""
    import numba

    known = backends.compiled_functions()
    pick, floor, where = (known[name] for name in ("pick", "floor", "where"))
    table = np.arange(7.0) ** 2

    @numba.njit
    def each(places: Array, parts: Array) -> None:
        for k in range(len(places)):
            parts[k] = pick(table, where(places[k] >= 5.0, floor(places[k]), places[k]))

    places, parts = np.random.default_rng(1).uniform(-100, 100, 500), np.empty(500)
    places[:4] = np.nan, np.inf, -np.inf, 6.999
    each(places, parts)
    with np.errstate(invalid="ignore"):
        assert np.array_equal(parts, pick_from(table, places))


@pytest.fixture
def without_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    actual = backends.importlib.util.find_spec

    def find_spec(name: str, package: str | None = None) -> Any:
        return None if name == "numba" else actual(name, package)

    monkeypatch.setattr(backends.importlib.util, "find_spec", find_spec)
    monkeypatch.setattr(backends, "engine", cache(engine.__wrapped__))
    monkeypatch.setattr(backends, "_loop_of", cache(backends._loop_of.__wrapped__))


def test_missing_numba_is_reported_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, without_numba: None,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.setenv(backends.FOLDER, str(tmp_path))
    with ThreadPoolExecutor(4) as pool:
        batches = list(pool.map(lambda _: Batch(CRANK, ["drive.speed"], WANTED), range(4)))
        list(pool.map(lambda batch: batch(np.ones((3, 1))), batches))
    Batch(four_bar(3, 1, 3, 2.5), ["drive.speed"], WANTED)(np.ones((3, 1)))
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"equipoise: {NOTICE}\n"
    assert "\n" not in NOTICE


def test_numba_is_no_news(capsys: pytest.CaptureFixture[str]) -> None:
    assert cache(engine.__wrapped__)() == "numba"
    assert capsys.readouterr() == ("", "")


# -- files -----------------------------------------------------------------------------------------


@pytest.fixture
def fresh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder for loops; none is known yet in this process."""
    folder = tmp_path / "some" / "loops"
    monkeypatch.setenv(backends.FOLDER, str(folder))
    monkeypatch.setattr(backends, "_loop_of", cache(backends._loop_of.__wrapped__))
    before = set(sys.modules)
    yield folder
    for name in set(sys.modules) - before:
        if name.startswith("equipoise_loop"):
            del sys.modules[name]


def written(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir() if path.is_file())


def test_file_is_written_once(fresh: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Under another name first, so that nobody ever sees half of it."""
    moves: list[tuple[Path, Path]] = []
    replace = os.replace

    def moved(old: str, new: str) -> None:
        assert Path(old).read_text(encoding="utf-8") == text
        moves.append((Path(old), Path(new)))
        replace(old, new)

    monkeypatch.setattr(os, "replace", moved)
    text = source_of(CRANK, "points.B.x").text
    path = backends._file_of(text)
    assert backends._file_of(text) == path
    assert [(old.parent, new) for old, new in moves] == [(path.parent, path)]
    assert path.parent == fresh
    assert path.read_text(encoding="utf-8") == text
    assert written(fresh) == [path.name]


def test_names_report_content_and_backend(fresh: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = backends._file_of("a = 1\n")
    other = backends._file_of("a = 2\n")
    assert first != other
    reported = backends.inspect.getsource

    def changed(what: Any) -> str:
        text: str = reported(what)
        return text.replace("0.0", "0.25") if what is backends else text

    monkeypatch.setattr(backends.inspect, "getsource", changed)
    assert backends._file_of("a = 1\n") not in (first, other)
    assert len(written(fresh)) == 3


def test_no_folders_are_left_behind(
    fresh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere = tmp_path / "temporary"
    elsewhere.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(elsewhere))
    backends._file_of("a = 1\n")
    backends._file_of("a = 1\n")
    assert not list(elsewhere.iterdir())


def no_folder(tmp_path: Path) -> Path:
    path = tmp_path / "a file"
    path.write_text("")
    return path


def below_a_file(tmp_path: Path) -> Path:
    return no_folder(tmp_path) / "loops"


@pytest.mark.parametrize("place", [no_folder, below_a_file])
def test_folder_that_cannot_be(
    place: Callable[[Path], Path], fresh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(backends.FOLDER, str(place(tmp_path)))
    figures, reasons = Batch(CRANK, ["drive.speed"], WANTED, angles=8)(np.ones((2, 1)))
    assert figures == pytest.approx(np.full((2, 1), 0.5**0.5))
    assert not reasons.any()


def test_folder_that_is_full_or_read_only(fresh: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever goes wrong there, a temporary folder does as well."""

    def refuse(**where: Any) -> Any:
        if Path(where["dir"]) == fresh:
            raise OSError(28, "No space left on device")
        return make(**where)

    make = tempfile.mkstemp
    monkeypatch.setattr(tempfile, "mkstemp", refuse)
    path = backends._file_of("a = 1\n")
    assert path.parent != fresh
    assert path.read_text(encoding="utf-8") == "a = 1\n"


def test_no_place_for_compiled_code(fresh: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Then it is compiled for this run alone."""
    import numba

    asked = []
    njit = numba.njit

    def refuse(*signature: Any, **options: Any) -> Any:
        if options.pop("cache", False):
            asked.append(signature)
            raise RuntimeError("cannot cache function: no locator available")
        return njit(*signature, **options)

    monkeypatch.setattr(numba, "njit", refuse)
    figures, _ = Batch(CRANK, ["drive.speed"], WANTED, angles=16)(np.ones((2, 1)))
    assert asked
    assert figures == pytest.approx(np.full((2, 1), 0.5**0.5))
    assert not list(fresh.glob("**/*.nbc"))


SCRIPT = """
import sys
import numpy as np
import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure

links = {"crank": eq.Link({"A": (0.0, 0.0), "B": (1.0, 0.0)})}
crank = eq.Machine("crank", eq.Drive("crank", 3.0), {"A": (0.0, 0.0)}, links)
batch = Batch(crank, ["links.crank.points.B.x"], [Figure("points.B.x", "rms")], angles=16)
sys.stdin.readline()
print(batch(np.array([[1.0], [2.0]]))[0].tobytes().hex())
"""


def started(folder: Path) -> subprocess.Popen[str]:
    pipes: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    environment = {**os.environ, backends.FOLDER: str(folder)}
    return subprocess.Popen([sys.executable, "-c", SCRIPT], text=True, env=environment, **pipes)


@EXHAUSTIVE  # On every change: `test_threads_that_ask_at_once`, and `test_file_is_written_once`.
def test_processes_that_start_at_once(tmp_path: Path) -> None:
    """They may all write and compile the same loop; one more finds it done."""
    folder = tmp_path / "loops"
    processes = [started(folder) for _ in range(2)]
    answers = [process.communicate("go\n", timeout=300) for process in processes]
    assert {error for _, error in answers} == {""}
    reported = np.array([[0.5**0.5], [2**0.5]])
    (answer,) = {out for out, _ in answers}
    got = np.frombuffer(bytes.fromhex(answer)).reshape(2, 1)
    assert got == pytest.approx(reported)
    files = sorted(path.suffix for path in folder.glob("**/*") if path.is_file())
    assert [file for file in files if file != ".pyc"] == [".nbc", ".nbi", ".py"]
    stamps = {path: path.stat().st_mtime_ns for path in folder.glob("**/*")}
    late = started(folder)
    assert late.communicate("go\n", timeout=300) == (answer, "")
    assert {path: path.stat().st_mtime_ns for path in folder.glob("**/*")} == stamps


# -- threads ---------------------------------------------------------------------------------------


def test_threads_that_ask_at_once(fresh: Path) -> None:
    """A loop is compiled once, whoever of several threads comes first."""
    values = np.linspace(1, 2, 50)[:, None]
    paths = ["links.crank.points.B.x"]

    def ask(_: int) -> Array:
        return Batch(CRANK, paths, WANTED, angles=16, threads=2)(values)[0]

    with ThreadPoolExecutor(6) as pool:
        answers = list(pool.map(ask, range(12)))
    assert backends._loop_of.cache_info().misses == 1
    assert all(answer.tobytes() == answers[0].tobytes() for answer in answers)
    assert answers[0][:, 0] == pytest.approx(values[:, 0] * 0.5**0.5)


# Threads that ask at once: the test above.
@pytest.mark.exhaustive
def test_one_batch_in_several_threads() -> None:
    base = four_bar(3, 1, 3, 2.5)
    numbers = numbers_of(base, 0.02)
    wanted = wanted_of(["drive_torque", "joints.C"], "rms", "mean", "max_at", "min", "peak_at")
    batch = Batch(base, paths_of(numbers), wanted)
    values = drawn(numbers, 800, 1)
    whole, _ = batch(values)
    with ThreadPoolExecutor(5) as pool:
        parts = list(pool.map(lambda part: batch(part)[0], np.array_split(values, 23)))
    assert np.concatenate(parts).tobytes() == whole.tobytes()
