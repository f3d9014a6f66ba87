"""The command line, where an interrupt is obeyed from the first import to the end of Python."""

import atexit
import os
import sys


def run() -> None:
    """Run the command line."""
    try:
        import signal

        from mechsym.cli import main

        main()
    except SystemExit as end:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # all is done, and Python ends by itself
        if end.code != 130:
            raise
    except KeyboardInterrupt:  # before the command has begun, or after its end
        pass
    atexit._run_exitfuncs()
    sys.stdout.flush()
    os._exit(130)  # at its end Python would free hundreds of megabytes one by one


if __name__ == "__main__":
    run()
