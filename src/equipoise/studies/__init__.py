"""Many designs of one model: ranges, tolerances, searches.  Zarr, Dask and pymoo are known here."""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
