"""Every table of a machine's file on a page: read into a form, put back, refused at its key."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.i18n import speaking
from equipoise.keys import Frozen, Named, Quantity, Tables
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.parts.links import SET_BY_BODIES
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import parse, showing
from equipoise.schema.entries import Document, entry_of, own_keys, tables_below
from equipoise.web.gallery import opened_example, titles
from equipoise.web.replies import refused
from equipoise.web.session import Session
from equipoise.web.tables import forms_of, menu_items, tables_of
from support.chosen import few
from unit.web.pages import Content, ask, opened, refusal, state

SPRING = {"link": "rocker", "point": "C", "to": "A", "stiffness": "2 kN/m"}
BAR = {"shape": "bar", "between": ["A", "B"], "width": "20 mm", "thickness": "5 mm",
       "material": "steel"}  # fmt: skip
LOAD = "crank_angle [deg],torque [N m]\n0,1\n180,3\n360,1\n"


def group(text: Content, where: str) -> Content:
    (actual,) = [item for item in text["groups"] if item["where"] == where]
    return actual


def tables(session: Any) -> Content:
    (reply,) = ask(session, "tables", seq=3)
    assert reply.content["type"] == "tables"
    return reply.content


def enter(session: Any, place: str | list[Any], values: Content | None, **more: Any) -> Any:
    path = place if isinstance(place, str) else str(KeyPath(place))
    return ask(session, "entry", seq=2, label="entry", place=path, values=values, **more)


# -- what there is ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", titles())
def test_each_entry_put_back_as_its_form_has_it_leaves_the_machine_as_it_was(name: str) -> None:
    machine = opened_example(name).own
    document, text = Document.of_machine(machine), tables_of(machine)
    for item in text["groups"]:
        known = {control["key"] for control in text["forms"][item["form"]]["controls"]}
        for entry in item["entries"]:
            assert known >= entry["values"].keys()
            place = KeyPath.parse(entry["place"]) if entry["place"] else KeyPath(())
            assert document.put(place, entry["values"]).machine() == machine


def test_menus_offer_what_tables_declare_with_keys_that_they_have() -> None:
    """Each below a list or table that a form can be opened for."""
    groups = {
        item["place"]: item for item in tables_of(opened_example("yamashita-1").own)["groups"]
    }
    forms = forms_of(Machine)
    with speaking("de"):
        items = {item["name"]: item for item in menu_items()}
    assert items["Feder …"]["place"] == "springs"
    for item in items.values():
        controls = forms[groups[item["place"]]["form"]]["controls"]
        for values in item["values"]:
            assert values.keys() <= {control["key"] for control in controls}


def test_each_table_that_a_file_can_have_is_offered() -> None:
    """Or its place below one that is not there yet, which is told; below one of a list, with it."""
    reported = tables_of(opened_example("yamashita-1").own)
    offered = {item["form"] for item in reported["groups"]}
    waiting, known, listed_ones = [Machine], set(), set()
    while waiting:
        of = waiting.pop()
        known.add(of.__name__)
        for value in tables_below(of).values():
            inner = entry_of(value.kind)
            assert inner is not None
            listed = isinstance(value.kind, Tables | Named)
            if inner.type.__name__ not in known:
                waiting.append(inner.type)
            listed_ones |= {inner.type} if listed or of in listed_ones else set()
            if of is Machine or not (listed or of in listed_ones):
                assert inner.type.__name__ in offered
    assert known == reported["forms"].keys()
    assert group(reported, "support.mounts")["needs"] == "support"
    assert group(reported, "planting.soil")["needs"] == "planting"
    for name, form in forms_of(Machine).items():
        needed = [control["required"] for control in form["controls"]]
        assert needed == sorted(needed, reverse=True), name
    assert [item["key"] for item in reported["forms"]["Spring"]["controls"]] == [
        "link", "point", "to", "stiffness", "free_length", "preload", "lengths", "forces", "table",
        "on",
    ]  # fmt: skip


def test_a_title_in_several_languages_is_shown_in_the_one_that_is_spoken() -> None:
    session, _ = opened("yamashita-1")
    english = group(tables(session), "")["entries"][0]["words"]
    ask(session, "speak", languages=["ja"])
    japanese = group(tables(session), "")["entries"][0]["words"]
    assert english.startswith("title Planting mechanism type I")
    assert japanese.split()[1] not in english


def test_names_are_chosen_from_those_that_there_are() -> None:
    reported = tables_of(opened_example("yamashita-1").own)
    controls = {item["key"]: item for item in reported["forms"]["Spring"]["controls"]}
    assert (controls["link"]["of"], controls["point"]["on"]) == ("link", "link")
    assert controls["to"]["on"] == "on"
    rough = {
        item["key"]: item["by"]
        for item in reported["forms"]["Position"]["controls"]
        if "by" in item
    }
    assert rough["points"] == {"kind": "name", "of": "point", "on": "links"}
    assert rough["angles"]["of"] == "link"
    (output,) = [
        item for item in reported["forms"]["Objective"]["controls"] if item["key"] == "output"
    ]
    assert (output["kind"], output["of"]) == ("text", "output")
    rig = tables_of(opened_example("yamashita-rig").own)["outputs"]
    assert rig["shaking_moment"] == "shaking moment"
    assert [name for name in rig if name.startswith("gauges.")]
    assert not [name for name in reported["outputs"] if name.startswith("gauges.")]
    assert reported["bodies"]["frame"]["A"] == (0.0, 0.0)
    assert own_keys(Machine).keys() == {
        "title", "description", "parameters", "gravity", "assembly",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("language", "to", "law"),
    [
        (
            "en",
            "its point on the frame, or on “other body”",
            "nothing moves where “angle at the end”",
        ),
        ("ja", "フレーム、または 「相手の物体」 の上の点", "「終わりの角度」"),
        ("ko", "프레임 또는 ‘상대 물체’ 위의 점", "‘"),
    ],
)
def test_what_a_key_means_is_reported_in_the_words_of_its_form(
    language: str, to: str, law: str
) -> None:
    with speaking(language):
        forms = forms_of(Machine)
    texts = {(name, item["key"]): item for name, form in forms.items() for item in form["controls"]}
    assert texts["Spring", "to"]["text"] == to
    assert law in texts["AngleSegment", "law"]["text"]
    assert "point: " in texts["Body", "shape"]["text"] or language != "en"  # a value, not its key
    words = {text["word"] for text in texts.values()}
    assert not words & {"to", "on", "at", "through"}


@pytest.mark.parametrize("units", [{}, {"length": "in", "force": "lbf"}])
def test_the_unit_beside_a_control_can_be_typed(units: Any) -> None:
    def look(of: type[Frozen]) -> None:
        controls = {form["key"]: form for form in forms[of.__name__]["controls"]}
        for name, value in own_keys(of).items():
            if isinstance(value.kind, Quantity):
                assert parse(f"1 {controls[name]['unit']}", value.kind.dimension) > 0
        for value in tables_below(of).values():
            inner = entry_of(value.kind)
            assert inner is not None
            look(inner.type)

    with showing(units):
        forms = forms_of(Machine)
        look(Machine)


# -- adding, changing, deleting --------------------------------------------------------------------


def test_a_spring_is_added_changed_and_deleted_each_as_one_step() -> None:
    session, first = opened("yamashita-1")
    added = state(enter(session, ["springs", 0], SPRING)[0])
    assert added.content["undo"] == "entry"
    assert added.field("springs[1].stiffness")["value"] == 2000.0
    (entry,) = group(tables(session), "springs")["entries"]
    assert entry["words"] == "link rocker, point C, other point A, stiffness 2000 N/m"
    enter(session, ["springs", 0], {**SPRING, "free_length": "30 mm"})
    machine = session.shown.design.machine
    assert machine == eq.loads(eq.dumps(machine))
    assert machine.springs[0].free_length == 0.03
    gone = state(enter(session, ["springs", 0], None)[0])
    assert gone.block.tobytes() == first.block.tobytes()
    back = state(ask(session, "undo")[0])
    assert back.field("springs[1].free_length")["value"] == 0.03


def test_servo_motor_brake_and_run_are_changed_by_their_forms() -> None:
    """Of the example that has all three; the run of the machine on the page follows the file's."""
    session, _ = opened("carton-pusher")
    reported = tables(session)
    (servo,) = group(reported, "drive.motor.servo")["entries"]
    assert servo["values"]["torque_limit"] == "1.9 N m"
    changed = {**servo["values"], "torque_limit": "2.5 N m", "acceleration": "900 rad/s^2"}
    enter(session, ["drive", "motor", "servo"], changed)
    (drive,) = group(reported, "drive")["entries"]
    assert drive["values"]["brake"] == "10 N m"
    enter(session, ["drive"], {**drive["values"], "brake": "12 N m"})
    enter(session, ["run"], {"turns": 3})
    machine = session.shown.design.own
    assert machine.drive.motor is not None and machine.drive.motor.servo is not None
    assert machine.drive.motor.servo.torque_limit == 2.5
    assert machine.drive.motor.servo.acceleration == 900.0
    assert machine.drive.brake == 12.0
    assert eq.run(machine).turned == pytest.approx(3.0)
    enter(session, ["run"], None)
    assert session.shown.design.own.run is None


