"""`equipoise sweep`, `resume`, `best` and `export` as a user runs them."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.cli import sweep
from equipoise.schema.study_units import study_of
from equipoise.studies.selection import NothingBestError
from equipoise.studies.store import checksum_of
from support.chosen import EXHAUSTIVE
from surface.running import (
    command,
    command_lines,
    equipoise,
    example_text,
    interrupted,
    process,
    refused,
    refuses,
    succeeded,
)
from surface.studies import LENGTHS, TOLERANCES, written

STORE = "lengths.zarr"


pytestmark = pytest.mark.usefixtures("with_progress")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory, with_progress: None) -> Path:
    """A store, and what was printed when it was made."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "study.toml").write_text(LENGTHS, encoding="utf-8")
    result = equipoise("sweep", folder / "study.toml", "-o", folder / STORE)
    (folder / "out").write_text(succeeded(result))
    (folder / "err").write_text(result.err)
    return folder


@pytest.fixture(autouse=True)
def copied(folder: Path, made: Path) -> None:
    """A copy of the store for each test."""
    shutil.copytree(made / STORE, STORE)


def best(*words: str | Path) -> dict[str, Any]:
    """What `equipoise best ... --json` prints, and that it prints only that."""
    result = equipoise("best", STORE, *words, "--json")
    assert result.out.count("\n") == 1
    content: dict[str, Any] = json.loads(succeeded(result))
    return content


# -- sweep and resume ------------------------------------------------------------------------------


def test_what_is_printed(made: Path) -> None:
    shown = (made / "out").read_text()
    assert shown.startswith(f"Lengths of type I\n{made / STORE}: 200 designs of 2 numbers, ")
    counts = dict(re.findall(r"^(computed|keep every limit) +(\d+) ", shown, re.MULTILINE))
    store = eq.studies.open_store(STORE)
    figures = store.read(range(200)).outcome.figures
    assert counts["computed"] == str(np.isfinite(figures[:, 0]).sum())
    assert counts["keep every limit"] == str(np.sum(figures[:, 0] <= 13))
    assert "The best designs; vertical smallest" in shown
    assert f"equipoise best {made / STORE}" in shown
    line = (made / "err").read_text().splitlines()[-1]
    assert re.match(r"200 designs computed in \d.* s, .* designs/s; best: vertical .* mN", line)


def test_units_are_those_of_the_files(made: Path) -> None:
    """The limit is in mN, lengths and masses of the model are in mm and g."""
    shown = (made / "out").read_text()
    first = eq.studies.best(eq.studies.open_store(STORE), 1)
    row = next(
        line for line in shown.splitlines() if re.match(rf"{first.designs[0]}  +[0-9]", line)
    )
    _, vertical, torque, length, mass = map(float, row.split())
    assert vertical == pytest.approx(1e3 * first.figures[0, 0], rel=1e-3)
    assert torque == pytest.approx(first.figures[0, 1], rel=1e-3)
    assert (length, mass) == pytest.approx(1e3 * first.values[0], rel=1e-3)
    assert re.search(r"^.* mN +N m +mm +g$", shown, re.MULTILINE)


def test_json() -> None:
    study = written(LENGTHS, ("designs = 200", "designs = 50"))
    result = equipoise("sweep", study, "-o", "new.zarr", "--json")
    content = json.loads(succeeded(result))
    assert result.out.count("\n") == 1
    assert {key: content[key] for key in ("title", "store", "designs", "note")} == {
        "title": "Lengths of type I",
        "store": "new.zarr",
        "designs": 50,
        "note": None,
    }
    actual = eq.studies.best(eq.studies.open_store("new.zarr"), 3)
    assert content["kept"] == actual.kept
    assert content["best"] == actual.to_dict()
    assert content["computed_now"] == 50
    assert content["seconds"] > 0


def test_resuming_computes_what_is_missing_and_nothing_else() -> None:
    def chunks() -> dict[str, bytes]:
        return {str(file): file.read_bytes() for file in Path(STORE).glob("*/c/*")}

    before = chunks()
    shown = succeeded(equipoise("resume", STORE))
    assert "200 designs of 2 numbers, nothing was missing" in shown
    for file in Path(STORE).glob("vertical/c/*"):
        file.unlink()
    assert eq.schema.resume(STORE, workers=2).missing() == []
    assert chunks() == before
    for file in Path(STORE).glob("vertical/c/*"):
        file.unlink()
    result = equipoise("resume", STORE, "--json", "--workers", "1")
    assert json.loads(succeeded(result))["computed_now"] == 200
    assert chunks() == before


