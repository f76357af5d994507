"""Many designs at once: loops over designs and crank angles, written out from the steps.

`batch.Batch` computes figures of designs that differ in any numbers, `gram.MassBatch` those of
designs that differ in masses alone.  `figures` says what they can gather and why a design has no
figures, `emit.emit` writes a linkage out as `source.TermSource`, and `backends.run_loop` runs it,
compiled by Numba or on NumPy's arrays.
"""
