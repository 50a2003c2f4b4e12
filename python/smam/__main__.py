"""``python -m smam ...`` is ``smam ...``."""

import os
import subprocess
import sys

from ._errors import SmamError
from ._program import find_program


def main() -> int:
    try:
        program = str(find_program())
    except SmamError as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    command = [program, *sys.argv[1:]]
    if os.name == "posix":
        os.execv(program, command)
    # Without exec, Ctrl-C reaches both: the program decides what to do with it.
    process = subprocess.Popen(command)
    while True:
        try:
            return process.wait()
        except KeyboardInterrupt:
            continue


if __name__ == "__main__":
    sys.exit(main())
