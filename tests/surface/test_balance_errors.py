"""What `equipoise balance` refuses: exit status 2, one sentence, and no results beside it."""

from __future__ import annotations

import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

from surface.running import command, equipoise, example_text, process, refused, succeeded
from surface.test_bad_input import heed_interrupts


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Every test runs in an empty folder of its own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


CRANK = ("yamashita-1", "--crank-counterweight")
UP = ("--objective", "shaking_force.y")
DISC = (*CRANK, *UP, "--shape", "disc")
GEARED = ("lee-kim-a", "--geared-counterweight", "rocker", "--objective", "shaking_energy")
PITCH = ("--pitch-radius", "50 mm")
BOTH = ("shaking_force.y", "shaking_force.x")


def asked(text: str) -> tuple[str, ...]:
    return (*CRANK, "--objective", text)


def limited(text: str) -> tuple[str, ...]:
    return (*CRANK, *UP, "--limit", text)


def front(*words: str) -> tuple[str, ...]:
    return ("trade-off", *CRANK, *words)


REFUSED: dict[str, tuple[tuple[str, ...], str]] = {
    # words, what is said
    "nothing free": (("yamashita-1", *UP), "nothing is free to change; give tables such as"),
    "no objective": (CRANK, "nothing is to become small; give [[balance.objectives]], or an opt"),
    "standing still": (("balance-crank", "--speed", "0 rpm"), "a crank that stands still shakes"),
    "speed": (("balance-crank", "--speed", "200"), "--speed: got '200'; the unit is missing"),
    "no file": (("nothing.toml",), "nothing.toml: there is no such file; give a path, or the name"),
    # what may change
    "link": (("yamashita-1", "--move-cm", "copler", *UP), "--move-cm: no link is called 'copler'; "
             "did you mean 'coupler'?"),
    "counterweight": (("yamashita-1", "--counterweight", "x", *UP), "--counterweight: no link is"),
    "twice": (("yamashita-1", "--move-cm", "coupler", "--move-cm", "coupler", *UP),
              "--move-cm: 'coupler' is given twice; give one of both"),
    "phases": (("yamashita-1", "--phases", *UP), "--phases: got 0 rows, which leaves no phase to"),
    "shape": ((*CRANK, *UP, "--shape", "cube"), 'Invalid value "cube" for --shape. Choose from'),
    "no thickness": ((*DISC, "--material", "steel"), "--thickness: missing; a disc is cut from"),
    "no material": ((*DISC, "--thickness", "5 mm"), "--material: missing; a disc is cut from a"),
    "material": ((*DISC, "--thickness", "5 mm", "--material", "stel"),
                 "--material: no material is called 'stel'; did you mean 'steel'?"),
    "material of a point": ((*CRANK, *UP, "--material", "steel"), "--material: goes with a disc"),
    "too heavy": ((*DISC, "--thickness", "5 mm", "--material", "steel", "--radius", "50 mm",
                   "--mass", "10 kg"), "--mass: a disc of 10000 g and 5 mm steel has a radius of "
                  "284.78 mm and does not fit into its room of 50 mm; make it thicker, or"),
    "radius": ((*CRANK, *UP, "--radius", "5 kg"), "--radius: got '5 kg'; kg is the unit of a mass"),
    "no radius": ((*CRANK, *UP, "--radius", "0 mm"), "--radius: got 0 m; give more than 0"),
    "mass": ((*CRANK, *UP, "--mass", "-2 g"), "--mass: got -0.002 kg; give more than 0"),
    "masses": ((*CRANK, *UP, "--mass", "1 g", "--at-most", "2 g"), "give either mass or at_most"),
    # gears
    "no pitch": (GEARED, "--geared-counterweight needs the pitch radius of the gear on its driver"),
    "coupler": (("lee-kim-a", "--geared-counterweight", "coupler", *PITCH, *UP),
                "--geared-counterweight: 'coupler' does not turn about a pin in the frame; those "),
    "crank": (("lee-kim-a", "--geared-counterweight", "crank", *PITCH, *UP),
              "--geared-counterweight: direction: missing; 'crank' turns about the drive's own"),
    "driver": (("lee-kim-a", "--geared-counterweight", "x", *PITCH, *UP),
               "--geared-counterweight: no link is called 'x'"),
    "ratio": ((*GEARED, *PITCH, "--ratio", "a"), "--ratio: got 'a'; give a number, or the least"),
    "ratios": ((*GEARED, *PITCH, "--ratio", "1,2,3"), "--ratio: got '1,2,3'; give a number, or"),
    "ratio 0": ((*GEARED, *PITCH, "--ratio", "0"), "--ratio: got 0; give a size above 0, the"),
    "ratio swapped": ((*GEARED, *PITCH, "--ratio", "2, 1"), "--ratio: got 2 to 1; give the smalle"),
    "ratio nan": ((*GEARED, *PITCH, "--ratio", "nan"), "--ratio: got nan; give a finite number"),
    "pitch": ((*GEARED, "--pitch-radius", "-5 mm"), "--pitch-radius: got -0.005 m; give more than"),
    # objectives
    "output": (asked("shaking_forces"), "--objective: no output is called 'shaking_forces'; did"),
    "measure": (asked("mean shaking_force.y"), "--objective: got 'mean shaking_force.y'; give suc"),
    "words": (asked("shaking_force y"), "--objective: got 'shaking_force y'; give such as"),
    "empty": (asked(""), "--objective: got ''; give such as"),
    "vector": (asked("ripple shaking_force"), "--objective: shaking_force is a vector, which has"),
    "about": (asked("shaking_moment about Q"), "--objective: about: no point of the frame is call"),
    "about what": (asked("shaking_moment about"), "--objective: got 'shaking_moment about'; give"),
    "about twice": (asked("shaking_moment about A about D"), "with about twice; give it once"),
    "about a force": (asked("shaking_force about A"), "--objective: about: goes with shaking_mome"),
    "orders": (asked("shaking_force.y orders one"), "--objective: got orders 'one'; give numbers:"),
    "order": (asked("shaking_force.y orders -1"), "--objective: orders: got -1; give 0 or more"),
    "order nan": (asked("shaking_force.y orders nan"), "orders: got nan; give a finite number"),
    "weight": (asked("shaking_force.y weight 0"), "--objective: weight: got 0; give more than 0"),
    "weights": (asked("shaking_force.y weight 1,2"), "got weight '1,2'; give one number: weight 2"),
    "speeds": (asked("shaking_force.y speeds 9 rpm"), "--objective: speeds: goes with gauges; oth"),
    "gauge": (asked("gauges.x"), "--objective: there is no gauge; give a support with gauges"),
    "which gauge": (("yamashita-rig", *CRANK[1:], "--objective", "gauges.x"), "no gauge is called"),
    "gauge's speed": (("yamashita-rig", *CRANK[1:], "--objective", "gauges.gauge speeds 100"),
                      "--objective: got '100'; the unit is missing; give an angular speed, such"),
    "joint": (asked("joints.Q"), "--objective: no joint is called 'Q'; there are 'A', 'D', 'B',"),
    "roll": (asked("roll_moment"), "--objective: roll_moment comes from linkages side by side; gi"),
    "no influence": (asked("shaking_moment"), "nothing that is free to change has an effect on the "
                     "rms of shaking_moment; free something else, or choose another objective"),
    # limits
    "no sign": (limited("peak joints.B 120 N"), "--limit: got 'peak joints.B 120 N'; give such as"),
    "the other sign": (limited("joints.B >= 120 N"), "--limit: got 'joints.B >= 120 N'; give such"),
    "half a limit": (limited("peak joints.B <="), "--limit: got 'peak joints.B <='; give such as"),
    "other half": (limited("<= 5 N"), "--limit: got '<= 5 N'; give such as"),
    "limit's unit": (limited("joints.A <= 5 mm"), "--limit: got '5 mm'; mm is the unit of a lengt"),
    "area": (limited("area shaking_force.x <= 1 N"), "--limit: there is no unit for the area unde"),
    "negative": (limited("joints.A <= -5 N"), "--limit: got -5 in SI units; give more than 0"),
    "no share": (limited("joints.A <= 0 %"), "--limit: got 0 %; give more than 0"),
    "shares": (limited("joints.A <= 9 % %"), "--limit: got '9 % %'; give a number, a space and %"),
    "limit's output": (limited("joint.A <= 9 %"), "--limit: no output is called 'joint.A'; did yo"),
    "added": (limited("added_mass <= 5 %"), "--limit: got '5 %'; there is no unit '%' here; a mas"),
    "no mass": (limited("added_mass <= 0 g"), "--limit: got 0 kg; give more than 0"),
    "cannot be met": (limited("shaking_force.x <= 30 %"), "this limit cannot be met: rms of shaking"
                      "_force.x at most 30 % of before; rms of shaking_force.x can become 2.808 N"),
    "clash": ((*limited("shaking_force.x <= 70 %"), "--limit", "added_mass <= 10 g"),
              "these limits clash: radius on crank, added mass at most 10 g and rms of shaking_for"
              "ce.x at most 70 % of before; rms of shaking_force.x can become 8.626 N at the least "
              "while the others are kept"),
    "given mass": ((*limited("added_mass <= 100 g"), "--mass", "500 g"),
                   "this limit cannot be met: added mass at most 100 g; allow more of it"),
    "phases and limits": (("four-row-transplanter", "--limit", "joints.B <= 5 N"),
                          "limits are not kept while phases are looked for; leave one of them out"),
    # trade-offs and other questions
    "against itself": (front("shaking_force.y", "rms shaking_force.y"), "rms of shaking_force.y "
                       "cannot be traded against itself; give another objective"),
    "one point": (front(*BOTH, "--points", "1"), "--points: got '1'; give a whole number from 2"),
    "many points": (front(*BOTH, "--points", "501"), "--points: got '501'; give a whole number"),
    "no points": (front(*BOTH, "--points", "x"), "--points: got 'x'; give a whole number from 2"),
    "half a front": (front("shaking_force.y"), "parameter SECOND requires an argument"),
    "wrong front": (front("shaking_force.y", "x"), "no output is called 'x'"),
    "no objective's words": (front("shaking_force.y", "a b"), "SECOND: got 'a b'; give such as"),
    "front of phases": (("trade-off", "four-row-transplanter", *BOTH), "a front is not drawn over "
                        "phases; lea"),
    "front of nothing": (("trade-off", "yamashita-1", *BOTH), "nothing is free to change; give"),
    "front's file": (front(*BOTH, "-o", "x.toml"), "Unknown option: -o."),
    "conditions' weight": (("conditions", *CRANK), "Unknown option: --crank-counterweight."),
    "sensitivity": (("sensitivities", "yamashita-1", "joints.B"), "OUTPUT: no output of this kind "
                    "is called 'joints.B'; there are 'shaking_force.x', 'shaking_force."),
    "crank zero": (("sensitivities", "yamashita-1", "drive_torque", "--crank-zero", "5"),
                   "--crank-zero: got '5'; the unit is missing; give an angle"),
    "still": (("sensitivities", "yamashita-1", "drive_torque", "--speed", "0 rpm"),
              "a crank that stands still shakes nothing; give the drive a speed"),
    "one row": (("arrangements", "yamashita-1", "1"), "ROWS: got '1'; give a whole number from 2"),
    "many rows": (("arrangements", "yamashita-1", "65"), "give a whole number from 2 to 64"),
    "spacing": (("arrangements", "yamashita-1", "4", "--spacing", "0 mm"), "--spacing: got '0 m"),
    "no spacing": (("arrangements", "yamashita-1", "4", "--spacing", ""), "--spacing: got ''; g"),
    # options without their owner
    **{
        option: (("yamashita-1", option, value, *UP), f"{option} belongs to {owner}; give both")
        for option, value, owner in (
            ("--shape", "disc", "a counterweight"),
            ("--radius", "5 mm", "a counterweight"),
            ("--mass", "5 g", "a counterweight"),
            ("--at-most", "5 g", "a counterweight"),
            ("--thickness", "5 mm", "a counterweight"),
            ("--material", "steel", "a counterweight"),
            ("--ratio", "1", "--geared-counterweight"),
            ("--pitch-radius", "5 mm", "--geared-counterweight"),
            ("--format", "png", "--plot"),
        )
    },
    # files
    "no folder": (("balance-crank", "-o", "no/x.toml"), "no/x.toml: there is no such folder; make"),
    "empty name": (("balance-crank", "-o", ""), "--out: got an empty name; give the name of a fil"),
    "folder": (("balance-crank", "-o", "."), "--out: . is a directory; give the name of a file"),
    "same file": (("balance-crank", "-o", "x", "--csv", "x"), "--csv: x has another part in this"),
    "no csv": (("balance-crank", "--csv", "no/x.csv"), "no/x.csv: there is no such folder; make i"),
}  # fmt: skip


