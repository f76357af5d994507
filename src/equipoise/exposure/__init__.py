"""Hand-arm vibration: how it is weighted, what a day of it amounts to, and what a hand may bear.

Public: `spectra.weigh_signal`, `spectra.weigh_spectrum` and `spectra.weigh_orders` (weighted
vibration of what was measured or computed), and `daily.daily_exposure` (tasks of a day, by ISO
5349, Directive 2002/44/EC and the Japanese guideline).
"""
