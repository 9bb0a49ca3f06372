"""Runs register words on an array of pixels, by ctypes: `combine.py LIBRARY`. Prints the results of SPARE0 = expand(TEXTURE0) . expand(PRIMARY)."""
import ctypes
import sys

import numpy

library = ctypes.CDLL(sys.argv[1])
words = numpy.array([[0x0AC0, 0x48440000], [0x1E40, 0x20C0], [0x0288, 0x0C], [0x028C, 0x1C80], [0x1E60, 0x101]], "u4")
pixels = numpy.zeros((256, 7, 4), "i4")  # primary, secondary, fog, four textures
pixels[:, 0] = [128, 128, 255, 255]
pixels[:, 3, :3] = numpy.arange(256)[:, None]
fragments = numpy.empty((256, 4), "u1")
message = ctypes.c_char_p()
pointer = lambda array: array.ctypes.data_as(ctypes.c_void_p)
size = ctypes.c_size_t
status = library.ninebit_evaluate(
    1, pointer(words), size(len(words)), pointer(pixels), pointer(fragments), size(256), ctypes.byref(message)
)
if status:
    sys.exit(message.value.decode())
print(fragments[::51].tolist())
