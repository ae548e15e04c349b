"""Property tests draw the same examples every time: a suite that passed passes again. One thread each is enough."""

import os

for library in ("OPENBLAS", "OMP", "MKL"):  # before NumPy is imported, or it has no effect
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

from hypothesis import settings  # noqa: E402

settings.register_profile("same", derandomize=True)
settings.load_profile("same")
