#include "draw.h"
#include "gl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE 512
#define UNITS 4

/* What is drawn at the moment. */
typedef struct drawing {
    const batch_file *file;
    const batch *from;
    /* Rows of the picture, and the next power of two. */
    int height, power;
    /* 0, or what unit 0 looks up: GL_TEXTURE_2D or GL_TEXTURE_CUBE_MAP. */
    GLenum enabled[UNITS];
    GLuint names[UNITS];
    int combines;
    char *message;
} drawing;

static int fail(drawing *d, const char *message, const char *detail)
{
    sprintf(d->message, "%.100s%.60s", message, detail);
    return 0;
}

static int max_of(GLenum name)
{
    GLint value = 0;
    gl.GetIntegerv(name, &value);
    return value;
}

/* The unit's number at the end of a name of a source. */
static int unit_of(const char *name)
{
    return name[strlen(name) - 1] - '0';
}

static void activate(int unit)
{
    if (gl.ActiveTexture) gl.ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
}

static int combiners(void)
{
    return gl_has("GL_NV_register_combiners") && gl.CombinerParameteriNV && gl.CombinerParameterfvNV && gl.CombinerInputNV
        && gl.CombinerOutputNV && gl.FinalCombinerInputNV;
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
            if (!gl.ActiveTexture || !gl.MultiTexCoord2f || max_of(GL_MAX_TEXTURE_UNITS) <= unit_of(name)) return 0;
        }
    }
    *missing = "a function that the extension should have";
    if (strcmp(from->path, "combiners") == 0 && !combiners()) return 0;
    if (batch_find(from, "secondary") && !gl.SecondaryColor3ub) return 0;
    if (batch_find(from, "blocks0") && !gl.CompressedTexImage2D) return 0;
    if (batch_find(from, "blend_color") && !gl.BlendColor) return 0;
    return 1;
}