def test_one_process_at_a_time() -> None:
    for file in Path(STORE).glob("vertical/c/*"):
        file.unlink()
    with eq.studies.open_store(STORE).writing():
        said = refused(equipoise("resume", STORE))
    assert said.startswith(f"{STORE}: process {os.getpid()} on ")
    assert "is writing into this store; wait until it is done, or stop it" in said


def test_a_study_without_an_aim() -> None:
    study = written(LENGTHS, ('at_most = "13000 mN"\nmake = "smallest"\n', ""))
    shown = succeeded(equipoise("sweep", study, "-o", "new.zarr", "--plot", "drawn"))
    assert "The best" not in shown
    assert "keep every limit" not in shown
    drawn = {path.stem: path.read_text(encoding="utf-8") for path in Path("drawn").iterdir()}
    assert drawn.keys() == {"designs", "parallel"}
    for text in drawn.values():  # none is better than another
        assert "200 designs, " in text and "all designs" in text and "the model itself" in text
        assert "is good" not in text and "chosen designs" not in text
    assert "equipoise best new.zarr --by vertical" in shown
    said = refused(equipoise("best", "new.zarr"))
    assert "the study has no objective; name an output to rank by" in said


def test_the_note_does_not_depend_on_the_wording_of_a_refusal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    study = written(LENGTHS, ("13000 mN", "1 N"))
    monkeypatch.setattr(NothingBestError, "__str__", lambda error: "another sentence")
    shown = succeeded(equipoise("sweep", study, "-o", "new.zarr"))
    assert re.search(r"^note: none of \d+ designs keeps every limit; .*: [^;]*vert", shown, re.M)


def test_no_design_keeps_the_limits() -> None:
    study = written(LENGTHS, ("13000 mN", "1 N"))
    shown = succeeded(equipoise("sweep", study, "-o", "new.zarr"))
    assert re.search(r"^keep every limit +0 +0.00$", shown, re.MULTILINE)
    assert re.search(r"^note: none of \d+ designs keeps every limit; .*: [^;]*vert", shown, re.M)
    assert "equipoise best new.zarr --plot pictures" in shown
    said = refused(equipoise("best", "new.zarr"))
    assert said.startswith("new.zarr: none of ")


def test_designs_nearest_to_the_limits_are_drawn() -> None:
    """Where none keeps all of them; the one that lacks least is told and named first."""
    study = written(LENGTHS, ("13000 mN", "1 N"))
    succeeded(equipoise("sweep", study, "-o", "new.zarr", "--plot", "swept"))
    shown = succeeded(equipoise("best", "new.zarr", "--count", "3", "--plot", "drawn"))
    assert re.search(r"^! none of \d+ designs keeps every limit", shown, re.M)
    assert "Designs nearest to the limits" in shown
    first = re.findall(r"^(\d+) +\d+", shown, re.M)
    everything = best("--count", "3")["designs"]  # of the same designs, with a limit they keep
    assert first == [str(item["design"]) for item in everything]
    for folder in ("swept", "drawn"):
        text = (Path(folder) / "designs.svg").read_text(encoding="utf-8")
        assert "all designs, none of which keeps every limit" in text
        assert "designs nearest to the limits" in text and f"design {first[0]}" in text
        assert "designs that keep every limit" not in text


# Bundled studies are checked, and other studies computed, on every change.
@pytest.mark.exhaustive
def test_a_bundled_study_and_the_examples() -> None:
    names = {line.split()[0] for line in succeeded(equipoise("examples")).splitlines()}
    assert set(eq.examples("study")) <= names
    for name in eq.examples("study"):
        shown = succeeded(equipoise("check", name))
        assert shown.startswith(eq.schema.load_study(name).title)
        assert f"ready for: equipoise sweep {name} -o designs.zarr" in shown


# Processes that compute one design after the other are tried by
# tests/unit/studies/test_executors.py.
@EXHAUSTIVE
def test_processes() -> None:
    """Figures of `plant` are computed one by one, in processes of their own."""
    study = written(
        LENGTHS,
        ("yamashita-1", "kim-chung-a"),
        ("designs = 200", "designs = 6"),
        (
            '[[outputs]]\nname = "torque"\nvalue = "drive_torque.peak"\n',
            '[[outputs]]\nof = "plant"\nvalue = "curve.height"\nmake = "largest"\n',
        ),
    )
    result = equipoise("sweep", study, "-o", "new.zarr", "--workers", "2")
    shown = succeeded(result)
    assert "Pareto-optimal designs" in shown or "note: " in shown
    assert result.err.splitlines()[-1].startswith("6 designs computed in ")


