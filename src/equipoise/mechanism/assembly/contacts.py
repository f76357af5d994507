"""How the two bodies of a coupling go together: in one of two ways, which its kind names."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from equipoise.mechanism.assembly import cam_groups, flanks
from equipoise.mechanism.assembly.builder import Builder
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.loops import Contact
from equipoise.mechanism.parts.couplings import Coupling

WAYS: Mapping[str, Callable[..., Contact]] = {"line": flanks.contact, "surface": cam_groups.contact}
"""Kind of the line of action -> contact: fixed on the carrier or moving with a ratio, or normal to
a surface."""


def contact_of(builder: Builder, joints: Structure, coupling: Coupling) -> Contact:
    """How a coupling is solved, and how its driver pushes.

    Raises
    ------
    ModelError : its bodies are not joined as they would have to be.
    """
    return WAYS[coupling.contact](builder, joints, coupling)
