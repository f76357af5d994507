"""What a page is sent, against the analysis that it shows."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.quantities import change, display, display_rules, number, typeset
from equipoise.web.deferred import responded
from equipoise.web.design import Design
from equipoise.web.edits import solved
from equipoise.web.gallery import opened_example, titles
from equipoise.web.state import spectra_of
from surface.running import example_text, massless
from unit.web.pages import ask, edit, opened


@pytest.mark.parametrize("name", ["slider-crank-engine", "four-row-transplanter"])
def test_spectra_of_a_drag_are_those_of_its_last_whole_state(name: str) -> None:
    """Forces that jump need thousands of crank angles for them, and a page draws at every move."""
    session, first = opened(name)
    spectra = [array for array in first.content["arrays"] if array.startswith("spectrum.")]
    path = next(
        entry["path"] for entry in first.content["fields"] if entry["path"].endswith(".mass")
    )
    change = {"set": path, "text": "5 kg"}
    session.brief = True
    moved = edit(session, change, commit=False)
    assert np.max(np.abs(moved.array("shaking_force") - first.array("shaking_force"))) > 1
    session.brief = False
    whole = edit(session, change, commit=False)
    key = "spectrum.shaking_force.x"
    assert np.max(np.abs(whole.array(key) - first.array(key))) > 0.1
    for array in spectra:
        np.testing.assert_array_equal(moved.array(array), first.array(array))
    np.testing.assert_array_equal(whole.array("shaking_force"), moved.array("shaking_force"))


def test_spectra_are_computed_anew_where_names_or_orders_are_others() -> None:
    """Without speed there is no force of all rows; a cycle of several turns has more orders."""
    session, first = opened("four-row-transplanter")
    session.brief = True
    moved = edit(session, {"set": "drive.speed", "text": "0 rpm"}, commit=False)
    every = {name for name in first.content["arrays"] if name.startswith("spectrum.")}
    left = {name for name in moved.content["arrays"] if name.startswith("spectrum.")}
    assert every - left == {f"spectrum.rows.shaking_force.{axis}" for axis in "xy"}
    analysis = eq.analyze(eq.load("geared-counterweight"))
    spectra = spectra_of(analysis)
    assert spectra_of(analysis, spectra) is spectra
    shorter = {name: sizes[:21] for name, sizes in spectra.items()}
    for name, sizes in spectra_of(analysis, shorter).items():
        np.testing.assert_array_equal(sizes, spectra[name])


def test_spectra_of_the_machine_before_are_computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """It stays the same while another one is dragged."""
    session, first = opened("yamashita-1")
    path = next(
        entry["path"] for entry in first.content["fields"] if entry["path"].endswith(".mass")
    )
    edit(session, {"set": path, "text": "5 kg"})
    ask(session, "compare", on=True)
    assert session.before is not None
    analyses = []

    def counted(analysis: eq.Analysis, last: object = None) -> object:
        analyses.append(analysis)
        return spectra_of(analysis)

    monkeypatch.setattr("equipoise.web.state.spectra_of", counted)
    key = "spectrum.shaking_force.x"
    for text in ("6 kg", "7 kg"):
        moved = edit(session, {"set": path, "text": text}, commit=False)
        np.testing.assert_array_equal(moved.array(f"before.{key}"), first.array(key))
    assert analyses.count(session.before.analysis) <= 1


def test_arrays_are_those_of_the_analysis() -> None:
    _, shown = opened("yamashita-1")
    whole = eq.analyze(eq.load("yamashita-1"))
    forces = whole.forces
    wanted = {
        "place.P": whole.motion.points["P"].place,
        "mass_center.coupler": whole.motion.mass_centers["coupler"].place,
        "angle.rocker": whole.motion.links["rocker"].angle,
        "shaking_force": forces.shaking_force.value,
        "shaking_moment": forces.shaking_moment,
        "drive_torque": forces.drive_torque,
        "joint.C": forces.joints["C"].size,
        "spectrum.shaking_force.y": whole.by_order["shaking_force.y"].sizes[:21],
    }
    for name, values in wanted.items():
        sent = shown.vector(name) if np.iscomplexobj(values) else shown.array(name)
        scale = np.max(np.abs(values))
        np.testing.assert_allclose(sent, values, rtol=0, atol=1e-6 * scale, err_msg=name)
    peak = whole.summary["shaking_force"].peak
    assert shown.figure("shaking_force.peak")["value"] == pytest.approx(peak, rel=1e-9)
    assert shown.content["orders"] == list(range(21))


def test_rows_add_up_as_their_phases_say() -> None:
    """The sum of one row's signal, read as far ahead as each row's crank is."""
    session, _ = opened("four-row-transplanter")
    shown = edit(session, {"set": "rows[2].phase", "text": "75 deg"})
    rows = session.shown.design.machine.rows
    for name, read in (("shaking_force", shown.vector), ("drive_torque", shown.array)):
        first = read(name)
        ahead = [round(row.phase / (2 * np.pi) * len(first)) for row in rows]
        total = sum(np.roll(first, -samples) for samples in ahead)
        scale = np.max(np.abs(first))
        np.testing.assert_allclose(read(f"rows.{name}"), total, atol=2e-5 * scale)
    assert shown.figure("drive_torque.rms")["label"] == "one row: drive torque, RMS"


def test_the_path_over_ground_advances_by_a_hill_a_turn() -> None:
    session, shown = opened("kim-chung-a")
    path, angle = shown.vector("ground.P"), shown.array("crank_angle")
    way = np.unwrap(angle)[-1] / (2 * np.pi)
    moved = (path - shown.place("P")).real
    figures = eq.plant(eq.load("kim-chung-a"))
    assert moved[-1] - moved[0] == pytest.approx(way * figures["hill_spacing"], rel=1e-5)
    assert shown.content["planting"]["surface"] == pytest.approx(figures["surface"])
    strokes, more = session.deferred_replies()
    content = {entry["name"]: entry["value"] for entry in more.content["figures"]}
    assert content["soil.depth"] == pytest.approx(1e3 * figures["soil.depth"])
    assert strokes.content["type"] == "strokes"
    assert not session.has_more


def test_links_beside_each_other_are_reported() -> None:
    session, shown = opened("twin-engine")
    across = eq.analyze(eq.load("twin-engine")).forces.across
    assert shown.content["beside"]
    peak = shown.figure("rocking_moment.x.peak")["value"]
    assert peak == pytest.approx(np.max(np.abs(across.rocking_moment.x)))
    sent = shown.vector("rocking_moment")
    np.testing.assert_allclose(sent, across.rocking_moment.value, rtol=0, atol=1e-4)
    drawn = next(
        reply.content for reply in session.deferred_replies() if reply.content["type"] == "side"
    )
    assert "piston-2" in drawn["svg"]


def test_figures_of_sliders_and_rockers_are_reported_in_the_units_of_tables() -> None:
    session, _ = opened("quick-return")
    (more,) = session.deferred_replies()
    content = {entry["label"]: entry for entry in more.content["figures"]}
    assert content["ram on frame: stroke"]["text"] == "304.0"
    assert content["ram on frame: stroke"]["unit"] == "mm"
    assert content["lever: time ratio"]["text"] == "1.710"
    assert content["lever: dwell"]["unit"] == "°"
    assert "block on lever: least mechanical advantage" not in content
    session, _ = opened("cam-pusher")
    content = {
        entry["name"]: entry
        for reply in session.deferred_replies()
        for entry in reply.content["figures"]
    }
    first = content["cams.crank to pusher.lift_off_speed"]
    assert (first["label"], first["unit"]) == ("crank → pusher: lift-off speed of the crank", "rpm")
    assert first["value"] == pytest.approx(583.6, rel=1e-3)


def test_strokes_and_planting_are_reported_before_and_after() -> None:
    session, _ = opened("kim-chung-a")
    assert not any(reply.content["compared"] for reply in session.deferred_replies())
    edit(session, {"set": "drive.speed", "text": "100 rpm"})
    strokes, planting = session.deferred_replies()
    assert [
        entry["was"] for entry in strokes.content["figures"] if entry["was"]
    ] == []  # a path has none
    was = {entry["name"]: entry["was"] for entry in planting.content["figures"]}
    assert was["hill_spacing"] == "150.0 · +140.0 %"
    ask(session, "variant", do="pin")
    edit(session, {"set": "links.rocker.lengths.D-C", "text": "82 mm"})
    for item in session.deferred_replies():
        assert any(figure["was"] for figure in item.content["figures"])
    ask(session, "variant", do="against", to="nothing")
    assert session.has_more
    assert not any(reply.content["compared"] for reply in session.deferred_replies())


def test_no_more_is_reported_of_what_is_unfinished_by_then() -> None:
    session, _ = opened("slider-crank-engine")
    assert session.has_more
    more = session.deferred_replies()
    ask(session, "make", do="delete", what="link", name="crank")
    assert not [*more]


def test_what_is_infinite_is_drawn_with_gaps() -> None:
    name = "sliders.piston on frame.advantage"
    session, _ = opened("slider-crank-engine")
    drawn = ask(session, "outputs", names=[name])[0]
    offset, length = drawn.content["arrays"][f"output.{name}"]
    sent = np.frombuffer(drawn.buffer, "<f4")[offset : offset + length]
    assert np.any(np.isnan(sent))
    assert np.nanmax(np.abs(sent)) < 1e3


def test_a_machine_on_a_support_reports_its_response() -> None:
    session, _ = opened("yamashita-rig")
    _, _, reply = ask(session, "ready")
    response = eq.respond(eq.load("yamashita-rig"))
    reported = next(
        item.content for item in session.deferred_replies() if item.content["type"] == "gauges"
    )["figures"]
    (reading,) = response.gauges.values()
    for entry, value in zip(
        reported,
        (reading.displacement.peak_to_peak, reading.displacement.vibration_rms),
        strict=True,
    ):
        assert entry["value"] == pytest.approx(1e3 * value)
    assert [item["label"].rpartition(", ")[2] for item in reported] == ["peak to peak", "RMS"]
    (drawn,) = reply.content["charts"]
    (gauge,) = drawn["choices"]
    (curve,) = gauge["curves"]
    assert (gauge["unit"], gauge["factor"]) == ("mm", 1e3)
    offset, length = reply.content["arrays"][curve["array"]]
    sent = np.frombuffer(reply.buffer, "<f4")[offset : offset + length]
    wanted = response.gauges[gauge["name"]].displacement.samples(length)
    np.testing.assert_allclose(sent, wanted, atol=1e-6 * np.max(np.abs(wanted)))


def test_a_machine_without_masses_moves() -> None:
    session, _ = opened("yamashita-1")
    shown = ask(session, "open", name="bare.toml", text=massless())[0].content
    text = "forces need mass, centre of mass and inertia of every link: give them, or bodies, at "
    assert shown["lacking"] == f"{text}“Parts of the model” for crank, coupler and rocker"
    assert shown["lacking"] in shown["notes"]
    links = {
        item["label"]: item["winds"]
        for item in shown["outputs"]
        if item["name"] == "links.crank.angle"
    }
    assert links and all(links.values())
    assert "shaking_force" not in shown["arrays"]
    assert not [item for item in shown["fields"] if item["path"].startswith("counterweights")]


def test_a_page_follows_the_units_of_its_file() -> None:
    session, plain = opened("yamashita-rig")
    text = example_text("yamashita-rig").replace(
        "[drive]", 'units = { length = "in", force = "lbf" }\n\n[drive]', 1
    )
    shown, response = ask(session, "open", name="inches.toml", text=text)[:2]
    content = shown.content
    assert plain.content["length"]["unit"] == "mm" and content["length"]["unit"] == "in"
    force = next(item for item in content["figures"] if item["name"] == "shaking_force.rms")
    old = plain.figure("shaking_force.rms")
    assert (force["unit"], old["unit"], force["value"]) == ("lbf", "N", old["value"])
    assert float(force["text"]) == pytest.approx(old["value"] / 4.4482216152605, rel=1e-3)
    moment = next(item for item in content["charts"] if item["name"] == "shaking_moment")
    assert moment["choices"][0]["unit"] == "lbf in"
    field = next(item for item in content["fields"] if item["path"] == "links.crank.points.B.x")
    assert (field["text"], field["unit"]) == ("1.318898 in", "in")
    assert response.content["charts"][0]["choices"][0]["unit"] == "in"
    (model,) = ask(session, "download", kind="model")
    assert b'length = "in"' in model.buffer
    assert display("length").unit == "mm"  # nothing of it stays


def test_numbers_are_written_as_everywhere() -> None:
    """Texts and units come from the product's one formatter, whatever the page shows."""
    session, _ = opened("yamashita-1")
    session.before = session.current_state
    shown = edit(session, {"set": "drive.speed", "text": "150 rpm"})
    for item in shown.content["figures"]:
        assert item["text"].lstrip("\N{MINUS SIGN}") == typeset(number(item["value"]))
        faster = typeset(change(item["before"], item["value"]))
        assert item["was"] == f"{typeset(number(item['before']))} · {faster}"
    slower = shown.figure("shaking_force.rms")["was"]
    assert slower.endswith("\N{MINUS SIGN}39.6 %")  # (150 / 193)^2
    speed, inertia = shown.field("drive.speed"), shown.field("links.coupler.inertia")
    assert (speed["shown"], speed["text"]) == ("150 rpm", "150 rpm")
    assert inertia["shown"].endswith(" kg mm²") and inertia["text"].endswith(" kg mm^2")
    assert speed["factor"] * speed["value"] == pytest.approx(150)
    units = {entry["name"]: entry["unit"] for entry in shown.content["outputs"]}
    assert units["drive_torque"] == "N m" and units["joints.C"] == "N"
    (hello, *_) = ask(session, "ready")
    assert hello.content["numbers"] == display_rules()