# Interrupts in this process: tests/unit/studies/test_run.py and the test below.
@pytest.mark.exhaustive
def test_an_interrupted_sweep_goes_on() -> None:
    study = written(LENGTHS, ("designs = 200", "designs = 500_000"))
    words = command("sweep", study, "-o", "long.zarr")
    result = interrupted(words, lambda: len([*Path("long.zarr").glob("reason/c/*")]) > 0)
    assert (result.status, result.out) == (130, "")
    assert result.err.splitlines()[-1] == (
        "equipoise: interrupted; what is stored stays; continue with: equipoise resume long.zarr"
    )
    assert "Traceback" not in result.err
    store = eq.studies.open_store("long.zarr")
    assert 0 < len(store.missing()) < store.chunks


def test_an_interrupt_while_designs_are_drawn_reports_how_to_go_on(monkeypatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(sweep, "_charts", interrupt)
    done = equipoise("sweep", written(LENGTHS), "-o", "drawn.zarr", "--plot", "pictures")
    assert done.status == 130
    assert done.err.splitlines()[-1] == (
        "equipoise: interrupted; what is stored stays; continue with: equipoise resume drawn.zarr"
    )


REFUSED = {
    "sweep": {
        "study.toml": "--out: missing; say where the store is to be, such as",
        "study.toml -o ''": "--out: missing; say where the store is",
        "study.toml -o lengths.zarr": "lengths.zarr: is there already; choo",
        "study.toml -o x --workers 0": "--workers: got '0'; give a whole number from 1 to 1000",
        "study.toml -o x --workers 2 --cluster tcp://127.0.0.1:9": (
            "--workers belongs to this machine, and --cluster computes elsewhere; give one of them"
        ),
        "study.toml -o x --cluster nowhere": "no Dask scheduler answers at nowhere",
        "none.toml -o x": "none.toml: there is no such file; give a p",
        "study-of-length -o x": (
            "study-of-length: there is no such file; did you mean 'study-of-lengths'?"
        ),
        "yamashita-1 -o x": (
            "yamashita-1.toml: this is a model file; give a study file, which names it by a key "
            "model"
        ),
        "pole-saw -o x": "pole-saw.toml: this is a model file; give a st",
        "wrong.toml -o x": "wrong.toml: outputs[2].value: got 'drive_torque.pek'; ",
    },
    "resume": {
        "x": "x: there is no such store; make it by: equipoise sweep",
        "study.toml": "study.toml: a store is a folder; of a study file it is made by: equi",
    },
    "best lengths.zarr": {
        "--by vertcal": "no output or varied number is called 'vertcal'; ",
        "--count 0": "--count: got '0'; give a whole number from 1 to",
        "--design 3": "--design belongs to --out; give both",
        "-o x.toml --design 200": "--design: got 200; give a whole number from 0 to 199",
        "-o study.toml": "study.toml: is there already; choose an",
        "-o no/x.toml": "no/x.toml: there is no such folder; make i",
        "--csv lengths.zarr": "--csv: lengths.zarr is a directory; give the name",
        "-o x.toml --csv x.toml": (
            "--csv: x.toml has another part in this command; give another name"
        ),
    },
    "export": {
        "lengths.zarr": "--out: missing; give the name of a file",
        "lengths.zarr -o x.txt": "--out: got 'x.txt'; give the name of a",
        "lengths.zarr -o no/x.csv": "--out: no/x.csv: there is no su",
        "x -o x.csv": "x: there is no such file; give a path",
    },
}


@command_lines(REFUSED)
def test_refused(line: str, said: str) -> None:
    written(LENGTHS)
    written(LENGTHS, ("drive_torque.peak", "drive_torque.pek"), name="wrong.toml")
    refuses(line, said)


@pytest.mark.parametrize(
    ("library", "words", "extra"),
    [
        ("zarr", ["sweep", "study.toml", "-o", "x"], "studies"),
        ("distributed", ["sweep", "study.toml", "-o", "x", "--cluster", "tcp://a:1"], "cluster"),
        ("pyarrow", ["export", STORE, "-o", "x.csv"], "studies"),
        ("pymoo", ["search", "study.toml"], "studies"),
    ],
)
def test_a_library_that_is_not_installed(
    monkeypatch: pytest.MonkeyPatch, library: str, words: list[str], extra: str
) -> None:
    written(LENGTHS)
    for name in [name for name in sys.modules if name.split(".")[0] == library]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, library, None)
    said = refused(equipoise(*words))
    assert f"needs {library}, which is not installed; " in said
    assert said.endswith(f'install it with: pip install "equipoise[{extra}]"')
    assert {path.name for path in Path().iterdir()} == {STORE, "study.toml"}


