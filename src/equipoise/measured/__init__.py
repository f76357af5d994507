"""Measured signals: what a recorded free decay tells of inertia, damping and friction.

Public: `record.Record` (a decay), `record.simulate_decay` (one from known constants) and
`decay.identify_decay` (constants with confidence intervals, by two methods side by side).
"""
