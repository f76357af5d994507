"""What the summary says, held to the same found another way."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.report.findings import find
from equipoise.report.numbers import brief, change, kept_together, number
from equipoise.report.shaking import Shaking, shares
from equipoise.report.summary import answers
from equipoise.words import speaking


def text_of(found) -> str:
    return " ".join(" ".join(answer.sentences) for answer in answers(found)).replace("\xa0", " ")


def test_shares_of_links_follow_from_masses_and_accelerations():
    found = find("yamashita-1")
    machine, motion = found.machine, found.analysis.motion
    pulls = {
        name: -machine.links[name].mass * center.acceleration_vector
        for name, center in motion.mass_centers.items()
    }
    whole = sum(pulls.values())
    by_link = shares(found.analysis.forces.split.by_link("shaking_force"))
    for name, pull in pulls.items():
        expected = np.vdot(whole, pull).real / np.vdot(whole, whole).real
        assert by_link[name] == pytest.approx(expected, rel=1e-9)
        assert f"{name} {100 * expected:.0f} %" in text_of(found)
    assert sum(by_link.values()) == pytest.approx(1)


def test_rows_shake_together_as_they_do_one_by_one():
    found = find("riding-transplanter")
    rows = found.machine.rows
    theta = np.arange(720) * (2 * pi / 720)
    force = sum(
        eq.analyze(found.machine, theta + row.phase).forces.shaking_force.value for row in rows
    )
    shaking = Shaking.of(found)
    np.testing.assert_allclose(shaking.force, force, rtol=0, atol=1e-9 * np.max(np.abs(force)))
    orders = np.abs(np.fft.fft(force))[1:360] ** 2 + np.abs(np.fft.fft(force))[:360:-1] ** 2
    assert shaking.loudest == pytest.approx((1 + np.argmax(orders), np.max(orders) / sum(orders)))
    assert (
        f"the 4 rows together shake their frame with a force of up to {brief(max(abs(force)))} N"
        in (text_of(found))
    )


def test_what_helps_most_is_what_balancing_finds():
    found = find("yamashita-rig-counterweight")
    told = text_of(found)
    better = eq.analyze(found.balanced.machine).forces.shaking_force.value
    rms = float(np.sqrt(np.mean(np.abs(better) ** 2)))
    assert f"to {brief(rms)} N" in told
    gauge = found.response.gauges["gauge"].displacement.peak_to_peak
    assert f"moves by {brief(1e3 * float(gauge))} mm peak to peak at 193 rpm" in told


def test_without_masses_nothing_is_said_of_forces():
    found = find("drag-link")
    told = text_of(found)
    assert (found.analysis.solved is None) == ("masses of links are missing" in told)


@pytest.mark.parametrize("language", ["en", "ja", "ko"])
def test_no_placeholder_is_left(language):
    with speaking(language):
        told = text_of(find("kim-chung-a"))
    assert not {"{", "}"} & set(told)


def test_numbers_are_short_and_rounding_is_nothing():
    assert [number(x) for x in (0.0, 12.345, -0.01234567, 1e-9, 2e7)] == [
        "0", "12.35", "−0.01235", "1.000e−09", "2.000e+07",
    ]  # fmt: skip
    assert number(1e-12, 1e3) == "0"
    assert [change(2.0, 1.0), change(2.0, 2.0001), change(0.0, 1.0)] == ["−50.0 %", "±0 %", ""]
    assert kept_together("2.22 N m and 4 rows") == "2.22\xa0N m and 4 rows"