@pytest.mark.parametrize("name", ["analyze", "plant", "respond", "balance", "modes", "tool"])
def test_commands_for_models_refuse_a_study(name: str) -> None:
    said = "this is a study, with tables [[vary]] and [[outputs]]; use `equipoise sweep FILE`"
    assert refuses(f"{name} {written(LENGTHS)}", said) == f"study.toml: {said}"


def test_a_study_of_a_study() -> None:
    written(TOLERANCES, name="other.toml")
    said = refused(equipoise("check", written(LENGTHS, ("yamashita-1", "other.toml"))))
    assert said.endswith("other.toml: this is a study; name the file of a linkage or a tool")


# -- best ------------------------------------------------------------------------------------------


def test_the_best_as_json() -> None:
    result = best("--count", "4")
    assert result == {
        "title": "Lengths of type I",
        **eq.studies.best(eq.studies.open_store(STORE), 4).to_dict(),
    }
    figures = [item["figures"]["vertical"] for item in result["designs"]]
    assert figures == sorted(figures)


def test_what_to_go_by() -> None:
    result = best("--by", "torque", "--largest", "links.crank.mass")
    assert result["by"] == {"torque": "smallest", "links.crank.mass": "largest"}
    shown = succeeded(equipoise("best", STORE, "--by", "torque", "--largest", "links.crank.mass"))
    assert "Pareto-optimal designs; torque smallest, mass of the crank largest" in shown
    assert "\n  mass of the crank: links.crank.mass\n" in shown  # as --by takes it
    assert "Limits: vertical at most 13000 mN" in shown


def test_designs_as_csv() -> None:
    result = equipoise("best", STORE, "--count", "3", "--csv", "best.csv")
    assert succeeded(result)
    assert result.err == "wrote best.csv\n"
    with Path("best.csv").open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head == [
        "design",
        "links.coupler.points.C.x [m]",
        "links.crank.mass [kg]",
        "vertical [N]",
        "torque [N m]",
    ]
    actual = eq.studies.best(eq.studies.open_store(STORE), 3)
    assert [int(row[0]) for row in rows] == actual.designs.tolist()
    assert np.array([row[1:3] for row in rows], float).tolist() == actual.values.tolist()


def test_the_best_as_a_model_file() -> None:
    """Analysed anew it has exactly the figures that stand in the store."""
    result = equipoise("best", STORE, "--out", "best.toml")
    assert succeeded(result)
    assert result.err == "wrote best.toml\n"
    actual = eq.studies.best(eq.studies.open_store(STORE), 1)
    machine = eq.load("best.toml")
    assert machine.links["coupler"].points["C"][0] == actual.values[0, 0]
    assert machine.title.endswith(f", design {actual.designs[0]}")
    assert machine.description.startswith(
        f'Design {actual.designs[0]} of the study "Lengths of type I". Started from: '
    )
    rms = eq.analyze(machine).summary["shaking_force.y"].rms
    assert rms == pytest.approx(actual.figures[0, 0], rel=1e-4)
    succeeded(equipoise("check", "best.toml"))


def test_another_design_as_a_model_file() -> None:
    store = eq.studies.open_store(STORE)
    reason = store.read(range(200)).outcome.reason
    good, bad = (int(np.flatnonzero(result)[0]) for result in (reason == 0, reason != 0))
    succeeded(equipoise("best", STORE, "-o", "other.toml", "--design", good))
    values = dict(zip(store.numbers, store.read(range(good, good + 1)).values[0], strict=True))
    assert eq.schema.machine_of(store, good) == study_of(store).model.machine(values)
    assert eq.load("other.toml").links == eq.schema.machine_of(store, good).links
    said = refused(equipoise("best", STORE, "-o", "bad.toml", "--design", bad))
    assert said == f"design {bad} has no figures (does not turn fully); choose another"
    assert not Path("bad.toml").exists()


