"""`equipoise search` as a user runs it, and how searches and sweeps tell how far they are."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.cli import progress as progress_lines
from equipoise.cli.progress import remaining_time_text, swept
from equipoise.quantities.numbers import duration_text, rate_text
from equipoise.schema.study_units import unit_named
from equipoise.studies.outcomes import Progress
from surface.running import command_lines, equipoise, refuses, succeeded
from surface.studies import LENGTHS, TOLERANCES, written

FRONT = LENGTHS.replace('list = ["199 g", "0.4 kg"]', 'range = ["199 g", "0.4 kg"]').replace(
    "drive_torque.peak", 'drive_torque.peak"\nmake = "largest'
)
QUICK = ("--population", "12", "--generations", "8")


pytestmark = pytest.mark.usefixtures("with_progress")


def test_json_is_what_python_has() -> None:
    study = written(FRONT)
    result = equipoise("search", study, *QUICK, "--seed", "5", "--json")
    assert result.out.count("\n") == 1
    content = json.loads(succeeded(result))
    own = eq.studies.search(eq.schema.load_study(study), population=12, generations=8, seed=5)
    expected = own.to_dict()
    assert content == expected
    line = result.err.splitlines()[-1]
    assert re.match(r"\d+ designs computed in .*; best: vertical .* mN, torque", line)


def test_generations_before_there_is_a_front() -> None:
    """JSON knows no NaN."""
    study = written(FRONT, ("13000 mN", "11700 mN"))
    content = json.loads(succeeded(equipoise("search", study, *QUICK, "--json")))
    assert content["volumes"][0] is None
    assert content["volumes"][-1] > 0


def test_the_front_as_a_table() -> None:
    """Beside the model itself, in the units of the files."""
    study = eq.schema.load_study(written(FRONT))
    shown = succeeded(equipoise("search", "study.toml", *QUICK))
    own = eq.studies.search(study, population=12, generations=8)
    assert shown.startswith(f"Lengths of type I\n{own.computed} designs in 8 generations, seed 1")
    assert "Limits: vertical at most 13000 mN" in shown
    assert f"{own.front} Pareto-optimal designs; vertical smallest, torque largest" in shown
    rows = [line.split() for line in shown.splitlines() if re.match(r"(model|\d+)  +\d", line)]
    assert rows[0][0] == "model"
    assert float(rows[0][3]) == 71.5
    values = np.array(rows[1:], float)
    assert values[:, 0].tolist() == list(range(len(own.values)))
    assert values[:, 1] == pytest.approx(1e3 * own.figures[:, 0], rel=1e-3)
    assert values[:, 3:] == pytest.approx(1e3 * own.values, rel=1e-3)
    assert "note: the search has not converged; give more generations" in shown


def test_one_aim() -> None:
    shown = succeeded(equipoise("search", written(LENGTHS), *QUICK))
    assert "The best design; vertical smallest" in shown
    rows = [line for line in shown.splitlines() if re.match(r"(model|\d+)  +\d", line)]
    assert len(rows) == 2


def test_files() -> None:
    study = written(FRONT)
    words = ("--csv", "front.csv", "-o", "new.toml", "--design", "1")
    result = equipoise("search", study, *QUICK, *words)
    assert "design" in succeeded(result)
    assert result.err.splitlines()[-2:] == ["wrote front.csv", "wrote new.toml"]
    with Path("front.csv").open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head[:2] == ["design", "links.coupler.points.C.x [m]"]
    own = eq.studies.search(eq.schema.load_study(study), population=12, generations=8)
    assert np.array(rows, float)[:, 1:3].tolist() == own.values.tolist()
    made = eq.load("new.toml")
    assert made.links == own.machine(1).links
    assert 'Design 1 of a search of the study "Lengths of type I", seed 1.' in made.description


def test_a_bundled_study() -> None:
    shown = succeeded(equipoise("search", "study-of-balance", *QUICK))
    assert "Pareto-optimal designs; forward smallest, upward smallest" in shown


REFUSED = {
    "search": {
        "tolerances.toml": "tolerances.toml: vary[1]: links.coupler.mass has a tolerance, whic",
        "aimless.toml": (
            "aimless.toml: outputs: no output is an objective; give one of them make = "
        ),
        "impossible.toml --population 12 --generations 8": "none of ",
        "study.toml --population 4": "--population: got '4'; give a whole number f",
        "study.toml --generations 0": "--generations: got '0'; give a whole number",
        "study.toml --seed -1": "--seed: got '-1'; give a whole number from 0 to 4294967",
        "study.toml --design 1": "--design belongs to --out; give both",
        "study.toml --population 12 --generations 8 -o x.toml --design 7": (
            "--design: got 7; give a whole number from 0 to 0"
        ),
        "study.toml -o study.toml": "study.toml: is there already; choose another name",
        "study.toml --csv study.toml": "--csv: study.toml is what is to be analysed; give",
    },
    "tolerance": {
        "study.toml": (
            "study.toml: vary[1]: links.coupler.points.C.x has a range or a list, which is no tol"
        ),
        "tolerances.toml --designs 10": "--designs: got 10; for 3 tolerances",
        "tolerances.toml --designs x": "--designs: got 'x'; give a whole number from",
        "few.toml": "few.toml: sampling.designs: got 10; for 3 tolerances give ",
        "yamashita-1": "yamashita-1.toml: this is a model file; give a study file",
        "none.toml": "none.toml: there is no such file",
    },
}


@command_lines(REFUSED)
def test_refused(line: str, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("EQUIPOISE_PROGRESS", "off")
    written(LENGTHS)
    written(TOLERANCES, name="tolerances.toml")
    written(TOLERANCES, ("2048", "10"), name="few.toml")
    written(LENGTHS, ('make = "smallest"', ""), name="aimless.toml")
    written(LENGTHS, ("13000 mN", "1 N"), name="impossible.toml")
    assert refuses(line, said).startswith(said)


# -- progress --------------------------------------------------------------------------------------


def progress(done: int, seconds: float, total: int = 10_000) -> Progress:
    rate = done / seconds if done else None
    failures = {"does not turn fully": done // 10} if done else {}
    return Progress(total, done, done, seconds, rate, failures, {"height": 0.25} if done else {})


def test_lines_in_a_log_grow_fewer(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = [0.0]
    monkeypatch.setattr(progress_lines, "monotonic", lambda: now[0])
    texts = []
    with swept({"height": unit_named("mm")}) as tell:
        for second in range(1000):
            now[0] = float(second)
            tell(progress(10 * second, float(second), 10_000))
            if line := capsys.readouterr().err:
                texts.append((second, line))
    seconds = [second for second, _ in texts]
    assert seconds[:4] == [5, 10, 15, 23]
    assert len(seconds) < 25
    assert np.all(np.diff(seconds) >= 5) and np.all(np.diff(seconds) <= 60)
    assert texts[0][1] == (
        "0 %, 50 of 10000 designs, 10 designs/s; best so far: height 250.0 mm; "
        "failed: does not turn fully 5\n"
    )
    assert "24 %, 2400 of 10000 designs, 10 designs/s, 12 min 40 s left; best" in texts[9][1]
    closing = capsys.readouterr().err
    assert closing.startswith(
        "9990 designs computed in 16 min 39 s, 10 designs/s; best: height 250"
    )
    assert closing.count("\n") == 1


class Terminal(io.StringIO):
    """Standard error that is a terminal."""

    def isatty(self) -> bool:
        return True


def test_a_bar_has_the_rate_the_time_left_the_best_and_the_failures(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As it stands half way; a bar refreshes a few times a second, which a short run may miss."""
    from rich.console import Console

    monkeypatch.setattr("sys.stderr", Terminal())
    monkeypatch.setattr(progress_lines, "monotonic", lambda: 50.0)
    page = Console(file=io.StringIO(), width=120)
    with swept({"height": unit_named("mm")}) as tell:
        tell(progress(5000, 50.0))
        page.print(progress_lines._shown_now)
    first, *further = page.file.getvalue().splitlines()  # type: ignore[attr-defined]
    assert first.startswith("50 %, 5000 of 10000 designs")
    assert first.rstrip().endswith("100 designs/s, 50.0 s left")
    assert further == ["best so far: height 250.0 mm", "failed: does not turn fully 500"]


