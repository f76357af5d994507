"""Links that a stranger has planted: nothing outside is changed or read, whatever is run."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from math import exp, sin
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

from equipoise.cli.tools import tools
from equipoise.errors import EquipoiseError, UsageError
from equipoise.exchange.formats import FORMATS
from equipoise.folders import Folder
from equipoise.schema.documents import load
from equipoise.schema.files import write_all
from equipoise.web import server as served_files
from equipoise.web.files import on_disk
from equipoise.web.stores import StoreDesk, stores_in
from support import refusals
from support.chosen import few, few_together
from surface.registered import functions, line_of, options
from surface.running import command, equipoise, example_text, refused, succeeded
from surface.studies import LENGTHS, TOLERANCES
from surface.test_fuzz_commands import FIT, words_of
from unit.web.pages import unpacked

MODEL = example_text("yamashita-1")
STORE, LOCK = Path("lengths.zarr"), ".lock"
SECRET = "what nobody else may see or change"
READING = (("best",), ("best", "--json"), ("export", "-o", "all.csv"))


@dataclass(frozen=True)
class Outside:
    """Files elsewhere, and what they were."""

    folder: Path
    before: dict[str, tuple[bytes, int]]

    def unchanged(self) -> None:
        assert everything(self.folder) == self.before


def everything(folder: Path) -> dict[str, tuple[bytes, int]]:
    """Content and time of change of every file below a folder; of a folder nothing but its name."""
    return {
        str(path.relative_to(folder)): (path.read_bytes(), path.stat().st_mtime_ns)
        if path.is_file()
        else (b"", 0)
        for path in sorted(folder.rglob("*"))
    }


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of two chunks, the second of which is missing."""
    folder = tmp_path_factory.mktemp("made")
    study = folder / "study.toml"
    study.write_text(LENGTHS.replace("designs = 200", "designs = 10000"), encoding="utf-8")
    succeeded(equipoise("sweep", study, "-o", folder / STORE))
    for chunk in (folder / STORE).glob("*/c/1"):
        chunk.unlink()
    return folder / STORE


@pytest.fixture
def store(folder: Path, made: Path) -> None:
    """A copy of it for each test."""
    shutil.copytree(made, STORE)


@pytest.fixture
def outside(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Outside]:
    """A folder elsewhere, with files of every kind; unchanged in the end."""
    there = tmp_path_factory.mktemp("outside")
    (there / "secret.txt").write_text(SECRET, encoding="utf-8")
    (there / "victim.partial").write_text(SECRET, encoding="utf-8")
    (there / "model.toml").write_text(MODEL, encoding="utf-8")
    (there / "load.csv").write_text("crank_angle [deg],torque [N m]\n0,1\n180,2\n")
    (there / "folder").mkdir()
    result = Outside(there, everything(there))
    yield result
    result.unchanged()


named = cache(tools)
"""As a server has them, which collects what commands take once."""


def in_agents_server(name: str, **given: object) -> str:
    """What a tool of `equipoise mcp` answers in this folder."""
    try:
        return named()[name].answer(given, Path.cwd().resolve()).text
    except EquipoiseError as error:
        return str(error)


PLACES = (
    *("zarr.json", LOCK, "torque", "reason/c", "reason/c/0", "torque/c/0", "vertical"),
    *("torque/c", "links.coupler.points.C.x/c/0", "links.crank.mass"),
)


def planted(place: Path, target: Path) -> None:
    """A link in the place of what was there, to a copy of it elsewhere."""
    if place.is_dir():
        shutil.rmtree(place)
    else:
        place.unlink(missing_ok=True)
    place.symlink_to(target)