/* A texture of a unit, looked up by the nearest texel. */
static void bind(drawing *d, int unit, GLenum target, GLint filter)
{
    activate(unit);
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

/* Uploads what the rows bring, a texel a row, in a format of OpenGL. */
static int upload(drawing *d, int unit, const batch_source *source, GLint internal, GLenum format, GLenum type)
{
    unsigned char *texels = (unsigned char *)calloc((size_t)BATCH_WIDTH * (size_t)d->power, (size_t)source->size);
    if (!texels) return fail(d, "not enough memory", "");
    memcpy(texels, source->bytes, (size_t)(d->from->rows * source->size));
    bind(d, unit, GL_TEXTURE_2D, GL_NEAREST);
    gl.TexImage2D(GL_TEXTURE_2D, 0, internal, BATCH_WIDTH, d->power, 0, format, type, texels);
    free(texels);
    return 1;
}

/* Four texels a row, which its coordinates lie between. */
static int upload_quads(drawing *d, const batch_source *source)
{
    unsigned char *texels = (unsigned char *)calloc((size_t)BATCH_WIDTH * (size_t)d->power, 16);
    long row;
    if (!texels) return fail(d, "not enough memory", "");
    for (row = 0; row < d->from->rows; row++) {
        unsigned char *place = texels + 4 * (row / BATCH_WIDTH * 2 * (2 * BATCH_WIDTH) + row % BATCH_WIDTH * 2);
        memcpy(place, source->bytes + 16 * row, 8);
        memcpy(place + 4 * 2 * BATCH_WIDTH, source->bytes + 16 * row + 8, 8);
    }
    bind(d, 0, GL_TEXTURE_2D, GL_LINEAR);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 2 * BATCH_WIDTH, 2 * d->power, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    free(texels);
    return 1;
}

/* A compressed block a row. */
static int upload_blocks(drawing *d, GLint internal)
{
    const batch_source *source = batch_find(d->from, "blocks0");
    size_t size;
    unsigned char *blocks;
    if (!source) return fail(d, "there are no blocks", "");
    size = (size_t)BATCH_WIDTH * (size_t)d->power * (size_t)source->size;
    blocks = (unsigned char *)calloc(size, 1);
    if (!blocks) return fail(d, "not enough memory", "");
    memcpy(blocks, source->bytes, (size_t)(d->from->rows * source->size));
    bind(d, 0, GL_TEXTURE_2D, GL_NEAREST);
    gl.CompressedTexImage2D(GL_TEXTURE_2D, 0, (GLenum)internal, 4 * BATCH_WIDTH, 4 * d->power, 0, (GLsizei)size, blocks);
    free(blocks);
    return 1;
}

/* A line of texels that say where they are: red and green the number of the column, blue 1. */
static int upload_ramp(drawing *d, int size)
{
    unsigned char *texels = (unsigned char *)calloc((size_t)size, 4);
    int column;
    if (!texels) return fail(d, "not enough memory", "");
    for (column = 0; column < size; column++) {
        texels[4 * column] = (unsigned char)(column & 255);
        texels[4 * column + 1] = (unsigned char)(column >> 8);
        texels[4 * column + 2] = 1;
        texels[4 * column + 3] = 255;
    }
    bind(d, 0, GL_TEXTURE_2D, GL_NEAREST);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    free(texels);
    return 1;
}

/* Six faces of texels that say where they are: red the column, green the row, blue the face. */
static int upload_cube(drawing *d, int size)
{
    unsigned char *texels = (unsigned char *)calloc((size_t)size * (size_t)size, 4);
    int face, n;
    if (!texels) return fail(d, "not enough memory", "");
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

/* Four bytes as a color of floats. */
static void color_of(const long *bytes, GLfloat *color)
{
    int n;
    for (n = 0; n < 4; n++) color[n] = (GLfloat)bytes[n] / 255.0f;
}

/* The inputs and outputs of a portion: words 3 to 14 are register, mapping and component of A to D. */
static int set_portion(const GLint *values)
{
    GLenum stage = GL_COMBINER0_NV + (GLenum)values[1], portion = (GLenum)values[2];
    int n;
    for (n = 0; n < 4; n++) {
        const GLint *input = values + 3 + 3 * n;
        gl.CombinerInputNV(stage, portion, GL_VARIABLE_A_NV + (GLenum)n, (GLenum)input[0], (GLenum)input[1], (GLenum)input[2]);
    }
    gl.CombinerOutputNV(stage, portion, (GLenum)values[15], (GLenum)values[16], (GLenum)values[17], (GLenum)values[18], (GLenum)values[19],
                        (GLboolean)values[20], (GLboolean)values[21], (GLboolean)values[22]);
    return 1;
}

/* Does what a line of state says. */
static int set_state(drawing *d, char **words, int count)
{
    GLint v[BATCH_WORDS];
    long bytes[4];
    GLfloat color[4];
    int known = 1, n;
    const char *what = words[0];
    for (n = 1; n < count; n++) v[n] = gl_value(words[n], &known);
    for (n = 0; n < 4; n++) bytes[n] = 255;
    if (!known) return fail(d, "unknown words in the state: ", what);
    if (strcmp(what, "env") == 0 && count == 4) {
        activate(v[1]);
        gl.TexEnvi(GL_TEXTURE_ENV, (GLenum)v[2], v[3]);
    } else if (strcmp(what, "parameter") == 0 && count == 4) {
        activate(v[1]);
        gl.TexParameteri(d->enabled[v[1] & 3], (GLenum)v[2], v[3]);
    } else if (strcmp(what, "ramp") == 0 && count == 3 && v[2] > 0) {
        if (v[2] > max_of(GL_MAX_TEXTURE_SIZE)) return fail(d, "the texture is too large", "");
        return upload_ramp(d, v[2]);
    } else if (strcmp(what, "cube") == 0 && count == 3 && v[2] > 0 && v[2] <= 256) {
        return upload_cube(d, v[2]);
    } else if (strcmp(what, "texels") == 0 && count == 5) {
        const batch_source *source = batch_find(d->from, "texture0");
        if (!source) return fail(d, "there are no texels", "");
        return upload(d, 0, source, v[2], (GLenum)v[3], (GLenum)v[4]);
    } else if (strcmp(what, "compressed") == 0 && count == 3) {
        return upload_blocks(d, v[2]);
    } else if (strcmp(what, "alpha_test") == 0 && count == 3) {
        gl.Enable(GL_ALPHA_TEST);
        gl.AlphaFunc((GLenum)v[1], (GLfloat)v[2] / 255.0f);
    } else if (strcmp(what, "blend") == 0 && count == 4) {
        if (gl.BlendEquation) gl.BlendEquation((GLenum)v[1]);
        else if (v[1] != GL_FUNC_ADD) return fail(d, "there is no glBlendEquation", "");
        gl.BlendFunc((GLenum)v[2], (GLenum)v[3]);
    } else if (strcmp(what, "fog_color") == 0 && count == 4) {
        for (n = 0; n < 3; n++) bytes[n] = v[n + 1];
        color_of(bytes, color);
        gl.Fogfv(GL_FOG_COLOR, color);
    } else if (strcmp(what, "combiners") == 0 && count == 2) {
        if (v[1] > max_of(GL_MAX_GENERAL_COMBINERS_NV)) return fail(d, "there are too few general combiners", "");
        gl.CombinerParameteriNV(GL_NUM_GENERAL_COMBINERS_NV, v[1]);
    } else if (strcmp(what, "portion") == 0 && count == 23) {
        return set_portion(v);
    } else if (strcmp(what, "constant") == 0 && count == 6) {
        for (n = 0; n < 4; n++) bytes[n] = v[n + 2];
        color_of(bytes, color);
        gl.CombinerParameterfvNV(GL_CONSTANT_COLOR0_NV + (GLenum)v[1], color);
    } else if (strcmp(what, "stage_constant") == 0 && count == 7) {
        if (!gl.CombinerStageParameterfvNV) return fail(d, "there are no constants of single stages", "");
        for (n = 0; n < 4; n++) bytes[n] = v[n + 3];
        color_of(bytes, color);
        gl.CombinerStageParameterfvNV(GL_COMBINER0_NV + (GLenum)v[1], GL_CONSTANT_COLOR0_NV + (GLenum)v[2], color);
    } else if (strcmp(what, "final") == 0 && count == 5) {
        gl.FinalCombinerInputNV((GLenum)v[1], (GLenum)v[2], (GLenum)v[3], (GLenum)v[4]);
    } else if (strcmp(what, "color_sum_clamp") == 0 && count == 2) {
        gl.CombinerParameteriNV(GL_COLOR_SUM_CLAMP_NV, v[1]);
    } else {
        return fail(d, "not a line of state: ", what);
    }
    return 1;
}

/* Whether the stages have constants of their own: batches for a chip whose stages share them must not turn that on. */
static int has_stage_constants(const batch *from)
{
    int n;
    for (n = 0; n < from->needs_count; n++) {
        if (strcmp(from->needs[n], "GL_NV_register_combiners2") == 0) return gl.CombinerStageParameterfvNV != NULL;
    }
    return 0;
}

/* No input, no output, anywhere. */
static void reset_combiners(int stage_constants)
{
    static const GLfloat black[4] = { 0, 0, 0, 0 };
    int stages = max_of(GL_MAX_GENERAL_COMBINERS_NV), stage, n;
    for (n = 0; n < 2; n++) {
        gl.CombinerParameterfvNV(GL_CONSTANT_COLOR0_NV + (GLenum)n, black);
    }
    for (stage = 0; stage < stages; stage++) {
        GLenum name = GL_COMBINER0_NV + (GLenum)stage;
        gl.CombinerOutputNV(name, GL_RGB, GL_DISCARD_NV, GL_DISCARD_NV, GL_DISCARD_NV, GL_NONE, GL_NONE, 0, 0, 0);
        gl.CombinerOutputNV(name, GL_ALPHA, GL_DISCARD_NV, GL_DISCARD_NV, GL_DISCARD_NV, GL_NONE, GL_NONE, 0, 0, 0);
        for (n = 0; stage_constants && n < 2; n++) {
            gl.CombinerStageParameterfvNV(name, GL_CONSTANT_COLOR0_NV + (GLenum)n, black);
        }
    }
}

static void reset_final(void)
{
    GLenum n;
    for (n = GL_VARIABLE_A_NV; n <= GL_VARIABLE_G_NV; n++) {
        gl.FinalCombinerInputNV(n, GL_ZERO, GL_UNSIGNED_IDENTITY_NV, n == GL_VARIABLE_G_NV ? GL_ALPHA : GL_RGB);
    }
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
        if (fixed) gl.TexCoord3f(fixed[0], fixed[1], fixed[2]);
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
    int apart = environment || environment_byte || blend_color, n;
    long row;
    GLfloat at[3], color[4];
    long bytes[4];
    if (!apart) gl.Begin(GL_QUADS);
    for (row = 0; row < b->rows; row++) {
        int x = (int)(row % BATCH_WIDTH), y = (int)(row / BATCH_WIDTH);
        const GLfloat *fixed = coordinates || corners || weights ? at : NULL;
        const unsigned char *p;
        if (environment) {
            for (n = 0; n < 4; n++) color[n] = float_of(environment->bytes + 16 * row + 4 * n);
            gl.TexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, color);
        }
        if (environment_byte) {
            for (n = 0; n < 4; n++) bytes[n] = environment_byte->bytes[4 * row + n];
            color_of(bytes, color);
            gl.TexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, color);
        }
        if (blend_color) {
            for (n = 0; n < 4; n++) bytes[n] = blend_color->bytes[4 * row + n];
            color_of(bytes, color);
            gl.BlendColor(color[0], color[1], color[2], color[3]);
        }
        if (apart) gl.Begin(GL_QUADS);
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
        at[2] = 0;
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
        channel = column >= 0 && strlen(words[2]) == 1 ? (int)strcspn("RGBA", words[2]) : 4;
        if (channel > 3) return fail(d, "not a line of a draw: ", words[0]);
        weight = strtol(words[3], NULL, 10);
        for (row = 0; row < d->from->rows; row++) results[row * d->file->column_count + column] += weight * pixels[4 * row + channel];
    }
    return 1;
}

