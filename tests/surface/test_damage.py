"""Stores that were damaged: what is read of them says so in one sentence, and changes nothing.

Set EQUIPOISE_FUZZ to a number of examples to search longer, and at random.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from random import Random
from typing import Any

import pytest
import zarr
from hypothesis import given
from hypothesis import strategies as st

from support.studies import contents
from surface.running import Result, equipoise, refused, succeeded
from surface.studies import LENGTHS
from surface.test_fuzz import fuzz, mutate

STORE = Path("lengths.zarr")
ABOUT = Path("zarr.json")
COMMANDS = (("best",), ("best", "--json"), ("export", "-o", "all.csv"), ("resume",))


@pytest.fixture(scope="module", autouse=True)
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of some designs, one chunk of which is missing."""
    folder = tmp_path_factory.mktemp("made")
    study = folder / "study.toml"
    study.write_text(LENGTHS.replace("designs = 200", "designs = 24"), encoding="utf-8")
    succeeded(equipoise("sweep", study, "-o", folder / STORE))
    return folder / STORE


@pytest.fixture(autouse=True)
def copied(folder: Path, made: Path) -> None:
    """A copy of it for each test."""
    shutil.copytree(made, STORE)


def run(words: tuple[str, ...]) -> Result:
    Path("all.csv").unlink(missing_ok=True)
    return equipoise(words[0], STORE, *words[1:])


def works_or_is_refused(result: Result) -> None:
    """It worked, or one sentence said why not."""
    if result.status:
        assert len(refused(result)) < 1000