def test_mounts_have_names_which_can_change() -> None:
    session, _ = opened("yamashita-rig")
    mounts = session.shown.design.own.support.mounts  # type: ignore[union-attr]
    entries = group(tables(session), "support.mounts")["entries"]
    enter(session, entries[0]["place"], entries[0]["values"], name="front")
    renamed = session.shown.design.own.support.mounts  # type: ignore[union-attr]
    assert [*renamed] == ["front", *[*mounts][1:]]
    assert [*renamed.values()] == [*mounts.values()]
    reported = refusal(enter(session, ["support", "mounts", "front"], {}, name=[*mounts][1]))
    assert "is taken already; give another name" in reported


def test_a_counterweight_leaves_with_the_mass_that_it_was_joined_to() -> None:
    session, _ = opened("yamashita-1")
    ask(session, "edit", seq=1, edits=[{"set": "counterweights.crank.mass", "text": "80 g"}])
    (crank,) = [item for item in group(tables(session), "links")["entries"]
                if item["where"] == "links.crank"]  # fmt: skip
    points = {"points": crank["values"]["points"]}
    shown = state(enter(session, ["links", "crank"], points)[0])
    assert shown.content["lacking"].endswith("for crank")
    assert not session.shown.design.counterweights


def test_masses_from_shapes() -> None:
    """The mass that the link had goes; a bar of steel, beside its own formula."""
    session, _ = opened("yamashita-1")
    enter(session, ["links", "crank", "bodies", 0], BAR)
    link = session.shown.design.machine.links["crank"]
    mass = 7850 * 0.0335 * 0.02 * 0.005
    assert link.mass == pytest.approx(mass)
    assert link.inertia == pytest.approx(mass * (0.0335**2 + 0.02**2) / 12)
    text = group(tables(session), "links.crank.bodies")
    assert text["result"].startswith("together 26.30 g; centre of mass at 16.75 mm, 0 mm;")
    enter(session, ["links", "crank", "bodies", 1],
          {"shape": "disc", "at": "B", "radius": "10 mm", "mass": "50 g"})  # fmt: skip
    both = session.shown.design.machine.links["crank"].mass
    assert both == pytest.approx(mass + 0.05)
    enter(session, ["links", "crank", "bodies", 1, "holes", 0], {"at": "B", "radius": "2 mm"})
    assert len(session.shown.design.machine.links["crank"].bodies[1].holes) == 1
    entry = group(tables(session), "links.crank.bodies")["entries"][1]
    enter(session, entry["place"], {**entry["values"], "mass": "60 g"})
    assert len(session.shown.design.machine.links["crank"].bodies[1].holes) == 1  # they stay


