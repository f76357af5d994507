"""Planting: the path of the tip in the ground, its figures, and the geometry that meets targets.

Public: `summary.plant` (all figures of a machine), `summary.soil_forces` (with and without the
soil), `summary.table` (against crank angle) and `search.fit_planting` (geometry for targets).
"""
