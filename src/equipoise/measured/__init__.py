"""Measured signals: what a recorded free decay tells of inertia, damping and friction."""
