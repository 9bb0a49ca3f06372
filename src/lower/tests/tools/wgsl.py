"""Runs every shader in a folder by WebGPU, and compares the pixels with the expected ones."""
import sys

import numpy
import wgpu
from wgpu.utils.device import get_default_device

COLUMNS = 64
count = int(sys.argv[1])
expected = numpy.fromfile("expected.bin", "<u4").reshape(count, -1, 4)
rows = expected.shape[1]
# One for all cases, or one for each.
pools = numpy.fromfile("pool.bin", "<i4").reshape(-1, rows, COLUMNS)
device = get_default_device()
given = device.create_buffer_with_data(data=pools[0].tobytes(), usage=wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_DST)
result = device.create_buffer(size=rows * 16, usage=wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC)
for case in range(count):
    if len(pools) > 1:
        device.queue.write_buffer(given, 0, pools[case].tobytes())
    module = device.create_shader_module(code=open(f"{case:05}.wgsl").read())
    entries = [
        {"binding": 0, "visibility": wgpu.ShaderStage.COMPUTE, "buffer": {"type": wgpu.BufferBindingType.read_only_storage}},
        {"binding": 1, "visibility": wgpu.ShaderStage.COMPUTE, "buffer": {"type": wgpu.BufferBindingType.storage}},
    ]
    layout = device.create_bind_group_layout(entries=entries)
    pipeline = device.create_compute_pipeline(
        layout=device.create_pipeline_layout(bind_group_layouts=[layout]), compute={"module": module, "entry_point": "main"}
    )
    bound = [{"binding": n, "resource": {"buffer": buffer, "offset": 0, "size": buffer.size}} for n, buffer in enumerate([given, result])]
    group = device.create_bind_group(layout=layout, entries=bound)
    encoder = device.create_command_encoder()
    work = encoder.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, group)
    work.dispatch_workgroups(rows // 64)
    work.end()
    device.queue.submit([encoder.finish()])
    got = numpy.frombuffer(device.queue.read_buffer(result), "<u4").reshape(rows, 4)
    wrong = numpy.flatnonzero((got != expected[case]).any(axis=1))
    if len(wrong):
        row = wrong[0]
        sys.exit(f"case {case}, row {row}: {got[row]}, not {expected[case][row]}; {len(wrong)} of {rows} differ")
print(f"{count} shaders, {rows} pixels each, on {device.adapter.info['device']}")
