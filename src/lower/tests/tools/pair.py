"""Draws a scene by its shaders, by OpenGL without a window: `draws.bin` has targets and draws, `drawn.bin` receives the targets."""
import os

import moderngl
import numpy

from draws import take

context = moderngl.create_context(standalone=True, require=430, backend="egl", libgl="libGL.so.1", libegl="libEGL.so.1")
fetches = "GL_EXT_shader_framebuffer_fetch" in context.extensions and "NINEBIT_COPIES" not in os.environ


def define(text, *names):
    first, rest = text.split("\n", 1)
    return "\n".join([first, *(f"#define {name}" for name in names), rest])


def rectangles(vertices, limit):
    low = numpy.clip(vertices[..., :2].min(axis=1) // 16 * 16, 0, limit)
    high = numpy.clip(-(-vertices[..., :2].max(axis=1) // 16) * 16, 0, limit)
    (left, top), (right, bottom), number = low.T, high.T, vertices[:, 0, 2]
    corners = [(left, top), (right, top), (left, bottom), (left, bottom), (right, top), (right, bottom)]
    return numpy.stack([numpy.stack([*corner, number], axis=1) for corner in corners], axis=1).astype("<i4")


targets, draws = take(2)
surfaces, programs = [], {}
for _ in range(targets):
    width, pixels = (int(n) for n in take(2))
    size = (width, pixels // width)
    of = [context.texture(size, 1, take(pixels).tobytes(), dtype="u4") for _ in range(2)]
    copies = [context.texture(size, 1, dtype="u4") for _ in range(2)]
    surfaces.append((size, context.framebuffer(of), of, copies))
for draw in range(draws):
    target, *window = (int(n) for n in take(5))
    triangles, memory, vertices, state = [take(int(take(1)[0])) for _ in range(4)]
    if not len(triangles):
        continue
    size, frame, of, copies = surfaces[target]
    options = ["NINEBIT_FETCH"] if fetches else []
    vertices = vertices.view("<i4").reshape(-1, 3, 3)
    # Drivers clip what leaves the surface, which moves vertices: rectangles stand for such triangles.
    limit = 16 * numpy.array(size, "<i4")
    if (vertices[..., :2] < 0).any() or (vertices[..., :2] > limit).any():
        options.append("NINEBIT_COVERS")
        vertices = rectangles(vertices, limit)
    each = vertices.shape[1]
    texts = [define(open(f"draw{draw}.{stage}").read(), *options) for stage in ("vert", "frag")]
    program = programs.get(texts[1]) or context.program(vertex_shader=texts[0], fragment_shader=texts[1])
    programs[texts[1]] = program
    program["ninebit_size"] = size
    for binding, words in enumerate((triangles, memory, *([state] if len(state) else []))):
        context.buffer(words.tobytes()).bind_to_storage_buffer(binding)
    array = context.vertex_array(program, [(context.buffer(vertices.tobytes()), "3i", "ninebit_vertex")])
    left, top, right, bottom = window

    def copy():
        for n in range(2):
            context.copy_framebuffer(context.framebuffer([copies[n]]), context.framebuffer([of[n]]))
            copies[n].use(n)
        frame.use()
        # A surface for which there is no output keeps its words.
        frame.color_mask = [(f"out highp uint ninebit_stored_{name}" in texts[1],) * 4 for name in ("word", "depth")]
        context.scissor = (left, top, right - left, bottom - top)

    if fetches:
        copy()
        array.render(moderngl.TRIANGLES)
        continue
    # One triangle after the other: what it reads is a copy of what is there before it.
    for first in range(0, vertices.size // 3, each):
        copy()
        array.render(moderngl.TRIANGLES, each, first=first)
with open("drawn.bin", "wb") as file:
    for size, frame, of, *_ in surfaces:
        for texture in of:
            file.write(texture.read(alignment=4))
print(f"{draws} draws, {'fetched' if fetches else 'copied'}, on {context.info['GL_RENDERER']}")
