"""What the summary says, held to the same found another way."""

from __future__ import annotations

import re
from copy import copy
from dataclasses import replace
from math import pi
from types import SimpleNamespace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.balancing.blocks import outcome_blocks
from equipoise.balancing.outcome import benefit_sentences, deterioration_sentences
from equipoise.i18n import Note, speaking
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Weight
from equipoise.present.cells import grid, noted, printed
from equipoise.present.composition import balance_blocks, report_page
from equipoise.present.findings import Findings
from equipoise.present.pictures import pictures
from equipoise.present.summary import (
    Shaking,
    answers,
    broken_limits,
    planting_sentences,
    tiles,
    tool_answers,
    vibration_sentences,
    why_sentences,
)
from equipoise.quantities import PER_RPM, brief
from equipoise.results.analysis_blocks import shares
from equipoise.results.blocks import Table
from equipoise.schema.documents import dumps
from support.findings import findings_of
from unit.planting.build import two_arms


def text_of(result) -> str:
    return " ".join(" ".join(answer.sentences) for answer in answers(result)).replace("\xa0", " ")


def test_shares_of_links_follow_from_masses_and_accelerations():
    findings = findings_of("yamashita-1")
    machine, motion = findings.machine, findings.analysis.motion
    pulls = {
        name: -machine.links[name].mass * center.acceleration_vector
        for name, center in motion.mass_centers.items()
    }
    whole = sum(pulls.values())
    by_link = shares(findings.analysis.forces.split.by_link("shaking_force"), motion)
    for name, pull in pulls.items():
        expected = np.vdot(whole, pull).real / np.vdot(whole, whole).real
        assert by_link[name] == pytest.approx(expected, rel=1e-9)
        assert f"{name} {100 * expected:.0f} %" in text_of(findings)
    assert sum(by_link.values()) == pytest.approx(1)


def test_parts_that_cancel_but_for_rounding_have_no_shares() -> None:
    turning, motion = np.exp(1j * np.arange(8)), move(eq.load("yamashita-1"), 8)
    parts = {"one": turning, "other": -turning * (1 + 1e-15)}
    assert shares(parts, motion) == {"one": 0.0, "other": 0.0}
    alone = shares({"one": turning, "other": 0 * turning}, motion)
    assert alone == {"one": pytest.approx(1), "other": 0.0}


def test_parts_that_mostly_cancel_are_said_to_stand_against_each_other() -> None:
    """Two walkers of 14 kg against two of 12: no share above 100 % or below 0 is left to read."""
    analysis = eq.analyze(eq.load("straw-walker"), 72)
    reported = SimpleNamespace(analysis=analysis, machine=analysis.machine)
    (why,) = (sentence for sentence in why_sentences(reported) if "taken away" in sentence)
    ahead, share, against = re.fullmatch(
        r".* from: (.*); of that (\d+) % is taken away again by (.*)\.", why
    ).groups()
    assert {*ahead.split(" and ")} == {"walker-1", "walker-4"}  # in either order, as equals
    assert {*against.split(" and ")} == {"walker-2", "walker-3"}
    assert int(share) == round(100 * 12 / 14)


