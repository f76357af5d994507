"""`equipoise tolerance` as a user runs it."""

from __future__ import annotations

import json
import re

import pytest

import equipoise as eq
from equipoise.schema.study_units import units_of
from equipoise.studies.blocks import named_together
from surface.running import equipoise, succeeded, unfolded
from surface.studies import TOLERANCES, written


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory, with_progress: None) -> str:
    """What is printed of the study."""
    path = tmp_path_factory.mktemp("shown") / "study.toml"
    path.write_text(TOLERANCES, encoding="utf-8")
    result = equipoise("tolerance", path)
    assert re.fullmatch(r"\d+ designs computed in .* s, .* designs/s", result.err.splitlines()[-1])
    return succeeded(result)


def test_json_is_what_python_has() -> None:
    study = written(TOLERANCES)
    result = equipoise("tolerance", study, "--json")
    assert result.out.count("\n") == 1
    content = json.loads(succeeded(result))
    own = eq.studies.tolerance(eq.schema.load_study(study)).to_dict()
    assert content["within"] == own["within"]
    assert content["tighten"] == own["tighten"]
    assert content["outputs"]["vertical"]["percentiles"] == pytest.approx(
        own["outputs"]["vertical"]["percentiles"]
    )


def test_figures_in_the_units_of_the_files(shown: str) -> None:
    own = eq.studies.tolerance(eq.schema.load_study(written(TOLERANCES)))
    first = own.scatters["vertical"]
    row = next(line for line in shown.splitlines() if re.match(r"vertical, N +\d", line))
    model, mean, deviation = map(float, row.split()[2:5])
    assert (model, mean) == pytest.approx((first.base, first.mean), rel=1e-3)
    assert deviation == pytest.approx(first.deviation, rel=1e-3)
    assert own.within is not None
    assert f"\n{100 * own.within.value:.2f} % (" in shown
    mass = r"^mass \+ inertia of the coupler +deviation 15.00 g, cut at 3; deviation "
    assert re.search(mass, shown, re.MULTILINE)
    assert re.search(r"^centre of mass of the coupler, x +\+- 2.000 mm ", shown, re.MULTILINE)


def test_what_to_tighten_first(shown: str) -> None:
    """Mass and inertia go together, so that they are one cause."""
    own = eq.studies.tolerance(eq.schema.load_study(written(TOLERANCES)))
    first = own.causes[0]
    sentence = unfolded(shown)[unfolded(shown).index("Tighten first: ") :]
    units = units_of(own.study)
    assert sentence.startswith(f"Tighten first: {named_together(first.numbers, units)}")
    assert f"reduces the variance of vertical by {100 * first.gain:.0f} %" in sentence
    ranked = [named_together(cause.numbers, units) for cause in own.causes]
    ranked = [words.replace("–", "-") for words in ranked]  # which is all that some terminals have
    lines = shown.replace("–", "-").splitlines()  # the ends of long cells stand in the next ones
    starts = [words for line in lines for words in ranked if line.startswith(words[:12])]
    assert starts == len(starts) // len(ranked) * ranked and len(starts) >= 2 * len(ranked)
    assert ("links.coupler.mass", "links.coupler.inertia") in [item.numbers for item in own.causes]


def test_without_limits() -> None:
    shown = succeeded(equipoise("tolerance", written(TOLERANCES, ('at_most = "23.5 N"', ""))))
    assert "Limits" not in shown
    assert "within all limits" not in shown
    assert re.search(
        r" Tighten first: .* reduces the variance of vertical by \d+ %\.$", unfolded(shown)
    )


def test_a_limit_that_the_model_does_not_keep() -> None:
    shown = succeeded(equipoise("tolerance", written(TOLERANCES, ("23.5 N", "20 N"))))
    assert "\n0.00 % (" in shown
    assert "the share of machines within all limits hardly changes" in shown
    assert (
        "note: the model itself is outside the limits of vertical; change its numbers first"
    ) in shown


def test_fewer_machines() -> None:
    study = written(TOLERANCES)
    shown = succeeded(equipoise("tolerance", study, "--designs", "512"))
    assert "\n512 machines drawn, seed 1\n" in shown


# Bundled studies are checked, and other tolerances computed, on every change.
@pytest.mark.exhaustive
def test_a_bundled_study() -> None:
    shown = succeeded(equipoise("tolerance", "study-of-tolerances", "--designs", "1024"))
    assert "Tighten first: " in shown
    assert not re.search(r"\b(nan|inf)\b|-0\.0 ", shown)
