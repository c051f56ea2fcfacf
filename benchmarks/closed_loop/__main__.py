"""scripts/bench closed_loop COMMAND: the same as the executable ``closed_loop_benchmark``."""

import sys

from singulation_bringup.closed_loop.main import main

if __name__ == "__main__":
    sys.exit(main())
