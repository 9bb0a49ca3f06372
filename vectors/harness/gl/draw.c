#include "draw.h"
#include "drawing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE 512

/* The unit's number at the end of a name of a source. */
static int unit_of(const char *name)
{
    return name[strlen(name) - 1] - '0';
}

int draw_supports(const batch_file *file, const batch *from, const char **missing)
{
    int n;
    (void)file;
    for (n = 0; n < from->needs_count; n++) {
        if (!gl_has(from->needs[n])) {
            *missing = from->needs[n];
            return 0;
        }
    }
    for (n = 0; n < from->source_count; n++) {
        const char *name = from->sources[n].name;
        if (strncmp(name, "texture", 7) == 0 && unit_of(name) > 0) {
            *missing = "more texture units";
            if (!gl.ActiveTexture || !gl.MultiTexCoord2f || drawing_max(GL_MAX_TEXTURE_UNITS) <= unit_of(name)) return 0;
        }
    }
    *missing = "eight bits of stencil beside a depth buffer";
    if (batch_find(from, "stencil0") && (drawing_max(GL_STENCIL_BITS) < 8 || drawing_max(GL_DEPTH_BITS) < 1)) return 0;
    *missing = "a function that the extension should have";
    if (strcmp(from->path, "combiners") == 0 && !drawing_combiners()) return 0;
    if (batch_find(from, "secondary") && !gl.SecondaryColor3ub) return 0;
    if (batch_find(from, "fog0") && !gl.FogCoordf) return 0;
    if (batch_find(from, "blocks0") && !gl.CompressedTexImage2D) return 0;
    if (batch_find(from, "blend_color") && !gl.BlendColor) return 0;
    return 1;
}

/* Four bytes, the lowest first, as a float. */
static GLfloat float_of(const unsigned char *bytes)
{
    GLuint bits = (GLuint)bytes[0] | (GLuint)bytes[1] << 8 | (GLuint)bytes[2] << 16 | (GLuint)bytes[3] << 24;
    GLfloat value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The four corners of a rectangle of pixels; texture coordinates lie alike at all of them, or span the picture. */
static void quad(const drawing *d, int x0, int y0, int x1, int y1, const GLfloat *fixed)
{
    static const int order[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    int n, unit;
    for (n = 0; n < 4; n++) {
        int x = order[n][0] ? x1 : x0, y = order[n][1] ? y1 : y0;
        GLfloat s = (GLfloat)x / BATCH_WIDTH, t = (GLfloat)y / (GLfloat)d->power;
        if (x1 - x0 == 1) {
            s = ((GLfloat)x0 + 0.5f) / BATCH_WIDTH;
            t = ((GLfloat)y0 + 0.5f) / (GLfloat)d->power;
        }
        for (unit = 1; unit < UNITS; unit++) {
            if (d->enabled[unit]) gl.MultiTexCoord2f(GL_TEXTURE0 + (GLenum)unit, s, t);
        }
        if (fixed && fixed[3] != 0) gl.TexCoord4f(fixed[0] * fixed[3], fixed[1] * fixed[3], fixed[2], fixed[3]);
        else if (fixed) gl.TexCoord3f(fixed[0], fixed[1], fixed[2]);
        else gl.TexCoord3f(s, t, 0);
        gl.Vertex2f((GLfloat)x / (BATCH_WIDTH / 2) - 1, (GLfloat)y / (BATCH_WIDTH / 2) - 1);
    }
}

/* Draws every row as a pixel of its own. */
static void draw_rows(const drawing *d)
{
    const batch *b = d->from;
    const batch_source *primary = batch_find(b, "primary"), *secondary = batch_find(b, "secondary");
    const batch_source *primary_float = batch_find(b, "primary_float"), *environment = batch_find(b, "environment_float");
    const batch_source *coordinates = batch_find(b, "coordinates0"), *corners = batch_find(b, "corners0");
    const batch_source *weights = batch_find(b, "weights0"), *blend_color = batch_find(b, "blend_color");
    const batch_source *environment_byte = batch_find(b, "environment");
    const batch_source *stencil = batch_find(b, "stencil0"), *fog = batch_find(b, "fog0"), *projected = batch_find(b, "projected0");
    int apart = environment || environment_byte || blend_color || stencil, n;
    long row;
    GLfloat at[4], color[4];
    long bytes[4];
    if (!apart) gl.Begin(GL_QUADS);
    for (row = 0; row < b->rows; row++) {
        int x = (int)(row % BATCH_WIDTH), y = (int)(row / BATCH_WIDTH);
        const GLfloat *fixed = coordinates || corners || weights || projected ? at : NULL;
        const unsigned char *p;
        if (environment) {
            for (n = 0; n < 4; n++) color[n] = float_of(environment->bytes + 16 * row + 4 * n);
            gl.TexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, color);
        }
        if (environment_byte) {
            for (n = 0; n < 4; n++) bytes[n] = environment_byte->bytes[4 * row + n];
            drawing_color(bytes, color);
            gl.TexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, color);
        }
        if (blend_color) {
            for (n = 0; n < 4; n++) bytes[n] = blend_color->bytes[4 * row + n];
            drawing_color(bytes, color);
            gl.BlendColor(color[0], color[1], color[2], color[3]);
        }
        if (stencil) {
            p = stencil->bytes + 5 * row;
            gl.StencilFunc(d->stencil, p[0], p[1]);
            gl.StencilMask(p[2]);
            gl.DepthFunc(d->depth && !p[4] ? GL_NEVER : GL_ALWAYS);
        }
        if (apart) gl.Begin(GL_QUADS);
        if (fog) gl.FogCoordf(float_of(fog->bytes + 4 * row));
        if (primary) {
            p = primary->bytes + 4 * row;
            gl.Color4ub(p[0], p[1], p[2], p[3]);
        }
        if (primary_float) {
            p = primary_float->bytes + 16 * row;
            gl.Color4f(float_of(p), float_of(p + 4), float_of(p + 8), float_of(p + 12));
        }
        if (secondary) {
            p = secondary->bytes + secondary->size * row;
            gl.SecondaryColor3ub(p[0], p[1], p[2]);
        }
        at[0] = ((GLfloat)x + 0.5f) / BATCH_WIDTH;
        at[1] = ((GLfloat)y + 0.5f) / (GLfloat)d->power;
        at[2] = at[3] = 0;
        if (coordinates) {
            for (n = 0; n < 3; n++) at[n] = float_of(coordinates->bytes + 12 * row + 4 * n);
        } else if (corners) {
            p = corners->bytes + 2 * row;
            at[0] = ((GLfloat)(4 * x + p[0]) + 0.5f) / (4 * BATCH_WIDTH);
            at[1] = ((GLfloat)(4 * y + p[1]) + 0.5f) / (GLfloat)(4 * d->power);
        } else if (weights) {
            p = weights->bytes + 2 * row;
            at[0] = ((GLfloat)(2 * x) + 0.5f + (GLfloat)p[0] / 256) / (2 * BATCH_WIDTH);
            at[1] = ((GLfloat)(2 * y) + 0.5f + (GLfloat)p[1] / 256) / (GLfloat)(2 * d->power);
        }
        if (projected) {
            for (n = 0; n < 2; n++) at[2 + n] = float_of(projected->bytes + 8 * row + 4 * n);
        }
        quad(d, x, y, x + 1, y + 1, fixed);
        if (apart) gl.End();
    }
    if (!apart) gl.End();
}

