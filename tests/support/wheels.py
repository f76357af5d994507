"""Wheels of NumPy and SciPy for browsers, which tests of the site need: wheels.py FOLDER

A package on PyPI carries them beside a runtime of the same version; of it nothing else is used.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

PACKAGE = "open-webui==0.12.4"
WANTED = ("numpy-", "scipy-")


def fetch(folder: Path) -> None:
    """Put the wheels into a folder, if they are not there."""
    if all(any(folder.glob(f"{name}*.whl")) for name in WANTED):
        return
    with tempfile.TemporaryDirectory() as place:
        words = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "-d", place]
        subprocess.run([*words, "--ignore-requires-python", PACKAGE], check=True)
        (carrier,) = Path(place).glob("*.whl")
        folder.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(carrier) as archive:
            for name in archive.namelist():
                file = name.rpartition("/")[2]
                if file.endswith("_wasm32.whl") and file.startswith(WANTED):
                    (folder / file).write_bytes(archive.read(name))


if __name__ == "__main__":
    fetch(Path(sys.argv[1]))
