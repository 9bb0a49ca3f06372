"""Renders every shader in a folder by OpenGL without a window, and compares the pixels with the expected ones."""
import sys

import moderngl
import numpy

COLUMNS = int(sys.argv[2]) if len(sys.argv) > 2 else 64
count = int(sys.argv[1])
expected = numpy.fromfile("expected.bin", "<u4").reshape(count, -1, 4)
rows = expected.shape[1]
# One for all cases, or one for each.
pools = numpy.fromfile("pool.bin", "<i4").reshape(-1, rows, COLUMNS)
context = moderngl.create_context(standalone=True, require=330, backend="egl", libgl="libGL.so.1", libegl="libEGL.so.1")
# Textures cannot have as many rows as frames have pixels, so further rows are placed to the right.
HIGH = 16384


def texels(pool):
    blocks = numpy.zeros((-(-rows // HIGH) * HIGH, COLUMNS), "<i4")
    blocks[:rows] = pool
    return numpy.ascontiguousarray(blocks.reshape(-1, HIGH, COLUMNS).transpose(1, 0, 2).reshape(HIGH, -1)[: min(rows, HIGH)])


first = texels(pools[0])
given = context.texture(first.shape[::-1], 1, first.tobytes(), dtype="i4", alignment=4)
given.filter = (moderngl.NEAREST, moderngl.NEAREST)
given.use(0)
target = context.framebuffer([context.texture((64, rows // 64), 4, dtype="u4", alignment=4)])
target.use()
corners = context.buffer(numpy.array([-1, -1, 3, -1, -1, 3], "f4").tobytes())
vertex = "#version 330\nin vec2 at;\nvoid main() { gl_Position = vec4(at, 0.0, 1.0); }\n"
for case in range(count):
    if len(pools) > 1:
        given.write(texels(pools[case]).tobytes(), alignment=4)
    program = context.program(vertex_shader=vertex, fragment_shader=open(f"{case:05}.glsl").read())
    if "pool" in program:
        program["pool"] = 0
    array = context.vertex_array(program, [(corners, "2f", "at")])
    array.render(moderngl.TRIANGLES)
    got = numpy.frombuffer(target.read(components=4, dtype="u4"), "<u4").reshape(rows, 4)
    wrong = numpy.flatnonzero((got != expected[case]).any(axis=1))
    if len(wrong):
        row = wrong[0]
        sys.exit(f"case {case}, row {row}: {got[row]}, not {expected[case][row]}; {len(wrong)} of {rows} differ")
    array.release()
    program.release()
print(f"{count} shaders, {rows} pixels each, on {context.info['GL_RENDERER']}")
