/* Scenes: whole pictures of several draws, triangle by triangle. */
#include "scene.h"
#include "drawing.h"
#include "picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE 512
#define PATH_LENGTH 1024
#define TEXTURES 16
/* Bytes of a vertex: x, y, depth and w, two colors, a fog coordinate, four coordinates of four units. */
#define VERTEX 92
/* Steps of a depth buffer of 24 bits. */
#define DEEPEST 16777215.0

/* A scene that is read line by line, as a batch is. */
typedef struct scene {
    drawing d;
    batch_file file;
    batch batch;
    int width, height;
    /* Units that the implementation has, of those that scenes know; and whether a line asks for what it lacks. */
    int units, lacks;
    /* What the extensions that the scene needs bring: combiners, fog coordinates, secondary colors, limits of depths, texture shaders, cube maps,
     * anisotropy. */
    int combines, fogs, adds, clamps, shades, cubes, stretches;
    /* Textures, and what each is bound to. */
    GLuint textures[TEXTURES];
    GLenum targets[TEXTURES];
} scene;

static int fail(scene *s, const char *message, const char *detail)
{
    return drawing_fail(&s->d, message, detail);
}

/* Fails for what the implementation does not have. */
static int lack(scene *s, const char *what)
{
    s->lacks = 1;
    return fail(s, what, "");
}

static GLfloat float_at(const unsigned char *bytes)
{
    GLuint bits = (GLuint)bytes[0] | (GLuint)bytes[1] << 8 | (GLuint)bytes[2] << 16 | (GLuint)bytes[3] << 24;
    GLfloat value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Bytes that a line points to; NULL if the file does not have them. */
static const unsigned char *bytes_at(const scene *s, long place, long count)
{
    if (place < 0 || count < 0 || (size_t)place > s->file.raw_length || (size_t)count > s->file.raw_length - (size_t)place) return NULL;
    return s->file.raw + place;
}

/* A number of a line, from 0 to `most`; -1 if it is none. */
static long count_of(const char *word, long most)
{
    char *end;
    long value = strtol(word, &end, 10);
    return *word >= '0' && *word <= '9' && !*end && value <= most ? value : -1;
}

/* Begins a texture whose texels lie at a place of the file. */
static const unsigned char *begin_texture(scene *s, const char *number, GLenum target, const char *place, long count)
{
    long n = count_of(number, TEXTURES - 1);
    const unsigned char *texels = bytes_at(s, count_of(place, 0x7fffffffL), count);
    if (n < 0 || s->textures[n] || !texels) {
        fail(s, "no such texture, or its texels are missing: ", number);
        return NULL;
    }
    gl.GenTextures(1, &s->textures[n]);
    gl.BindTexture(target, s->textures[n]);
    s->targets[n] = target;
    return texels;
}

/* texture N WIDTH HEIGHT PLACE */
static int make_texture(scene *s, char **words)
{
    long width = count_of(words[2], 4096), height = count_of(words[3], 4096);
    const unsigned char *texels;
    if (width < 1 || height < 1) return fail(s, "not a size: ", words[2]);
    texels = begin_texture(s, words[1], GL_TEXTURE_2D, words[4], 4 * width * height);
    if (!texels) return 0;
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)width, (GLsizei)height, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    return 1;
}

/* cube N SIDE PLACE */
static int make_cube(scene *s, char **words)
{
    long side = count_of(words[2], 4096), face;
    const unsigned char *texels;
    if (side < 1 || !s->cubes) return fail(s, "not a size, or there are no cube maps: ", words[2]);
    texels = begin_texture(s, words[1], GL_TEXTURE_CUBE_MAP, words[3], 24 * side * side);
    if (!texels) return 0;
    for (face = 0; face < 6; face++) {
        gl.TexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + (GLenum)face, 0, GL_RGBA8, (GLsizei)side, (GLsizei)side, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                      texels + 4 * side * side * face);
    }
    return 1;
}

/* depths N WIDTH HEIGHT BITS PLACE */
static int make_depths(scene *s, char **words)
{
    long width = count_of(words[2], 4096), height = count_of(words[3], 4096), bits = count_of(words[4], 24);
    int is_short = bits == 16;
    const unsigned char *texels;
    if (width < 1 || height < 1 || (bits != 16 && bits != 24)) return fail(s, "not a size: ", words[2]);
    texels = begin_texture(s, words[1], GL_TEXTURE_2D, words[5], (is_short ? 2 : 4) * width * height);
    if (!texels) return 0;
    gl.TexImage2D(GL_TEXTURE_2D, 0, is_short ? GL_DEPTH_COMPONENT16 : GL_DEPTH_COMPONENT24, (GLsizei)width, (GLsizei)height, 0, GL_DEPTH_COMPONENT,
                  is_short ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT, texels);
    return 1;
}