@pytest.mark.parametrize(("words", "said"), REFUSED.values(), ids=REFUSED)
def test_refused(words: tuple[str, ...], said: str) -> None:
    assert said in refused(equipoise("balance", *words))
    assert list(Path().iterdir()) == []


RATIO = "ratio = [0.2, 3]"
PAIR = f'{RATIO}\npitch_radius = "50 mm"'
POINT = 'shape = "point"\nmass = "1145 g"'
SECOND = """[[balance.geared]]
driver = "rocker"
ratio = 1
pitch_radius = "30 mm"
radius = "30 mm"
name = "second"

[[balance.objectives]]"""

MACHINES = {
    # example, what is replaced, by what, what is said
    "into a link": ("balance-geared-a", RATIO,
                    'ratio = 1\ndirection = "180 deg"\nclear_of = ["coupler"]',
                    "the counterweight would run into coupler, which comes within "),
    "into no link": ("balance-geared-a", RATIO, 'ratio = 1\nclear_of = ["copler"]',
                     "model.toml: balance.geared[1].clear_of[1]: no link is called 'copler'"),
    "gears apart": ("balance-geared-a", PAIR, 'teeth = [20, 22]\nmodule = "2 mm"\n'
                    'axis = ["200 mm", "0 mm"]', "model.toml: balance.geared[1].axis: lies 134 mm "
                    "from the driver's pin 'O4'; two gears with these teeth are 40 mm to 44 mm ap"),
    "gears that do not mesh": ("balance-geared-a", PAIR, 'teeth = [20, 22]\nmodule = "2 mm"\n'
                               'axis = ["107.3 mm", "0 mm"]', "the gears of the counterweight do "
                               "not mesh: shafts 41.3 mm apart need 41.3 teeth of module 2 mm"),
    "no way back": ("balance-geared-a", f'driver = "rocker"\n{RATIO}',
                    'driver = "crank"\ndirection = "180 deg"\nratio = [0.1, 0.3]',
                    "has no ratio from 0.1 to 0.3 that brings it back within 3 turns; give anoth"),
    "taken": ("balance-geared-a", RATIO, 'ratio = 1\nname = "rocker"', "model.toml: balance.geared"
              "[1].name: 'rocker' is taken already; give another name"),
    "two scans": ("balance-geared-a", "[[balance.objectives]]", SECOND, "only the last of "
                  "[[balance.geared]] may have several ratios; give the others one ratio each"),
    "larger than its room": ("balance-crank", POINT, 'shape = "disc"\nradius = "40 mm"\nthickness '
                             '= "5 mm"\nmaterial = "steel"\nmass = "1145 g"', "model.toml: balance."
                             "masses[1].mass: a disc of 1145 g and 5 mm steel has a radius of"),
    "a ring of no use": ("balance-crank", POINT, 'shape = "ring"\nradius = "40 mm"\nthickness = '
                         '"5 mm"\nmaterial = "steel"', "nothing that is free to change has an eff"),
    "no masses": ("balance-crank", 'mass = "687 g"\n', "", "mass"),
    "no balance": ("balance-crank", "[[balance.masses]]", "[[balance.mases]]", "balance.mases: no"),
}  # fmt: skip


