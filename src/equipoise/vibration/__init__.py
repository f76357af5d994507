"""Vibration: a machine on its mounts, free, forced and coupled to its drive.

Public: `free.vibrate_freely` (modes and resonances), `forced.respond` (steady response at one
speed, by any of the models), `sweep.sweep_speed` (over a range of speeds) and
`transient.from_rest` (the exact equations in time).
"""
