"""The command `site`: the live page as a folder for any web host."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from equipoise.cli.options import NewFolder, wants
from equipoise.cli.outputs import refuse_file_name, wrote
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, say

InFolder = Annotated[str | None, wants("FOLDER")]


@command(tool=False)
def site(
    *,
    out: Annotated[NewFolder, Parameter(name=["--out", "-o"])] = None,
    runtime: InFolder = None,
    wheels: InFolder = None,
    docs: InFolder = None,
    no_compile: bool = False,
) -> CommandResult:
    """Write the live page as a folder for any web host; it computes in the browser.

    To try it: python -m http.server --directory FOLDER

    Parameters
    ----------
    out
        Folder to write; an earlier site in it is replaced.  Default: site in the current folder.
    runtime
        Folder of the npm package pyodide.  Default: node_modules/pyodide.
    wheels
        Folder with wheels of the runtime's packages, such as NumPy and SciPy.  Those that are not
        in it are loaded by the page from where the runtime's packages are published.
    docs
        Folder of the documentation as HTML, to become docs in the site.
    no_compile
        Leave compiling Python modules to the browser, which then shows the first machine later.
        Otherwise Node compiles them, if it is installed and --wheels has NumPy.
    """
    from equipoise.folders import reason
    from equipoise.web.bytecode import find_node
    from equipoise.web.site import write_site

    folder = out or "site"
    refuse_file_name("--out", folder, Note("into which all files of the site go"))
    try:
        node = None if no_compile else find_node()
        written = write_site(folder, runtime or "node_modules/pyodide", wheels, docs, node)
    except OSError as error:
        raise UsageError(
            at_place(folder, Note("the site cannot be written ({reason})", reason=reason(error)))
        ) from error
    lines = [say("first load: {size} MB", size=f"{written.first / 1e6:.1f}")]
    if written.compiled:
        lines += [say("compiled modules: {count}", count=written.compiled)]
    if written.missing:
        packages = ", ".join(written.missing)
        lines += [say("loaded from elsewhere when needed: {packages}", packages=packages)]
    return CommandResult(lines=lambda: lines, save=lambda: [wrote(f"{folder}/index.html")])