/* The words of a line from the first on, as values. */
static int values_of(scene *s, char **words, int first, int count, GLint *values)
{
    int n, found = 1;
    for (n = first; n < count; n++) values[n] = gl_value(words[n], &found);
    return found || fail(s, "not words of OpenGL: ", words[0]);
}

/* Makes a unit the one that calls are about. */
static int activate(scene *s, const char *word)
{
    long unit = count_of(word, UNITS - 1);
    if (unit < 0) return fail(s, "no such unit: ", word);
    if (unit >= s->units) return lack(s, "more texture units");
    drawing_activate((int)unit);
    return 1;
}

/* unit UNIT TEXTURE FILTER WRAP_S WRAP_T */
static int bind_unit(scene *s, char **words)
{
    long texture = count_of(words[2], TEXTURES - 1);
    GLint values[6];
    GLenum target;
    if (texture < 0 || !s->textures[texture]) return fail(s, "no such texture: ", words[2]);
    if (!activate(s, words[1]) || !values_of(s, words, 3, 6, values)) return 0;
    target = s->targets[texture];
    gl.Enable(target);
    gl.BindTexture(target, s->textures[texture]);
    gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, values[3]);
    gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, values[3]);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_S, values[4]);
    gl.TexParameteri(target, GL_TEXTURE_WRAP_T, values[5]);
    if (s->stretches) gl.TexParameteri(target, GL_TEXTURE_MAX_ANISOTROPY_EXT, 1);
    return 1;
}

/* anisotropy UNIT TAPS */
static int set_anisotropy(scene *s, char **words)
{
    long taps = count_of(words[2], 8);
    if (taps < 1 || !s->stretches || !activate(s, words[1])) return fail(s, "not an anisotropy: ", words[2]);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, (GLint)taps);
    return 1;
}

/* compare UNIT FUNCTION */
static int set_comparison(scene *s, char **words)
{
    GLint values[3];
    if (!activate(s, words[1]) || !values_of(s, words, 2, 3, values)) return 0;
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_R_TO_TEXTURE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, values[2]);
    return 1;
}

/* Numbers of a line from the first on. */
static int numbers_of(scene *s, char **words, int first, int count, GLfloat *numbers)
{
    int n;
    for (n = first; n < count; n++) {
        char *end;
        numbers[n] = (GLfloat)strtod(words[n], &end);
        if (end == words[n] || *end) return fail(s, "not a number: ", words[n]);
    }
    return 1;
}

/* shader UNIT NAME WORD, shader UNIT NAME WORD WORD WORD WORD, or shader UNIT NAME X Y Z */
static int set_shader(scene *s, char **words, int count)
{
    GLint values[7];
    GLfloat numbers[7] = { 0, 0, 0, 0, 0, 0, 0 };
    int found = 1;
    GLenum name = (GLenum)gl_value(words[2], &found);
    if (!found || !s->shades || !activate(s, words[1])) return fail(s, "not a line of a texture shader: ", words[2]);
    gl.Enable(GL_TEXTURE_SHADER_NV);
    if (count == 6) {
        if (!numbers_of(s, words, 3, count, numbers)) return 0;
        gl.TexEnvfv(GL_TEXTURE_SHADER_NV, name, numbers + 3);
        return 1;
    }
    if (!values_of(s, words, 3, count, values)) return 0;
    if (count == 4) gl.TexEnvi(GL_TEXTURE_SHADER_NV, name, values[3]);
    else gl.TexEnviv(GL_TEXTURE_SHADER_NV, name, values + 3);
    return 1;
}

/* depth FUNCTION WRITE */
static int set_depth(scene *s, char **words)
{
    GLint values[3];
    if (!values_of(s, words, 1, 3, values)) return 0;
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc((GLenum)values[1]);
    gl.DepthMask(values[2] != 0);
    return 1;
}

/* stencil_test FUNCTION REFERENCE MASK WRITE_MASK FAIL DEPTH_FAIL PASS */
static int set_stencil(scene *s, char **words)
{
    GLint values[8];
    if (!values_of(s, words, 1, 8, values)) return 0;
    gl.Enable(GL_STENCIL_TEST);
    gl.StencilFunc((GLenum)values[1], values[2], (GLuint)values[3]);
    gl.StencilMask((GLuint)values[4]);
    gl.StencilOp((GLenum)values[5], (GLenum)values[6], (GLenum)values[7]);
    return 1;
}

