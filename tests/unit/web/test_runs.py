"""A machine that runs on the page: what came of it, and where it is at each instant."""

from __future__ import annotations

import importlib
import itertools
import json
import shutil
import subprocess
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MassError, UsageError
from equipoise.mechanism.parts.support import FREEDOMS, PLANAR
from equipoise.present.cells import printed
from equipoise.results.blocks import Block, Column, Facts, FileText, Notes, Table, Text, Value
from equipoise.results.charts import Axis, Chart, Curve, Panel
from equipoise.running.run_results import DrivesRun, Run
from equipoise.web import result_blocks, runs
from equipoise.web.messages import message_of
from equipoise.web.replies import FloatBlock
from surface.running import example_text
from unit.web.pages import State, ask, edit, opened, refusal

BARE = {"mass": None, "center_of_mass": None, "inertia": None}
"""Of a link that is not to have a mass."""


def run_of(name: str) -> tuple[State, State]:
    """The state of an example, and its run."""
    session, shown = opened(name)
    (reply,) = ask(session, "run", seq=3)
    assert reply.content["type"] == "run"
    return shown, State(reply.content, np.frombuffer(reply.buffer, "<f4"))


@pytest.fixture
def computed(monkeypatch: pytest.MonkeyPatch) -> list[Run]:
    """The runs that the page computes, which need not be computed again."""
    kept: list[Run] = []
    module = importlib.import_module("equipoise.running.run")
    compute = module.run

    def keep(*given: Any, **options: Any) -> Run:
        kept.append(compute(*given, **options))
        return kept[-1]

    monkeypatch.setattr(module, "run", keep)
    return kept


def test_a_run_on_the_page_is_that_of_the_command() -> None:
    """Words, figures, curves, and the crank at each instant."""
    machine, (shown, text) = eq.load("cutter-bar"), run_of("cutter-bar")
    run = eq.run(machine)
    assert text.content["design"] == shown.content["design"]
    headline = run.headline()[0]
    assert isinstance(headline, Text)
    assert text.content["blocks"][0]["text"] == printed(headline.text)
    tables = {entry["title"]: entry for entry in text.content["blocks"] if entry["kind"] == "table"}
    events = tables["Events"]
    assert [row[0] for row in events["rows"]] == ["motor switched off", "stands still"]
    assert events["numbers"] == [False, True, True, True]
    assert float(events["rows"][1][1]) == pytest.approx(run.end.time, rel=1e-3)  # four digits
    speed, torque = text.content["charts"]
    assert speed["x"] == {"array": "run.speed.0.x", "at": None, "unit": "s", "factor": 1.0}
    assert (speed["choices"][0]["label"], torque["choices"][0]["unit"]) == ("Crank speed", "N m")
    assert speed["choices"][0]["factor"] == pytest.approx(30 / pi)
    # What follows is as 32-bit floats are.
    assert text.array("run.speed.0.0") == pytest.approx(run.crank_speed, rel=1e-6, abs=1e-6)
    assert text.array("run.speed.1.0") == pytest.approx(run.drive_torque, rel=1e-6, abs=1e-6)
    assert text.array("run.time") == pytest.approx(run.time, rel=1e-6)
    assert text.array("run.cycles") * 2 * pi == pytest.approx(run.crank_angle, rel=1e-6)
    assert text.content["frames"] == 0
    # One array for all that is over time.
    arrays = text.content["arrays"]
    assert arrays["run.time"] == arrays["run.speed.0.x"] == arrays["run.speed.1.x"]


def test_a_cycle_of_several_turns_is_one_part(computed: list[Run]) -> None:
    shown, text = run_of("four-stroke-engine")
    (run,) = computed
    assert shown.content["turns"] == 2
    assert text.array("run.cycles")[-1] == pytest.approx(run.turned / 2, rel=1e-6)


