"""The contact of each kind of coupling: how it is solved, and how one body pushes the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from equipoise.mechanism.assembly.belt_contacts import pull_of
from equipoise.mechanism.assembly.builder import Builder
from equipoise.mechanism.assembly.cam_groups import push_of
from equipoise.mechanism.assembly.gear_contacts import mesh_of
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.loops import Contact
from equipoise.mechanism.assembly.rack_groups import teeth_of
from equipoise.mechanism.parts.couplings import Coupling

CONTACTS: Mapping[str, Callable[[Builder, Structure, Any], Contact]] = {
    "gears": mesh_of,
    "cams": push_of,
    "belts": pull_of,
    "racks": teeth_of,
}
"""What makes the contact of a coupling, by its `table`."""


def contact_of(builder: Builder, joints: Structure, coupling: Coupling) -> Contact:
    """How the two bodies of a coupling go together.

    Raises
    ------
    ModelError : they are not joined as they would have to be.
    """
    return CONTACTS[coupling.table](builder, joints, coupling)
