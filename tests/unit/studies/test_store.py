"""The store: what is in it, what it refuses, and the lock."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray
import zarr

from equipoise.atomic_files import temporary_name
from equipoise.codegen.figures import REASONS
from equipoise.design.variables import Range, Variable
from equipoise.errors import UsageError
from equipoise.folders import Folder
from equipoise.studies.run import create_store, resume
from equipoise.studies.store import UNKNOWN, DamagedError, open_store, versions
from equipoise.studies.study import Output, Sampling, samples
from support.refusals import refused
from support.studies import LENGTH, MASS, SPEED, Formulas, contents, filled, restore, short_study

STUDY = short_study(250)


def test_what_is_stored_is_read_again_and_the_rest_is_known_to_be_missing(tmp_path: Path) -> None:
    filled(tmp_path / "s", STUDY, (2, 0))
    store = open_store(tmp_path / "s")
    assert store.missing() == [1]
    assert store.numbers == STUDY.paths
    assert store.outputs == STUDY.names
    (start, actual), *more = store.in_blocks()
    assert start == 0
    assert not more
    values = samples(STUDY, 0, 250)
    values[100:200] = np.nan
    np.testing.assert_array_equal(actual.values, values)
    np.testing.assert_array_equal(actual.outcome.figures[200:], Formulas()(values[200:]).figures)
    assert set(actual.outcome.reason[100:200]) == {UNKNOWN}
    assert set(actual.outcome.reason[:100]) == {0, 1, 2}


def test_many_designs_are_read_some_chunks_at_a_time(tmp_path: Path) -> None:
    study = short_study(140_000, 30_000)
    store = create_store(tmp_path / "s", study, 30_000, "compiled")
    assert [(start, len(block.values)) for start, block in store.in_blocks()] == [
        (0, 60_000),
        (60_000, 60_000),
        (120_000, 20_000),
    ]


def test_it_opens_in_xarray_and_says_what_is_in_it(tmp_path: Path) -> None:
    store = filled(tmp_path / "s", STUDY)
    data = xarray.open_zarr(store.path)
    assert data[LENGTH].dims == ("design",)
    assert data[LENGTH].chunks == ((100, 100, 50),)
    np.testing.assert_array_equal(data[MASS], samples(STUDY, 0, 250)[:, 1])
    units = {name: array.attrs.get("units") for name, array in data.items()}
    assert units == {
        LENGTH: "m",
        MASS: "kg",
        SPEED: "rad/s",
        "area": None,
        "momentum": "N",
        "energy": "J",
        "reason": None,
    }
    meanings = data["reason"].attrs["flag_meanings"].split()
    flags = dict(zip(data["reason"].attrs["flag_values"], meanings, strict=True))
    assert flags[1] == REASONS[1].replace(" ", "_")
    assert flags[UNKNOWN] == "not_computed_yet"
    assert data.attrs["seed"] == 7
    assert json.loads(data.attrs["versions"]) == versions() == store.versions
    assert restore(json.loads(data.attrs["study"])) == STUDY


def test_zarr_reads_each_array_as_it_is_described(tmp_path: Path) -> None:
    """Chunks are written without Zarr; what it would write itself is the same to every reader."""
    store = filled(tmp_path / "s", STUDY)
    again = zarr.open_group(tmp_path / "again", mode="w")
    for name, array in store.arrays.items():
        again.create_array(name, data=array[:], chunks=array.chunks, compressors=array.compressors)
        np.testing.assert_array_equal(again[name][:], array[:])
        mine, theirs = ((folder / name / "c" / "0") for folder in (store.path, tmp_path / "again"))
        assert mine.read_bytes() == theirs.read_bytes()


def test_only_what_repeats_is_compressed(tmp_path: Path) -> None:
    store = filled(tmp_path / "s", STUDY, (0,))
    sizes = {name: (store.path / name / "c" / "0").stat().st_size for name in store.arrays}
    assert sizes[LENGTH] == sizes["area"] == 800 + 4  # and the checksum
    assert sizes[MASS] < 100
    grid = short_study(
        sampling=Sampling("grid"),
        vary=(Variable(LENGTH, Range(0.06, 0.08, 3)), Variable(MASS, Range(0.1, 0.2, 40))),
    )
    arrays = create_store(tmp_path / "grid", grid, 100, "compiled").arrays
    assert [len(array.compressors) - 1 for array in arrays.values()] == [1, 1, 0, 0, 0, 1]


def test_names_of_outputs_may_have_any_signs(tmp_path: Path) -> None:
    names = ['joint_forces."A, b".rms', "Länge [1]", "__x", "a: b*?", "c"]
    study = short_study(50, outputs=tuple(Output(name) for name in names))
    create_store(tmp_path / "s", study, 50, "compiled")
    assert open_store(tmp_path / "s").outputs == tuple(names)
    assert set(names) < set(xarray.open_zarr(tmp_path / "s"))


# -- chunks that are not whole ---------------------------------------------------------------------


def test_a_chunk_counts_once_all_its_files_are_there_and_have_something_in_them(
    tmp_path: Path,
) -> None:
    store = filled(tmp_path / "s", STUDY)
    assert store.missing() == []
    (store.path / "momentum" / "c" / "1").unlink()
    (store.path / LENGTH / "c" / "2").write_bytes(b"")  # as a failure of the power leaves it
    assert store.missing() == [1, 2]


def test_what_a_killed_process_left_half_written_is_cleared_away(tmp_path: Path) -> None:
    store = filled(tmp_path / "s", STUDY, (0,))
    before = contents(store.path)
    (store.path / MASS / "c" / "1.partial").write_bytes(b"half")
    assert store.missing() == [1, 2]
    with store.writing():
        pass
    assert contents(store.path) == {**before, ".lock": b""}


# -- refused ---------------------------------------------------------------------------------------


def test_a_store_that_cannot_be_made_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with refused(UsageError, place=str(tmp_path / "file" / "s")):
        create_store(tmp_path / "file" / "s", STUDY, 100, "compiled")
    with refused(UsageError, brief="file name too long"):
        create_store(tmp_path / "s", short_study(outputs=(Output("ä" * 150),)), 100, "compiled")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def other_group(path: Path) -> None:
    zarr.create_group(path, attributes={"title": "not ours"})


def newer(path: Path) -> None:
    zarr.create_group(path, attributes={"equipoise_store": 7})


def torn(path: Path) -> None:
    filled(path, STUDY, ())
    (path / "zarr.json").write_text("{")


def incomplete(path: Path) -> None:
    zarr.create_group(path, attributes={"equipoise_store": 2, "numbers": 3, "outputs": ["a"]})


@pytest.mark.parametrize(
    "make",
    [
        lambda path: None,
        Path.touch,
        Path.mkdir,
        other_group,
        torn,
        incomplete,
        newer,
    ],
)
def test_what_is_no_store_is_reported_in_a_sentence(tmp_path: Path, make) -> None:
    make(tmp_path / "s")
    layouts = {"layout": 7, "own": 2} if make is newer else {}
    with refused(UsageError, place=str(tmp_path / "s"), **layouts) as caught:
        open_store(tmp_path / "s")
    assert str(caught.value).startswith(f"{tmp_path / 's'}: ")
    assert "\n" not in str(caught.value)


def test_a_damaged_chunk_is_reported_in_a_sentence(tmp_path: Path) -> None:
    store = filled(tmp_path / "s", STUDY)
    (store.path / "area" / "c" / "1").write_bytes(b"too short")
    with refused(DamagedError, start=100, stop=199, name="area"):
        list(store.in_blocks())


def test_a_store_that_cannot_be_written_is_reported_in_a_sentence(tmp_path: Path) -> None:
    store = filled(tmp_path / "s", STUDY, (0,))
    (store.path / ".lock").mkdir()
    with refused(UsageError, place=str(store.path)), store.writing():
        pass


# -- the lock --------------------------------------------------------------------------------------

HOLD = """
import sys, time
from pathlib import Path
from equipoise.folders import Folder
from equipoise.atomic_files import locked
with locked(Folder.at(Path(sys.argv[1]))):
    print("held", flush=True)
    time.sleep(60)