def test_a_table_from_a_file_that_is_chosen_and_of_one_that_is_there() -> None:
    session, _ = opened("yamashita-1")
    load = {"link": "rocker", "table": "load.csv"}
    assert "got 'load.csv', which is not known here" in refusal(enter(session, ["loads", 0], load))
    enter(session, ["loads", 0], load, files={"load.csv": LOAD})
    assert session.shown.design.own.loads[0].table.values == ((1.0, 3.0, 1.0),)  # type: ignore[union-attr]
    enter(session, ["springs", 0], SPRING)
    assert session.shown.design.own.loads[0].table.file == "load.csv"  # type: ignore[union-attr]


def test_the_whole_and_its_lists_keep_what_is_not_in_their_form() -> None:
    session, _ = opened("yamashita-1")
    before = session.shown.design.own
    (entry,) = group(tables(session), "")["entries"]
    enter(session, [], {**entry["values"], "gravity": ["0 m/s^2", "0 m/s^2"]})
    after = session.shown.design.own
    assert after.gravity == (0.0, 0.0)
    assert (after.links, after.drive, after.assembly) == (
        before.links, before.drive, before.assembly
    )  # fmt: skip


def test_bearings_come_and_go_in_twos() -> None:
    session, _ = opened("yamashita-1")
    crank = group(tables(session), "links")["entries"][0]
    enter(session, ["links", "crank"], {**crank["values"], "plane": "10 mm"})
    enter(session, ["bearings", "front"], {"link": "crank", "plane": "-20 mm"})
    planes = {name: value.plane for name, value in session.shown.design.own.bearings.items()}
    assert planes == {"front": -0.02, "front2": pytest.approx(0.04)}
    enter(session, ["bearings", "front2"], {"link": "crank", "plane": "30 mm"}, name="back")
    assert session.shown.design.own.bearings["back"].plane == 0.03
    enter(session, ["bearings", "front"], None)
    assert not session.shown.design.own.bearings