# Tools in studies: `test_figures_are_those_that_the_command_prints` of tests/unit/studies.
@pytest.mark.exhaustive
def test_a_tool() -> None:
    """Written with what lies beside it; its studies are computed one by one."""
    study = written(
        'schema = 1\nmodel = "nagamine-irie"\n[[vary]]\npath = "shaft.stations[3].position"\n'
        'list = ["700 mm", "750 mm"]\n[sampling]\nmethod = "grid"\n'
        '[[outputs]]\nvalue = "natural_frequencies[1]"\nmake = "largest"\n'
    )
    result = process("sweep", study, "-o", "tool.zarr", "--workers", "1")
    shown = succeeded(result)
    assert re.search(r"natural", shown)
    succeeded(equipoise("best", "tool.zarr", "--out", "saw.toml"))
    assert eq.schema.load_tool("saw.toml").title.startswith(
        "Brush cutter of Nagamine and Irie, design "
    )


def test_a_store_whose_study_cannot_be_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its figures can still be told, in SI units; a model file cannot be written."""
    file = Path(STORE, "zarr.json")
    content = json.loads(file.read_text().replace("[links.crank]", "[links.cranc]"))
    content["attributes"]["checksum"] = checksum_of(content)
    file.write_text(json.dumps(content))
    shown = succeeded(equipoise("best", STORE))
    assert " kg" in shown
    said = refused(equipoise("best", STORE, "--out", "x.toml"))
    assert said.startswith("lengths.zarr: what is kept of the study cannot be read (")
    said = refused(equipoise("resume", STORE))
    assert said.startswith("lengths.zarr: what is kept of the study cannot be read (")


# -- export ----------------------------------------------------------------------------------------


def test_all_designs_as_one_table() -> None:
    import pandas

    result = equipoise("export", STORE, "-o", "all.parquet")
    assert (succeeded(result), result.err) == ("", "wrote 200 designs to all.parquet\n")
    table = pandas.read_parquet("all.parquet")
    assert len(table) == 200
    result = equipoise("export", STORE, "-o", "kept.csv", "--kept")
    kept = int(best("--count", "1")["kept"])
    assert result.err == f"wrote {kept} designs to kept.csv\n"
    rows = pandas.read_csv("kept.csv")
    assert rows["design"].tolist() == table.index[table["vertical"] <= 13].tolist()
    assert set(rows["reason"]) == {"computed"}


# -- progress --------------------------------------------------------------------------------------


# What bars say is rendered in tests of their own.
@pytest.mark.exhaustive
@pytest.mark.skipif(os.name != "posix", reason="a terminal is made by posix means")
def test_a_bar_in_a_terminal() -> None:
    """What it says half way is tested beside searches; this is its last state, and it goes away."""
    import pty

    study = written(LENGTHS, ("designs = 200", "designs = 2_000"))
    ours, theirs = pty.openpty()
    words = command("sweep", study, "-o", "new.zarr")
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "120"}
    done = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=theirs, env=environment)
    os.close(theirs)
    seen = b""
    try:
        while part := os.read(ours, 65536):
            seen += part
    except OSError:  # the other end is closed
        pass
    out, _ = done.communicate()
    text = seen.decode()
    assert done.returncode == 0
    assert b"2000 designs of 2 numbers" in out
    assert re.search(r"2000 designs computed in .* designs/s", text)
    assert "best: vertical" in text
    assert "failed: does not turn fully" in text
    assert text.endswith("\x1b[2K")  # the lines are wiped


def test_a_model_that_no_command_computes_is_refused_before_there_is_a_store() -> None:
    """A compiled loop may be made of it, and fails for every design."""
    torsion = (
        '\n[[torsion_springs]]\nlink = "crank"\non = "coupler"\nangles = ["-40 deg", "60 deg"]\n'
    )
    torsion += 'torques = ["9 N m", "-20 N m"]\n'
    Path("model.toml").write_text(example_text("yamashita-1") + torsion, encoding="utf-8")
    study = LENGTHS.replace('"yamashita-1"', '"model.toml"')
    Path("study.toml").write_text(study, encoding="utf-8")
    sentence = refuses("sweep study.toml -o new.zarr", "beyond half a turn")
    assert sentence.startswith("study.toml: outputs[")
