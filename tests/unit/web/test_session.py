"""A page from opening a machine to downloading what became of it."""

from __future__ import annotations

import csv
import gc
import weakref
from math import pi
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.web.design import Design
from equipoise.web.desk import begun
from equipoise.web.messages import message_of
from equipoise.web.session import Session
from equipoise.web.tables import tables_of
from support.chosen import few
from support.refusals import refused
from unit.web.pages import ask, counterweight, edit, move, opened, refusal, state

MASS = {"set": "links.crank.mass", "text": "250 g"}
STUCK = eq.dumps(eq.load("yamashita-1")).replace('"33.5 mm"', '"200 mm"')
SIDELESS = eq.dumps(eq.load("yamashita-1")).replace('[assembly]\nC = "left"', "")


def test_undo_and_redo_go_through_every_step() -> None:
    session, first = opened("yamashita-1")
    assert (first.content["undo"], first.content["redo"]) == (None, None)
    edit(session, MASS, label="mass of crank")
    after = edit(session, {"set": "drive.speed", "text": "250 rpm"}, label="speed")
    assert after.content["undo"] == "speed"
    assert after.content["speed"] == pytest.approx(250 * pi / 30)
    back = state(ask(session, "undo", seq=5)[0])
    assert (back.content["undo"], back.content["redo"]) == ("mass of crank", "speed")
    assert back.field("links.crank.mass")["text"] == "250 g"
    first_again = state(ask(session, "undo")[0])
    assert first_again.block.tobytes() == first.block.tobytes()
    assert "nothing to undo" in refusal(ask(session, "undo"))
    ask(session, "redo")
    again = state(ask(session, "redo")[0])
    assert again.block.tobytes() == after.block.tobytes()
    edit(session, MASS, label="another")
    assert "nothing to redo" in refusal(ask(session, "redo"))


def test_a_drag_is_one_step_from_where_it_began() -> None:
    session, first = opened("yamashita-1")
    for value in (0.21, 0.24, 0.3):
        edit(session, {"set": "links.crank.mass", "value": value}, commit=False)
    last = edit(session, {"set": "links.crank.mass", "value": 0.3}, label="slide")
    assert last.field("links.crank.mass")["value"] == 0.3
    assert state(ask(session, "undo")[0]).block.tobytes() == first.block.tobytes()


def test_parallel_cranks_are_opened_and_edited() -> None:
    """Throws that cannot be alike, as two were typed, do not fit; a mass may be any."""
    session, _ = opened("straw-walker")
    after = edit(session, {"set": "links.walker-2.mass", "text": "20 kg"}, label="mass")
    assert after.content["status"]["finished"]
    typed = {"links.rear.points.R3.x": "-51 mm", "links.front.points.F3.x": "-52 mm"}
    wrong = [{"set": path, "text": text} for path, text in typed.items()]
    replies = ask(session, "edit", seq=9, commit=True, label="throw", edits=wrong)
    assert "R3 of 'walker-3' comes 1 mm beside its pin" in refusal(replies)


@pytest.mark.parametrize(
    ("name", "point"),
    [
        ("elliptic-quick-return", "B"),
        ("four-stroke-engine", "B"),
        ("pick-and-place", "C"),
        ("twin-engine", "B1"),
    ],
)
def test_a_drag_changes_figures_and_is_taken_back(name: str, point: str) -> None:
    session, before = opened(name)
    after = edit(session, move(point, before.place(point)[0] * 1.01, 0))
    assert after.figure("shaking_force.rms")["text"] != before.figure("shaking_force.rms")["text"]
    assert state(ask(session, "undo")[0]).block.tobytes() == before.block.tobytes()