def test_segments_of_a_law_fill_its_cycle() -> None:
    session, _ = opened("yamashita-1")
    way = ["drive", "motion"]
    enter(session, way, {"between": ["40 deg", "120 deg"]})

    def segments() -> list[float]:
        law = session.shown.design.own.drive.motion
        assert law is not None and law.between is None
        return [*np.degrees([(segment.over, segment.to) for segment in law.segments]).flat]

    enter(session, [*way, "segments", 0], {"over": "100 deg", "to": "90 deg"})
    assert segments() == pytest.approx([100, 90, 260, 40])
    enter(session, [*way, "segments", 0], {"over": "120 deg", "to": "100 deg"})
    assert segments() == pytest.approx([120, 100, 240, 40])
    enter(session, [*way, "segments", 2], {"over": "60 deg", "to": "40 deg"})  # a dwell
    assert segments() == pytest.approx([120, 100, 180, 40, 60, 40])
    enter(session, [*way, "segments", 2], None)
    assert segments() == pytest.approx([120, 100, 240, 40])
    assert "come back" in refusal(enter(session, [*way, "segments", 1], None))


def test_masses_that_balancing_adds_beside_a_link_are_listed_in_round_numbers() -> None:
    session, _ = opened("yamashita-1")
    enter(session, ["balance"], {})
    mass = {"link": "crank", "at": "A", "radius": "30 mm", "at_most": "300 g", "plane": "20 mm"}
    enter(session, ["balance", "masses", 0], mass)
    enter(session, ["balance", "objectives", 0], {"output": "shaking_force"})
    ask(session, "balance")
    *_, body = session.shown.design.own.links["crank"].bodies
    assert body.plane == 0.02  # and no counterweight in the plane of the link
    assert np.hypot(*body.at) == pytest.approx(0.03)
    assert body.at == tuple(round(item, 10) for item in body.at)
    *_, listed = group(tables(session), "links.crank.bodies")["entries"]
    assert all(len(number) < 11 for number in listed["words"].split()), listed["words"]


