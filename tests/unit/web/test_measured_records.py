"""Records that are dropped on the page, beside the model's own signals."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from unit.web.pages import ask, edit, opened, refusal, state

NAME = "shaking_force.y"


def model():
    whole = eq.analyze(eq.load("yamashita-1"))
    return whole, whole.outputs[NAME].values


def written(*columns):
    """A CSV file of columns: header and values each."""
    rows = zip(*(values for _, values in columns), strict=True)
    lines = [",".join(f"{value:.9g}" for value in row) for row in rows]
    return "\n".join([",".join(head for head, _ in columns), *lines])


def dropped(text, session=None):
    session = session or opened("yamashita-1")[0]
    return state(ask(session, "record", name="run.csv", text=text)[0])


def test_a_record_over_the_crank_angle_stands_beside_the_model_in_si_units() -> None:
    whole, values = model()
    some = slice(0, None, 5)
    text = written(
        ("crank_angle [deg]", np.degrees(whole.crank_angle[some])),
        (f"{NAME} [kN]", 0.9e-3 * values[some]),
        ("transmission angle at C [deg]", np.degrees(whole.motion.transmission["C"][some])),
        ("operator", np.ones(72)),
    )
    session, _ = opened("yamashita-1")
    shown = dropped(text, session)
    sent = shown.array(f"measured.{NAME}")
    np.testing.assert_allclose(sent, 0.9 * values, atol=0.02 * np.max(np.abs(values)))
    assert "output.transmission.C" in shown.content["arrays"]  # so that both are drawn
    record = shown.content["record"]
    assert record["name"] == "run.csv" and record["left_out"] == ["operator"]
    (force, angle) = record["lines"]
    rms = np.sqrt(np.mean(values**2))
    assert force.startswith("shaking force y: RMS measured ")
    assert f"model {rms:.4g} N" in force and "transmission angle at C" in angle
    moved = edit(session, {"set": "links.crank.mass", "text": "0.3 kg"})
    np.testing.assert_array_equal(moved.array(f"measured.{NAME}"), sent)
    gone = state(ask(session, "record", name="", text="")[0]).content
    assert gone["record"] is None and f"measured.{NAME}" not in gone["arrays"]


def test_a_record_over_time_is_the_mean_of_its_turns_where_it_fits_best() -> None:
    whole, values = model()
    speed = whole.machine.drive.speed
    time = np.arange(0.0, 1.5, 0.001)  # almost five turns
    late = np.radians(50)
    clean = np.interp(speed * time - late, whole.crank_angle, values, period=2 * np.pi)
    noise = np.random.default_rng(3).normal(0, 0.5, len(time))
    shown = dropped(written(("time [s]", time), (f"{NAME} [N]", clean + noise)))
    sent = shown.array(f"measured.{NAME}")
    assert np.sqrt(np.mean((sent - values) ** 2)) < 0.6
    last = shown.content["record"]["lines"][-1]
    assert last == "moved by \N{MINUS SIGN}50° to where it fits best"


def test_what_was_not_measured_is_a_gap() -> None:
    whole, values = model()
    part = slice(100, 300)
    columns = (("crank_angle [rad]", whole.crank_angle[part]), (f"{NAME} [N]", values[part]))
    sent = dropped(written(*columns)).array(f"measured.{NAME}")
    assert np.all(np.isfinite(sent[100:300]))
    assert np.all(np.isnan(sent[320:700]))


def test_what_a_gauge_reads_stands_beside_its_response() -> None:
    session, _ = opened("yamashita-rig")
    samples = eq.respond(eq.load("yamashita-rig")).gauges["gauge"].displacement.samples(360)
    text = written(("crank_angle [deg]", np.arange(360.0)), ("gauge [mm]", 1e3 * samples))
    sent = dropped(text, session).array("measured.gauges.gauge")
    np.testing.assert_allclose(sent, samples, atol=0.02 * np.max(np.abs(samples)))


ROWS = "\n".join(f"{k},{k}" for k in range(20))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", None),
        ("\n", "run.csv, line 1: "),
        (f"place [m],{NAME} [N]\n{ROWS}", "run.csv, line 1: got 'place [m]'; the header is"),
        (f"time [mm],{NAME} [N]\n{ROWS}", "run.csv, line 1: got 'time [mm]'; the header is"),
        (f"time [s],{NAME} [mm]\n{ROWS}", f"column {NAME}: got another unit; give one such as N"),
        (f"time [s],{NAME} [oxen]\n{ROWS}", "got the unit 'oxen'"),
        (f"time [s],wind [m/s]\n{ROWS}", "no column is an output of this machine"),
        (f"time [s],{NAME} [N]\n0,1\n1,2", "there are 2 rows below the header"),
        (f"time [s],{NAME} [N]\n0,1,2\n{ROWS}", "line 2: got 3 values; the header has 2 columns"),
        (f"time [s],{NAME} [N]\n0,x\n{ROWS}", f"line 2, column {NAME}: got 'x'; give a number"),
    ],
)
def test_what_is_no_record_is_reported_in_one_sentence(text, said) -> None:
    session, _ = opened("yamashita-1")
    replies = ask(session, "record", name="run.csv", text=text)
    assert said is None or said in refusal(replies)
    assert session.view_state.record is None
