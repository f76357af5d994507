"""Planting: the path of the tip in the ground, its figures, and the geometry that meets targets."""
