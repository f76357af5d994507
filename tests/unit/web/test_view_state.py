"""What a page shows besides a machine: arrows, variants that are kept, a support that moves."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.swing import LARGEST
from equipoise.web.messages import message_of
from equipoise.web.replies import Reply
from unit.web.pages import ask, edit, opened, refusal, state


def contents(replies, kind):
    """The contents of one kind among replies."""
    return [reply.content for reply in replies if reply.content["type"] == kind]


ROWS = (f"{45 * k},{k % 3}" for k in range(8))
RECORD = "\n".join(["crank_angle [deg],gauges.gauge [mm]", *ROWS, ""])


@pytest.mark.exhaustive(but=["asked0", "asked3"])
@pytest.mark.parametrize("asked", [
    ("arrows", {"point": "C"}),
    ("variant", {"do": "pin"}),
    ("variant", {"do": "against", "to": "opened"}),
    ("record", {"name": "run.csv", "text": RECORD}),
])  # fmt: skip
def test_a_page_keeps_the_response_over_speed(asked: tuple[str, dict[str, Any]]) -> None:
    """Whatever else is told of the same design."""
    session, _ = opened("yamashita-rig")
    shown: list[str] = []

    def hear(replies: Iterable[Reply]) -> None:
        """Whatever is told of the response takes the place of all that was."""
        for reply in replies:
            if reply.content["type"] == "response":
                shown[:] = [entry["name"] for entry in reply.content["charts"]]

    hear(session.deferred_replies())
    assert shown == ["response", "sweep"]
    kind, values = asked
    replies = [*session.receive(message_of({"type": kind, "seq": 1, **values}))]
    assert not contents(replies, "refused")
    hear(replies)
    hear(session.deferred_replies())
    assert shown == ["response", "sweep"]
    moved = [{"set": "links.crank.mass", "value": 0.2}]
    ask(session, "edit", commit=False, edits=moved)  # before the rest of the answer is computed
    hear(session.receive(message_of({"type": "compare", "seq": 2, "on": False})))
    hear(session.deferred_replies())
    assert shown == ["response", "sweep"]


def test_arrows_are_the_vectors_at_a_point() -> None:
    session, _ = opened("yamashita-1")
    shown = state(ask(session, "arrows", point="C")[0])
    whole = eq.analyze(eq.load("yamashita-1"))
    wanted = {
        "velocity": (whole.motion.points["C"].velocity, "m/s"),
        "acceleration": (whole.motion.points["C"].acceleration_vector, "m/s²"),
        "force": (whole.forces.joints["C"].value, "N"),
    }
    assert [item["kind"] for item in shown.content["arrows"]] == [*wanted]
    for entry in shown.content["arrows"]:
        values, unit = wanted[entry["kind"]]
        sent = shown.vector(entry["array"])
        np.testing.assert_allclose(sent, values, atol=1e-6 * np.max(np.abs(values)))
        assert entry["unit"] == unit
    force = shown.content["arrows"][-1]["label"]
    assert force == f"force in joint C, on {whole.forces.joints['C'].on}"
    moved = edit(session, {"set": "drive.speed", "text": "386 rpm"})
    assert np.max(np.abs(moved.vector("arrow.velocity"))) == pytest.approx(
        2 * np.max(np.abs(shown.vector("arrow.velocity"))), rel=1e-5
    )
    assert state(ask(session, "arrows", point="")[0]).content["arrows"] == []
    assert "no point is called 'Q'" in refusal(ask(session, "arrows", point="Q"))


def test_arrows_of_a_frame_point_and_of_a_slider() -> None:
    session, _ = opened("slider-crank-engine")
    machine = eq.load("slider-crank-engine")
    fixed = state(ask(session, "arrows", point=next(iter(machine.frame)))[0]).content["arrows"]
    assert {item["kind"] for item in fixed} == {"force"}
    (slider,) = machine.sliders
    block = state(ask(session, "arrows", point=slider.point)[0]).content["arrows"]
    forces = [item["array"] for item in block if item["kind"] == "force"]
    assert f"arrow.force.{slider.name}" in forces
    assert len(forces) == 2  # in the pin, and on the guide


def test_figures_are_reported_before_and_after_every_change() -> None:
    session, first = opened("yamashita-1")
    assert not first.content["compared"]
    name = "shaking_force.rms"
    start = first.figure(name)["value"]
    dragged = edit(session, {"set": "links.crank.mass", "text": "0.4 kg"}, commit=False)
    assert dragged.figure(name)["before"] == start
    second = edit(session, {"set": "links.crank.mass", "text": "0.5 kg"})
    assert second.figure(name)["before"] == start != second.figure(name)["value"]
    assert not second.content["before"]  # numbers alone: its curves would be in the way
    third = edit(session, {"set": "links.crank.mass", "text": "0.6 kg"})
    assert third.figure(name)["before"] == second.figure(name)["value"]
    against = ask(session, "variant", do="against", to="opened")
    shown = state(against[0])
    assert shown.figure(name)["before"] == start
    assert shown.content["before"] and "before.shaking_force" in shown.content["arrays"]
    (ghost,) = contents(against, "ghost")
    assert ghost["scene"]["signs"] and "place.P" in ghost["arrays"]
    alone = ask(session, "variant", do="against", to="nothing")
    assert not state(alone[0]).content["compared"]
    assert contents(alone, "ghost")[0]["scene"] is None


def test_variants_are_kept_named_compared_and_gone_back_to() -> None:
    session, _ = opened("yamashita-rig")
    before = session.shown.design
    ask(session, "variant", do="pin")
    edit(session, {"set": "links.crank.mass", "text": "0.1 kg"})
    pinned = ask(session, "variant", do="pin")
    (table,) = contents(pinned, "variants")
    assert table["kept"] == ["A", "B"] and table["against"] == "variant:B"
    rows = {row["label"]: row for row in table["rows"]}
    mass = rows["mass of the links"]
    assert mass["best"] == [1, 2]  # B, and what is now the same
    heavy, light, now = (float(text) for text in mass["texts"])
    assert heavy - light == pytest.approx(99, abs=0.6) and now == light
    gauge = rows["reading at gauge, peak to peak"]
    peak_to_peak = eq.respond(eq.load("yamashita-rig")).gauges["gauge"].displacement.peak_to_peak
    assert float(gauge["texts"][0]) == pytest.approx(1e3 * peak_to_peak, rel=1e-3)
    renamed = ask(session, "variant", do="rename", name="A", to="as built")
    assert contents(renamed, "variants")[0]["kept"] == ["as built", "B"]
    gone = ask(session, "variant", do="go", name="as built")
    assert session.shown.design.machine == before.machine
    assert state(gone[0]).content["undo"] == "go to as built"
    dropped = ask(session, "variant", do="drop", name="B")
    assert contents(dropped, "variants")[0]["against"] == "step"
    ask(session, "undo")
    assert session.shown.design.machine != before.machine
    ask(session, "open", example="yamashita-1")
    assert contents(ask(session, "variant", do="pin"), "variants")[0]["kept"] == ["A"]


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"do": "rename", "name": "A", "to": "  "}, "got a name of 0 signs"),
        ({"do": "rename", "name": "B", "to": "A"}, "there is a variant of the name 'A' already"),
        ({"do": "go", "name": "Z"}, "no variant is called 'Z'"),
        ({"do": "against", "to": "variant:Z"}, "no variant is called 'Z'"),
        ({"do": "dance"}, "is called 'dance'"),
        ({"do": "rename", "name": "A"}, "give a text"),
    ],
)
def test_what_cannot_be_done_with_variants_is_refused(asked, said) -> None:
    session, _ = opened("yamashita-1")
    for _ in "AB":
        ask(session, "variant", do="pin")
    assert said in refusal(ask(session, "variant", **asked))


def test_no_more_than_twelve_variants_are_kept() -> None:
    session, _ = opened("yamashita-1")
    for _ in range(12):
        assert not contents(ask(session, "variant", do="pin"), "refused")
    assert "12 variants are kept already" in refusal(ask(session, "variant", do="pin"))


@pytest.mark.parametrize("name", ["yamashita-rig", "sieve", "riding-transplanter"])
def test_a_support_is_reported_how_it_moves(name) -> None:
    session, shown = opened(name)
    (actual,) = [item for item in ask(session, "ready") if item.content["type"] == "response"]
    arrays = actual.content["arrays"]
    block = np.frombuffer(actual.buffer, "<f4").astype(float)
    _, length = arrays["support.place"]
    assert length == 2 * shown.content["angles"]
    assert actual.content["swing"]
    modes = actual.content["modes"]
    assert len(modes) == len(eq.modes(eq.load(name)).modes)
    scene = shown.content["scene"]
    (x0, y0, x1, y1), (rx, ry) = scene["box"], scene["reference"]
    size = max(x1 - x0, y1 - y0)
    arm = max(abs(complex(x - rx, y - ry)) for x in (x0, x1) for y in (y0, y1))
    for mode in modes:
        if mode["seen"]:
            dx, dy, turn = (complex(*mode["shape"][i : i + 2]) for i in (0, 2, 4))
            assert abs(dx) + abs(dy) + arm * abs(turn) >= 0.5 * LARGEST * size
            assert max(abs(dx), abs(dy)) <= 2 * LARGEST * size + arm * abs(turn)
    held = [item["hold"] for item in scene["signs"] if item["hold"] and "mount" in item["hold"]]
    assert held and all(abs(complex(*item["ground"])) == pytest.approx(50) for item in held)
    assert any(item["still"] for item in scene["signs"])
    assert np.all(np.isfinite(block))


def test_balancing_can_be_held_to_what_gauges_read() -> None:
    session, _ = opened("sieve")
    free = contents(ask(session, "balance"), "balanced")[0]
    stand = {item["label"]: item for item in free["figures"]}[
        "reading at stand, RMS about the mean"
    ]
    assert free["gauges_worse"] and stand["way"] == "worse"
    assert any("gauges: reading at stand" in sentence for sentence in free["worse"])
    ask(session, "undo")
    held = contents(ask(session, "balance", hold=True), "balanced")[0]
    stand = {item["label"]: item for item in held["figures"]}[
        "reading at stand, RMS about the mean"
    ]
    assert not held["gauges_worse"] and stand["way"] != "worse"
    assert held["aims"][0]["way"] == "better"
