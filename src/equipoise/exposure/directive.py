"""Directive 2002/44/EC, Article 3: action and limit value of hand-arm vibration in a day."""

from __future__ import annotations

from math import inf

from equipoise.exposure.iso_5349 import EIGHT_HOURS

ACTION, LIMIT = 2.5, 5.0
"""m/s2, of A(8); Article 3, paragraph 1, b and a.  Above the first an employer has to act, Article
5, paragraph 2; above the second nobody may be exposed, paragraph 3."""
POINTS_OF_ACTION = 100.0
"""Points of a day at the action value, by the exposure points system of the Health and Safety
Executive (L140): 2 points for each hour and each (m/s2)^2, so that the limit value has 400."""


def time_to_reach(value: float, a_hv: float) -> float:
    """Time, s, in which a total value, m/s2, makes up a daily exposure, m/s2; infinite for 0."""
    return EIGHT_HOURS * (value / a_hv) ** 2 if a_hv > 0 else inf


def points(a8: float) -> float:
    """Exposure points of a daily or partial exposure, m/s2; those of several tasks add up."""
    return POINTS_OF_ACTION * (a8 / ACTION) ** 2