# -- refusals --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("place", "values", "path", "what"),
    [
        (["springs", 0], {**SPRING, "stiffness": "3 kg"}, "springs[1].stiffness",
         "got '3 kg'; kg is the unit of a mass"),
        (["springs", 0], {**SPRING, "stiffness": "-1 N/m"}, "springs[1].stiffness",
         "got -1 N/m; give more than 0"),
        (["springs", 0], {"link": "rocker"}, "springs[1].point", 'missing; add point = "C"'),
        (["springs", 0], {**SPRING, "point": "X"}, "springs[1].point", "no point of rocker"),
        (["springs", 3], SPRING, "springs[4]", "there are 0 entries; the next has the number 1"),
        (["springs"], SPRING, "springs", "give the number of the entry too"),
        (["brakes", 0], {}, "brakes[1]", "no table is called 'brakes'"),
        (["planting", "soil"], {}, "planting.soil", "there is no planting; add that first"),
        (["support", "mounts", "m"], {}, "support.mounts.m", "there is no support; add that"),
        (["links", "crank", "bodies", 0], {"shape": "bar"}, "links.crank.bodies[1].between",
         "missing"),
        (["loads", "links", 0], None, "loads.links[1]", "give the number of the entry too"),
        (["drive"], None, "drive", "missing; add the table [drive]"),
        (["gears", 0], None, "gears[1]", "entry not found"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_reported_at_its_key(
    place: list[Any], values: Content | None, path: str, what: str
) -> None:
    session, _ = opened("yamashita-1")
    before = session.shown
    (reply,) = enter(session, place, values)
    assert reply.content["path"] == path
    assert what in reply.content["what"]
    assert session.shown is before


def test_forms_are_refused_in_their_own_words() -> None:
    """What forms call a key, in each language; the message and its place keep the file's."""
    session, _ = opened("yamashita-1")
    values = {"points": {"A": ["0 mm", "0 mm"]}, "mass": "1 kg"}
    (reply,) = enter(session, ["links", "other"], values)
    missing = "give mass, {} and inertia together, or none of them"
    assert missing.format("centre of mass") in reply.content["what"]
    assert reply.content["what"].startswith("centre of mass and inertia missing; ")
    assert missing.format("center_of_mass") in reply.content["message"]
    error = ModelError("links.crank.mass", SET_BY_BODIES)
    content = refused(1, error, "ja").content
    assert "重心" in content["what"] and "center_of_mass" in content["message"]


@pytest.mark.parametrize(
    "asked",
    [
        {"place": ["springs", 0], "values": {}},
        {"place": ".".join("abcdefghi"), "values": {}},
        {"values": {}},
        {"place": "springs[1]", "values": [1]},
        {"place": "springs[1]", "values": {"link": None}},
        {"place": "springs[1]", "values": {}, "name": 3},
        {"place": "springs[1]", "values": {}, "files": {"a": 1}},
        {"place": "springs[1]", "values": {"link": [[[[[[[[["deep"]]]]]]]]]}},
    ],
)
def test_nonsense_is_refused_in_a_sentence(asked: Content) -> None:
    session, _ = opened("yamashita-1")
    assert refusal(ask(session, "entry", seq=1, **asked)).startswith("entry: ")


@pytest.mark.exhaustive(but=["1e400 mm", "junk2"])
@pytest.mark.parametrize(
    "junk",
    few(
        ["", -1, 10**400, True, [], {}, [{}], {"": ""}, ["1 mm", "A"], "1e400 mm", "\0"],
        ["", 10**400, {}, ["1 mm", "A"], "1e400 mm"],
    ),
)
def test_every_value_may_be_nonsense(junk: Any) -> None:
    """One after the other; what is refused leaves the machine, what is taken can be shown."""
    session, _ = opened("yamashita-rig")
    for table in tables(session)["groups"]:
        for entry in table["entries"]:
            for key in entry["values"]:
                enter(session, entry["place"], {**entry["values"], key: junk})
                assert session.shown.design.own == eq.loads(eq.dumps(session.shown.design.own))


def test_what_cannot_turn_is_reported_and_nothing_changes() -> None:
    session, _ = opened("yamashita-1")
    before = session.shown
    points = {"points": {"A": ["0 mm", "0 mm"], "B": ["200 mm", "0 mm"]}}
    assert "cannot turn fully" in refusal(enter(session, ["links", "crank"], points))
    assert session.shown is before


# -- what is unfinished ----------------------------------------------------------------------------


def test_gears_make_one_motion_of_two() -> None:
    """Without them the machine is unfinished, and with them as it was."""
    session, first = opened("planetary-planting-arm")
    entries = group(tables(session), "gears")["entries"]
    for entry in reversed(entries):
        shown = state(enter(session, entry["place"], None)[0])
    assert not shown.content["status"]["finished"]
    assert "mobility" in shown.content["status"]["text"]
    wrong = {**entries[0]["values"], "carrier": "nothing"}
    assert "no link is called 'nothing'" in refusal(enter(session, ["gears", 0], wrong))
    for entry in entries:
        shown = state(enter(session, entry["place"], entry["values"])[0])
    assert shown.content["status"]["finished"]
    for name in first.content["arrays"]:
        if name.startswith("place."):
            assert shown.array(name) == pytest.approx(first.array(name), abs=1e-6)
    assert [gear.teeth for gear in session.shown.design.own.gears] == [(40, 40), (40, 20)]


def test_a_link_that_is_drawn_gets_its_mass_by_bodies() -> None:
    session = Session()
    ask(session, "open", new=True)
    assert "has no links yet" in refusal(ask(session, "tables"))
    ask(session, "make", do="point", spot={"place": [0.0, 0.0]})
    ask(session, "make", do="link", **{"from": {"point": "A"}, "to": {"place": [0.06, 0.0]}})
    (link,) = group(tables(session), "links")["entries"]
    name = KeyPath.parse(link["place"])[-1]
    bar = {**BAR, "between": [*link["values"]["points"]]}
    enter(session, ["links", name, "bodies", 0], bar)
    text = group(tables(session), f"links.{name}.bodies")
    assert text["result"].startswith("together 47.10 g")


def test_rows_that_are_added_are_computed() -> None:
    session, first = opened("yamashita-1")
    for number, phase in enumerate(("0 deg", "180 deg")):
        enter(session, ["rows", number], {"phase": phase, "lateral": f"{300 * number} mm"})
    both = state(ask(session, "ready")[1])
    assert np.abs(both.vector("rows.shaking_force")).max() < np.abs(
        2 * first.vector("shaking_force")
    ).max()  # fmt: skip
