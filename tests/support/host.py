"""A web host that knows nothing but files, for the live page as a folder."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
WHEELS, RUNTIME = ROOT / "build" / "wheels", ROOT / "page" / "node_modules" / "pyodide"
"""Where `make test` keeps what it fetches."""


def lacks_runtime() -> bool:
    """Return whether the runtime or its wheels could not be fetched."""
    return not RUNTIME.is_dir() or not any(WHEELS.glob("numpy-*.whl"))


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Say nothing."""


class SlowLine(Quiet):
    """All files go one after the other over a line of so many bytes a second."""

    rate = 20e6 / 8
    _line = threading.Lock()

    def copyfile(self, source: Any, outputfile: Any) -> None:
        """Send a file in pieces, between which those of others go."""
        while piece := source.read(16384):
            with self._line:
                time.sleep(len(piece) / self.rate)
            outputfile.write(piece)


@contextmanager
def hosting(folder: Path, kind: type[Quiet] = Quiet) -> Iterator[str]:
    """Serve a folder, and give its address."""
    handler = partial(kind, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()