@pytest.mark.parametrize(("name", "old", "new", "said"), MACHINES.values(), ids=MACHINES)
def test_a_plan_that_cannot_be(name: str, old: str, new: str, said: str) -> None:
    text = example_text(name)
    assert old in text
    Path("model.toml").write_text(text.replace(old, new), encoding="utf-8")
    files = ("-o", "new.toml", "--csv", "x.csv", "--plot", "pictures")
    assert said in refused(equipoise("balance", "model.toml", *files))
    assert [path.name for path in Path().iterdir()] == ["model.toml"]


def test_missing_masses_are_named() -> None:
    text = re.sub(r"(?m)^(mass|center_of_mass|inertia) = .*\n", "", example_text("yamashita-1"))
    Path("model.toml").write_text(text, encoding="utf-8")
    for words in (
        ("model.toml", "--crank-counterweight", *UP),
        ("conditions", "model.toml"),
        ("sensitivities", "model.toml", "drive_torque"),
    ):
        line = refused(equipoise("balance", *words))
        assert line.startswith("model.toml: forces need mass, center_of_mass and inertia of every")


def test_a_file_that_is_there_is_not_overwritten() -> None:
    Path("new.toml").write_text("mine", encoding="utf-8")
    line = refused(equipoise("balance", "balance-crank", "--out", "new.toml", "--csv", "x.csv"))
    assert line == "new.toml: is there already; choose another name by --out"
    assert Path("new.toml").read_text(encoding="utf-8") == "mine"
    assert [path.name for path in Path().iterdir()] == ["new.toml"]


