"""The application to which every command belongs."""

from __future__ import annotations

from cyclopts import App, Parameter

import equipoise

FILE = Parameter(name="FILE", negative="")
STUDY = Parameter(name="STUDY", negative="")
STORE = Parameter(name="STORE", negative="")
OPTION = Parameter(negative="")
OUT = Parameter(name=["--out", "-o"], negative="")
MANY = Parameter(negative="", consume_multiple=False)
SIGNED = Parameter(negative="", allow_leading_hyphen=True)

app = App(
    name="equipoise",
    help="How a planar linkage moves, what that does to its frame, drive and joints.",
    version=equipoise.__version__,
    default_parameter=OPTION,
    suppress_keyboard_interrupt=False,
)