def test_charts_are_those_of_the_outputs() -> None:
    """Every chart draws arrays that are there, with label and unit of the output that it shows."""
    _, shown = opened("four-row-transplanter")
    outputs = {entry["name"]: entry for entry in shown.content["outputs"]}
    drawn = {}
    for chart in shown.content["charts"]:
        for choice in chart["choices"]:
            arrays = [curve["array"] for curve in choice["curves"]]
            assert set(arrays) <= set(shown.content["arrays"])
            drawn[(chart["name"], choice["of"], choice["name"])] = choice
            if chart["name"] not in ("spectrum", "joint"):
                output = outputs[f"{choice['of']}{choice['name']}"]
                assert choice["label"].lower() == output["label"].lower()
                assert choice["unit"] == output["unit"]
    assert {"x", "y"} == {
        curve["label"] for curve in drawn["shaking_force", "rows.", "shaking_force"]["curves"]
    }
    assert ("roll_moment", "rows.", "roll_moment") in drawn  # which one row by itself has not
    assert ("roll_moment", "", "roll_moment") not in drawn
    assert drawn["joint", None, "joint.A"]["label"] == "One row: force in joint A"
    whole = drawn["spectrum", "rows.", "shaking_force"]
    assert whole["label"] == "All rows: shaking force, by order"
    assert [curve["array"] for curve in whole["curves"]] == [
        "spectrum.rows.shaking_force.x", "spectrum.rows.shaking_force.y"
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "first", "point"),
    [
        ("transplanter", "squares", "P"),
        ("kim-chung-a", "squares", "P"),
        ("slider-crank-engine", "squares", "C"),
        ("drag-link", "squares", "C"),
        ("riding-transplanter", "answers", "P"),
        ("exudyn-slider-crank", "answers", "C"),
        ("sieve", "answers", "C"),
        ("stephenson-six-bar", "output", "E"),
        ("quick-return", "output", "F"),
    ],
)
def test_what_a_machine_is_for_comes_first(name: str, first: str, point: str) -> None:
    _, shown = opened(name)
    assert (shown.content["first"], shown.content["traced"][0]) == (first, point)