def test_a_drag_that_ends_where_nothing_can_be_keeps_its_last_good_place() -> None:
    session, _ = opened("yamashita-1")
    good = edit(session, {"set": "links.coupler.points.C.x", "text": "90 mm"}, commit=False)
    bad = {"set": "links.coupler.points.C.x", "text": "10 mm"}
    replies = ask(session, "edit", seq=9, commit=True, label="drag", edits=[bad])
    assert "cannot turn" in refusal(replies)
    kept = state(replies[1])
    assert kept.block.tobytes() == good.block.tobytes()
    assert (kept.content["seq"], kept.content["undo"]) == (9, "drag")


def test_a_counterweight_is_a_point_mass_on_the_link() -> None:
    """Beside the force of a mass that turns in a circle, and the file that is downloaded."""
    session, before = opened("yamashita-1")
    after = edit(session, *counterweight("80 g", "45 mm", "170 deg"))
    added = after.vector("shaking_force") - before.vector("shaking_force")
    turning = 0.08 * 0.045 * before.content["speed"] ** 2
    assert abs(added) == pytest.approx(turning, rel=1e-4)
    (model,) = ask(session, "download", kind="model")
    crank = eq.loads(model.buffer.decode()).links["crank"]
    own = eq.load("yamashita-1").links["crank"]
    assert crank.mass == pytest.approx(0.279)
    about_pin = crank.inertia + crank.mass * abs(complex(*crank.center_of_mass)) ** 2  # type: ignore[operator, misc]
    own_about_pin = own.inertia + own.mass * abs(complex(*own.center_of_mass)) ** 2  # type: ignore[operator, misc]
    assert about_pin - own_about_pin == pytest.approx(0.08 * 0.045**2)


def test_balancing_shows_before_and_after_and_can_be_taken_back() -> None:
    session, first = opened("balance-crank")
    reply, shown = ask(session, "balance", seq=4)
    machine = eq.load("balance-crank")
    balanced = eq.balance(machine)
    assert reply.content["changes"]
    by_label = {entry["label"]: entry for entry in reply.content["figures"]}
    force = by_label["shaking force y, RMS"]
    assert force["before"] == pytest.approx(balanced.before["shaking_force.y.rms"])
    assert force["after"] == pytest.approx(balanced.after["shaking_force.y.rms"])
    after = state(shown)
    (aim,) = reply.content["aims"]
    assert [aim["before"], aim["after"]] == pytest.approx(next(iter(balanced.objectives.values())))
    assert after.content["before"]
    assert after.figure("shaking_force.y.rms")["before"] == pytest.approx(
        balanced.before["shaking_force.y.rms"], rel=1e-6
    )
    assert (after.vector("before.shaking_force") == first.vector("shaking_force")).all()
    assert after.field("counterweights.crank.mass")["text"] == "1145 g"
    radius = after.field("counterweights.crank.radius")["value"]
    assert radius == pytest.approx(balanced.changes[0].values["radius"])
    assert state(ask(session, "undo")[0]).block.tobytes() == first.block.tobytes()
    compared = state(ask(session, "compare", on=True)[0])
    assert "before.shaking_force" in compared.content["arrays"]
    alone = state(ask(session, "compare", on=False)[0])
    assert "before.shaking_force" not in alone.content["arrays"]


@pytest.mark.parametrize("name", ["balance-crank"])
def test_balancing_again_replaces_the_counterweight(name: str) -> None:
    """As heavy as if the machine had been changed first and balanced once, by the same plan."""
    session, _ = opened(name)
    ask(session, "balance")
    edit(session, {"set": "links.coupler.mass", "text": "900 g"})
    shown = edit(session, {"set": "counterweights.rocker.mass", "text": "100 g"})
    reply, after = ask(session, "balance")
    once, _ = opened(name)
    edit(once, {"set": "links.coupler.mass", "text": "900 g"})
    edit(once, {"set": "counterweights.rocker.mass", "text": "100 g"})
    ask(once, "balance")
    weights = [item.shown.design.counterweights["crank"].mass for item in (session, once)]
    assert weights[0] == pytest.approx(weights[1], rel=1e-6)
    own = session.shown.design.own.links
    assert own["crank"] == eq.load(name).links["crank"]
    assert session.shown.design.counterweights["rocker"].mass == 0.1
    assert reply.content["changes"][0].startswith("crank: take off the counterweight of 1")
    (force,) = [
        entry for entry in reply.content["figures"] if entry["label"] == "shaking force, RMS"
    ]
    table = state(after).figure("shaking_force.rms")
    assert force["before"] == table["before"] == shown.figure("shaking_force.rms")["value"]
    assert force["after"] == table["value"]


