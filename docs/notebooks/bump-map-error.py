# ---
# jupyter:
#   jupytext:
#     text_representation:
#       format_name: percent
# ---

# %% [markdown]
# # Where does the error of a bump map come from?
#
# A height field as a normal map, lit by one dot product a pixel. The light turns from straight above to the horizon. Which part of the chip makes the
# picture wrong: the filter, which shortens normals between texels; the expansion of bytes to signed numbers, the light's among them; or the method?

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import ninebit

scene = ninebit.Scene.load("vectors/scenes/techniques/dot-product-texture-blending/height-field.ron")

# %% [markdown]
# The scene says in its `truth` what the lighting equation yields in float64. `measure` holds the picture against it, and splits the error by its cause.

# %%
angles = np.linspace(0, 85, 100)
rms = {}
for angle in np.radians(angles):
    scene.set("names.vectors.sun", np.array([0.8 * np.sin(angle), 0.6 * np.sin(angle), np.cos(angle)]))
    for cause, errors in scene.measure().causes.items():
        rms.setdefault(cause, []).append(errors.rms)

# %%
figure, (chart, picture) = plt.subplots(1, 2, figsize=(11, 4), width_ratios=[3, 2])
for cause, values in sorted(rms.items(), key=lambda item: -np.mean(item[1])):
    if max(values) > 0:
        chart.plot(angles, values, label=cause)
chart.set(xlabel="angle of the light from the normal of the surface, degrees", ylabel="rms error, steps of 1/255", xlim=(0, 85), ylim=(0, None))
chart.legend()
chart.grid(alpha=0.3)

# %% [markdown]
# The error itself, at 40 degrees: red where the chip is too bright, blue where it is too dark.

# %%
angle = np.radians(40)
scene.set("names.vectors.sun", np.array([0.8 * np.sin(angle), 0.6 * np.sin(angle), np.cos(angle)]))
error = scene.measure().error[:, :, 1]
shown = picture.imshow(error, cmap="RdBu_r", vmin=-8, vmax=8)
picture.set(title="picture minus truth at 40 degrees", xticks=[], yticks=[])
figure.colorbar(shown, ax=picture, label="steps of 1/255")
figure.tight_layout()
if len(sys.argv) > 1 and sys.argv[1].endswith(".png"):
    figure.savefig(sys.argv[1], dpi=120)

# %% [markdown]
# **The expansion, at every angle**: a byte x becomes 2x - 256 in place of 2x - 255, one step too small, of the normal and of the light, and the dot product
# adds them up. The filter costs one step. The saw teeth are the light: its direction is rounded to bytes, which costs up to a step more where it falls badly.