def test_cycles_are_reported_of_drives_without_a_crank() -> None:
    """The file says how long a lift, a stop and a descent take together: 10 s."""
    findings = findings_of("hydraulic-loader")
    pace = next(iter(tiles(findings)))
    assert (pace.label, pace.value, pace.unit) == ("cycles", "6.00", "a minute")
    assert pace.note == "cylinder A to B"
    force = findings.analysis.forces.shaking_force.value
    sizes = np.abs(np.fft.fft(force)) ** 2
    each = sizes + np.roll(sizes[::-1], 1)  # both ways round
    loudest = 1 + int(np.argmax(each[1 : len(force) // 2]))
    assert loudest == 1
    text = f"comes once a cycle, at {brief(loudest / 10)} Hz."
    assert text in text_of(findings) and "a turn" not in text_of(findings)


def test_rows_shake_together_as_they_do_one_by_one():
    findings = findings_of("riding-transplanter")
    rows = findings.machine.rows
    theta = np.arange(360) * (2 * pi / 360)
    force = sum(
        eq.analyze(findings.machine, theta + row.phase).forces.shaking_force.value for row in rows
    )
    shaking = Shaking.of(findings)
    np.testing.assert_allclose(shaking.force, force, rtol=0, atol=1e-9 * np.max(np.abs(force)))
    orders = np.abs(np.fft.fft(force))[1:180] ** 2 + np.abs(np.fft.fft(force))[:180:-1] ** 2
    assert shaking.loudest == pytest.approx((1 + np.argmax(orders), np.max(orders) / sum(orders)))
    assert (
        f"the 4 rows together shake their frame with a force of up to {brief(max(abs(force)))} N"
        in (text_of(findings))
    )


def test_what_helps_most_is_what_balancing_finds():
    """What the gauge reads is told, and what it reads after."""
    findings = findings_of("riding-transplanter")
    text = text_of(findings)
    before, after = (
        eq.respond(machine).gauges["left_end"].displacement
        for machine in (findings.machine, findings.balanced.machine)
    )
    rms = [1e3 * float(np.std(item.samples(1440))) for item in (before, after)]
    assert f"Reading at left_end, RMS about the mean: {brief(rms[0])} → {brief(rms[1])} mm" in text
    sizes = [brief(1e3 * float(item.peak_to_peak)) for item in (before, after)]
    assert f"moves by {sizes[0]} mm peak to peak at 240 rpm, and by {sizes[1]} mm after" in text
    assert "In exchange" not in text


# Lines of what gets worse: `test_a_tool_s_hand_that_gets_worse_is_reported`.
@pytest.mark.exhaustive
def test_what_gets_worse_is_reported():
    """A weight on the driving shaft of a knife makes its bearing carry more; it is not offered."""
    heavy = eq.load("yamashita-rig-counterweight").with_balance(None)
    text = " ".join(benefit_sentences(advise(heavy)))
    assert "In exchange these become larger, frame and drive: shaking force y, peak, " in text
    advice = advise(eq.load("knife-drive").with_balance(None))
    tried = (item for item in advice.tried if item.changes[0].link == "shaft")
    weight = max(tried, key=lambda item: item.gain)
    assert "In exchange these become larger, joints: force in joint S, peak, " in " ".join(
        deterioration_sentences(weight)
    )
    assert not advice.helps


def test_without_masses_nothing_is_said_of_forces():
    findings = findings_of("drag-link")
    text = text_of(findings)
    assert (findings.analysis.solved is None) == ("masses of links are missing" in text)


@pytest.mark.exhaustive(but=["ja", "ko"])
@pytest.mark.parametrize("language", ["en", "ja", "ko"])
def test_no_placeholder_is_left(language):
    with speaking(language):
        text = text_of(findings_of("kim-chung-a"))
    assert not {"{", "}"} & set(text)


@pytest.mark.exhaustive(but=["2.0-Hills are 50.0 mm to 107 mm"])
@pytest.mark.parametrize(
    ("ahead", "hills"), [(pi, "Hills are 78.5 mm apart"), (2.0, "Hills are 50.0 mm to 107 mm")]
)
def test_every_arm_is_reported(ahead: float, hills: str):
    figures = eq.plant(two_arms(ahead))
    first, second, holes, fastest = planting_sentences(SimpleNamespace(planting=figures))
    for text, arm in ((first, figures.arms[0]), (second, figures.arms[1])):
        entry = np.degrees(arm["entry.crank_angle"])
        assert f"The tip {arm.tip} goes 30.0 mm into the soil" in text
        assert f"enters at a crank angle of {entry:.1f}" in text
    assert holes.startswith(hills) and "the holes at the surface are up to" in holes
    assert fastest.startswith("The tips move at up to")


@pytest.mark.parametrize(("speed", "broken"), [(240.0, True), (200.0, False)])
def test_limits_of_the_tip_are_said_to_be_kept_or_not(speed: float, broken: bool):
    """At the speed of the file, and at one that keeps them; accelerations grow with its square."""
    machine = eq.load("transplanter").with_drive(speed=speed * PER_RPM)
    (arm,) = (figures := eq.plant(machine)).arms
    reported = SimpleNamespace(planting=figures)
    (sentence,) = (item for item in planting_sentences(reported) if "limit" in item)
    highest = speed * np.sqrt(150.0 / arm["max_acceleration.value"])
    assert sentence.startswith(
        f"Largest acceleration of the tip, {brief(arm['max_acceleration.value'])}"
    )
    assert "limit of 150" in sentence and f"up to {brief(highest)} rpm" in sentence
    assert ("is over its limit" in sentence) is broken
    assert [*broken_limits(reported)] == ([sentence] if broken else [])


def test_limits_of_several_tips_name_them():
    figures = eq.plant(two_arms(acceleration_limit=1.0))
    sentences = [*broken_limits(SimpleNamespace(planting=figures))]
    assert [text.partition(":")[0] for text in sentences] == [
        f"Tip {arm.tip}" for arm in figures.arms
    ]


def test_a_support_turns_where_its_gauge_does():
    """What reads an angle is not said to move."""
    reported = SimpleNamespace(
        response=eq.respond(eq.load("riding-transplanter")), after=None, sweep=None
    )
    verbs = {
        sentence.partition(":")[0]: "support turns" in sentence
        for sentence in vibration_sentences(reported)
    }
    assert [*verbs.values()] == [False, False, True, True]


def test_numbers_are_set_as_in_print():
    shown = printed("-0.01235 to 1.000e-09 m/s^2, a-1 and 2026-11-22, (-1, -2)")
    assert shown == "\u22120.01235 to 1.000×10⁻⁹ m/s², a-1 and 2026-11-22, (\u22121, \u22122)"
    text = "2.22 N m and 4 rows, ratio in N m s/rad, (5.4 g mm) at (1, 2) mm, 7 milestones, 3 %"
    assert printed(text) == (
        "2.22\xa0N\xa0m and 4 rows, ratio in N\xa0m s/rad, (5.4\xa0g\xa0mm) at (1, 2)\xa0mm, "
        "7 milestones, 3\xa0%"
    )


def test_where_balancing_brings_nothing_that_is_said_and_not_drawn():
    findings = findings_of("slider-crank-engine")
    before, after = next(iter(findings.balanced.objectives.values()))
    assert after == before
    text = text_of(findings)
    assert (
        "No counterweight that fits reduces what is large here: drive torque, peak to peak." in text
    )
    assert "add a counterweight" not in text
    assert [*tiles(findings)][-1].note == "leave the masses as they are"
    assert "balance" not in {picture.section for picture in pictures(findings)}


def test_a_remedy_that_makes_something_far_worse_is_reported_and_not_recommended():
    findings = findings_of("class-three")
    assert not findings.helped and findings.after is None
    text = text_of(findings)
    assert "Leave the masses as they are: the best change within the assumed space" in text
    assert "shaking moment, peak, from 1.62 to 3.54 N m" in text and " would grow." in text
    assert "add a counterweight" not in text
    assert [*tiles(findings)][-1].value == "0"


# Rows: `test_rows_shake_together_as_they_do_one_by_one`.
@pytest.mark.exhaustive
def test_rows_are_not_warned_of_a_counterweight():
    findings = findings_of("walking-transplanter")
    text = " ".join(str(block) for block in balance_blocks(findings))
    assert "other phases of the rows" in text and "add a counterweight" not in text
    rolls = findings.balanced.after["rows.roll_moment.peak"]
    rolls = findings.balanced.after["rows.roll_moment.rms"]
    assert f"roll moment, RMS, from 0 to {brief(rolls)} N m" in text_of(findings)


def test_a_mass_that_is_large_beside_the_links_is_reported():
    findings = findings_of("balance-crank")
    added = findings.balanced.after["mass"] - findings.balanced.before["mass"]
    assert f"have {brief(findings.machine.mass)} kg, and {brief(added)} kg are added" in text_of(
        findings
    )


def test_rounding_has_no_crank_angle():
    findings = findings_of("planetary-planting-arm")
    moment = next(tile for tile in tiles(findings) if "moment" in tile.label)
    assert (moment.value, moment.note) == ("0", "")
    weight = AddedMass("carrier", "A", Weight("any", 0.05, at_most=0.2))
    plan = Balance(masses=(weight,), objectives=(Objective("shaking_force"),))
    blocks = outcome_blocks(eq.balance(findings.machine, plan))
    rows = [row for table in blocks if isinstance(table, Table) for row in grid(table).rows]
    area = [
        row for row in rows if row[0].text.startswith("shaking moment, area") and len(row) == 4
    ][-1]
    assert [cell.text for cell in area[1:]] == ["0", "0", ""]


def test_notes_are_said_in_the_language_of_the_reader():
    note = Note("{name} has no contact at rest and is ignored", name="float")
    assert str(note) == "float has no contact at rest and is ignored"
    with speaking("ko"):
        assert noted(note).startswith("참고: float: 정지")
        assert noted("the moon is full") == "참고(원문): the moon is full"


def test_a_tool_s_hand_that_gets_worse_is_reported():
    """Beside the gain of the hand that felt most; a gain is not."""
    result = copy(findings_of("brush-cutter"))  # which is given other designs
    design = result.design
    first, *others = design.figures
    kept = [replace(other, after=0.9 * other.before) for other in others]
    assert "larger" not in " ".join(of_tool(result, replace(design, figures=(first, *kept))))
    worse = replace(kept[0], before=2.0, after=2.03)
    reported = of_tool(result, replace(design, figures=(first, worse, *kept[1:])))
    assert reported[-1].startswith("In exchange these become larger, hands and holders: ")
    assert reported[-1].endswith(" 2.00 → 2.03 m/s² (+1.5 %).")


def of_tool(result, design):
    """What helps most by a design of a tool."""
    result.__dict__["design"] = design
    (helps,) = (answer for answer in tool_answers(result) if answer.question == "What helps most")
    return helps.sentences


# Lines of what gets worse: `test_a_tool_s_hand_that_gets_worse_is_reported`.
@pytest.mark.exhaustive
def test_what_gets_worse_stands_out_in_the_report():
    """A tile whose figure is larger after; and sentences, once, in the summary."""
    machine = eq.load("yamashita-rig-counterweight").with_balance(None)
    findings = Findings(machine, dumps(machine), "rig.toml")
    assert findings.balanced is not None and findings.helped
    (helps,) = (answer for answer in answers(findings) if answer.question == "What helps most")
    assert helps.worse and set(helps.worse) <= set(helps.sentences)
    html = report_page(findings)
    assert html.count('<p class="strong">') == len(helps.worse)
    forces = {name: [abs(eq.analyze(each).summary[name].peak) for each in
                     (machine, findings.balanced.machine)]
              for name in ("shaking_moment", "drive_torque")}  # fmt: skip
    shown = {tile.label: tile for tile in tiles(findings)}
    for name, (before, after) in forces.items():
        (tile,) = (value for label, value in shown.items() if name.replace("_", " ") in label)
        assert (tile.emphasis == "worse") == (after > 1.01 * before)
