#!/usr/bin/env python3
"""Builds ../verilog/general_stage.v with Icarus Verilog and runs the cocotb bench over a pack.

    python3 run.py pack

With --plant the stage rounds one step off, and rows must fail. Exit status: 0 all rows pass, 1 some fail.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

from cocotb_tools.runner import get_results, get_runner

HERE = Path(__file__).resolve().parent


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pack", type=Path)
    parser.add_argument("--plant", action="store_true", help="round with 253 instead of 255")
    arguments = parser.parse_args()
    os.environ["NINEBIT_PACK"] = str(arguments.pack.resolve())
    with tempfile.TemporaryDirectory() as folder:
        runner = get_runner("icarus")
        runner.build(
            sources=[HERE.parent / "verilog" / "general_stage.v"],
            hdl_toplevel="general_stage",
            parameters={"ROUNDING": 253 if arguments.plant else 255},
            build_args=["-g2005-sv"],
            timescale=("1ns", "1ps"),
            build_dir=folder,
            always=True,
        )
        results = runner.test(
            hdl_toplevel="general_stage",
            test_module="test_general_stage",
            test_dir=HERE,
            build_dir=folder,
            results_xml=str(Path(folder) / "results.xml"),
        )
        tests, failures = get_results(results)
    # A bench that found no test has checked nothing.
    return 1 if tests == 0 or failures else 0


if __name__ == "__main__":
    sys.exit(main())