"""


def test_a_second_process_gets_the_name_of_the_writer_until_that_is_killed(tmp_path: Path) -> None:
    store = filled(tmp_path / "s", STUDY, (0,))
    command = [sys.executable, "-c", HOLD, str(store.path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        writer = f"process {holder.pid} on {socket.gethostname()}"
        with refused(UsageError, holder=writer), store.writing():
            pass
        assert open_store(store.path).missing() == [1, 2]  # whoever reads may
        holder.kill()
        holder.wait()
    with store.writing():  # what the killed one wrote of itself is still there, and is longer
        text = (store.path / ".lock").read_text()
        assert text == f"process {os.getpid()} on {socket.gethostname()}"
    assert (store.path / ".lock").read_bytes() == b""


def test_what_killed_processes_have_begun_goes_with_the_next_store(tmp_path: Path) -> None:
    """Of a store, and of a file; what a living process has begun stays."""
    ended = subprocess.Popen([sys.executable, "-c", "pass"])
    ended.wait()
    with temporary_name(Folder.at(tmp_path), "new.zarr") as own:
        (tmp_path / own.replace(str(os.getpid()), str(ended.pid)) / "c").mkdir(parents=True)
        for pid in (ended.pid, os.getppid()):
            (
                tmp_path / own.replace("new.zarr", "x.csv").replace(f"{os.getpid()}", f"{pid}")
            ).touch()
        (tmp_path / ".mine.tmp").touch()
        assert len([*tmp_path.iterdir()]) == 4
        create_store(tmp_path / "s", STUDY, 100, "compiled")
        left = {path.name for path in tmp_path.iterdir()}
    assert len(left) == 3
    assert {"s", ".mine.tmp"} < left
    assert any(name.endswith(f"-{os.getppid()}.tmp") for name in left)


def test_the_lock_of_a_process_that_was_killed_at_its_end_is_cleared(tmp_path: Path) -> None:
    store = filled(tmp_path / "s", STUDY)
    (store.path / ".lock").write_text("process 1 on a machine")
    resume(store.path, restore)
    assert (store.path / ".lock").read_bytes() == b""
