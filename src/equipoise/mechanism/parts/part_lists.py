"""Lists of parts that a machine may have, one of each kind in this package.

Written by ``PYTHONPATH=tests python tests/unit/mechanism/test_part_lists.py`` from the kinds.
"""

from __future__ import annotations

from equipoise.keys import Frozen, KeyTable, Tables, declared, key
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.bushings import Bushing
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.dampers import Damper
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.racks import Rack
from equipoise.mechanism.parts.resistances import Resistance
from equipoise.mechanism.parts.springs import Spring
from equipoise.mechanism.parts.stops import Stop
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper
from equipoise.mechanism.parts.torsion_springs import TorsionSpring


# fmt: off
@declared
class PartLists(Frozen):
    """Parts of a machine that declare themselves."""

    circular_slots: tuple[CircularSlot, ...] = key(
        Tables(KeyTable(CircularSlot)), CircularSlot.list_text, default=(), kw_only=True)
    curved_slots: tuple[CurvedSlot, ...] = key(
        Tables(KeyTable(CurvedSlot)), CurvedSlot.list_text, default=(), kw_only=True)
    gears: tuple[Gear, ...] = key(
        Tables(KeyTable(Gear)), Gear.list_text, default=(), kw_only=True)
    belts: tuple[Belt, ...] = key(
        Tables(KeyTable(Belt)), Belt.list_text, default=(), kw_only=True)
    racks: tuple[Rack, ...] = key(
        Tables(KeyTable(Rack)), Rack.list_text, default=(), kw_only=True)
    cams: tuple[Cam, ...] = key(
        Tables(KeyTable(Cam)), Cam.list_text, default=(), kw_only=True)
    springs: tuple[Spring, ...] = key(
        Tables(KeyTable(Spring)), Spring.list_text, default=(), kw_only=True)
    torsion_springs: tuple[TorsionSpring, ...] = key(
        Tables(KeyTable(TorsionSpring)), TorsionSpring.list_text, default=(), kw_only=True)
    dampers: tuple[Damper, ...] = key(
        Tables(KeyTable(Damper)), Damper.list_text, default=(), kw_only=True)
    torsion_dampers: tuple[TorsionDamper, ...] = key(
        Tables(KeyTable(TorsionDamper)), TorsionDamper.list_text, default=(), kw_only=True)
    bushings: tuple[Bushing, ...] = key(
        Tables(KeyTable(Bushing)), Bushing.list_text, default=(), kw_only=True)
    stops: tuple[Stop, ...] = key(
        Tables(KeyTable(Stop)), Stop.list_text, default=(), kw_only=True)
    resistances: tuple[Resistance, ...] = key(
        Tables(KeyTable(Resistance)), Resistance.list_text, default=(), kw_only=True)