def test_a_cam_comes_with_the_motion_of_its_follower() -> None:
    _, shown = opened("cam-pusher")
    assert shown.content["first"] == "output"
    lift = eq.analyze(eq.load("cam-pusher")).outputs["sliders.pusher on arm.travel"].values_to_draw
    assert shown.array("output.sliders.pusher on arm.travel") == pytest.approx(lift, rel=1e-6)


@pytest.mark.parametrize("name", [name for name in titles() if not name.startswith("drag")])
def test_the_first_path_is_no_circle_of_the_crank(name: str) -> None:
    """Of every example where another point moves than those of the crank."""
    _, shown = opened(name)
    machine = eq.load(name)
    first = shown.content["traced"][0]
    crank = machine.links[machine.drive.link].points
    moving = [point for link in machine.links.values() for point in link.points]
    assert first not in crank or {*moving} <= {*crank, *machine.frame}


def test_a_six_bar_shows_what_its_output_does() -> None:
    """Without being asked; and no more of it where another machine is opened."""
    session, shown = opened("stephenson-six-bar")
    angle = eq.analyze(eq.load("stephenson-six-bar")).outputs["links.output.angle"].values_to_draw
    assert shown.array("output.links.output.angle") == pytest.approx(angle, rel=1e-6)
    session.open(opened_example("quick-return"))
    (state_of_it, *_) = ask(session, "compare", on=False)
    outputs = [entry for entry in state_of_it.content["arrays"] if entry.startswith("output.")]
    assert outputs == ["output.sliders.ram on frame.travel"]


def test_what_takes_long_is_computed_once_and_not_written_into_the_design() -> None:
    shown = solved(Design("rig", eq.load("yamashita-rig")))
    before = set(vars(shown))
    assert responded(shown) is responded(shown)
    assert set(vars(shown)) == before
    assert responded(solved(shown.design)) is not responded(shown)
