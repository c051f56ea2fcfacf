"""Command-line programs that look at a running cell or prepare one."""