def test_a_limit_of_the_file_is_kept_beside_that_of_the_option() -> None:
    line = refused(equipoise("balance", "balance-rig", "--limit", "gauges.gauge <= 1 %"))
    assert "rms of gauges.gauge at most 1 % of before" in line


def test_nothing_is_printed_beside_a_broken_pipe() -> None:
    """Where nobody reads, the command ends quietly."""
    words = " ".join(f"'{word}'" for word in command("balance", "balance-crank"))
    done = subprocess.run(f"{words} | head -1", shell=True, capture_output=True, check=True)
    assert done.stderr == b""


def test_interruption_of_a_long_scan(folder: Path) -> None:
    files = ("-o", "new.toml", "--csv", "x.csv", "--plot", "pictures")
    words = command("balance", "balance-geared-a", *files)
    pipe = subprocess.PIPE
    with subprocess.Popen(
        words,
        stdout=pipe,
        stderr=pipe,
        encoding="utf-8",
        preexec_fn=heed_interrupts,  # noqa: PLW1509
    ) as child:
        time.sleep(2.5)  # well past the start, far from the end
        assert child.poll() is None
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=30)
    assert (child.returncode, out) == (130, "")
    assert err.splitlines()[-1] == "equipoise: interrupted"
    assert list(folder.iterdir()) == []


def test_a_log_tells_how_far_a_scan_is() -> None:
    """On standard error only, and not before there is time to read it."""
    result = process("balance", *GEARED, *PITCH, "--ratio", "1", "--at-most", "300 g")
    succeeded(result)
    assert result.err == ""
