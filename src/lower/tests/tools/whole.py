"""Draws a scene by its printed shader, one thread for each pixel, by WebGPU: `draws.bin` has targets and draws, `drawn.bin` receives the targets."""
import struct

import numpy
import wgpu
from wgpu.utils.device import get_default_device

from draws import take

device = get_default_device()
STORAGE = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC
targets, draws = take(2)
surfaces = []
for _ in range(targets):
    width, pixels = (int(n) for n in take(2))
    buffers = [device.create_buffer_with_data(data=take(pixels).tobytes(), usage=STORAGE) for _ in range(2)]
    surfaces.append((width, pixels, buffers))
kinds = [wgpu.BufferBindingType.read_only_storage] * 3 + [wgpu.BufferBindingType.storage] * 2
entries = [{"binding": n, "visibility": wgpu.ShaderStage.COMPUTE, "buffer": {"type": kind}} for n, kind in enumerate(kinds)]
layout = device.create_bind_group_layout(entries=entries)
module = device.create_shader_module(code=open("whole.wgsl").read())
for draw in range(draws):
    target, *window = (int(n) for n in take(5))
    triangles, memory, *_ = [take(int(take(1)[0])) for _ in range(4)]
    if not len(triangles):
        continue
    width, pixels, buffers = surfaces[target]
    bounds = struct.pack("<8I", width, pixels // width, *window, len(triangles) // 184, 0)
    read = [device.create_buffer_with_data(data=data, usage=STORAGE) for data in (bounds, triangles.tobytes(), memory.tobytes())]
    pipeline = device.create_compute_pipeline(
        layout=device.create_pipeline_layout(bind_group_layouts=[layout]), compute={"module": module, "entry_point": f"main{draw}"}
    )
    bound = [{"binding": n, "resource": {"buffer": buffer, "offset": 0, "size": buffer.size}} for n, buffer in enumerate(read + buffers)]
    encoder = device.create_command_encoder()
    work = encoder.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, device.create_bind_group(layout=layout, entries=bound))
    work.dispatch_workgroups(-(-width // 8), -(-(pixels // width) // 8))
    work.end()
    device.queue.submit([encoder.finish()])
with open("drawn.bin", "wb") as file:
    for _, _, buffers in surfaces:
        for buffer in buffers:
            file.write(device.queue.read_buffer(buffer))