/* Puts what the buffer holds before the draw: plain colors. */
static void draw_destination(const drawing *d, const batch_source *source)
{
    long row;
    gl.Begin(GL_QUADS);
    for (row = 0; row < d->from->rows; row++) {
        const unsigned char *p = source->bytes + 4 * row;
        int x = (int)(row % BATCH_WIDTH), y = (int)(row / BATCH_WIDTH);
        gl.Color4ub(p[0], p[1], p[2], p[3]);
        quad(d, x, y, x + 1, y + 1, NULL);
    }
    gl.End();
}

/* Puts bytes into the stencil buffer before the draw. */
static void draw_stencil(const drawing *d, const batch_source *source)
{
    long row;
    gl.StencilMask(255);
    gl.DepthFunc(GL_ALWAYS);
    for (row = 0; row < d->from->rows; row++) {
        int x = (int)(row % BATCH_WIDTH), y = (int)(row / BATCH_WIDTH);
        gl.StencilFunc(GL_ALWAYS, source->bytes[5 * row + 3], 255);
        gl.Begin(GL_QUADS);
        quad(d, x, y, x + 1, y + 1, NULL);
        gl.End();
    }
    gl.Clear(GL_COLOR_BUFFER_BIT);
}

/* Whether rows differ in more than their texels. */
static int apart_from_texels(const batch *b)
{
    int n;
    for (n = 0; n < b->source_count; n++) {
        const char *name = b->sources[n].name;
        if (strncmp(name, "texture", 7) != 0 && strcmp(name, "destination") != 0) return 1;
    }
    return 0;
}

/* Adds what a draw's pixels show; `place` is at its first `read`. */
static int read_back(drawing *d, size_t *place, size_t end, const unsigned char *pixels, long *results)
{
    char line[LINE], *words[BATCH_WORDS];
    while (*place < end) {
        size_t before = *place;
        int count = batch_words(d->file, place, line, words), column, channel;
        long weight, row;
        if (strcmp(words[0], "draw") == 0) {
            *place = before;
            break;
        }
        column = count == 4 && strcmp(words[0], "read") == 0 ? batch_column(d->file, words[1]) : -1;
        channel = column >= 0 && strlen(words[2]) == 1 ? (int)strcspn("RGBAS", words[2]) : 5;
        if (channel > 4) return drawing_fail(d, "not a line of a draw: ", words[0]);
        weight = strtol(words[3], NULL, 10);
        for (row = 0; row < d->from->rows; row++) {
            /* Behind the colors stand bytes of the stencil. */
            long byte = channel == 4 ? pixels[4L * BATCH_WIDTH * d->height + row] : pixels[4 * row + channel];
            results[row * d->file->column_count + column] += weight * byte;
        }
    }
    return 1;
}