# -- a store ---------------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=[".lock", "torque", "reason/c/0", "vertical"])
@pytest.mark.parametrize("place", [*PLACES, "torque/c/1", "torque/c/1.partial"])
@pytest.mark.usefixtures("store")
def test_links_in_a_store_are_not_followed(
    place: str, outside: Outside, made: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Each leads to what would be right in its place, so that only the link can be refused."""
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    if (made / place).is_dir():
        shutil.copytree(made / place, elsewhere / "copy")
        (elsewhere / "copy" / "left.partial").write_text(SECRET)
    elif (made / place).is_file() and (made / place).stat().st_size:
        shutil.copy(made / place, elsewhere / "copy")
    else:
        (elsewhere / "copy").write_text(SECRET)
    before = everything(elsewhere)
    planted(STORE / place, elsewhere / "copy")
    for words in READING:
        result = equipoise(words[0], STORE, *words[1:])
        if place in {LOCK, "torque/c/1.partial"}:  # which nobody reads
            succeeded(result)
        else:
            assert "is a link" in refused(result)
            assert SECRET not in result.err
    assert SECRET not in in_agents_server("best", store=str(STORE))
    in_agents_server("resume", store=str(STORE))
    resumed = equipoise("resume", STORE)
    if place == "torque/c/1.partial":  # of a process that was killed: the link itself goes
        succeeded(resumed)
    else:
        assert "is a link" in refused(resumed)
    assert everything(elsewhere) == before


@pytest.mark.usefixtures("store")
def test_a_number_that_leads_out_of_the_store_names_no_file(outside: Outside) -> None:
    text = (STORE / "zarr.json").read_text()
    up = f"../../{outside.folder.name}/folder"
    for name in ("torque", "vertical"):
        (STORE / "zarr.json").write_text(text.replace(name, up))
        for words in (*READING, ("resume",)):
            refused(equipoise(words[0], STORE, *words[1:]))


@pytest.mark.usefixtures("store")
def test_pages_list_and_open_no_store_through_a_link(outside: Outside, made: Path) -> None:
    planted(STORE / "zarr.json", made / "zarr.json")
    assert stores_in(Path()) == []
    with refusals.refused(UsageError, place="lengths.zarr"):
        StoreDesk.load(str(STORE))


def test_the_fence_is_asked_for_a_store(outside: Outside, made: Path) -> None:
    Path("way.zarr").symlink_to(made)
    Path("way").symlink_to(made.parent)
    for store in ("way.zarr", f"way/{STORE}"):
        for name in ("best", "resume", "export"):
            more = {"out": "all.csv"} if name == "export" else {}
            key = "file" if name == "export" else "store"
            assert "leads out of the folder" in in_agents_server(name, **{key: store}, **more)
    assert not Path("all.csv").exists()
    assert not (made / LOCK).exists() or not (made / LOCK).read_bytes()


# -- a model ---------------------------------------------------------------------------------------

LOADS = '\n[[loads]]\nlink = "crank"\ntable = "{}"\noutside = "hold"\n'
COMMANDS = (
    *("check", "analyze", "report", "balance", "plot", "animate", "respond", "modes", "run"),
    *("plant", "export -o out.xml", "simulate '0.1 s'", "plant fit fit.toml"),
    *("balance conditions", "balance arrangements 3", "balance --csv out.csv"),
    *("balance sensitivities shaking_force.y", "plot -o pictures", "serve --no-browser"),
    "balance trade-off shaking_force.y drive_torque",
    "plot map 'links.crank.mass = 1 kg : 2 kg' 'drive.speed = 9 : 10 rpm' shaking_force.y",
)
"""Every command of a linkage, behind whose name its file goes."""


@pytest.mark.exhaustive(but=["load.csv"])
@pytest.mark.parametrize("name", ["load.csv", "sub/load.csv", "way/load.csv"])
def test_a_model_reads_no_table_through_a_link_that_leads_out(name: str, outside: Outside) -> None:
    Path("sub").mkdir()
    Path("way").symlink_to(outside.folder)
    for place in ("load.csv", "sub/load.csv"):
        Path(place).symlink_to(outside.folder / "load.csv")
    Path("model.toml").write_text(MODEL + LOADS.format(name))
    Path("fit.toml").write_text(FIT)
    for line in COMMANDS:
        assert "leads out of its folder" in refused(equipoise(*words_of(line, "model.toml"))), line


@pytest.mark.parametrize(
    "text", [SECRET, f"{SECRET},another", f"crank_angle [deg],torque [N m]\n0,{SECRET}"]
)
@pytest.mark.parametrize("named", ["absolute", "above"])
def test_of_a_file_elsewhere_that_a_model_names_nothing_is_quoted(
    folder: Path, named: str, text: str
) -> None:
    """It need not be a table; whoever sent the model may be sent what was printed of it."""
    (folder / "secret").write_text(text)
    (folder / "here").mkdir()
    name = str(folder / "secret") if named == "absolute" else "../secret"
    Path("here/model.toml").write_text(MODEL + LOADS.format(name))
    sentence = refused(equipoise("analyze", "here/model.toml"))
    assert name in sentence and "line " in sentence
    assert SECRET not in sentence
    Path("here/table.csv").write_text(text)
    Path("here/model.toml").write_text(MODEL + LOADS.format("table.csv"))
    assert SECRET[:20] in refused(equipoise("analyze", "here/model.toml"))


def test_a_link_within_the_folder_of_a_model_is_followed(outside: Outside) -> None:
    Path("real.csv").write_text((outside.folder / "load.csv").read_text())
    Path("load.csv").symlink_to("real.csv")
    Path("model.toml").write_text(MODEL + LOADS.format("load.csv"))
    succeeded(equipoise("analyze", "model.toml"))
    Path("below").mkdir()
    Path("below/model.toml").write_text(MODEL + LOADS.format("../real.csv"))
    succeeded(equipoise("analyze", "below/model.toml"))


def test_a_study_reads_no_model_through_a_link_that_leads_out(outside: Outside) -> None:
    Path("model.toml").symlink_to(outside.folder / "model.toml")
    Path("study.toml").write_text(LENGTHS.replace('"yamashita-1"', '"model.toml"'))
    for words in (("check",), ("sweep", "-o", STORE), ("tolerance",), ("search",)):
        said = refused(equipoise(words[0], "study.toml", *words[1:]))
        assert "leads out of its folder" in said
    assert not STORE.exists()


# -- what is written -------------------------------------------------------------------------------

SMALL = ("--population", "8", "--generations", "2")
WRITING = {
    "analyze --csv": ("analyze", "mine.toml", "--csv", "{}"),
    "report": ("report", "mine.toml", "-o", "{}.html"),
    "export": ("export", "mine.toml", "-o", "{}.xml"),
    "animate": ("animate", "mine.toml", "-o", "{}.svg"),
    "balance": ("balance", "balance-crank", "--out", "{}.toml"),
    "new": ("new", "{}.toml"),
    "import": ("import", "mine.mjcf.xml", "--out", "{}.toml"),
    "export of a store": ("export", str(STORE), "-o", "{}.csv"),
    "best": ("best", str(STORE), "--out", "{}.toml"),
    "sweep": ("sweep", "study.toml", "-o", "{}.zarr"),
    "search": ("search", "search.toml", *SMALL, "--out", "{}.toml"),
    "search --csv": ("search", "search.toml", *SMALL, "--csv", "{}.csv"),
    "balance --csv": ("balance", "balance-crank", "--csv", "{}.csv"),
    "respond --csv": ("respond", "yamashita-rig", "--speed", "60 : 70 rpm", "--csv", "{}.csv"),
    "simulate --csv": ("simulate", "yamashita-rig", "0.1 s", "--csv", "{}.csv"),
    "plant --csv": ("plant", "kim-chung-a", "--csv", "{}.csv"),
    "tool --csv": ("tool", "nagamine-irie", "--modes", "--csv", "{}.csv"),
    "best --csv": ("best", str(STORE), "--csv", "{}.csv"),
    "run --csv": ("run", "balance-crank", "0.1 s", "--csv", "{}.csv"),
    "tool design": ("tool", "design", "brush-cutter", "--out", "{}.toml"),
    "plant fit": ("plant", "fit", "kim-chung-a", "fit.toml", "--out", "{}.toml"),
    "plant fit --csv": (
        *("plant", "fit", "kim-chung-a", "fit.toml", "--out", "fitted.toml", "--csv", "{}.csv"),
    ),
    "balance trade-off --csv": (
        *("balance", "trade-off", "balance-crank", "shaking_force.y", "drive_torque"),
        *("--points", "2", "--csv", "{}.csv"),
    ),
}
DRAWING = {
    "plot": ("plot", "mine.toml", "--only", "linkage", "-o", "pictures"),
    "tolerance": ("tolerance", "study.toml", "--designs", "352", "--plot", "pictures"),
    "search": ("search", "search.toml", *SMALL, "--plot", "pictures"),
    "best": ("best", str(STORE), "--plot", "pictures"),
    "exposure": ("exposure", "tasks.csv", "--plot", "pictures"),
    "modes": ("modes", "yamashita-rig", "--plot", "pictures"),
    "plot map": (
        *(
            "plot",
            "map",
            "mine.toml",
            "links.crank.mass = 1 kg : 2 kg",
            "drive.speed = 60 rpm : 90 rpm",
        ),
        *("rms shaking_force.y", "--points", "5", "-o", "pictures"),
    ),
    "balance": ("balance", "balance-crank", "--plot", "pictures"),
    "balance trade-off": (
        *("balance", "trade-off", "balance-crank", "shaking_force.y", "drive_torque"),
        *("--points", "2", "--plot", "pictures"),
    ),
    "decay": ("decay", "swing.csv", "--stiffness", "2 N/mm", "--plot", "pictures"),
    "plant": ("plant", "kim-chung-a", "--plot", "pictures"),
    "plant fit": (
        *("plant", "fit", "kim-chung-a", "fit.toml", "--out", "fitted.toml", "--plot", "pictures"),
    ),
    "respond": ("respond", "yamashita-rig", "--plot", "pictures"),
    "resume": ("resume", str(STORE), "--plot", "pictures"),
    "run": ("run", "balance-crank", "0.1 s", "--plot", "pictures"),
    "simulate": ("simulate", "yamashita-rig", "0.1 s", "--plot", "pictures"),
    "sweep": ("sweep", "search.toml", "-o", "swept.zarr", "--plot", "pictures"),
    "tool": ("tool", "nagamine-irie", "--modes", "--plot", "pictures"),
    "tool design": ("tool", "design", "brush-cutter", "--plot", "pictures"),
    "tool vary": (
        *("tool", "vary", "nagamine-irie", "harness position = 0 mm : 410 mm"),
        *("--plot", "pictures"),
    ),
}
for name in functions():  # of a file that it tells of, and of nothing else
    asked, of_file = {*options(name)}, line_of(name)
    if of_file and "--csv" in asked and f"{name} --csv" not in WRITING:
        WRITING[f"{name} --csv"] = (*of_file, "--csv", "{}.csv")
    if of_file and "--plot" in asked and name not in DRAWING:
        DRAWING[name] = (*of_file, "--plot", "pictures")
OFTEN = (
    "analyze --csv",
    "report",
    "export",
    "animate",
    "balance",
    "sweep",
    "plot",
    "best",
    "plant fit --csv",
)
"""What is tried on every change; all write by the same few functions."""


def inputs() -> None:
    """Files for each of these commands."""
    Path("mine.toml").write_text(MODEL)
    Path("rod.toml").write_text(example_text("slider-crank-engine") + SECTION)
    Path("study.toml").write_text(TOLERANCES)
    Path("search.toml").write_text(LENGTHS)
    Path("tasks.csv").write_text("task,acceleration [m/s^2],duration [h]\nbrush saw,4.6,2\n")
    swing = (f"{k / 500},{30 * exp(-k / 200) * sin(k / 20)}" for k in range(800))
    Path("swing.csv").write_text("\n".join(["time [s],displacement [mm]", *swing]))
    Path("fit.toml").write_text(FIT)


def unswept() -> None:
    """Nothing is in the way of a command that runs a second time."""
    shutil.rmtree("swept.zarr", ignore_errors=True)
    Path("fitted.toml").unlink(missing_ok=True)


@pytest.mark.exhaustive(
    but=[
        "analyze --csv-secret.txt",
        "analyze --csv-nowhere",
        "balance-secret.txt",
        "sweep-secret.txt",
        "animate-secret.txt",
    ]
)
@pytest.mark.parametrize(
    ("name", "target"),
    few_together(
        product(WRITING, ("secret.txt", "nowhere", "folder")),
        {*product(OFTEN, ["secret.txt"]), *product(OFTEN[:1], ("nowhere", "folder"))},
    ),
)
@pytest.mark.usefixtures("store")
def test_what_is_written_goes_through_no_link_that_leads_out(
    name: str, target: str, outside: Outside
) -> None:
    words = WRITING[name]
    inputs()
    succeeded(equipoise("export", "mine.toml", "-o", "mine.mjcf.xml"))
    place = next(word for word in words if "{}" in word).format("out")
    Path(place).symlink_to(outside.folder / target)
    refused(equipoise(*(word.format("out") for word in words)))
    assert Path(place).is_symlink()


TABLES = {"csv", "parquet"}
"""Kinds of files of a store."""
SECTION = """
[links.rod.section]
diameter = "12 mm"
elastic_modulus = "206 GPa"
"""
DRAWN = ("svg", "pdf")
"""Formats of outlines alone."""
KINDS_OF_FILES = [
    *(
        ("export", str(STORE) if name in TABLES else "mine.toml", "-o", f"out{value.ending}")
        for name, value in FORMATS.items()
        if name not in DRAWN and not value.of_link  # this machine has neither outlines nor sections
    ),
    *(
        ("export", "yamashita-1", "--balanced", "-o", f"out{FORMATS[name].ending}")
        for name in DRAWN
    ),
    *(
        ("export", "rod.toml", "-o", f"out{value.ending}")
        for value in FORMATS.values()
        if value.of_link
    ),
    *(("animate", "mine.toml", "--width", "100", "-o", f"out.{end}") for end in ("gif", "mp4")),
    ("report", "mine.toml", "--pdf", "-o", "out.pdf"),
]


@pytest.mark.exhaustive(but=["out.csv1", "out.svg", "out.html", "out.dxf", "out.fmu", "out.gif"])
@pytest.mark.parametrize("words", KINDS_OF_FILES, ids=lambda words: words[-1])
@pytest.mark.usefixtures("store")
def test_no_kind_of_file_is_written_through_a_link(
    words: tuple[str, ...], outside: Outside
) -> None:
    """Whatever library makes it."""
    inputs()
    Path(words[-1]).symlink_to(outside.folder / "secret.txt")
    assert "leads out of its folder" in refused(equipoise(*words))
    assert Path(words[-1]).is_symlink()


def test_every_option_that_writes_is_tried() -> None:
    """A new one joins the tables."""
    tried = [" ".join(words) for words in (*WRITING.values(), *DRAWING.values(), *KINDS_OF_FILES)]
    lines = [line.replace(" -o ", " --out ") for line in tried]
    left = {
        (command, option)
        for command in functions()
        for option in {*options(command)} & {"--out", "--csv", "--plot"}
        if not any(line.startswith(f"{command} ") and f" {option} " in line for line in lines)
    }
    assert left == {("site", "--out")}  # which has tests of its own


@pytest.mark.exhaustive(but=["plot-svg", "balance-svg"])
@pytest.mark.parametrize(
    ("name", "kind"),
    few_together(product(DRAWING, ("svg", "png")), {*product(OFTEN, ["svg"]), ("plot", "png")}),
)
@pytest.mark.usefixtures("store")
def test_pictures_go_through_no_link_in_their_folder(
    name: str, kind: str, outside: Outside
) -> None:
    words = DRAWING[name]
    inputs()
    succeeded(equipoise(*words, "--format", kind))
    first, *_, last = sorted(Path("pictures").iterdir()) * 2
    for picture in {first, last}:
        planted(picture, outside.folder / "secret.txt")
        unswept()
        assert "leads out of its folder" in refused(equipoise(*words, "--format", kind))
        picture.unlink()
    shutil.rmtree("pictures")
    Path("pictures").symlink_to(outside.folder / "folder")
    unswept()
    assert "leads out of its folder" in refused(equipoise(*words, "--format", kind))


def test_recordings_that_are_links_are_read_and_no_others_written(outside: Outside) -> None:
    """Whoever names a link by hand wants to read it; a program within its fence may not."""
    (outside.folder / "tasks.csv").write_text("task,acceleration [m/s^2],duration [h]\nsaw,4,2\n")
    Path("tasks.csv").symlink_to(outside.folder / "tasks.csv")
    before = everything(outside.folder)
    assert "saw" in succeeded(equipoise("exposure", "tasks.csv"))
    assert "leads out of the folder" in in_agents_server("exposure", input=["tasks.csv"])
    assert everything(outside.folder) == before
    (outside.folder / "tasks.csv").unlink()


def test_what_is_begun_beside_a_place_goes_through_no_link(
    outside: Outside, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever guesses the name that a file has until it is whole plants a link there."""
    from equipoise import atomic_files

    monkeypatch.setattr("equipoise.atomic_files.os.getpid", lambda: 4242)
    for name in ("out.csv", "out.zarr"):
        begun = f".{name}.{atomic_files._here()}-4242.tmp"
        Path(begun).symlink_to(outside.folder / ("folder" if "zarr" in name else "secret.txt"))
    Path("mine.toml").write_text(MODEL)
    Path("study.toml").write_text(LENGTHS)
    succeeded(equipoise("analyze", "mine.toml", "--csv", "out.csv"))
    succeeded(equipoise("sweep", "study.toml", "-o", "out.zarr"))
    assert not Path("out.csv").is_symlink() and not Path("out.zarr").is_symlink()


@pytest.mark.exhaustive(
    but=["analyze --csv-folder", "analyze --csv-file", "balance-file", "sweep-file", "export-file"]
)
@pytest.mark.parametrize(
    ("name", "swap"),
    few_together(
        product(WRITING, ("file", "folder")), {*product(OFTEN, ["file"]), (OFTEN[0], "folder")}
    ),
)
@pytest.mark.usefixtures("store")
def test_what_is_written_goes_through_no_link_that_comes_meanwhile(
    name: str, swap: str, outside: Outside, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = WRITING[name]
    """A link is put in the place of the file, or of its folder, once writing has begun."""
    inputs()
    succeeded(equipoise("export", "mine.toml", "-o", "mine.mjcf.xml"))
    place = next(word for word in words if "{}" in word).format("here/out")
    Path("here").mkdir()
    opened, planted_there = Folder.open, []

    def open_late(folder: Folder, file: str, flags: int, mode: int = 0o666) -> int:
        descriptor = opened(folder, file, flags, mode)
        if flags & os.O_CREAT and not planted_there:
            planted_there.append(file)
            if swap == "file":
                Path(place).symlink_to(outside.folder / "secret.txt")
            else:
                Path("here").rename("old")
                Path("here").symlink_to(outside.folder)
        return descriptor

    monkeypatch.setattr(Folder, "open", open_late)
    equipoise(*(word.format("here/out") for word in words))
    assert planted_there


# By Python: the test below; each writer refuses links on every change.
@pytest.mark.exhaustive
@pytest.mark.parametrize("name", few(DRAWING, OFTEN))
@pytest.mark.usefixtures("store")
def test_pictures_go_into_the_folder_that_was_named_whatever_comes_there(
    name: str, outside: Outside, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A link is put in the place of their folder once the first is begun."""
    words = DRAWING[name]
    inputs()
    opened, planted_there = Folder.open, []

    def open_late(folder: Folder, file: str, flags: int, mode: int = 0o666) -> int:
        descriptor = opened(folder, file, flags, mode)
        if flags & os.O_CREAT and Path("pictures").is_dir() and not planted_there:
            planted_there.append(file)
            Path("pictures").rename("old")
            Path("pictures").symlink_to(outside.folder)
        return descriptor

    monkeypatch.setattr(Folder, "open", open_late)
    equipoise(*words)
    assert planted_there


def test_pictures_drawn_in_python_go_into_the_folder_that_was_named(
    outside: Outside, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = Folder.open

    def open_late(folder: Folder, file: str, flags: int, mode: int = 0o666) -> int:
        descriptor = opened(folder, file, flags, mode)
        if flags & os.O_CREAT and not Path("old").exists():
            Path("new").rename("old")
            Path("new").symlink_to(outside.folder)
        return descriptor

    monkeypatch.setattr(Folder, "open", open_late)
    write_all("new", {"a.svg": b"a", "b.svg": b"b"})
    assert {path.name for path in Path("old").iterdir()} == {"a.svg", "b.svg"}


@pytest.mark.parametrize("name", few(WRITING, ("analyze --csv", "sweep")))
@pytest.mark.usefixtures("store")
def test_a_folder_that_is_named_may_be_a_link_and_what_is_in_it_not(
    name: str, outside: Outside, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Whoever types the way names it; what lies below it may be a stranger's."""
    words, elsewhere = WRITING[name], tmp_path_factory.mktemp("elsewhere")
    inputs()
    succeeded(equipoise("export", "mine.toml", "-o", "mine.mjcf.xml"))
    Path("way").symlink_to(elsewhere)
    place = Path(next(word for word in words if "{}" in word).format("way/out"))
    named = [word.format("way/out") for word in words]
    place.symlink_to(outside.folder / "secret.txt")
    refused(equipoise(*named))
    assert place.is_symlink()
    place.unlink()
    unswept()
    if place.suffix == ".zarr":  # a store is a folder that programs go on with: no link at all
        assert "way is a link" in refused(equipoise(*named))
        return
    succeeded(equipoise(*named))
    assert place.exists() and not place.is_symlink()


@pytest.mark.parametrize("name", few(DRAWING, ("plot",)))
@pytest.mark.usefixtures("store")
def test_pictures_below_a_link_that_is_named_go_through_none(
    name: str, outside: Outside, tmp_path_factory: pytest.TempPathFactory
) -> None:
    inputs()
    Path("way").symlink_to(tmp_path_factory.mktemp("elsewhere"))
    words = [f"way/{item}" if item == "pictures" else item for item in DRAWING[name]]
    succeeded(equipoise(*words))
    first = min(Path("way/pictures").iterdir())
    planted(first, outside.folder / "secret.txt")
    unswept()
    assert "leads out of its folder" in refused(equipoise(*words))
    shutil.rmtree("way/pictures")
    Path("way/pictures").symlink_to(outside.folder / "folder")
    unswept()
    assert "leads out of its folder" in refused(equipoise(*words))


def test_a_link_within_the_folder_stays_one() -> None:
    Path("mine.toml").write_text(MODEL)
    Path("out.csv").symlink_to("real.csv")
    succeeded(equipoise("analyze", "mine.toml", "--csv", "out.csv"))
    assert Path("out.csv").is_symlink() and Path("real.csv").is_file()


# Each writer refuses links on every change; so do tools: the test below.
@pytest.mark.exhaustive
def test_agents_write_through_no_link(outside: Outside) -> None:
    Path("mine.toml").write_text(MODEL)
    Path("way").symlink_to(outside.folder)
    Path("pictures").mkdir()
    Path("pictures/linkage.png").symlink_to(outside.folder / "secret.txt")
    Path("mine-plots").symlink_to(outside.folder / "folder")
    for out in ("way", "way/new", "pictures", "mine-plots"):
        in_agents_server("plot", file="mine.toml", out=out, overwrite=True)
        in_agents_server("sweep", file="study.toml", out=f"{out}/new.zarr")
    in_agents_server("plot", file="mine.toml", overwrite=True)


def test_no_tool_opens_or_writes_what_leads_out_of_the_fence(outside: Outside) -> None:
    """Each place of each tool, by a link and by a path that goes up."""
    inputs()
    Path("way").symlink_to(outside.folder)
    Path("way.toml").symlink_to(outside.folder / "model.toml")
    away = (f"../{outside.folder.name}/model.toml", str(outside.folder / "model.toml"))
    paths = {"file", "study", "store", "input", "targets", "out", "csv", "plot"}
    usual = {"study": "study.toml", "targets": "fit.toml", "store": "none.zarr", "csv": "swing.csv"}
    usual |= {"rows": 3, "points": 3, "input": ["tasks.csv"], "duration": "0.1 s"}
    tried = set()
    for name, tool in named().items():
        schema = tool.schema()
        needed = {key: usual.get(key, "mine.toml") for key in schema["required"]}
        for key in paths & schema["properties"].keys():
            if schema["properties"][key]["type"] == "boolean":
                continue
            for place in ("way/model.toml", "way.toml", *away):
                given = [place] if schema["properties"][key]["type"] == "array" else place
                reported = in_agents_server(name, **needed | {key: given, "overwrite": True})
                if not tool.writes:
                    reported = in_agents_server(name, **needed | {key: given})
                said = "without .. and not from the root" if place in away else "leads out of the f"
                assert said in reported, (name, key, place, reported)
                tried.add((name, key))
    assert len(tried) > 60


# -- saving in place -------------------------------------------------------------------------------


def test_saving_in_place_follows_no_link_that_was_put_there(outside: Outside) -> None:
    model = outside.folder / "model.toml"
    Path("sub").mkdir()
    Path("sub/mine.toml").write_text(MODEL)
    disk = on_disk("sub/mine.toml", load("sub/mine.toml"))
    assert disk is not None
    planted(Path("sub/mine.toml"), model)  # with the same content
    with refusals.refused(UsageError, name="mine.toml"):
        disk.save(replace(disk.model, title="another"))
    Path("sub/mine.toml").unlink()
    Path("sub").rename("old")
    Path("twin").mkdir()
    Path("twin/mine.toml").write_text(MODEL)
    Path("sub").symlink_to(Path("twin").resolve())
    with refusals.refused(UsageError, place=str(Path("sub/mine.toml").absolute())):
        disk.save(disk.model)
    assert Path("twin/mine.toml").read_text() == MODEL


def test_a_file_that_was_opened_through_a_link_is_saved_where_it_is(folder: Path) -> None:
    Path("real").mkdir()
    Path("real/mine.toml").write_text(MODEL)
    Path("mine.toml").symlink_to("real/mine.toml")
    disk = on_disk("mine.toml", load("mine.toml"))
    assert disk is not None
    disk.save(disk.model)
    assert Path("mine.toml").is_symlink()
    assert load("real/mine.toml") == disk.model


# -- the live page ---------------------------------------------------------------------------------


@contextmanager
def page_of(file: str) -> Iterator[ClientConnection]:
    """The connection of a page that `equipoise serve` has opened for a file."""
    words = command("serve", file, "--no-browser")
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as run:
        assert run.stdout is not None
        address = run.stdout.readline().decode().strip()
        host, query = address.split("/")[2], address.rpartition("?")[2]
        try:
            with connect(
                f"ws://{host}/live?{query}", origin=f"http://{host}", max_size=None  # type: ignore[arg-type]
            ) as page:  # fmt: skip
                yield page
        finally:
            run.kill()


def asked(page: ClientConnection, kind: str, **given: object) -> dict[str, Any]:
    """The first answer that tells how a message of the page has ended."""
    page.send(json.dumps({"type": kind, "seq": 7, **given}))
    while True:
        data = page.recv(timeout=300)
        assert isinstance(data, bytes)
        answer: dict[str, Any] = unpacked(data)[0]
        if answer["type"] in {"saved", "refused"}:
            return answer


def put_elsewhere(elsewhere: Path) -> None:
    """The file goes, and a link to a copy of it lies in its place."""
    shutil.copy("sub/mine.toml", elsewhere)
    planted(Path("sub/mine.toml"), elsewhere / "mine.toml")


def put_beside(elsewhere: Path) -> None:
    """The link leads to a copy within the folder, where links of paths that one gives may lead."""
    shutil.copy("sub/mine.toml", "sub/copy.toml")
    planted(Path("sub/mine.toml"), Path("copy.toml"))


def put_above(elsewhere: Path) -> None:
    """The whole folder becomes a link to another with a copy."""
    shutil.copy("sub/mine.toml", elsewhere)
    planted(Path("sub"), elsewhere)


PLANTS = (put_elsewhere, put_beside, put_above)
SAVED = {
    "linkage": ("yamashita-1", "links.crank.mass", "300 g"),
    "tool": ("nagamine-irie", "shaft.stations[3].mass", "1.5 kg"),
}


@pytest.mark.exhaustive(but=["linkage-put_above"])
@pytest.mark.parametrize(
    ("kind", "plant"),
    few_together(
        product(SAVED, PLANTS),
        {*product(["linkage"], PLANTS), ("tool", put_beside)}
        - {("linkage", put_beside), ("linkage", put_elsewhere)},
    ),
)
def test_a_page_saves_through_no_link_that_was_put_in_the_place_of_its_file(
    kind: str,
    plant: Callable[[Path], None],
    outside: Outside,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    if not (Path(served_files.__file__).parent / "static" / "equipoise.js").exists():
        pytest.skip("the page is not bundled")
    name, number, text = SAVED[kind]
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    Path("sub").mkdir()
    Path("sub/mine.toml").write_text(example_text(name))
    edit = {"type": "edit", "seq": 1, "label": "it", "edits": [{"set": number, "text": text}]}
    with page_of("sub/mine.toml") as page:
        page.send(json.dumps(edit))
        assert asked(page, "save")["type"] == "saved"
        assert text.split()[0] in Path("sub/mine.toml").read_text()
        plant(elsewhere)
        copies = {
            path: path.read_bytes() for path in (*elsewhere.iterdir(), *Path("sub").iterdir())
        }
        page.send(
            json.dumps(edit | {"edits": [{"set": number, "text": f"1.25 {text.split()[1]}"}]})
        )
        asked(page, "save")
        del copies[Path("sub/mine.toml")]  # where the link itself may give way to a file
        assert copies == {path: path.read_bytes() for path in copies}
        if plant is not put_above:
            planted(Path("sub/mine.toml"), outside.folder / "nowhere")
            assert asked(page, "save")["type"] != "saved"


@pytest.mark.usefixtures("store")
def test_a_page_opens_no_store_through_a_link(outside: Outside, made: Path) -> None:
    Path("mine.toml").write_text(MODEL)
    Path("way.zarr").symlink_to(made)
    with page_of("mine.toml") as page:
        for name in ("way.zarr", "../made0/lengths.zarr", str(made)):
            assert "message" in asked(page, "study", name=name)