/* offset FACTOR STEPS */
static int set_offset(scene *s, char **words)
{
    GLfloat numbers[3] = { 0, 0, 0 };
    if (!numbers_of(s, words, 1, 3, numbers)) return 0;
    gl.Enable(GL_POLYGON_OFFSET_FILL);
    gl.PolygonOffset(numbers[1], numbers[2]);
    return 1;
}

/* fog_range START END, or fog_density MODE DENSITY */
static int set_fog(scene *s, char **words)
{
    GLfloat numbers[3] = { 0, 0, 0 }, values[4] = { 0, 0, 0, 0 };
    GLint mode[2];
    int is_range = strcmp(words[0], "fog_range") == 0;
    mode[1] = GL_LINEAR;
    if (!s->fogs || !numbers_of(s, words, is_range ? 1 : 2, 3, numbers)) return fail(s, "not fog: ", words[1]);
    if (!is_range && !values_of(s, words, 1, 2, mode)) return 0;
    drawing_fog((GLenum)mode[1]);
    values[0] = is_range ? numbers[1] : numbers[2];
    gl.Fogfv(is_range ? GL_FOG_START : GL_FOG_DENSITY, values);
    values[0] = numbers[2];
    if (is_range) gl.Fogfv(GL_FOG_END, values);
    return 1;
}

/* clear R G B A */
static int clear_color(scene *s, char **words)
{
    GLfloat color[5] = { 0, 0, 0, 0, 0 };
    int n;
    if (!numbers_of(s, words, 1, 5, color)) return 0;
    for (n = 1; n < 5; n++) color[n] /= 255.0f;
    gl.ClearColor(color[1], color[2], color[3], color[4]);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    return 1;
}

/* clear_depth STEPS STENCIL */
static int clear_depth(scene *s, char **words)
{
    long steps = count_of(words[1], (long)DEEPEST), stencil = count_of(words[2], 255);
    if (steps < 0 || stencil < 0) return fail(s, "not a depth: ", words[1]);
    if (drawing_max(GL_DEPTH_BITS) != 24 || drawing_max(GL_STENCIL_BITS) < 8) return lack(s, "24 bits of depth beside a stencil");
    gl.DepthMask(1);
    gl.StencilMask(255);
    gl.ClearDepth((double)steps / DEEPEST);
    gl.ClearStencil((GLint)stencil);
    gl.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    return 1;
}

/* The triangles of a draw. y points down in scenes, and up in OpenGL. */
static int draw_vertices(scene *s, char **words)
{
    long count = count_of(words[2], 1000000L), n;
    int unit;
    const unsigned char *p = count < 0 ? NULL : bytes_at(s, count_of(words[3], 0x7fffffffL), VERTEX * count);
    if (!p) return fail(s, "vertices are missing, or too many: ", words[2]);
    gl.Begin(GL_TRIANGLES);
    for (n = 0; n < count; n++, p += VERTEX) {
        GLfloat w = float_at(p + 12);
        gl.Color4ub(p[16], p[17], p[18], p[19]);
        if (s->adds) gl.SecondaryColor3ub(p[20], p[21], p[22]);
        if (s->fogs) gl.FogCoordf(float_at(p + 24));
        for (unit = 1; unit < s->units; unit++) {
            const unsigned char *at = p + 28 + 16 * unit;
            gl.MultiTexCoord4f(GL_TEXTURE0 + (GLenum)unit, float_at(at), float_at(at + 4), float_at(at + 8), float_at(at + 12));
        }
        gl.TexCoord4f(float_at(p + 28), float_at(p + 32), float_at(p + 36), float_at(p + 40));
        gl.Vertex4f((2 * float_at(p) / (GLfloat)s->width - 1) * w, (1 - 2 * float_at(p + 4) / (GLfloat)s->height) * w,
                    (GLfloat)(2.0 * float_at(p + 8) - 1) * w, w);
    }
    gl.End();
    return 1;
}

