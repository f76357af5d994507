"""An FMU for co-simulation by FMI 2.0: the crank turns at a speed, forces and motion come out.

Its C is the linkage written out by `codegen.other_languages`, and `fmu_model.c`, which FMI calls.
It is compiled where a C compiler is found; else the file has its sources alone, which FMPy and
others compile.
"""

from __future__ import annotations

import hashlib
import io
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files
from math import pi
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree as ET

from equipoise.codegen.emit import emit, signals_in_loops
from equipoise.codegen.figures import Gathered
from equipoise.codegen.other_languages import in_c
from equipoise.exchange.formats import Job
from equipoise.exchange.tree import constant_loads
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.outputs import AnalysisOutput

SOURCE = "model.c"
MODEL = "linkage"
SYSTEMS = {"linux": ("linux64", ".so"), "darwin": ("darwin64", ".dylib")}
"""Where the binary of a system stands, and how its name ends."""


def export_bytes(job: Job) -> bytes:
    """The file's content."""
    loads = tuple(load for _, load in constant_loads(job, between=True))
    machine = replace(job.machine, loads=loads, planting=None, balance=None)
    job.leave_out_support()
    job.leave_out_forces()
    job.leave_out_motor()
    job.leave_out_planes()
    outputs = _outputs(analyze(machine, [job.crank_angle]))
    code = _code(machine, [output.name for output in outputs], job.crank_angle)
    guid = hashlib.sha256(code.encode()).hexdigest()[:32]
    code = f'#define GUID "{guid}"\n{code}'
    content: dict[str, str | bytes] = {
        "modelDescription.xml": _description(job, outputs, guid),
        f"sources/{SOURCE}": code,
    }
    folder, ending = SYSTEMS.get(sys.platform, ("", ""))
    binary = _compiled(code) if folder else None
    if binary is None:
        job.leave_out(
            Note("what this computer could run at once: `fmpy compile` makes it of the sources")
        )
    else:
        content[f"binaries/{folder}/{MODEL}{ending}"] = binary
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, part in content.items():
            packed.writestr(zipfile.ZipInfo(name), part)
    return data.getvalue()


def _outputs(analysis: Analysis) -> list[AnalysisOutput]:
    """Those that a compiled loop can have too."""
    arrays = {value.name: value for value in analysis.outputs.arrays}
    names = signals_in_loops(assemble(analysis.machine), arrays)
    return [arrays[name] for name in names]


def _code(machine: Machine, names: Sequence[str], crank_angle: float) -> str:
    """The linkage, and what FMI calls."""
    linkage = assemble(machine)
    source = emit(linkage, Gathered(tuple((name, "squares") for name in names)), alone=True)
    numbers = {"COUNT": len(names), "SPEED": machine.drive.speed}
    numbers["START"] = crank_angle
    defined = "".join(f"#define {name} {value!r}\n" for name, value in numbers.items())
    model = files("equipoise.exchange").joinpath("fmu_model.c").read_text("utf-8")
    return f"{defined}{in_c(source, linkage, names)}\n{model}"


def _description(job: Job, outputs: Sequence[AnalysisOutput], guid: str) -> str:
    """What there is to set and to read, by number, unit and name."""
    machine = job.machine
    root = ET.Element("fmiModelDescription", fmiVersion="2.0", modelName=_plain(machine), guid=guid)
    root.set("description", str(machine.title))
    root.set("generationTool", "Equipoise")
    slave = {"modelIdentifier": MODEL, "canHandleVariableCommunicationStepSize": "true"}
    listed = ET.SubElement(ET.SubElement(root, "CoSimulation", slave), "SourceFiles")
    ET.SubElement(listed, "File", name=SOURCE)
    units = dict.fromkeys(
        ["rad", "rad/s", "rad/s^2", *(output.unit for output in outputs if output.unit)]
    )
    defined = ET.SubElement(root, "UnitDefinitions")
    for unit in units:
        ET.SubElement(defined, "Unit", name=unit)
    period = 2 * pi / (abs(machine.drive.speed) or 1.0)
    span = {"startTime": "0.0", "stopTime": repr(period), "stepSize": repr(period / 360)}
    ET.SubElement(root, "DefaultExperiment", span)
    variables = ET.SubElement(root, "ModelVariables")
    parts: list[tuple[str, str, str, float | None]] = [
        *((output.name, output.unit, "output", None) for output in outputs),
        ("crank_angle", "rad", "output", None),
        ("speed", "rad/s", "input", machine.drive.speed),
        ("acceleration", "rad/s^2", "input", 0.0),
        ("start", "rad", "parameter", job.crank_angle),
    ]
    for number, (name, unit, causality, start) in enumerate(parts):
        kind = {"variability": "fixed", "initial": "exact"} if causality == "parameter" else {}
        item = {"name": name, "valueReference": str(number), "causality": causality, **kind}
        variable = ET.SubElement(variables, "ScalarVariable", item)
        real = ET.SubElement(variable, "Real", {"unit": unit} if unit else {})
        if start is not None:
            real.set("start", repr(start))
    structure = ET.SubElement(root, "ModelStructure")
    for part in ("Outputs", "InitialUnknowns"):
        unknowns = ET.SubElement(structure, part)
        for number in range(1, len(outputs) + 2):
            ET.SubElement(unknowns, "Unknown", index=str(number))
    return ET.tostring(root, encoding="unicode", xml_declaration=True)


def _plain(machine: Machine) -> str:
    return re.sub(r"\W+", "_", str(machine.title), flags=re.ASCII) or MODEL


def _compiled(code: str) -> bytes | None:
    """The library that FMI calls; None where there is no compiler, or it cannot."""
    compiler = shutil.which("cc")
    if compiler is None:
        return None
    with TemporaryDirectory() as folder:
        source, library = Path(folder) / SOURCE, Path(folder) / "library"
        source.write_text(code, encoding="utf-8")
        words = [compiler, "-shared", "-fPIC", "-O2", "-o", str(library), str(source), "-lm"]
        try:
            subprocess.run(words, capture_output=True, check=True)
            return library.read_bytes() or None
        except (OSError, subprocess.CalledProcessError):  # also one that ends well without a file
            return None