def test_drives_that_go_their_own_ways_bring_their_poses(computed: list[Run]) -> None:
    """Each a pose of the linkage: links keep their lengths, and cranks their angles of the run."""
    machine, (_, text) = eq.load("two-motor-mixer"), run_of("two-motor-mixer")
    (run,) = computed
    count, time = text.content["frames"], text.array("run.time")
    assert len(time) == count == len(text.place("C"))
    assert text.array("run.cycles") == pytest.approx(np.arange(count) / count)
    for link in machine.links.values():
        for (a, at), (b, to) in itertools.pairwise(link.points.items()):
            gap = abs(complex(*to) - complex(*at))
            assert abs(text.place(b) - text.place(a)) == pytest.approx(gap, rel=1e-5)
    crank = text.place("B") - text.place("A")
    angle = np.interp(time, run.time, run.drives["left-crank"].angle)
    own = complex(*machine.links["left-crank"].points["B"])
    assert crank == pytest.approx(own * np.exp(1j * angle), abs=1e-6)
    assert np.max(np.diff(angle)) < pi / 18  # a motion that the eye can follow
    assert [choice["label"] for choice in text.content["charts"][0]["choices"][0]["curves"]] == [
        "left-crank",
        "right-crank",
    ]


def test_a_support_moves_with_the_poses_of_a_run() -> None:
    """As much larger than true at each instant, in all three of its movements."""
    text = f"{example_text('balance-rig')}\n[run]\nsupport = true\nturns = 3\n"
    session, _ = opened("cutter-bar")
    ask(session, "open", seq=2, name="rig.toml", text=text)
    (reply,) = ask(session, "run", seq=3)
    reported = State(reply.content, np.frombuffer(reply.buffer, "<f4"))
    run = eq.run(eq.loads(text))
    assert isinstance(run, DrivesRun) and run.support is not None
    assert len(reported.array("run.angle")) == reported.content["frames"] > 100
    moved = [*reported.array("run.place").reshape(-1, 2).T, reported.array("run.angle")]
    planar = run.support.place[[*map(FREEDOMS.index, PLANAR)]]
    true = [np.interp(reported.array("run.time"), run.time, each) for each in planar]
    factor = np.max(np.abs(moved)) / np.max(np.abs(true))  # 1, 2 or 5 and zeros
    assert f"{factor:.2e}"[0] in "125"
    assert any(
        "movement of the support" in entry.get("text", "") for entry in reported.content["blocks"]
    )
    size = np.max(np.abs(moved))
    np.testing.assert_allclose(moved, factor * np.array(true), atol=1e-4 * size)


def test_a_run_is_of_the_design_that_was_shown() -> None:
    """By its number, which is another after each edit and move of a drag, and else stays."""
    session, shown = opened("cutter-bar")
    mass = {"set": "links.crank.mass", "text": "9 kg"}
    base = session.current()
    after = edit(session, mass)
    assert after.content["design"] != shown.content["design"]
    with pytest.raises(UsageError) as refused:
        session.run_reply(base, message_of({"type": "run", "seq": 1}))
    assert refused.value.note == runs.CHANGED
    (again,) = ask(session, "outputs", seq=4, names=["drive_torque"])
    assert again.content["design"] == after.content["design"]
    moved = edit(session, {**mass, "text": "10 kg"}, commit=False)
    assert moved.content["design"] != after.content["design"]
    assert ask(session, "run", seq=5)[0].content["design"] == 0


def test_what_cannot_run_is_reported_in_the_sentence_of_the_command() -> None:
    session, _ = opened("cutter-bar")
    massless = eq.load("cutter-bar").with_link("crank", **BARE)
    ask(session, "open", seq=2, name="massless.toml", text=eq.dumps(massless))
    (reply,) = ask(session, "run", seq=3)
    with pytest.raises(MassError) as refused:
        eq.run(massless)
    assert refusal([reply]) == refused.value.message()


def test_a_run_is_reported_in_the_language_of_the_page() -> None:
    session, _ = opened("cutter-bar")
    ask(session, "speak", seq=2, languages=["de"])
    (reply,) = ask(session, "run", seq=3)
    assert reply.content["blocks"][0]["text"].startswith(
        "Die Maschine steht nach 3,789\N{NO-BREAK SPACE}s"
    )
    assert reply.content["charts"][0]["choices"][0]["label"] == "Kurbeldrehzahl"