def inner(change: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """A change of the study, which lies in the attributes as a text in a text."""

    def changed(attributes: Any) -> None:
        texts = json.loads(attributes["study"])
        study = json.loads(texts["study"])
        change(study)
        texts["study"] = json.dumps(study, default=str)
        attributes["study"] = json.dumps(texts)

    return changed


DAMAGED: dict[str, tuple[Callable[[Any], Any], str]] = {
    "chunk 0": (lambda a: a.update(chunk=0), "chunk: got 0, and its study has 24"),
    "chunk 1e308": (lambda a: a.update(chunk=1e308), "chunk: got 1e+308, and "),
    "negative chunk": (lambda a: a.update(chunk=-5), "chunk: got -5, and "),
    "chunk a text": (lambda a: a.update(chunk="x"), "chunk: got 'x', and "),
    "chunk null": (lambda a: a.update(chunk=None), "chunk: got None, and "),
    "a number less": (lambda a: a["numbers"].pop(), "numbers: got ["),
    "numbers null": (lambda a: a.update(numbers=None), "numbers: got None, "),
    "another output": (lambda a: a["outputs"].append("x"), "outputs: got ["),
    "no study": (lambda a: a.pop("study"), "'study'"),
    "study a text": (lambda a: a.update(study="x"), "xpecting value"),
    "versions null": (lambda a: a.update(versions="null"), "has no attribute"),
    "more designs": (inner(lambda s: s["sampling"].update(designs=25)), "places for 24 designs"),
    "a limit as text": (inner(lambda s: s["outputs"][0].update(at_most="5")), "must be real"),
    "another aim": (inner(lambda s: s["outputs"][0].update(make="?")), "no limits or aims"),
    "no vary": (inner(lambda s: s.update(vary=[])), "numbers: got ["),
}


def altered(file: Path, change: Callable[[Any], Any]) -> None:
    content = json.loads(file.read_text(encoding="utf-8"))
    change(content["attributes"])
    content.pop("consolidated_metadata", None)
    file.write_text(json.dumps(content), encoding="utf-8")


@pytest.mark.exhaustive(but=["negative chunk", "another output", "numbers null", "no vary"])
@pytest.mark.parametrize(("change", "words"), DAMAGED.values(), ids=DAMAGED)
def test_attributes_that_do_not_fit(change: Callable[[Any], Any], words: str) -> None:
    altered(STORE / ABOUT, change)
    for command in COMMANDS:
        said = refused(run(command))
        assert said.startswith("lengths.zarr: is no store of Equipoise, or one that was damaged (")
        assert words in said
    assert not Path("all.csv").exists()


@given(st.data(), st.sampled_from(COMMANDS))
@fuzz(20)
def test_damage_at_random(made: Path, data: Any, words: tuple[str, ...]) -> None:
    shutil.rmtree(STORE, ignore_errors=True)
    shutil.copytree(made, STORE)
    file = data.draw(st.sampled_from([path for path in sorted(STORE.rglob("*")) if path.is_file()]))
    if file.name == "zarr.json":
        content = json.loads(file.read_text(encoding="utf-8"))
        where = data.draw(st.sampled_from(("whole", "attributes", "study")))
        if where == "whole" or where not in {"whole", *content.get("attributes", {})}:
            where = "attributes" if content.get("attributes") else "whole"
        part = deepcopy(content if where == "whole" else content["attributes"])
        if where == "study":
            inner(lambda study: mutate(data.draw, study))(part)
        else:
            mutate(data.draw, part)
        whole = part if where == "whole" else {**content, "attributes": part}
        if data.draw(st.booleans()):
            whole.pop("consolidated_metadata", None)
        file.write_text(json.dumps(whole, default=str), encoding="utf-8")
    else:
        kept = file.read_bytes()
        cut = data.draw(st.integers(0, len(kept)))
        file.write_bytes(kept[:cut] + data.draw(st.binary(max_size=4)))
    works_or_is_refused(run(words))


# -- checksums -------------------------------------------------------------------------------------


# Damage at random, of fewer files: `test_damage_at_random`.
@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", range(3))
def test_a_bit_that_flips_changes_no_figure(made: Path, seed: int) -> None:
    """Each file in turn: what is read is refused, or what was written; computing again mends it."""
    random = Random(seed)
    expected, whole = run(("best", "--json")).out, contents(STORE)
    chunks = [path for path in sorted(STORE.rglob("*")) if path.is_file() and path.name != ".lock"]
    for file in chunks:
        kept = bytearray(file.read_bytes())
        kept[random.randrange(len(kept))] ^= 1 << random.randrange(8)
        file.write_bytes(kept)
        for words in COMMANDS[:3]:
            result = run(words)
            if file.name == "zarr.json" and file.parent != STORE:  # as in that of the store
                succeeded(result)
            elif file.name == "zarr.json":
                assert "is no store of Equipoise, or one that was damaged" in refused(result)
            else:
                said = refused(result)
                assert "was damaged; compute again what was by: equipoise resume" in said
        if file.name.isdecimal():
            succeeded(run(("resume",)))
            assert contents(STORE) == {**whole, ".lock": b""}
        else:
            file.write_bytes(whole[str(file.relative_to(STORE))])
        assert run(("best", "--json")).out == expected


@pytest.mark.parametrize("name", ["torque", "links.crank.mass"])
def test_a_chunk_of_one_array_that_is_lost_is_no_gap(name: str) -> None:
    """Best designs were told of what was left, and tables had gaps, in silence."""
    expected = run(("best", "--json")).out
    (STORE / name / "c" / "0").unlink()
    for words in COMMANDS[:3]:
        assert f"{name} of designs 0 to 23 was damaged" in refused(run(words))
    succeeded(run(("resume",)))
    assert run(("best", "--json")).out == expected


def test_reasons_that_have_changed_places_are_refused(folder: Path) -> None:
    """Of the last chunk, which is filled up, and the first: a traceback of `resume`."""
    Path("study.toml").write_text(LENGTHS.replace("designs = 200", "designs = 10000"))
    shutil.rmtree(STORE)
    succeeded(equipoise("sweep", "study.toml", "-o", STORE))
    reasons = STORE / "reason" / "c"
    (reasons / "0").rename(reasons / "way")
    (reasons / "1").rename(reasons / "0")
    (reasons / "way").rename(reasons / "1")
    for words in COMMANDS[:3]:
        assert "reason of designs 0 to " in refused(run(words))
    succeeded(run(("resume",)))
    works_or_is_refused(run(("best",)))


def test_a_store_without_checksums_is_read_and_gone_on_with_as_it_was(made: Path) -> None:
    """As versions before made them."""
    old = Path("old.zarr")
    content = json.loads((STORE / ABOUT).read_text())
    about = {**content["attributes"], "equipoise_store": 1}
    group = zarr.create_group(old, zarr_format=3, attributes=about)
    for name, array in zarr.open_group(STORE, mode="r").arrays():
        group.create_array(
            name,
            data=array[:],
            chunks=array.chunks,
            compressors=array.compressors[:-1] or None,
            fill_value=array.fill_value,
            attributes=dict(array.attrs),
        )
    del group.attrs["checksum"]
    before = contents(old)
    assert equipoise("best", old, "--json").out == run(("best", "--json")).out
    chunk = old / "torque/c/0"
    chunk.unlink()
    succeeded(equipoise("resume", old))
    assert contents(old) == {**before, ".lock": b""}