# Of a machine with a plan: the test below.
@pytest.mark.exhaustive
def test_advice_ends_where_nothing_more_helps() -> None:
    """The second time nothing is better than what is on the crank already."""
    session, _ = opened("kim-chung-c")
    reply, _ = ask(session, "balance")
    assert reply.content["changes"][0].startswith("crank: add a counterweight of ")
    before = session.shown
    weight = before.design.counterweights["crank"].mass
    (again,) = ask(session, "balance")
    assert again.content["notes"][0].startswith("Leave the masses as they are")
    edit(session, {"set": "counterweights.crank.mass", "text": "20 g"})
    reply, _ = ask(session, "balance")
    assert reply.content["changes"][0] == "crank: take off the counterweight of 20.00 g"
    assert session.shown.design.counterweights["crank"].mass == pytest.approx(weight)
    before = session.shown
    ask(session, "balance")
    assert session.shown is before


@pytest.mark.exhaustive(but=["balance-crank"])
@pytest.mark.parametrize("name", ["balance-crank", "four-row-transplanter"])
def test_what_is_balanced_has_nothing_to_gain(name: str) -> None:
    session, _ = opened(name)
    ask(session, "balance")
    before = session.shown
    (again,) = ask(session, "balance", seq=8)
    assert again.content["seq"] == 8
    assert again.content["notes"][0].startswith("nothing to gain: balancing would not make ")
    assert session.shown is before
    assert state(ask(session, "undo")[0]).content["redo"] == "balance"


def test_the_plan_of_a_file_outlives_balancing(tmp_path: Path) -> None:
    """In the model that is shown, downloaded and saved; and it is what a second balance goes by."""
    path = tmp_path / "crank.toml"
    eq.save(eq.load("balance-crank"), path)
    desk = begun(str(path))()
    plan = eq.load("balance-crank").balance
    for message in ({"type": "balance"}, {"type": "compare", "on": False}, {"type": "save"}):
        [*desk.receive(message_of({"seq": 1, **message}))]
    own = desk.session.shown.design.own
    assert own.links == eq.load("balance-crank").links  # the counterweight stands beside it
    assert own.balance == eq.load(path).balance == plan
    text = ask(desk.session, "download", kind="model")[0].buffer.decode()
    assert eq.loads(text).balance == plan
    listed = tables_of(own)["groups"]
    assert next(item for item in listed if item["where"] == "balance.masses")["entries"]
    entry = {"place": "balance.objectives[1]", "label": "", "name": ""}
    ask(desk.session, "entry", **entry, values={"output": "shaking_force.x", "measure": "rms"})
    reply, _ = ask(desk.session, "balance")
    assert [item["label"] for item in reply.content["aims"]] == ["shaking force x, RMS"]


