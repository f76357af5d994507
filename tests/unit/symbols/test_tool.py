"""A tool from the side: its signs sit on the shaft and go with it."""

from __future__ import annotations

import numpy as np
import pytest

from equipoise.symbols.looks import LOOKS
from equipoise.symbols.tool import SeatSign, ToolScene, TubeSign

SEATS = (
    SeatSign("engine", 0.0, mass=8.0, excitation="turns", part="engine"),
    SeatSign("belt", 0.4, harness=True),
    SeatSign("grip", 0.6, absorber=1.0, hands=2),
    SeatSign("bench", 1.0, grounded=True, clamped=True, excitation="force"),
    SeatSign("head", 2.0, mass=1.0, part="blade"),
)
ALONG = np.linspace(0.0, 2.0, 201)
TUBES = (TubeSign(0.0, 1.2, 0.03), TubeSign(1.2, 2.0, 0.0))
SCENE = ToolScene(TUBES, SEATS, ALONG, np.array([0 * ALONG, 0.1 * ALONG]))


def test_every_sign_has_a_look_and_lies_in_the_box() -> None:
    low, high = SCENE.box
    for k in range(2):
        for shape in SCENE.at(k):
            assert shape.role in LOOKS
            corners = shape.at(1.0, SCENE.unit)
            assert np.all((corners.real > low.real) & (corners.real < high.real))
            assert np.all((corners.imag > low.imag) & (corners.imag < high.imag))


def test_each_kind_of_seat_has_its_signs() -> None:
    def count(role: str, **seat: object) -> int:
        alone = SeatSign("one", 0.5, **seat)  # type: ignore[arg-type]
        values = ToolScene(TUBES, (alone,), ALONG, 0 * ALONG[None]).at(0)
        return sum(shape.role == role for shape in values)

    assert count("stand", hands=2) == 2 * 5
    assert count("spring", absorber=0.1) == count("tie", harness=True) == 1
    assert count("mount", grounded=True) == count("force-arc", excitation="turns") == 1
    assert count("force", excitation="force") == count("tray", mass=1.0, part="blade") == 1
    assert count("rest", mass=1.0, part="engine") == 2 and count("rest", mass=1.0) == 1


def test_bodies_turn_with_the_shaft_and_hands_stay_upright() -> None:
    """The shaft climbs by a tenth; a cube of 8 kg of water has 200 mm."""
    for name, (turned, upright) in SCENE.tracks.items():
        (place,) = (seat.place for seat in SEATS if seat.name == name)
        assert turned.place[1] == upright.place[1] == pytest.approx(place * (1 + 0.1j))
        assert turned.angle == pytest.approx([0, np.arctan(0.1)]) and not np.any(upright.angle)
    assert SEATS[0].edge == pytest.approx(0.2)
