"""`--units` of every command, `units` of a file, and numbers that can be read at any size."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.balancing import linear_conditions
from equipoise.cli.tools import tools
from equipoise.quantities import parse, showing
from surface.running import cells, changed, equipoise, read, refused, succeeded

pytestmark = pytest.mark.usefixtures("folder")

PUMP = """
schema = 1
title = "Pump-jack"
drive = { link = "crank", speed = "10 rpm" }
[frame]
points = { A = ["0 m", "0 m"], D = ["3 m", "3 m"] }
[links.crank]
mass = "1437 kg"
center_of_mass = ["-0.6 m", "0 m"]
inertia = "900 kg m^2"
points = { A = ["0 m", "0 m"], B = ["0.9 m", "0 m"] }
[links.pitman]
mass = "300 kg"
center_of_mass = ["1.6 m", "0 m"]
inertia = "260 kg m^2"
points = { B = ["0 m", "0 m"], C = ["3.2 m", "0 m"] }
[links.beam]
mass = "1400 kg"
center_of_mass = ["0 m", "0 m"]
inertia = "2900 kg m^2"
points = { D = ["0 m", "0 m"], C = ["-2.5 m", "0 m"], H = ["2.5 m", "0 m"] }
[assembly]
C = "left"
[[loads]]
link = "beam"
point = "H"
force = ["0 N", "-30 kN"]
[support]
mass = "12 t"
center_of_mass = ["1.5 m", "0.5 m"]
inertia = "9000 kg m^2"
freedoms = ["heave", "pitch"]
[support.mounts.left]
point = ["0 m", "-1 m"]
stiffness = "4000 kN/m"
damping = "20 kN s/m"
[support.mounts.right]
point = ["4 m", "-1 m"]
stiffness = "4000 kN/m"
damping = "20 kN s/m"
[support.gauges.floor]
point = ["0 m", "0 m"]
"""
LINKAGE = [
    ("check",),
    ("analyze",),
    ("analyze", "--full"),
    ("analyze", "--orders", "2"),
    ("modes",),
    ("respond",),
    ("respond", "--full"),
    ("respond", "--speed", "5 rpm : 40 rpm", "--speeds", "5", "--full"),
    ("simulate", "0.5 s"),
    ("balance", "--crank-counterweight", "--objective", "shaking_force"),
    ("balance", "--crank-counterweight", "--objective", "shaking_force", "--full"),
    ("balance conditions",),
    ("balance sensitivities", "shaking_force.y"),
    ("balance arrangements", "2"),
]
"""Commands that print tables of a linkage on a support."""
COARSE = re.compile(r"-?\d\.?\d*e\+\d+")
ROUNDING = re.compile(r"-?\d\.?\d*e-(?:0[7-9]|[1-9]\d)")


def printed(words: tuple[str, ...], file: str, *more: str) -> str:
    return succeeded(equipoise(*words[0].split(), file, *words[1:], *more))


def pump(to: str = "pump.toml", units: str = "") -> str:
    Path(to).write_text(PUMP.replace("[frame]", f"{units}\n[frame]", 1), encoding="utf-8")
    return to


@pytest.mark.exhaustive(but=["analyze", "respond", "modes", "check"])
@pytest.mark.parametrize("words", LINKAGE, ids=" ".join)
def test_a_pump_jack_is_reported_in_numbers_that_can_be_read(words: tuple[str, ...]) -> None:
    text = printed(words, pump())
    assert COARSE.findall(text) == []
    # but for what a proof leaves, and shares of a motion that has died away
    assert [match for match in ROUNDING.findall(text) if "more than" not in text] == []


# Tables of a terminal have the same numbers.
@pytest.mark.exhaustive
def test_masses_of_a_pump_jack_in_its_report() -> None:
    succeeded(equipoise("report", pump(), "--out", "pump.html"))
    page = Path("pump.html").read_text(encoding="utf-8")
    links = page[page.index("Links; places") :][:3000]
    assert "1437" in links and "kg" in links and "10⁶" not in links


def test_a_machine_of_micrometres() -> None:
    text = PUMP.split("[[loads]]", maxsplit=1)[0]
    sizes = {" kg m^2": (" g mm^2", 1e-15), " kg": (" mg", 1e-9), " m": (" um", 3.0)}

    def smaller(result: re.Match[str]) -> str:
        unit, factor = sizes[result[2]]
        return f'"{float(result[1]) * factor:.6g}{unit}"'

    text = re.sub(r'"([-\d.]+)( kg m\^2| kg| m)"', smaller, text).replace("10 rpm", "6000 rpm")
    Path("micro.toml").write_text(text, encoding="utf-8")
    reported = succeeded(equipoise("analyze", "--full", "micro.toml"))
    # what shakes weighs some ng; forces are some pN, lengths some um
    assert re.search(r"crank +crank +A, B +0\.002700$", reported, re.MULTILINE)
    assert re.search(r"shaking force x, nN", reported) and "-0" not in cells(
        reported, "shaking force x"
    )


@pytest.mark.exhaustive(but=["analyze", "respond", "modes", "check", "balance conditions"])
@pytest.mark.parametrize("words", LINKAGE, ids=" ".join)
def test_every_table_follows_the_units_that_are_asked_for(words: tuple[str, ...]) -> None:
    asked = "length=in, force=lbf, mass=lb, angle=rad"
    text = printed(words, pump(), "--units", asked)
    lines = [line for line in text.splitlines() if not line.startswith("note:")]
    rest = re.sub(r"rad/s(\^2)?|in m beside", "", "\n".join(lines))
    assert re.findall(r"(?<=[\s,(])(?:mm|cm|m|g|kg|t|N|kN|N m|kN m|deg)(?=[\s,);]|$)", rest) == []
    # the file asks for the same
    units = 'units = { length = "in", force = "lbf", mass = "lb", angle = "rad" }'
    Path("asking").mkdir()
    assert printed(words, pump("asking/pump.toml", units)) == text
    assert printed(words, "asking/pump.toml", "--units", "mm, N, kg, deg, N m, kg m^2") != text


# Units of every quantity: tests/unit/quantities.
@pytest.mark.exhaustive
def test_the_same_value_whatever_its_unit() -> None:
    rows = {
        unit: cells(
            succeeded(equipoise("analyze", "--full", pump(), "--units", f"force={unit}")), label
        )
        for unit in ("N", "kN", "lbf", "kgf")
        for label in ("shaking force y",)
    }
    newtons = [
        [float(cell) * parse(f"1 {unit}", "force") for cell in row[::2][:2]]
        for unit, row in rows.items()
    ]
    for result in newtons[1:]:
        assert result == pytest.approx(newtons[0], rel=6e-4, abs=1e-9)
    assert read("analyze", pump(), "--units", "lbf") == read("analyze", pump())


def test_csv_stays_in_si_units_and_names_them() -> None:
    succeeded(equipoise("analyze", "--full", pump(), "--csv", "a.csv"))
    succeeded(equipoise("analyze", "--full", pump(), "--units", "in, lbf", "--csv", "b.csv"))
    assert Path("a.csv").read_text("utf-8") == Path("b.csv").read_text("utf-8")
    assert "shaking_force.x [N]" in Path("b.csv").read_text("utf-8").splitlines()[0]


# Tables and notebooks follow on every change.
@pytest.mark.exhaustive
def test_axes_of_pictures_and_reports_follow() -> None:
    file = pump(units='units = { length = "ft", force = "lbf" }')
    succeeded(equipoise("plot", file, "--only", "force", "--out", "own"))
    succeeded(equipoise("plot", file, "--only", "force", "--out", "asked", "--units", "kgf"))
    assert "lbf" in Path("own/force.svg").read_text("utf-8")
    assert "kgf" in Path("asked/force.svg").read_text("utf-8")
    succeeded(equipoise("report", file, "--out", "own.html", "--language", "ja"))
    page = re.sub(
        r"<pre.*?</pre>|<svg.*?</svg>", "", Path("own.html").read_text("utf-8"), flags=re.S
    )
    assert "lbf ft" in page.replace("\N{NO-BREAK SPACE}", " ") and "kN" not in page
    # in the file of a machine that is written, units of the file come first
    machine = eq.load(file).with_link("crank", points={"A": (0, 0), "B": (0.9144, 0)})
    assert (
        'points.B = ["3 ft", "0 ft"]' in eq.dumps(machine)
        and eq.loads(eq.dumps(machine)) == machine
    )


def test_notebooks_and_printed_results_follow() -> None:
    analysis = eq.analyze(eq.load(pump(units='units = { force = "kgf" }')))
    assert "kgf" in analysis._repr_html_()
    with showing({"force": "lbf"}):
        assert "lbf" in analysis._repr_html_() and "kgf" not in analysis._repr_html_()


def test_tools_studies_and_records_follow() -> None:
    for words in (("check", "brush-cutter"), ("tool", "brush-cutter", "--modes", "--number", "2")):
        text = succeeded(equipoise(*words, "--units", "in, lb, lbf"))
        assert " in" in text and "mm" not in text and "kg" not in text
    study = succeeded(equipoise("check", "study-of-lengths", "--units", "in"))
    assert cells(study, "length A-B of the crank")[1:] == ["1.319", "1.181 to 1.457"]
    text = succeeded(equipoise("exposure", "7.4 m/s^2 for 2.5 h", "--units", "acceleration=ft/s^2"))
    assert "ft/s^2" in text


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ('units = { length = "inch" }', "units.length: got 'inch'; did you mean 'in'?"),
        (
            'units = { lenght = "in" }',
            "units.lenght: no key is called 'lenght'; did you mean 'length'?",
        ),
        ('units = "in"', "units: got 'in'"),
    ],
)
def test_wrong_units_of_a_file(given: str, sentence: str) -> None:
    refusal = refused(equipoise("analyze", pump(units=given)))
    assert refusal.startswith("pump.toml: ") and sentence in refusal


def test_wrong_units_of_the_command_line() -> None:
    assert "--units: got 'furlong'; choose among length: m" in refused(
        equipoise("modes", pump(), "--units", "furlong")
    )
    assert "--units: got 'kg' for length; length is shown in one of m" in refused(
        equipoise("best", "nowhere.zarr", "--units", "length=kg")
    )


def test_rounding_is_reported_as_nothing_in_harmonics() -> None:
    """Of a machine that is balanced in one direction, other harmonics are -6.9e-15."""
    for name in ("scotch-yoke", "planetary-planting-arm"):
        text = succeeded(equipoise("analyze", "--full", name, "--orders", "6"))
        assert ROUNDING.findall(text) == []


def test_a_json_object_knows_no_units() -> None:
    words = ("balance", "conditions", pump())
    assert json.loads(succeeded(equipoise(*words, "--json", "--units", "in"))) == read(*words)


def test_a_written_file_has_the_numbers_that_were_typed() -> None:
    file = changed("yamashita-1", ('"33.5 mm"', '"1.3 in"'))
    assert 'points.B = ["33.02 mm"' in eq.dumps(eq.load(file))


def test_conditions_are_computed_once_for_text_and_json(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Units are those of where they are read."""
    asked = list[str]()
    real = linear_conditions.conditions

    def conditions(machine: eq.Machine, kind: linear_conditions.Kind) -> object:
        asked.append(kind)
        return real(machine, kind)

    monkeypatch.setattr(linear_conditions, "conditions", conditions)
    given = {"file": pump(), "units": "in", "json": True}
    shown = tools()["balance_conditions"].answer({**given, "json": False}, Path.cwd())
    assert asked == ["zero", "sine"]
    assert "of crank / 35.433 in" in shown.text and "mm" not in shown.text
    values = tools()["balance_conditions"].answer(given, Path.cwd()).values
    assert "crank.moment_x / 900 mm" in values["zero"]["conditions"][0]["condition"]
