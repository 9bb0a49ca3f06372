"""The program `ninebit`."""

import sys

from . import _native


def main() -> int:
    return _native.main(["ninebit", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
