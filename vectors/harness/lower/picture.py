import sys, moderngl, numpy
from PIL import Image
shader, texture, ours = sys.argv[1:]
texels, frame = (numpy.asarray(Image.open(name).convert("RGBA")) for name in (texture, ours))
gl = moderngl.create_context(standalone=True, backend="egl", libgl="libGL.so.1", libegl="libEGL.so.1")
main = """uniform sampler2D texels; out vec4 color; void main() { NinebitPixel pixel; pixel.primary = ivec4(255, 190, 120, 255);
    pixel.texture0 = ivec4(texelFetch(texels, ivec2(gl_FragCoord.xy), 0) * 255.0 + 0.5); color = vec4(ninebit_program(pixel)) / 255.0; }"""
program = gl.program("#version 330\nin vec2 at; void main() { gl_Position = vec4(at, 0, 1); }", f"#version 330\n{open(shader).read()}{main}")
gl.texture(texels.shape[1::-1], 4, texels.tobytes()).use()
target = gl.simple_framebuffer(frame.shape[1::-1], 4)
target.use()
gl.vertex_array(program, gl.buffer(numpy.float32([-1, -1, 3, -1, -1, 3])), "at").render()
drawn = numpy.frombuffer(target.read(components=4), "u1").reshape(frame.shape)
sys.exit("not equal" if (drawn != frame).any() else 0)
