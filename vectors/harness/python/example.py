#!/usr/bin/env python3
"""Tests one function, the sum of two products, against the unit `sum` of a pack. Put your own in its place.

    python3 example.py pack

With --plant the constant of the rounding is one step off, and rows must fail. Exit status: 0 all rows pass, 1 some fail, 2 no pack.
"""

import argparse
import sys

from ninebit_vectors import Pack, VectorError, show

SHOWN = 5


def rounded_sum(a, b, c, d, half=127):
    """A B + C D, all in steps of 1/255, rounded once to the nearest step, limited to what a register holds."""
    return max(-256, min(255, (a * b + c * d + half) // 255))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pack")
    parser.add_argument("--plant", action="store_true", help="round with 126 instead of 127")
    arguments = parser.parse_args()
    rows, failed = 0, 0
    for row in Pack(arguments.pack).table("sum"):
        found = rounded_sum(row["in.a"], row["in.b"], row["in.c"], row["in.d"], 126 if arguments.plant else 127)
        rows += 1
        if found != row["out.sum"]:
            failed += 1
            if failed <= SHOWN:
                print(f"found {found} for {show(row)}")
    print(f"sum: {failed} of {rows} rows failed")
    if rows == 0:
        return 2
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except VectorError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
