"""Keeps the linear algebra under NumPy to one thread; has to be imported before NumPy is."""

import os

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"