/* What a draw does not say: no texture, every channel written, no test, no blending, no fog, no combiner. */
static void begin_draw(scene *s)
{
    static const GLfloat black[4] = { 0, 0, 0, 0 };
    int unit;
    for (unit = 0; unit < s->units; unit++) {
        drawing_activate(unit);
        gl.Disable(GL_TEXTURE_2D);
        if (s->cubes) gl.Disable(GL_TEXTURE_CUBE_MAP);
        gl.TexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    }
    if (s->shades) gl.Disable(GL_TEXTURE_SHADER_NV);
    gl.ColorMask(1, 1, 1, 1);
    gl.Disable(GL_BLEND);
    gl.Disable(GL_ALPHA_TEST);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_STENCIL_TEST);
    gl.Disable(GL_POLYGON_OFFSET_FILL);
    gl.Disable(GL_FOG);
    gl.Fogfv(GL_FOG_COLOR, black);
    if (s->adds) gl.Disable(GL_COLOR_SUM);
    if (s->clamps) gl.Disable(GL_DEPTH_CLAMP);
    if (!s->combines) return;
    end_combiners(&s->batch);
    begin_combiners(&s->batch);
    reset_final();
}

/* Does what a line says; 0 with a message if it cannot. */
static int set_line(scene *s, char **words, int count)
{
    const char *what = words[0];
    if (strcmp(what, "texture") == 0 && count == 5) return make_texture(s, words);
    if (strcmp(what, "cube") == 0 && count == 4) return make_cube(s, words);
    if (strcmp(what, "depths") == 0 && count == 6) return make_depths(s, words);
    if (strcmp(what, "clear") == 0 && count == 5) return clear_color(s, words);
    if (strcmp(what, "clear_depth") == 0 && count == 3) return clear_depth(s, words);
    if (strcmp(what, "draw") == 0 && count == 1) {
        begin_draw(s);
        return 1;
    }
    if (strcmp(what, "unit") == 0 && count == 6) return bind_unit(s, words);
    if (strcmp(what, "anisotropy") == 0 && count == 3) return set_anisotropy(s, words);
    if (strcmp(what, "compare") == 0 && count == 3) return set_comparison(s, words);
    if (strcmp(what, "shader") == 0 && (count == 4 || count == 6 || count == 7)) return set_shader(s, words, count);
    if (strcmp(what, "depth") == 0 && count == 3) return set_depth(s, words);
    if (strcmp(what, "offset") == 0 && count == 3) return set_offset(s, words);
    if (strcmp(what, "stencil_test") == 0 && count == 8) return set_stencil(s, words);
    if ((strcmp(what, "fog_range") == 0 || strcmp(what, "fog_density") == 0) && count == 3) return set_fog(s, words);
    if (strcmp(what, "color_sum") == 0 && count == 1 && s->adds) {
        gl.Enable(GL_COLOR_SUM);
        return 1;
    }
    if (strcmp(what, "depth_clamp") == 0 && count == 1 && s->clamps) {
        gl.Enable(GL_DEPTH_CLAMP);
        return 1;
    }
    if (strcmp(what, "mask") == 0 && count == 5) {
        gl.ColorMask(words[1][0] == '1', words[2][0] == '1', words[3][0] == '1', words[4][0] == '1');
        return 1;
    }
    if (strcmp(what, "scissor") == 0 && count == 5) {
        int height = atoi(words[4]);
        gl.Enable(GL_SCISSOR_TEST);
        gl.Scissor(atoi(words[1]), s->height - atoi(words[2]) - height, atoi(words[3]), height);
        return 1;
    }
    if (strcmp(what, "vertices") == 0 && count == 4) return draw_vertices(s, words);
    if (strcmp(what, "blend") == 0) gl.Enable(GL_BLEND);
    return set_state(&s->d, words, count);
}

/* Whether the functions of what the scene needs are there. */
static int has_functions(const scene *s)
{
    if (s->combines && !drawing_combiners()) return 0;
    if (s->units > 1 && (!gl.ActiveTexture || !gl.MultiTexCoord4f)) return 0;
    return (!s->fogs || gl.FogCoordf) && (!s->adds || gl.SecondaryColor3ub);
}

/* Takes an extension that the scene needs. */
static int need(scene *s, const char *extension)
{
    if (s->batch.needs_count == BATCH_NEEDS) return fail(s, "this needs too much: ", extension);
    sprintf(s->batch.needs[s->batch.needs_count++], "%.120s", extension);
    s->combines |= strcmp(extension, "GL_NV_register_combiners") == 0;
    s->fogs |= strcmp(extension, "GL_EXT_fog_coord") == 0;
    s->adds |= strcmp(extension, "GL_EXT_secondary_color") == 0;
    s->clamps |= strstr(extension, "depth_clamp") != NULL;
    s->shades |= strcmp(extension, "GL_NV_texture_shader") == 0;
    s->cubes |= strstr(extension, "texture_cube_map") != NULL;
    s->stretches |= strcmp(extension, "GL_EXT_texture_filter_anisotropic") == 0;
    return 1;
}

