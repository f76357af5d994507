"""Many designs of one model: ranges, tolerances, searches.  Zarr, Dask and pymoo are known here."""

from __future__ import annotations

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
