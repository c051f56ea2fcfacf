"""For all tests: Ctrl-C works in the processes they start, also where a shell ignores it (background commands)."""

import signal

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
