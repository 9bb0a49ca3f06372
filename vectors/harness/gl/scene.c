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
/* Bytes of a vertex: x and y, two colors, four coordinates of two units. */
#define VERTEX 48

/* A scene that is read line by line, as a batch is. */
typedef struct scene {
    drawing d;
    batch_file file;
    batch batch;
    int width, height, blends;
    GLuint textures[TEXTURES];
} scene;

static int fail(scene *s, const char *message, const char *detail)
{
    return drawing_fail(&s->d, message, detail);
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

static int make_texture(scene *s, char **words)
{
    long n = strtol(words[1], NULL, 10), width = strtol(words[2], NULL, 10), height = strtol(words[3], NULL, 10);
    const unsigned char *texels;
    if (n < 0 || n >= TEXTURES || width < 1 || height < 1 || width > 4096 || height > 4096) return fail(s, "no such texture: ", words[1]);
    texels = bytes_at(s, strtol(words[4], NULL, 10), 4 * width * height);
    if (!texels) return fail(s, "texels are missing: ", words[1]);
    gl.GenTextures(1, &s->textures[n]);
    gl.BindTexture(GL_TEXTURE_2D, s->textures[n]);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)width, (GLsizei)height, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    return 1;
}

/* Binds a texture to a unit. */
static int bind_unit(scene *s, char **words)
{
    long unit = strtol(words[1], NULL, 10), texture = strtol(words[2], NULL, 10);
    GLint filter, wrap_s, wrap_t;
    int found = 1, all;
    if (unit < 0 || unit > 1 || texture < 0 || texture >= TEXTURES || !s->textures[texture]) return fail(s, "no such unit: ", words[1]);
    filter = gl_value(words[3], &found);
    all = found;
    found = 1;
    wrap_s = gl_value(words[4], &found);
    all &= found;
    found = 1;
    wrap_t = gl_value(words[5], &found);
    all &= found;
    if (!all) return fail(s, "not a word of a unit: ", words[3]);
    drawing_activate((int)unit);
    gl.Enable(GL_TEXTURE_2D);
    gl.BindTexture(GL_TEXTURE_2D, s->textures[texture]);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_s);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_t);
    return 1;
}

/* The triangles of a draw. y points down in scenes, and up in OpenGL. */
static int draw_vertices(scene *s, char **words)
{
    long count = strtol(words[2], NULL, 10), n;
    const unsigned char *p;
    if (count < 0 || count > 1000000L) return fail(s, "too many vertices: ", words[2]);
    p = bytes_at(s, strtol(words[3], NULL, 10), VERTEX * count);
    if (!p) return fail(s, "vertices are missing", "");
    gl.Begin(GL_TRIANGLES);
    for (n = 0; n < count; n++, p += VERTEX) {
        gl.Color4ub(p[8], p[9], p[10], p[11]);
        if (gl.SecondaryColor3ub) gl.SecondaryColor3ub(p[12], p[13], p[14]);
        gl.MultiTexCoord2f(GL_TEXTURE0 + 1, float_at(p + 32), float_at(p + 36));
        gl.TexCoord4f(float_at(p + 16), float_at(p + 20), float_at(p + 24), float_at(p + 28));
        gl.Vertex2f(2 * float_at(p) / (GLfloat)s->width - 1, 1 - 2 * float_at(p + 4) / (GLfloat)s->height);
    }
    gl.End();
    return 1;
}

/* What a draw does not say: no texture, every channel written, no blending, no combiner. */
static void begin_draw(scene *s)
{
    int unit;
    for (unit = 0; unit < 2; unit++) {
        drawing_activate(unit);
        gl.Disable(GL_TEXTURE_2D);
    }
    gl.ColorMask(1, 1, 1, 1);
    gl.Disable(GL_BLEND);
    gl.Disable(GL_ALPHA_TEST);
    gl.Disable(GL_SCISSOR_TEST);
    end_combiners(&s->batch);
    begin_combiners(&s->batch);
    reset_final();
}

/* Does what a line says; 0 with a message if it cannot. */
static int set_line(scene *s, char **words, int count)
{
    const char *what = words[0];
    if (strcmp(what, "texture") == 0 && count == 5) return make_texture(s, words);
    if (strcmp(what, "clear") == 0 && count == 5) {
        GLfloat color[4];
        int n;
        for (n = 0; n < 4; n++) color[n] = (GLfloat)strtol(words[n + 1], NULL, 10) / 255.0f;
        gl.ClearColor(color[0], color[1], color[2], color[3]);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        return 1;
    }
    if (strcmp(what, "draw") == 0 && count == 1) {
        begin_draw(s);
        return 1;
    }
    if (strcmp(what, "unit") == 0 && count == 6) return bind_unit(s, words);
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
    if (count != 2 || strcmp(words[0], "ninebit-scene") != 0 || strcmp(words[1], "1") != 0) return fail(s, "not a scene of this version", "");
    for (;;) {
        before = *place;
        count = batch_words(&s->file, place, line, words);
        if (count == 3 && strcmp(words[0], "size") == 0) {
            s->width = atoi(words[1]);
            s->height = atoi(words[2]);
        } else if (count == 2 && strcmp(words[0], "needs") == 0) {
            if (s->batch.needs_count < BATCH_NEEDS) sprintf(s->batch.needs[s->batch.needs_count++], "%.120s", words[1]);
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
    end_combiners(&s->batch);
    drawing_activate(0);
    for (n = 0; n < TEXTURES; n++) {
        if (s->textures[n]) gl.DeleteTextures(1, &s->textures[n]);
    }
}

enum scene_status scene_draw(const char *pack, const char *results, const char *name, char *message)
{
    char text_path[PATH_LENGTH], raw_path[PATH_LENGTH], path[PATH_LENGTH];
    scene *s = (scene *)calloc(1, sizeof *s);
    unsigned char *pixels = NULL;
    size_t place = 0;
    int head, drawn = 0;
    if (!s) return SCENE_FAILED;
    s->d.file = &s->file;
    s->d.from = &s->batch;
    s->d.message = message;
    s->d.combines = 1;
    sprintf(text_path, "%.900s/scenes/%.60s.scene.txt", pack, name);
    sprintf(raw_path, "%.900s/scenes/%.60s.scene.raw", pack, name);
    sprintf(path, "%.900s/%.60s.png", results, name);
    head = read_head(s, text_path, raw_path, &place);
    if (head > 0 && (!gl.ActiveTexture || !gl.MultiTexCoord2f || !gl.CombinerInputNV || !gl.FinalCombinerInputNV)) {
        fail(s, "a function that the extension should have", "");
        head = -1;
    }
    if (head > 0) {
        gl.Viewport(0, 0, s->width, s->height);
        gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
        gl.Disable(GL_DITHER);
        gl.ShadeModel(GL_SMOOTH);
        begin_combiners(&s->batch);
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
    free(pixels);
    free(s->file.text);
    free(s->file.raw);
    free(s);
    if (head < 0) return SCENE_UNSUPPORTED;
    return drawn ? SCENE_DRAWN : SCENE_FAILED;
}
