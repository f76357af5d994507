"""A machine that runs on the page: what came of it, and where it is at each instant."""

from __future__ import annotations

import itertools
import json
import shutil
import subprocess
from math import pi
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MassError
from equipoise.web import runs
from equipoise.web.messages import message_of
from unit.web.pages import State, ask, edit, opened, refusal

BARE = {"mass": None, "center_of_mass": None, "inertia": None}
"""Of a link that is not to have a mass."""


def run_of(name: str) -> tuple[State, State]:
    """The state of an example, and its run."""
    session, shown = opened(name)
    busy, reply = ask(session, "run", seq=3)
    assert (busy.content["type"], reply.content["type"]) == ("busy", "run")
    return shown, State(reply.content, np.frombuffer(reply.buffer, "<f4"))


def test_a_run_on_the_page_is_that_of_the_command() -> None:
    """Words, figures, curves, and the crank at each instant."""
    machine, (shown, told) = eq.load("cutter-bar"), run_of("cutter-bar")
    run = eq.run(machine)
    assert told.content["design"] == shown.content["design"]
    assert [block["text"] for block in told.content["blocks"][:1]] == [run.headline()[0].text]  # type: ignore[union-attr]
    tables = {one["title"]: one for one in told.content["blocks"] if one["kind"] == "table"}
    events = tables["Events"]
    assert [row[0] for row in events["rows"]] == ["motor switched off", "stands still"]
    assert events["numbers"] == [False, True, True, True]
    assert float(events["rows"][1][1]) == pytest.approx(run.end.time, rel=1e-3)  # four digits
    speed, torque = told.content["charts"]
    assert speed["x"] == {"array": "speed.0.x", "at": None, "unit": "s", "factor": 1.0}
    assert (speed["choices"][0]["label"], torque["choices"][0]["unit"]) == ("Crank speed", "N m")
    assert speed["choices"][0]["factor"] == pytest.approx(30 / pi)
    # What follows is as 32-bit floats are.
    assert told.array("speed.0.0") == pytest.approx(run.crank_speed, rel=1e-6, abs=1e-6)
    assert told.array("speed.1.0") == pytest.approx(run.drive_torque, rel=1e-6, abs=1e-6)
    assert told.array("run.time") == pytest.approx(run.time, rel=1e-6)
    assert told.array("run.part") * 2 * pi == pytest.approx(run.crank_angle, rel=1e-6)
    assert told.content["frames"] == 0


def test_a_cycle_of_several_turns_is_one_part() -> None:
    shown, told = run_of("four-stroke-engine")
    run = eq.run(eq.load("four-stroke-engine"))
    assert shown.content["turns"] == 2
    assert told.array("run.part")[-1] == pytest.approx(run.turned / 2, rel=1e-6)


def test_drives_that_go_their_own_ways_bring_their_poses() -> None:
    """Each a pose of the linkage: links keep their lengths, and cranks their angles of the run."""
    machine, (_, told) = eq.load("two-motor-mixer"), run_of("two-motor-mixer")
    run = eq.run(machine)
    count, time = told.content["frames"], told.array("run.time")
    assert len(time) == count == len(told.place("C"))
    assert told.array("run.part") == pytest.approx(np.arange(count) / count)
    for link in machine.links.values():
        for (a, at), (b, to) in itertools.pairwise(link.points.items()):
            gap = abs(complex(*to) - complex(*at))
            assert abs(told.place(b) - told.place(a)) == pytest.approx(gap, rel=1e-5)
    crank = told.place("B") - told.place("A")
    angle = np.interp(time, run.time, run.drives["left-crank"].angle)
    own = complex(*machine.links["left-crank"].points["B"])
    assert crank == pytest.approx(own * np.exp(1j * angle), abs=1e-6)
    assert np.max(np.diff(angle)) < pi / 18  # a motion that the eye can follow
    assert [choice["label"] for choice in told.content["charts"][0]["choices"][0]["curves"]] == [
        "left-crank",
        "right-crank",
    ]


def test_a_run_is_of_the_design_that_was_shown() -> None:
    """By its number, which is another after each edit and move of a drag, and else stays."""
    session, shown = opened("cutter-bar")
    mass = {"set": "links.crank.mass", "text": "9 kg"}
    replies = session.receive(message_of({"type": "run", "seq": 1}))
    assert next(replies).content["type"] == "busy"
    after = edit(session, mass)
    assert after.content["design"] != shown.content["design"]
    assert refusal([next(replies)]) == runs.CHANGED
    (again,) = ask(session, "outputs", seq=4, names=["drive_torque"])
    assert again.content["design"] == after.content["design"]
    moved = edit(session, {**mass, "text": "10 kg"}, commit=False)
    assert moved.content["design"] != after.content["design"]
    assert ask(session, "run", seq=5)[1].content["design"] == 0


def test_what_cannot_run_is_told_in_the_sentence_of_the_command() -> None:
    session, _ = opened("cutter-bar")
    massless = eq.load("cutter-bar").with_link("crank", **BARE)
    ask(session, "open", seq=2, name="massless.toml", text=eq.dumps(massless))
    _, told = ask(session, "run", seq=3)
    with pytest.raises(MassError) as refused:
        eq.run(massless)
    assert refusal([told]) == refused.value.message()


def test_a_run_is_told_in_the_language_of_the_page() -> None:
    session, _ = opened("cutter-bar")
    ask(session, "speak", seq=2, languages=["de"])
    busy, told = ask(session, "run", seq=3)
    assert busy.content["what"] == "die Maschine läuft"
    assert told.content["blocks"][0]["text"].startswith("Die Maschine steht nach 3,789 s")
    assert told.content["charts"][0]["choices"][0]["label"] == "Kurbeldrehzahl"


PAGE = Path(__file__).parents[3] / "page"
ESBUILD = PAGE / "node_modules" / ".bin" / "esbuild"
NODE = shutil.which("node")
PLAYED = """
import { Player } from "./player.mjs";
import { before } from "./scale.mjs";
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
console.log(JSON.stringify([told, [-1, 0, 0.4, 0.5, 2.5, 3, 9].map((t) => before(times, t))]));
"""


@pytest.mark.skipif(NODE is None or not ESBUILD.exists(), reason="the page's tools are not here")
def test_the_clock_of_the_page_plays_a_run_to_its_end_and_the_cycle_again(tmp_path: Path) -> None:
    """At half of the true speed, so that 3 s are seen for 6 s; a run that is over begins anew."""
    for name in ("player", "scale"):
        words = [str(PAGE / "src" / f"{name}.ts"), "--bundle", "--format=esm"]
        words.append(f"--outfile={tmp_path / name}.mjs")
        subprocess.run([str(ESBUILD), *words], check=True, timeout=300, capture_output=True)
    (tmp_path / "ask.mjs").write_text(PLAYED, encoding="utf-8")
    done = subprocess.run(
        [str(NODE), "ask.mjs"],
        cwd=tmp_path,
        check=True,
        capture_output=True,
        text=True,
        timeout=300,
    )
    (begun, later, ended, over, again, cycle), places = json.loads(done.stdout)
    assert begun == [0, True, 0, 0.5]
    assert later == [pytest.approx(0.5), True, 167, 0.5]
    assert ended == [3, True, 1000, 0.5]
    assert over == [3, False, 1000, 0.5]
    assert again == [0, True, 0, 0.5]
    assert cycle == [None, 90, 360, True]
    assert places == [0, 0, 0, 2, 3, 4, 4]