def test_blocks_are_reported_as_print_has_them() -> None:
    """With true signs, what stands out, and what is left out."""
    table = Table.of(
        "Gap of 2e-5 m",
        ("", Column("Largest", "length", "mm"), Column("Angle", "angle", "deg")),
        [("A", Value(-2.0, limit=1.0, emphasis="broken"), Value(1.0))],
    )
    blocks: list[Block] = [
        Text("error -2.4e-13", "worse"),
        Facts("", ("5 N m",), omitted=0),
        Facts("Events", ("a",), omitted=2),
        table,
        Notes(("no load",), omitted=1),
    ]
    text, untitled, titled, grid, note = result_blocks.block_messages(blocks)
    assert text == {"kind": "text", "text": "error −2.4×10⁻¹³", "emphasized": True}
    assert (untitled["title"], untitled["items"]) == ("", [printed("5 N m")])
    assert titled["title"] == "Events (and 2 more)"
    assert grid["title"] == "Gap of 2×10⁻⁵ m"
    assert grid["heads"] == ["", "Largest, mm", "Angle, °"]
    assert grid["rows"][0][1].startswith("−2000")
    assert "over the limit of 1000" in grid["rows"][0][1]
    assert (grid["numbers"], grid["emphasized"]) == ([False, True, True], [(0, 1)])
    assert note["text"] == "Note: no load (and 1 more)"
    with pytest.raises(TypeError, match="listing"):
        list(result_blocks.block_messages([FileText("model", "text")]))


def test_long_curves_keep_their_extremes() -> None:
    """Of each step of time the highest and the lowest value, of all curves at the same instants."""
    count = 30 * result_blocks.MOST_POINTS
    time = np.sort(np.random.default_rng(7).uniform(0, 9, count))
    slow, fast = np.sin(time), np.cos(400 * time)
    slow[123_457], fast[400_001] = 5.0, -7.0  # of one instant alone
    axis = Axis.of("time", "time", low=0.0, high=9.0)
    panels = tuple(Panel(axis, axis, (Curve(time, values),)) for values in (slow, fast))
    block = FloatBlock()
    charts = list(result_blocks.panel_charts("run", [Chart("speed", "", "", panels)], block))
    reported = State({"arrays": block.placement}, np.frombuffer(block.data, "<f4"))
    assert [chart["x"]["array"] for chart in charts] == ["run.speed.0.x", "run.speed.1.x"]
    assert (
        reported.content["arrays"]["run.speed.0.x"] == reported.content["arrays"]["run.speed.1.x"]
    )
    at = reported.array("run.speed.0.x")
    assert len(at) <= result_blocks.MOST_POINTS
    assert np.all(np.diff(at) >= 0)
    assert (at[0], at[-1]) == (np.float32(time[0]), np.float32(time[-1]))
    edges = np.linspace(time[0], time[-1], 50)
    for name, values in (("run.speed.0.0", slow), ("run.speed.1.0", fast)):
        sent = reported.array(name)
        assert len(sent) == len(at)
        for low, high in itertools.pairwise(edges):
            whole = values[(time >= low) & (time <= high)]
            part = sent[(at >= low) & (at <= high)]
            assert np.max(part) == pytest.approx(np.max(whole), abs=3e-3)
            assert np.min(part) == pytest.approx(np.min(whole), abs=3e-3)
    assert (np.max(reported.array("run.speed.0.0")), np.min(reported.array("run.speed.1.0"))) == (
        5.0,
        -7.0,
    )


def test_the_clock_of_a_long_run_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """The angles that are sent are those of the run, from its start to its end."""
    monkeypatch.setattr(runs, "MOST_INSTANTS", 500)
    _, text = run_of("cutter-bar")
    run = eq.run(eq.load("cutter-bar"))
    time, angle = text.array("run.time"), text.array("run.cycles") * 2 * pi
    assert len(time) == len(angle) == 500
    assert angle == pytest.approx(np.interp(time, run.time, run.crank_angle), abs=1e-3)
    assert (time[-1], angle[-1]) == pytest.approx((run.time[-1], run.crank_angle[-1]), rel=1e-6)


