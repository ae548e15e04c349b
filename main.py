"""`python main.py` in a checkout: the same as `python -m tranquility`."""

from __future__ import annotations

import sys

from tranquility.__main__ import limit_threads, main

__all__ = ["limit_threads", "main"]

if __name__ == "__main__":
    sys.exit(main())
