"""Holds ../verilog/general_stage.v to the rows of a pack's general-stage table, with cocotb.

The pack is named by the environment variable NINEBIT_PACK. Every row is applied, until five have
failed, which are shown with their intermediates.
"""

import os
import sys
from pathlib import Path

import cocotb
from cocotb.triggers import Timer

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))

from ninebit_vectors import Pack, show  # noqa: E402

SHOWN = 5
MAPPINGS = [
    "UnsignedIdentity",
    "UnsignedInvert",
    "ExpandNormal",
    "ExpandNegate",
    "HalfBiasNormal",
    "HalfBiasNegate",
    "SignedIdentity",
    "SignedNegate",
]
SCALES = ["One", "Two", "Four", "Half"]


def packed(row, name):
    """Red, green and blue of a column group as one word, red in the top bits."""
    red, green, blue = (row[f"{name}.{channel}"] & 511 for channel in "rgb")
    return red << 18 | green << 9 | blue


@cocotb.test()
async def every_row(dut):
    """The stage yields what every row says."""
    rows, failed = 0, 0
    for row in Pack(os.environ["NINEBIT_PACK"]).table("general-stage"):
        for name in "abcd":
            getattr(dut, f"mapping_{name}").value = MAPPINGS.index(row[f"cfg.mapping_{name}"])
            getattr(dut, name).value = packed(row, f"in.{name}")
        dut.scale.value = SCALES.index(row["cfg.scale"])
        dut.bias.value = row["cfg.bias"] == "NegativeHalf"
        dut.mux.value = row["cfg.mux"]
        dut.mux_lsb.value = row["cfg.mux_select"] == "Lsb"
        dut.ab_dot.value = row["cfg.ab_dot"]
        dut.cd_dot.value = row["cfg.cd_dot"]
        dut.spare0_alpha.value = row["in.spare0.a"]
        await Timer(1, "step")
        rows += 1
        wrong = [
            f"{name} is {found:07x}, expected {packed(row, f'out.{name}'):07x}"
            for name in ("ab", "cd", "third")
            if (found := int(getattr(dut, name).value)) != packed(row, f"out.{name}")
        ]
        if wrong:
            failed += 1
            dut._log.error("general-stage: %s: %s", show(row), ", ".join(wrong))
            assert failed < SHOWN, f"general-stage: {failed} of the first {rows} rows failed; the others were not applied"
    assert rows > 0, "the table has no rows"
    assert failed == 0, f"general-stage: {failed} of {rows} rows failed"
    dut._log.info("0 of %d rows failed", rows)
