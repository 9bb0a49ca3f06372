/* Textures: what rows bring, and those that say where they are. */
#include "drawing.h"

#include <stdlib.h>
#include <string.h>

/* A texture of a unit, looked up by the nearest texel. */
static void bind(drawing *d, int unit, GLenum target, GLint filter)
{
    drawing_activate(unit);
    gl.GenTextures(1, &d->names[unit]);
    gl.BindTexture(target, d->names[unit]);
    gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.Enable(target);
    gl.TexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    d->enabled[unit] = target;
}

int upload(drawing *d, int unit, const batch_source *source, GLint internal, GLenum format, GLenum type)
{
    unsigned char *texels = (unsigned char *)calloc((size_t)BATCH_WIDTH * (size_t)d->power, (size_t)source->size);
    if (!texels) return drawing_fail(d, "not enough memory", "");
    memcpy(texels, source->bytes, (size_t)(d->from->rows * source->size));
    bind(d, unit, GL_TEXTURE_2D, GL_NEAREST);
    gl.TexImage2D(GL_TEXTURE_2D, 0, internal, BATCH_WIDTH, d->power, 0, format, type, texels);
    free(texels);
    return 1;
}

int upload_quads(drawing *d, const batch_source *source, GLint internal, GLenum format, GLenum type)
{
    size_t half = (size_t)source->size / 2;
    unsigned char *texels = (unsigned char *)calloc((size_t)BATCH_WIDTH * (size_t)d->power, 2 * half);
    long row;
    if (!texels) return drawing_fail(d, "not enough memory", "");
    for (row = 0; row < d->from->rows; row++) {
        unsigned char *place = texels + half * (size_t)(row / BATCH_WIDTH * 2 * BATCH_WIDTH + row % BATCH_WIDTH);
        memcpy(place, source->bytes + source->size * row, half);
        memcpy(place + half * BATCH_WIDTH, source->bytes + source->size * row + half, half);
    }
    bind(d, 0, GL_TEXTURE_2D, GL_LINEAR);
    gl.TexImage2D(GL_TEXTURE_2D, 0, internal, 2 * BATCH_WIDTH, 2 * d->power, 0, format, type, texels);
    free(texels);
    return 1;
}

int upload_blocks(drawing *d, GLint internal)
{
    const batch_source *source = batch_find(d->from, "blocks0");
    size_t size;
    unsigned char *blocks;
    if (!source) return drawing_fail(d, "there are no blocks", "");
    size = (size_t)BATCH_WIDTH * (size_t)d->power * (size_t)source->size;
    blocks = (unsigned char *)calloc(size, 1);
    if (!blocks) return drawing_fail(d, "not enough memory", "");
    memcpy(blocks, source->bytes, (size_t)(d->from->rows * source->size));
    bind(d, 0, GL_TEXTURE_2D, GL_NEAREST);
    gl.CompressedTexImage2D(GL_TEXTURE_2D, 0, (GLenum)internal, 4 * BATCH_WIDTH, 4 * d->power, 0, (GLsizei)size, blocks);
    free(blocks);
    return 1;
}

/* Texels that say which they are, along one axis. */
static int upload_line(drawing *d, GLenum target, int size)
{
    unsigned char *texels = (unsigned char *)calloc((size_t)size, 4);
    int column;
    if (!texels) return drawing_fail(d, "not enough memory", "");
    for (column = 0; column < size; column++) {
        texels[4 * column] = (unsigned char)(column & 255);
        texels[4 * column + 1] = (unsigned char)(column >> 8);
        texels[4 * column + 2] = 1;
        texels[4 * column + 3] = 255;
    }
    bind(d, 0, target, GL_NEAREST);
    if (target == GL_TEXTURE_3D) gl.TexImage3D(target, 0, GL_RGBA8, 1, 1, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    else gl.TexImage2D(target, 0, GL_RGBA8, size, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    free(texels);
    return 1;
}

int upload_ramp(drawing *d, int size)
{
    return upload_line(d, GL_TEXTURE_2D, size);
}

int upload_layers(drawing *d, int layers)
{
    return gl.TexImage3D ? upload_line(d, GL_TEXTURE_3D, layers) : drawing_fail(d, "there is no glTexImage3D", "");
}

int upload_cube(drawing *d, int size)
{
    unsigned char *texels = (unsigned char *)calloc((size_t)size * (size_t)size, 4);
    int face, n;
    if (!texels) return drawing_fail(d, "not enough memory", "");
    bind(d, 0, GL_TEXTURE_CUBE_MAP, GL_NEAREST);
    for (face = 0; face < 6; face++) {
        for (n = 0; n < size * size; n++) {
            texels[4 * n] = (unsigned char)(n % size);
            texels[4 * n + 1] = (unsigned char)(n / size);
            texels[4 * n + 2] = (unsigned char)face;
            texels[4 * n + 3] = 255;
        }
        gl.TexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + (GLenum)face, 0, GL_RGBA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    }
    free(texels);
    return 1;
}