/* One draw, from the line after `draw`. */
static int draw_once(drawing *d, size_t *place, size_t end, unsigned char *pixels, long *results)
{
    char line[LINE], *words[BATCH_WORDS];
    const batch_source *destination = batch_find(d->from, "destination"), *stencil = batch_find(d->from, "stencil0");
    size_t before = *place;
    gl.ClearColor(0, 0, 0, 0);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    if (destination) draw_destination(d, destination);
    if (stencil) {
        gl.Enable(GL_STENCIL_TEST);
        gl.Enable(GL_DEPTH_TEST);
        gl.StencilOp(GL_REPLACE, GL_REPLACE, GL_REPLACE);
        draw_stencil(d, stencil);
    }
    if (d->combines) reset_final();
    while (*place < end) {
        int count = batch_words(d->file, place, line, words);
        if (strcmp(words[0], "read") == 0) break;
        if (!set_state(d, words, count)) return 0;
        before = *place;
    }
    *place = before;
    if (destination) gl.Enable(GL_BLEND);
    gl.Color4ub(255, 255, 255, 255);
    if (apart_from_texels(d->from) || d->from->rows < BATCH_WIDTH) {
        draw_rows(d);
    } else {
        gl.Begin(GL_QUADS);
        quad(d, 0, 0, BATCH_WIDTH, d->height, NULL);
        gl.End();
    }
    if (destination) gl.Disable(GL_BLEND);
    gl.ReadPixels(0, 0, BATCH_WIDTH, d->height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    if (stencil) gl.ReadPixels(0, 0, BATCH_WIDTH, d->height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, pixels + 4L * BATCH_WIDTH * d->height);
    return read_back(d, place, end, pixels, results);
}

static int draw_all(drawing *d, unsigned char *pixels, long *results)
{
    char line[LINE], *words[BATCH_WORDS];
    size_t place = d->from->state;
    int n;
    for (n = 0; n < d->from->source_count; n++) {
        const batch_source *source = &d->from->sources[n];
        /* Texels of other formats wait for the line that names them. */
        if (strncmp(d->file->text + place, "texels", 6) == 0) continue;
        if (strncmp(source->name, "texture", 7) == 0) {
            if (!upload(d, unit_of(source->name), source, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE)) return 0;
        }
        if (strncmp(source->name, "quads", 5) == 0 && !upload_quads(d, source, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE)) return 0;
    }
    while (place < d->from->draws) {
        int count = batch_words(d->file, &place, line, words);
        if (!set_state(d, words, count)) return 0;
    }
    while (place < d->from->end) {
        int count = batch_words(d->file, &place, line, words);
        if (count != 1 || strcmp(words[0], "draw") != 0) return drawing_fail(d, "expected: ", "draw");
        if (!draw_once(d, &place, d->from->end, pixels, results)) return 0;
    }
    return 1;
}

enum draw_status draw_batch(const batch_file *file, const batch *from, long *results, char *message)
{
    static const unsigned short order = 1;
    drawing d;
    unsigned char *pixels;
    int unit, drawn;
    GLenum error;
    memset(&d, 0, sizeof d);
    d.file = file;
    d.from = from;
    d.message = message;
    d.combines = strcmp(from->path, "combiners") == 0;
    d.height = (int)((from->rows + BATCH_WIDTH - 1) / BATCH_WIDTH);
    for (d.power = 1; d.power < d.height;) d.power *= 2;
    pixels = (unsigned char *)malloc((size_t)BATCH_WIDTH * (size_t)d.height * 8);
    if (!pixels) {
        drawing_fail(&d, "not enough memory", "");
        return DRAW_ERROR;
    }
    memset(results, 0, (size_t)from->rows * (size_t)file->column_count * sizeof *results);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    /* The files have the lowest byte first. */
    gl.PixelStorei(GL_UNPACK_SWAP_BYTES, *(const unsigned char *)&order == 0);
    gl.Disable(GL_DITHER);
    gl.ShadeModel(GL_SMOOTH);
    if (d.combines) begin_combiners(from);
    /* Without it the secondary color may not reach the fragment; the combiners ignore the sum itself. */
    if (batch_find(from, "secondary")) gl.Enable(GL_COLOR_SUM);
    drawn = draw_all(&d, pixels, results);
    for (unit = 0; unit < UNITS; unit++) {
        if (!d.enabled[unit]) continue;
        drawing_activate(unit);
        gl.Disable(d.enabled[unit]);
        gl.DeleteTextures(1, &d.names[unit]);
    }
    drawing_activate(0);
    gl.Disable(GL_ALPHA_TEST);
    gl.Disable(GL_FOG);
    gl.Disable(GL_STENCIL_TEST);
    gl.Disable(GL_DEPTH_TEST);
    if (d.combines) end_combiners(from);
    if (batch_find(from, "secondary")) gl.Disable(GL_COLOR_SUM);
    free(pixels);
    error = gl.GetError();
    if (drawn && error) sprintf(message, "OpenGL error 0x%x", error);
    return drawn && !error ? DRAW_OK : DRAW_ERROR;
}
