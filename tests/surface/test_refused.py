"""What commands refuse: exit status 2, one sentence that tells what would be right, no file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from surface.running import command_lines, refuses

RADIUS, DIRECTION = "counterweights.crank.radius", "counterweights.crank.direction"
ROOM, TURN, AIM = (
    f"'{RADIUS} = 0 : 70 mm'",
    f"'{DIRECTION} = 0 deg : 360 deg'",
    "'ripple drive_torque'",
)
PARTS = "shaking_force.x shaking_force.y"
UP = "--objective shaking_force.y"
PITCH = "--pitch-radius '50 mm'"
"""Parts of command lines that are long."""


@pytest.fixture(autouse=True, scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """All are tried in one folder with one file, in which no other is to be seen."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("refused"))
        Path("taken").touch()
        yield


REFUSED = {
    # begin of a command line: its end, what is said
    "": {
        "analyse yamashita-1": 'Unknown command "analyse". Did you mean "analyze"?',
        "qqq": "Available commands: analyze, animate, balance, best, check, completion",
        "--qqq": "--qqq",
        "analyze": "FILE requires an argument",
        "check": "FILE requires an argument",
        "sweep": "STUDY requires an argument",
        "best": "STORE requires an argument",
        "check yamashita-1 --json=1": "--json",
        "examples more": "more",
        "schema more": "more",
        "new a.toml b.toml": "b.toml",
        "analyze --FILE yamashita-1": "--FILE",
    },
    "analyze yamashita-1": {
        "--angles 0": "give at least 1",
        "--angles -3": "give at least 1",
        "--angles abc": "--angles: got 'abc'",
        "--angles 1e9": "--angles: got '1e9'; the unit is missing",
        "--angles 1000000000": "give at most 400000",
        f"--angles {'9' * 5000}": "--angles: got '999",
        "--angles 1_000": "--angles: got '1_000'",
        "--angles '٣'": "--angles: got '٣'",
        "--angles 'nan deg'": "--angles: got 'nan deg'; give a finite",
        "--angles '0 deg,,1 deg'": "--angles: got ''",
        "--speed 5": "--speed: got '5'; the unit is missing",
        "--speed '5 m'": "--speed: got '5 m'; m is the unit of a length",
        "--speed '50 Hz'": "--speed: got '50 Hz'; Hz is ambiguous",
        "--speed 'nan rpm'": "--speed: got 'nan rpm'; give a finite number",
        "--speed '250,5 rpm'": '"250.5 rpm"',
        "--speed": "--speed requires an argument",
        "--speed '1 rpm' --speed '2 rpm'": "--speed specified multiple times",
        "--acceleration '5 rpm'": "--acceleration: got '5 rpm'; rpm is the",
        "--about Q": "no point of the frame is called 'Q'; there are 'A', 'D'",
        "--about B": "no point of the frame is called 'B'",
        "--about '1 mm,'": "--about: got ''",
        "--about '1 mm, 2 mm, 3 mm'": '"10 mm, 20 mm"',
        "--about '1, 2'": "--about: got '1'; the unit is missing",
        "--spead '5 rpm'": "Unknown option: --spead. Did you mean --speed?",
        "'--\x1b[31m'": "Unknown option: --\\x1b[31m",
        "kim-chung-a": "kim-chung-a",
        "--split": "--split belongs to --json",
        "--json=perhaps": "--json",
        "--csv no/x.csv": "no/x.csv: there is no such folder",
        "--csv .": ". is a directory; give the name of a file",
        "--csv taken/x.csv": "there is no such folder",
        "--csv ''": "got an empty name",
        f"--csv {'x' * 300}": "name too long",
    },
    "analyze yamashita-1 --csv x.csv": {
        "--crank-zero '9 deg'": "--crank-zero belongs to --orders; give both",
        "--orders 0": "--orders: got '0'; give a whole number from 1 to 100",
        "--orders -1": "--orders: got '-1'; give a whole number from 1 to 100",
        "--orders 101": "--orders: got '101'; give a whole number from 1 to 100",
        "--orders all": "--orders",
        "--orders 3 --crank-zero 9": "--crank-zero: got '9'; the unit is missi",
        "--orders 3 --crank-zero '9 m'": "--crank-zero: got '9 m'; m is the u",
        "--orders 3 --angles '0 deg, 9 deg'": "over the whole cycle; give a",
    },
    "respond yamashita-rig": {
        "--spede '3 rpm'": "--spede",
        "--speed '0 rpm'": "--speed: got '0 rpm'; a crank that stands still",
        "--speed 193": "--speed: got '193'; the unit is missing; give an angula",
        "--speed '3 m/s'": "--speed: got '3 m/s'; m/s is the unit of a speed",
        "--speed 'nan rpm'": "--speed: got 'nan rpm'; give a finite number",
        "--speed ''": "--speed: got ''; give a speed, \"193 rpm\", or a range",
        "--speed '1:2:3 rpm'": "--speed: got '1:2:3 rpm'; give a speed",
        "--speed '20 rpm :'": "--speed: got '20 rpm :'; give a speed",
        "--speed ': 20 rpm'": "--speed: got ': 20 rpm'; give a speed",
        "--speed 20:300": "--speed: got '300'; the unit is missing",
        "--speed '20 rpm : 300'": "--speed: got '300'; the unit is missing",
        "--speed '300 rpm : 20 rpm'": "slower one first",
        "--speed '-300:-20 rpm'": "slower one first",
        "--speed '20:20 rpm'": "slower one first",
        "--speed '0:20 rpm'": "slower one first",
        "--speed '-20:30 rpm'": "slower one first",
        "--speeds 9": '--speeds belongs to a range, --speed "20 rpm :',
        "--speed '9 rpm' --speeds 9": "--speeds belongs to a range",
        "--speed '20:30 rpm' --speeds 1": "--speeds: got '1'; give",
        "--speed '20:30 rpm' --speeds -2": "--speeds: got '-2'; give",
        "--speed '2:3 rpm' --speeds 20001": "got '20001'; give",
        "--speed '20:30 rpm' --speeds many": "--speeds",
        "--drive --model linear": "the motor in the exact model, not in",
        "--model best": "--model",
        "--format png": "--format belongs to --plot; give both",
        "--plot new --format gif": "--format",
        "--plot ''": "--plot: got ''; give the name of a folder",
        "--csv no/x.csv": "--csv: no/x.csv: there is no such folder; make i",
        "--csv .": "--csv: . is a directory; give the name of a file",
        "--csv ''": "--csv: got an empty name; give the name of a file",
        "--units furlong": "--units: got 'furlong'; choose among length: m, mm",
        "--units 'mm=kg'": "--units: no dimension of units is called 'mm'",
        "--units 'mm, cm'": "--units: got 'mm' and 'cm', both units of length",
    },
    "respond": {
        "yamashita-rig --speed '100-300 rpm'": "--speed: got '100-300 rpm'; give a speed, "
        '"193 rpm", or a range: "20 rpm : 400 rpm"',
        "yamashita-1": "yamashita-1: support: the machine stands on solid ground; ad",
        "yamashita-1 --speed '20:300 rpm'": "stands on solid ground; add ",
        "nothing.toml": "nothing.toml: there is no such file; give a path, or the name",
        "yamashita-rig-counterweight --drive": "drive.motor: missing; give its no_l",
        "riding-transplanter --drive": "riding-transplanter: drive.motor: mi",
        "riding-transplanter --model exact": (
            "riding-transplanter: support.freedoms: the exact model is for motion in the plane"
        ),
        "riding-transplanter --model coupled": "the coupled model is for",
    },
    "simulate yamashita-rig": {
        "--foo": "Unknown option: --foo.",
        "'1 s' --speed '20:30 rpm'": "--speed: got '20:30 rpm'",
        "'-1 s'": "DURATION: got '-1 s'; give a time of more than 0",
        "'0 s'": "DURATION: got '0 s'; give a time of more than 0",
        "'1e9 s'": "give a time of more than 0 and at most 2000 turns",
        "5": "DURATION: got '5'; the unit is missing",
        "'5 rpm'": "DURATION: got '5 rpm'; rpm is the unit of",
    },
    "simulate": {
        "yamashita-1 '1 s'": "yamashita-1: support: the machine stands on solid gro",
        "riding-transplanter '1 s'": "the exact model is for motion in the plane",
    },
    "modes": {
        "yamashita-1": "yamashita-1: support: the machine stands on solid ground; ad",
        "yamashita-rig --model best": "--model",
        "yamashita-rig --format png": "--format belongs to --plot; give both",
        "yamashita-rig --csv x.csv": "--csv",
        "nothing.toml": "nothing.toml: there is no such file",
    },
    f"balance yamashita-1 --crank-counterweight {UP} --limit": {
        "'peak joints.B 120 N'": "--limit: got 'peak joints.B 120 N'; give such as",
        "'joints.B >= 120 N'": "--limit: got 'joints.B >= 120 N'; give such",
        "'peak joints.B <='": "--limit: got 'peak joints.B <='; give such as",
        "'<= 5 N'": "--limit: got '<= 5 N'; give such as",
        "'joints.A <= 5 mm'": "--limit: got '5 mm'; mm is the unit of a lengt",
        "'area shaking_force.x <= 1 N'": "--limit: there is no unit for the area unde",
        "'joints.A <= -5 N'": "--limit: got -5 N; give more than 0",
        "'joints.A <= 0 %'": "--limit: got 0 %; give more than 0",
        "'joints.A <= 9 % %'": "--limit: got '9 % %'; give a number, a space and %",
        "'joint.A <= 9 %'": "--limit: no output is called 'joint.A'; did yo",
        "'added_mass <= 5 %'": "--limit: got '5 %'; there is no unit '%' here; a mas",
        "'added_mass <= 0 g'": "--limit: got 0 kg; give more than 0",
        "'shaking_force.x <= 30 %'": (
            "this limit cannot be met: rms of shaking_force.x at most 30 % of before; rms of "
            "shaking_force.x can become 2.808 N"
        ),
        "'shaking_force.x <= 70 %' --limit 'added_mass <= 10 g'": (
            "these limits clash: radius on crank, added mass at most 10 g and rms of "
            "shaking_force.x at most 70 % of before; rms of shaking_force.x can become 8.626 "
            "N at the least while the others are kept"
        ),
        "'added_mass <= 100 g' --mass '500 g'": (
            "this limit cannot be met: added mass at most 100 g; allow more of it"
        ),
    },
    f"balance yamashita-1 --crank-counterweight {UP} --shape disc": {
        "--material steel": "--thickness: missing; a disc is cut from",
        "--thickness '5 mm'": "--material: missing; a disc is cut from a",
        "--thickness '5 mm' --material stel": (
            "--material: no material is called 'stel'; did you mean 'steel'?"
        ),
        "--thickness '5 mm' --material steel --radius '50 mm' --mass '10 kg'": (
            "--mass: a disc of 10000 g and 5 mm steel has a radius of 284.777 mm and does not "
            "fit into its room of 50 mm; make it thicker, or"
        ),
    },
    f"balance yamashita-1 --crank-counterweight {UP}": {
        "--shape cube": 'Invalid value "cube" for --shape. Choose from',
        "--material steel": "--material: goes with a disc",
        "--radius '5 kg'": "--radius: got '5 kg'; kg is the unit of a mass",
        "--radius '0 mm'": "--radius: got 0 m; give more than 0",
        "--mass '-2 g'": "--mass: got -0.002 kg; give more than 0",
        "--mass '1 g' --at-most '2 g'": "give either mass or at_most",
    },
    "balance yamashita-1 --crank-counterweight --objective": {
        "shaking_forces": "--objective: no output is called 'shaking_forces'; did",
        "'mean shaking_force.y'": "--objective: got 'mean shaking_force.y'; give suc",
        "'shaking_force y'": "--objective: got 'shaking_force y'; give such as",
        "''": "--objective: got ''; give such as",
        "'ripple shaking_force'": "--objective: shaking_force is a vector, which has",
        "'shaking_moment about Q'": "--objective: about: no point of the frame is call",
        "'shaking_moment about'": "--objective: got 'shaking_moment about'; give",
        "'shaking_moment about A about D'": "with about twice; give it once",
        "'shaking_force about A'": "--objective: about: goes with shaking_mome",
        "'shaking_force.y orders one'": "--objective: got orders 'one'; give numbers:",
        "'shaking_force.y orders -1'": "--objective: orders: got -1; give 0 or more",
        "'shaking_force.y orders nan'": "orders: got nan; give a finite number",
        "'shaking_force.y weight 0'": "--objective: weight: got 0; give more than 0",
        "'shaking_force.y weight 1,2'": "got weight '1,2'; give one number: weight 2",
        "'shaking_force.y speeds 9 rpm'": "--objective: speeds: goes with gauges; oth",
        "gauges.x": "--objective: there is no gauge; give a support",
        "joints.Q": "--objective: no joint is called 'Q'; there are 'A', 'D', 'B',",
        "roll_moment": "--objective: roll_moment comes from linkages side by side; gi",
        "shaking_moment": (
            "none of the permitted changes affects the rms of shaking_moment; "
            "permit another change, or choose another objective"
        ),
    },
    f"balance lee-kim-a {UP} --geared-counterweight": {
        "rocker": "--geared-counterweight needs the pitch radius of the gear on its driver",
        f"coupler {PITCH}": (
            "--geared-counterweight: 'coupler' does not turn about a pin in the frame; those "
        ),
        f"crank {PITCH}": (
            "--geared-counterweight: direction: missing; 'crank' turns about the drive's own"
        ),
        f"x {PITCH}": "--geared-counterweight: no link is called 'x'",
        f"rocker {PITCH} --ratio a": "--ratio: got 'a'; give a number, or the least",
        f"rocker {PITCH} --ratio 1,2,3": "--ratio: got '1,2,3'; give a number, or",
        f"rocker {PITCH} --ratio 0": "--ratio: got 0; give a size above 0, the",
        f"rocker {PITCH} --ratio '2, 1'": "--ratio: got 2 to 1; give the smalle",
        f"rocker {PITCH} --ratio nan": "--ratio: got nan; give a finite number",
        "rocker --pitch-radius '-5 mm'": "--pitch-radius: got -0.005 m; give more than",
    },
    "balance trade-off yamashita-1 --crank-counterweight": {
        "shaking_force.y 'rms shaking_force.y'": (
            "rms of shaking_force.y cannot be traded against itself; give another objective"
        ),
        f"{PARTS} --points 1": "--points: got '1'; give a whole number from 2",
        f"{PARTS} --points 501": "--points: got '501'; give a whole number",
        f"{PARTS} --points x": "--points: got 'x'; give a whole number from 2",
        "shaking_force.y": "parameter SECOND requires an argument",
        "shaking_force.y x": "no output is called 'x'",
        "shaking_force.y 'a b'": "SECOND: got 'a b'; give such as",
        f"{PARTS} -o x.toml": "Unknown option: -o.",
    },
    "balance trade-off": {
        f"four-row-transplanter {PARTS}": "a front is not drawn over phases; lea",
        f"yamashita-1 {PARTS}": "no change is permitted; give",
    },
    "balance sensitivities yamashita-1": {
        "joints.B": (
            "OUTPUT: no output of this kind is called 'joints.B'; there are "
            "'shaking_force.x', 'shaking_force."
        ),
        "drive_torque --crank-zero 5": "--crank-zero: got '5'; the unit is missing; give an angle",
        "drive_torque --speed '0 rpm'": (
            "a crank that stands still shakes nothing; give the drive a speed"
        ),
    },
    "balance arrangements yamashita-1": {
        "1": "ROWS: got '1'; give a whole number from 2",
        "65": "give a whole number from 2 to 64",
        "4 --spacing '0 mm'": "--spacing: got '0 m",
        "4 --spacing ''": "--spacing: got ''; g",
    },
    "balance balance-crank": {
        "--speed '0 rpm'": "a crank that stands still shakes",
        "--speed 200": "--speed: got '200'; the unit is missing",
        "-o no/x.toml": "no/x.toml: there is no such folder; make",
        "-o ''": "--out: got an empty name; give the name of a fil",
        "-o .": "--out: . is a directory; give the name of a file",
        "-o x --csv x": "--csv: x has another part in this",
        "--csv no/x.csv": "no/x.csv: there is no such folder; make i",
    },
    "balance yamashita-1": {
        f"{UP} --move-cm copler": "--move-cm: no link is called 'copler'; did you mean 'coupler'?",
        f"{UP} --counterweight x": "--counterweight: no link is",
        f"{UP} --move-cm coupler --move-cm coupler": (
            "--move-cm: 'coupler' is given twice; give one of both"
        ),
        f"{UP} --phases": "--phases: got 0 rows, which leaves no phase to",
        f"{UP} --shape disc": "--shape belongs to a counterweight; give both",
        f"{UP} --radius '5 mm'": "--radius belongs to a counterweight; give both",
        f"{UP} --mass '5 g'": "--mass belongs to a counterweight; give both",
        f"{UP} --at-most '5 g'": "--at-most belongs to a counterweight; give both",
        f"{UP} --thickness '5 mm'": "--thickness belongs to a counterweight; give both",
        f"{UP} --material steel": "--material belongs to a counterweight; give both",
        f"{UP} --ratio 1": "--ratio belongs to --geared-counterweight; give both",
        f"{UP} {PITCH}": "--pitch-radius belongs to --geared-counterweight; give both",
        f"{UP} --format png": "--format belongs to --plot; give both",
    },
    "balance": {
        "nothing.toml": "nothing.toml: there is no such file; give a path, or the name",
        "yamashita-rig --crank-counterweight --objective gauges.x": "no gauge is called",
        "yamashita-rig --crank-counterweight --objective 'gauges.gauge speeds 100'": (
            "--objective: got '100'; the unit is missing; give an angular speed, such"
        ),
        "four-row-transplanter --limit 'joints.B <= 5 N'": (
            "no phase changes a force inside of a row; leave its limit out"
        ),
        "conditions yamashita-1 --crank-counterweight": "Unknown option: --crank-counterweight.",
    },
    "plant kim-chung-a": {
        "--speed '0 rpm'": "drive.speed: got 0; give the speed at which",
        "--speed 300": "--speed: got '300'; the unit is missing",
        "--speed '3 m/s'": "--speed: got '3 m/s'; m/s is the unit",
        "--units furlong": "--units: got 'furlong'; choose among length: m",
        "--units 'length=kg'": "--units: got 'kg' for length; length is shown in one of m",
        "--crank-zero 90": "--crank-zero: got '90'; the unit is mi",
        "--csv x.csv --angles 0": "--angles: got 0; give 1 to",
        "--csv x.csv --angles 400001": "got 400001; give 1",
        "--csv no/x.csv": "no/x.csv: there is no such folder",
        "--csv ''": "--csv: got an empty name; give the name",
    },
    "plant": {
        "yamashita-1": "yamashita-1: planting: missing; add a table [planting]",
        "nothing.toml": "nothing.toml: there is no such file; give a path, or the name",
    },
    "tool nagamine-irie": {
        "--respond fast": "got 'fast'; give a range of speeds, the slower one first",
        "--respond '9000 rpm'": "got '9000 rpm'; give a range of speeds, the slower one first",
        "--respond '5 rpm'": "--respond: got '5 rpm'; give a range of speeds",
        "--respond '9000 rpm : 2000 rpm'": "the slower one first",
        "--respond '0 rpm : 2000 rpm'": "the slower one first",
        "--respond '2000 : 9000'": "the unit is missing",
        "--respond '20 Hz : 30 Hz'": "--respond: got '20 Hz'",
        "--number 0": "--number: got '0'; give a whole number from 1 to 100",
        "--number many": "--number: got 'many'",
        "--speeds 1": "--speeds: got '1'; give a whole number from 2 to 5000",
        "--at '2 m'": "--at: got 2 m, off the shaft; give places from 0 to 1.544 m",
        "--at 2": "--at: got '2'",
        "--duration '25 h'": "--duration: got '25 h'; give more than 0 and at most 24 h a day",
        "--duration '0 h'": "--duration: got '0 h'",
        "--number 5 --exposure": "--number belongs to --modes; give both",
        "--format png": "--format belongs to --plot; give both",
        "--csv ''": "--csv: got an empty name",
        "--csv no/where.csv": "there is no such folder",
        "--plot ''": "--plot: got ''",
        "--units furlong": "--units: got 'furlong'",
    },
    "tool vary nagamine-irie": {
        "harness": "CHANGE: got 'harness'; give a station, one of its numbers and a range",
        "'belt position = 0 m : 1 m'": "CHANGE: stations: no station is called 'belt'",
        "'harness length = 0 m : 1 m'": "no number of 'harness' is called 'length'",
        "'engine harness.stiffness = 1 N/m : 2 N/m'": "'engine' has no harness",
        "'harness position = 0 m : 2 m'": "the shaft",
        "'harness harness.damping = 0 N s/m : 9 N s/m'": "do not feel; vary another",
        "'harness position = 1 m : 0 m'": "the smaller value first",
        "'harness position = 0 kg : 1 kg'": "CHANGE: got '0 kg'",
    },
    "animate yamashita-1": {
        "-o a.png": "--out: got 'a.png'; give a name that ends in .svg, .gif or .mp4",
        "-o no/a.svg": "--out: no/a.svg: there is no such folder; make it",
        "--turns 2": "--turns: got 2; give 1 or more, with a name that ends in .mp4",
        "-o a.mp4 --turns 0": "--turns: got 0; give 1 or more",
        "--dark": "--dark: an SVG follows the reader's screen; leave it out",
        "--speed '3 rpm'": "--speed belongs to --force; give both",
        "--seconds -1": "got -1 s for a turn; give more than 0 s, and at most 600 s",
        "--width 9": "got a width of 9 pixels; give 100 to 3840",
        "-o a.gif --seconds 600": "the film has 15000 frames; 640 pixels wide",
        "--trace Q": "no point is called 'Q'; there are 'A', 'D', 'B', 'C', 'P'",
    },
    "report": {
        "scotch-yoke -o report.docx": "--out: got 'report.docx'; give a name that",
        "scotch-yoke -o no/report.html": "no/report.html: there is no such folder",
        "scotch-yoke --language fr": '"en", "de", "ja", "ko"',
        "study-of-lengths": "this is a study",
        "nosuch": "nosuch: there is no such file",
    },
    "serve --no-browser": {
        "nowhere.toml": "nowhere.toml: there is no such file",
        "study-of-lengths": "study-of-lengths.toml: this is a study",
        "yamashita-1 --port 99999": "--port: got '99999'; give a whole number from 0 to",
        "yamashita-1 --port 8o": "--port: got '8o'",
    },
    "plot map yamashita-1": {
        "'links.crank.mass = 1 g : 2 g'": "parameter SECOND requires",
        f"{ROOM} {TURN}": "parameter OUTPUT requires",
        f"{ROOM} {TURN} 'rms force'": "no output is called 'force'",
        f"'links.a = 1 : 2' {TURN} {AIM}": "no number of the model",
        f"'links.crank.mass = 2 g' {TURN} {AIM}": (
            "FIRST: got 'links.crank.mass = 2 g'; give a number and its range"
        ),
        f"'2 g : 3 g' {TURN} {AIM}": "give such as",
        f"'links.crank.mass = 1 : 2 mm' {TURN} {AIM}": "a mass is wanted",
        f"'links.crank.mass = 2 : 1 g' {TURN} {AIM}": "the smaller value",
        f"{ROOM} {ROOM} {AIM}": "twice",
        f"{ROOM} {TURN} {AIM} --set '{RADIUS} = 1 mm'": "give one of both",
        f"{ROOM} {TURN} {AIM} --points 3": "--points",
        f"{ROOM} {TURN} {AIM} -o taken": "--out",
    },
    "plot yamashita-1": {
        "--only polr": "did you mean 'polar'",
        "--at '3 mm'": "--at",
        "-o taken": "--out",
    },
}


@command_lines(REFUSED)
def test_refused(line: str, said: str) -> None:
    refuses(line, said)