def test_nothing_is_said_of_what_nothing_is_known_of() -> None:
    assert remaining_time_text(progress(0, 1.0)) == ""
    assert remaining_time_text(progress(100, 1.0)) == ""
    assert remaining_time_text(progress(5000, 50.0), ago=10.0) == "40.0 s left"
    assert rate_text(None) == ""


@pytest.mark.parametrize(
    ("seconds", "said"),
    [
        (0.04, "0.0 s"),
        (59.9, "59.9 s"),
        (61, "1 min 1 s"),
        (3599.6, "1 h 0 min"),
        (9000, "2 h 30 min"),
    ],
)
def test_times(seconds: float, said: str) -> None:
    assert duration_text(seconds) == said


# The number that bounds a search: tests/unit/studies/test_search.py.
@pytest.mark.exhaustive
def test_check_reports_what_a_search_computes_at_most() -> None:
    """The estimate and the bound are those of the search itself."""
    study = written(FRONT, ("designs = 200", "designs = 90"))
    printed = succeeded(equipoise("check", study))
    assert "time for a search of at most 90 designs, 10 generations of 9: " in printed
    result = equipoise("search", study, "--json")
    assert 8 < json.loads(succeeded(result))["computed"] <= 90
    printed = succeeded(equipoise("check", "study-of-tolerances"))
    machines = re.search(r"time for equipoise tolerance, of (\d+) machines: ", printed)
    result = equipoise("tolerance", "study-of-tolerances", "--json")
    assert machines and json.loads(succeeded(result))["computed"] == int(machines[1])
