"""`python main.py` in a checkout: the same as `python -m tranquility`."""

from __future__ import annotations

import sys

from tranquility.__main__ import limit_threads, main

__all__ = ["limit_threads", "main"]

if __name__ == "__main__":
    if getattr(sys, "frozen", False):  # a packaged program is its own interpreter, also for the processes it starts
        from multiprocessing import freeze_support

        freeze_support()
    sys.exit(main())