PAGE = Path(__file__).parents[3] / "page"
ESBUILD = PAGE / "node_modules" / ".bin" / "esbuild"
NODE = shutil.which("node")
PLAYED = """
import { Player } from "./player.mjs";
import { indexAtOrBelow } from "./scale.mjs";
const player = new Player();
player.take({ angles: 360, turns: 1, speed: 30 });
player.suit();
player.sample = 90;
const { rate } = player;
const told = [];
const tell = () => told.push([player.time, player.playing, player.step, player.rate]);
player.run(3);
player.toggle();
player.tick(0);
tell();
for (let now = 100; now <= 1000; now += 100) player.tick(now);
tell();
player.step = 1000;
tell();
player.tick(1100);
tell();
player.toggle();
tell();
player.leave();
told.push([player.time, player.sample, player.steps, player.rate === rate]);
const times = [0, 0.5, 0.5, 2, 3];
const places = [-1, 0, 0.4, 0.5, 2.5, 3, 9].map((t) => indexAtOrBelow(times, t));
console.log(JSON.stringify([told, places]));
"""


TALK = """
import { Conversation } from "./conversation.mjs";
globalThis.window = globalThis;
let hear;
const shown = [];
const busy = (now) => shown.push(now);
const events = new Proxy({ busy }, { get: (own, name) => own[name] ?? (() => 0) });
const sent = [];
const wire = { send: (one) => sent.push(one), on: (_, heard) => (hear = heard), off: () => 0 };
const talk = new Conversation(wire, events, null);
for (const type of ["balance", "run", "gallery"]) talk.ask({ type });
const [balance, run, gallery] = sent.map(({ seq }) => seq);
hear({ type: "busy", seq: balance, what: "balancing" }, []);
hear({ type: "busy", seq: run, what: "running" }, []);
hear({ type: "gallery", seq: gallery }, []);
hear({ type: "refused", seq: run, message: "no" }, []);
hear({ type: "refused", seq: balance, message: "no" }, []);
hear({ type: "busy", seq: balance, what: "balancing" }, []);
console.log(JSON.stringify(shown.map((now) => now.map(({ kind, what }) => [kind, what]))));
"""
needs_tools = pytest.mark.skipif(
    NODE is None or not ESBUILD.exists(), reason="the page's tools are not here"
)


def said_by(script: str, names: tuple[str, ...], folder: Path) -> Any:
    """What a script prints as JSON that imports modules of the page."""
    for name in names:
        words = [str(PAGE / "src" / f"{name}.ts"), "--bundle", "--format=esm"]
        words.append(f"--outfile={folder / name}.mjs")
        subprocess.run([str(ESBUILD), *words], check=True, timeout=300, capture_output=True)
    (folder / "ask.mjs").write_text(script, encoding="utf-8")
    command = [str(NODE), "ask.mjs"]
    done = subprocess.run(
        command, cwd=folder, check=True, capture_output=True, text=True, timeout=300
    )
    return json.loads(done.stdout)


@needs_tools
def test_what_is_computed_is_shown_until_it_is_answered(tmp_path: Path) -> None:
    """Each by its own question: others that end meanwhile take nothing of it away."""
    balance, run = ["balance", "balancing"], ["run", "running"]
    shown = said_by(TALK, ("conversation",), tmp_path)
    assert shown == [[balance], [balance, run], [balance], []]


@needs_tools
def test_the_clock_of_the_page_plays_a_run_to_its_end_and_the_cycle_again(tmp_path: Path) -> None:
    """At half of the true speed, so that 3 s are seen for 6 s; a run that is over begins anew."""
    text, places = said_by(PLAYED, ("player", "scale"), tmp_path)
    begun, later, ended, over, again, cycle = text
    assert begun == [0, True, 0, 0.5]
    assert later == [pytest.approx(0.5), True, 167, 0.5]
    assert ended == [3, True, 1000, 0.5]
    assert over == [3, False, 1000, 0.5]
    assert again == [0, True, 0, 0.5]
    assert cycle == [None, 90, 360, True]
    assert places == [0, 0, 0, 2, 3, 4, 4]
