"""Reads `draws.bin`, which has targets and draws, from the working directory."""
import numpy

given = numpy.fromfile("draws.bin", "<u4")
at = 0


def take(count):
    global at
    at += count
    return given[at - count : at]