# Counterweights are: `test_balancing_again_replaces_the_counterweight`.
@pytest.mark.exhaustive
@pytest.mark.parametrize("name", few(["balance-geared-b", "balance-shafts"], {"balance-shafts"}))
def test_shafts_of_a_plan_are_replaced_by_balancing_again(name: str) -> None:
    """Whose names are taken by the first ones, so that the plan has others."""
    session, _ = opened(name)
    plan = session.shown.design.own.balance
    assert plan is not None
    ask(session, "balance")
    first = session.shown.design.machine
    kept = first.balance
    assert kept is not None and kept.objectives == plan.objectives
    renamed = [f"{item.name} 2" for item in (*plan.geared, *plan.shafts)]
    assert [item.name for item in (*kept.geared, *kept.shafts)] == renamed
    (again,) = ask(session, "balance")
    assert again.content["notes"][0].startswith("nothing to gain")
    lighter = {"set": f"links.{'coupler' if 'geared' in name else 'rod'}.mass", "text": "20 g"}
    edit(session, lighter)
    reply, _ = ask(session, "balance")
    second = session.shown.design.machine
    assert len(second.links) == len(first.links) and len(second.gears) == len(first.gears)
    assert second.balance == plan
    taken = [line for line in reply.content["changes"] if line.endswith("take off this shaft")]
    assert len(taken) == len(first.links) - len(eq.load(name).links)
    once, _ = opened(name)
    edit(once, lighter)
    alone, _ = ask(once, "balance")
    after = [item.content["aims"][0]["after"] for item in (reply, alone)]
    assert after[0] == pytest.approx(after[1], rel=1e-3)


def test_rows_have_the_same_figures_in_the_panel_and_the_table() -> None:
    """Peaks between the samples, and moments that are nothing but rounding before."""
    session, _ = opened("four-row-transplanter")
    reply, shown = ask(session, "balance")
    panel = {entry["label"]: entry for entry in reply.content["figures"]}
    for name in ("shaking_force", "roll_moment"):
        table = state(shown).figure(f"rows.{name}.peak")
        line = panel[table["label"].replace("rows,", "rows:")]
        assert (line["before"], line["after"]) == (table["before"], table["value"])
    assert table["before"] == 0.0
    assert table["value"] > 1


# Counterweights on the page: `test_balancing_again_replaces_the_counterweight`.
@pytest.mark.exhaustive
def test_a_sector_keeps_its_own_inertia_on_the_page() -> None:
    session, _ = opened("balance-rig")
    ask(session, "balance")
    balanced = eq.balance(eq.load("balance-rig"))
    assert session.shown.design.own.links["crank"] == balanced.original.links["crank"]
    shown, made = (item.links["crank"] for item in (session.shown.design.machine, balanced.machine))
    assert (shown.mass, shown.inertia) == pytest.approx((made.mass, made.inertia), rel=1e-9)
    assert shown.center_of_mass == pytest.approx(made.center_of_mass, rel=1e-9)
    (piece,) = balanced.changes[0].values["pieces"]
    outer, inner = piece["outer_radius"], piece["inner_radius"]
    weight = session.shown.design.counterweights["crank"]
    about = piece["mass"] * (outer**2 + inner**2) / 2
    assert weight.mass * (weight.gyration**2 + weight.radius**2) == pytest.approx(about, rel=1e-9)


def test_a_change_while_it_is_balanced_is_not_lost() -> None:
    session, _ = opened("balance-crank")
    question, base = message_of({"type": "balance", "seq": 1}), session.current()
    balancing = session.balancing(base, question)
    edit(session, MASS)
    with refused(UsageError, by="adopted"):
        next(session.adopted(base, balancing, question))
    assert session.shown.design.own.links["crank"].mass == 0.25


def test_a_speed_within_a_resonance_is_reported_with_the_response() -> None:
    session, _ = opened("yamashita-rig")
    shown = ask(session, "edit", seq=1, edits=[{"set": "drive.speed", "text": "118 rpm"}])
    notes = next(item.content["notes"] for item in shown if item.content["type"] == "response")
    assert any("is to be avoided: between 97.0 and 137 rpm order 1" in note for note in notes)


