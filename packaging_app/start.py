"""Where the packed program begins: the window, a command, or a worker process of either."""

from __future__ import annotations

import sys
from multiprocessing import freeze_support

if __name__ == "__main__":
    freeze_support()  # a packaged program is its own interpreter, also for the processes it starts
    from tranquility.__main__ import main

    sys.exit(main())