/* Reads the head: 1, 0 with a message, or -1 if the card lacks something. */
static int read_head(scene *s, const char *text_path, const char *raw_path, size_t *place)
{
    char line[LINE], *words[BATCH_WORDS];
    size_t before;
    int count;
    s->file.text = read_file(text_path, &s->file.length);
    s->file.raw = (unsigned char *)read_file(raw_path, &s->file.raw_length);
    if (!s->file.text || !s->file.raw) return fail(s, "cannot be read", "");
    count = batch_words(&s->file, place, line, words);
    if (count != 2 || strcmp(words[0], "ninebit-scene") != 0 || strcmp(words[1], "2") != 0) return fail(s, "not a scene of this version", "");
    for (;;) {
        before = *place;
        count = batch_words(&s->file, place, line, words);
        if (count == 3 && strcmp(words[0], "size") == 0) {
            s->width = atoi(words[1]);
            s->height = atoi(words[2]);
        } else if (count == 2 && strcmp(words[0], "needs") == 0) {
            if (!need(s, words[1])) return 0;
            if (!gl_has(words[1])) {
                fail(s, words[1], "");
                return -1;
            }
        } else if (count != 2 || strcmp(words[0], "scene") != 0) {
            break;
        }
    }
    *place = before;
    if (s->width < 1 || s->height < 1 || s->width > SURFACE_WIDTH || s->height > SURFACE_HEIGHT) return fail(s, "it has no size, or is too large", "");
    return 1;
}

static int draw_lines(scene *s, size_t place)
{
    char line[LINE], *words[BATCH_WORDS];
    while (place < s->file.length) {
        int count = batch_words(&s->file, &place, line, words);
        if (count == 1 && strcmp(words[0], "end") == 0) return 1;
        if (count < 1) return fail(s, "a line is too long, or empty", "");
        if (!set_line(s, words, count)) return 0;
    }
    return fail(s, "it has no end", "");
}

static void leave(scene *s)
{
    int n;
    begin_draw(s);
    if (s->combines) end_combiners(&s->batch);
    drawing_activate(0);
    gl.DepthMask(1);
    gl.StencilMask(255);
    for (n = 0; n < TEXTURES; n++) {
        if (s->textures[n]) gl.DeleteTextures(1, &s->textures[n]);
    }
}

enum scene_status scene_draw(const char *pack, const char *results, const char *name, char *message)
{
    static const unsigned short order = 1;
    char text_path[PATH_LENGTH], raw_path[PATH_LENGTH], path[PATH_LENGTH];
    scene *s = (scene *)calloc(1, sizeof *s);
    unsigned char *pixels = NULL;
    size_t place = 0;
    int head, lacks, drawn = 0;
    if (!s) return SCENE_FAILED;
    s->d.file = &s->file;
    s->d.from = &s->batch;
    s->d.message = message;
    sprintf(text_path, "%.900s/scenes/%.60s.scene.txt", pack, name);
    sprintf(raw_path, "%.900s/scenes/%.60s.scene.raw", pack, name);
    sprintf(path, "%.900s/%.60s.png", results, name);
    head = read_head(s, text_path, raw_path, &place);
    s->units = gl.ActiveTexture ? drawing_max(GL_MAX_TEXTURE_UNITS) : 1;
    if (s->units > UNITS) s->units = UNITS;
    if (head > 0 && !has_functions(s)) {
        fail(s, "a function that the extension should have", "");
        head = -1;
    }
    if (head > 0) {
        gl.Viewport(0, 0, s->width, s->height);
        gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.Disable(GL_DITHER);
        gl.ShadeModel(GL_SMOOTH);
        gl.PixelStorei(GL_UNPACK_SWAP_BYTES, *(const unsigned char *)&order == 0);
        if (s->combines) begin_combiners(&s->batch);
        drawn = draw_lines(s, place);
        leave(s);
        pixels = (unsigned char *)malloc((size_t)s->width * (size_t)s->height * 4);
        if (drawn && pixels) {
            GLenum error;
            gl.ReadPixels(0, 0, s->width, s->height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
            error = gl.GetError();
            if (error) sprintf(message, "OpenGL error 0x%x", error);
            drawn = !error && (picture_write(path, pixels, s->width, s->height) || fail(s, "the picture cannot be written", ""));
        }
        drawn &= pixels != NULL;
    }
    lacks = s->lacks;
    free(pixels);
    free(s->file.text);
    free(s->file.raw);
    free(s);
    if (head < 0 || lacks) return SCENE_UNSUPPORTED;
    return drawn ? SCENE_DRAWN : SCENE_FAILED;
}
