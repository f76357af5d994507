"""The command `serve`."""

from __future__ import annotations

import gc
import sys
from typing import Annotated

from equipoise.cli.app import FILE, SIGNED, app
from equipoise.cli.options import naming, whole


@app.command
def serve(
    file: Annotated[str | None, FILE] = None,
    /,
    *,
    port: Annotated[str | None, SIGNED] = None,
    no_browser: bool = False,
) -> None:
    """Open a page in the browser on which the linkage moves and can be dragged and changed.

    It is served on this machine, for this machine only, until Ctrl+C; nothing is sent elsewhere.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example; else one is picked on the page.
    port
        On which it is served; any that is free if not given.
    no_browser
        Print the address, and open no browser.
    """
    from equipoise.web.server import serve
    from equipoise.web.session import Session, opened_file

    number = 0 if port is None else whole("--port", port, 0, 65535)
    design = None if file is None else opened_file(file)

    def begin() -> Session:
        session = Session()
        if design is not None:
            session.open(design)
        return session

    with naming(file or ""):
        begin()  # what is wrong with the machine is told before a page is opened

    def tell(address: str) -> None:
        print(address, flush=True)
        print("press Ctrl+C to end", file=sys.stderr)
        if not no_browser:
            import webbrowser

            webbrowser.open(address)

    gc.enable()  # other commands end before garbage matters
    gc.freeze()
    serve(begin, number, tell)