/* One draw, from the line after `draw`. */
static int draw_once(drawing *d, size_t *place, size_t end, unsigned char *pixels, long *results)
{
    char line[LINE], *words[BATCH_WORDS];
    const batch_source *destination = batch_find(d->from, "destination");
    size_t before = *place;
    gl.ClearColor(0, 0, 0, 0);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    if (destination) draw_destination(d, destination);
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
        if (strncmp(source->name, "texture", 7) == 0 && strncmp(d->file->text + place, "texels", 6) != 0) {
            if (!upload(d, unit_of(source->name), source, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE)) return 0;
        }
        if (strncmp(source->name, "quads", 5) == 0 && !upload_quads(d, source)) return 0;
    }
    while (place < d->from->draws) {
        int count = batch_words(d->file, &place, line, words);
        if (!set_state(d, words, count)) return 0;
    }
    while (place < d->from->end) {
        int count = batch_words(d->file, &place, line, words);
        if (count != 1 || strcmp(words[0], "draw") != 0) return fail(d, "expected: ", "draw");
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
    pixels = (unsigned char *)malloc((size_t)BATCH_WIDTH * (size_t)d.height * 4);
    if (!pixels) {
        fail(&d, "not enough memory", "");
        return DRAW_ERROR;
    }
    memset(results, 0, (size_t)from->rows * (size_t)file->column_count * sizeof *results);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    /* The files have the lowest byte first. */
    gl.PixelStorei(GL_UNPACK_SWAP_BYTES, *(const unsigned char *)&order == 0);
    gl.Disable(GL_DITHER);
    gl.ShadeModel(GL_SMOOTH);
    if (d.combines) {
        gl.Enable(GL_REGISTER_COMBINERS_NV);
        if (has_stage_constants(from)) gl.Enable(GL_PER_STAGE_CONSTANTS_NV);
        reset_combiners(has_stage_constants(from));
    }
    /* Without it the secondary color may not reach the fragment; the combiners ignore the sum itself. */
    if (batch_find(from, "secondary")) gl.Enable(GL_COLOR_SUM);
    drawn = draw_all(&d, pixels, results);
    for (unit = 0; unit < UNITS; unit++) {
        if (!d.enabled[unit]) continue;
        activate(unit);
        gl.Disable(d.enabled[unit]);
        gl.DeleteTextures(1, &d.names[unit]);
    }
    activate(0);
    gl.Disable(GL_ALPHA_TEST);
    if (d.combines) {
        if (has_stage_constants(from)) gl.Disable(GL_PER_STAGE_CONSTANTS_NV);
        gl.Disable(GL_REGISTER_COMBINERS_NV);
    }
    if (batch_find(from, "secondary")) gl.Disable(GL_COLOR_SUM);
    free(pixels);
    error = gl.GetError();
    if (drawn && error) sprintf(message, "OpenGL error 0x%x", error);
    return drawn && !error ? DRAW_OK : DRAW_ERROR;
}
