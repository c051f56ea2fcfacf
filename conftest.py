"""For all tests: Ctrl-C works in the processes they start, also where a shell ignores it (commands in the background)."""

import signal

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