def test_downloads() -> None:
    session, _ = opened("yamashita-1")
    edit(session, MASS)
    model, table = (ask(session, "download", kind=kind)[0] for kind in ("model", "csv"))
    assert model.content["name"] == "yamashita-1.toml"
    assert eq.loads(model.buffer.decode()) == session.shown.design.machine
    odd = Session()
    odd.open(Design("a/b: c?", eq.load("yamashita-1")))
    assert ask(odd, "download", kind="csv")[0].content["name"] == "a-b- c-.csv"
    rows = [*csv.reader(table.buffer.decode().splitlines())]
    assert rows[0][0] == "crank_angle [rad]"
    assert len(rows) == 361
    assert "there are 'model', 'csv', 'report'" in refusal(ask(session, "download", kind="pdf"))
    replies = ask(session, "download", kind="report", language="xx")
    assert "no language of reports is called 'xx'" in refusal(replies)


# Cranks that swing: `test_a_crank_that_cannot_turn_swings_and_goes_on_being_made` of
# test_sketch.py.
@pytest.mark.exhaustive
def test_a_crank_that_cannot_turn_swings_and_can_be_dragged() -> None:
    session = Session()
    first = state(ask(session, "open", seq=1, name="s.toml", text=STUCK)[0]).content
    assert "which is not in the file: motion = { between =" in first["notes"][0]
    assert "crank from" in first["status"]["text"]
    moved = [{"move": "C", "to": [0.1, 0.1], "at": 3}]
    actual = state(ask(session, "edit", seq=2, edits=moved, label="move C")[0]).content
    assert actual["status"]["finished"] and actual["angles"] == first["angles"]
    (film,) = ask(session, "download", kind="film")
    assert film.buffer.startswith(b"GIF")
    content = ask(session, "balance", seq=3)[0].content
    assert content["type"] == "state" and content["notes"][0].startswith(
        "Leave the masses as they are"
    )


def test_what_a_drive_holds_is_reported_where_it_is_dragged() -> None:
    session, first = opened("hydraulic-loader")
    assert first.content["held"] is None
    content = edit(session, move("B", 0.95 - 0.05j, at=90)).content["held"]
    assert content.startswith("the position of B is limited by the stroke of the drive")
    assert edit(session, move("Q", -0.1 + 0.32j, at=90)).content["held"] is None


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"example": "yamashita-9"}, "no example of the name 'yamashita-9'"),
        ({"example": "../secret"}, "no example of the name"),
        ({"name": "a.toml", "text": ""}, "a.toml: schema: missing"),
        ({"name": "a\n.toml", "text": "[["}, "a\\n.toml: end of document"),
        ({"name": "b.toml", "text": "x" * 2_000_001}, "b.toml: the text is longer than 2 MB"),
        ({"name": "t.toml", "text": 'schema = 1\nshaft.length = "1 m"'}, "hand-held tool"),
        ({"name": "c.toml"}, "open: text: got nothing"),
        ({"name": "s.toml", "text": SIDELESS}, "such as\n[assembly]\n# C lies left or right of"),
    ],
)
def test_what_is_no_machine_is_refused(given: dict[str, str], words: str) -> None:
    session = Session()
    assert words in refusal(ask(session, "open", seq=2, **given))
    for kind in ("edit", "undo", "balance", "download", "compare"):
        assert "no machine is open" in refusal(ask(session, kind, edits=[MASS], kind="csv"))


def test_a_file_with_a_byte_order_mark_is_opened() -> None:
    session = Session()
    text = "\ufeff" + eq.dumps(eq.load("yamashita-1"))
    assert state(ask(session, "open", name="m.toml", text=text)[0]).content["name"] == "m.toml"


def test_steps_of_undo_keep_no_motion() -> None:
    """Hundreds of designs would keep hundreds of motions, and the answers of large machines."""
    session, _ = opened("yamashita-rig")
    before = edit(session, MASS)
    assert session.current_state is not None
    kept = [
        weakref.ref(item) for item in (session.current_state, session.current_state.motion.linkage)
    ]
    for mass in ("31 g", "32 g"):
        edit(session, {"set": "links.crank.mass", "text": mass})
    gc.collect()
    assert [item() for item in kept] == [None, None]
    ask(session, "undo")
    assert state(ask(session, "undo")[0]).block.tobytes() == before.block.tobytes()
