/* The workloads of vectors/scenes/bench by a software OpenGL, timed without a window.
 *
 *   llvmpipe FOLDER [FRAMES]   median ns a shaded pixel of each workload; FOLDER holds the pictures
 *   llvmpipe FOLDER FRAMES WORKLOAD PICTURE.png
 *                              the same of one workload, then its frame against a picture: rms over R, G and B, and the largest difference
 *   llvmpipe --mesh            the scene of W6 in RON, from the numbers that are drawn here
 *
 * Which renderer runs is the environment's choice (GALLIUM_DRIVER, LP_NUM_THREADS): compare.sh sets it.
 */
#define EGL_EGLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 640, HEIGHT = 480, CELL = 10, CELLS = 5000, TEXTURES = 12, WORKLOADS = 15 };

static void fail(const char *what)
{
    fprintf(stderr, "llvmpipe: %s\n", what);
    exit(1);
}

/* Light towards a point near the middle of a plane that the frame shows. */
typedef struct { double x, y, z; } Vector;

static Vector light_at(double x, double y)
{
    Vector v = { 0.3 - x, 0.2 - y, 0.8 };
    return v;
}

static double length(Vector v) { return sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/* A component of -1 to 1 as a byte. */
static int biased(double v) { return (int)floor(v * 127.5 + 128.0); }

/* ---- The mesh of W6: cells of 10 x 10 pixels in rows, then further layers shifted by (3, 5) pixels. ---- */

typedef struct { float clip[4], st[2]; unsigned char color[4]; } MeshVertex;

static void mesh_vertex(int layer, int column, int row, MeshVertex *out)
{
    double px = column * CELL + 3 * layer, py = row * CELL + 5 * layer;
    double nx = 2 * px / WIDTH - 1, ny = 2 * py / HEIGHT - 1, w = 1.5 + 0.5 * ny;
    Vector v = light_at(nx * w, ny * w);
    double m = length(v);
    MeshVertex vertex = {
        { nx * w, ny * w, 0, w },
        { px / 300 * w, py / 300 * w },
        { biased(v.x / m), biased(v.y / m), biased(v.z / m), 255 },
    };
    *out = vertex;
}

static const int COLUMNS = (WIDTH - CELL) / CELL, ROWS = (HEIGHT - CELL) / CELL;

static void cell_place(int cell, int *layer, int *column, int *row)
{
    int per_layer = COLUMNS * ROWS;
    *layer = cell / per_layer;
    *column = cell % per_layer % COLUMNS;
    *row = cell % per_layer / COLUMNS;
}

/* A number in the fewest digits that read back as the same float, so that the file stays small. */
static void print_number(const char *before, float number)
{
    char text[32];
    for (int digits = 1; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtof(text, NULL) == number) break;
    }
    printf("%s%s", before, text);
}

static void print_mesh(void)
{
    int per_layer = COLUMNS * ROWS, layers = (CELLS + per_layer - 1) / per_layer;
    printf("// DOT3 on ten thousand small triangles: This benchmark (W6) takes the dot product of W1 on 10,000 triangles of 50 pixels, in perspective.\n"
           "// Written by benches/peers/llvmpipe.c.\n"
           "(\n    version: 1,\n    profile: Nv2a,\n    targets: [(name: \"frame\", width: %d, height: %d)],\n"
           "    textures: {\n        \"normals\": (source: File(\"normal.png\")),\n    },\n    draws: [\n    (\n"
           "        name: \"mesh\",\n        vertices: Window([\n", WIDTH, HEIGHT);
    for (int layer = 0; layer < layers; layer++)
        for (int row = 0; row <= ROWS; row++)
            for (int column = 0; column <= COLUMNS; column++) {
                MeshVertex v;
                mesh_vertex(layer, column, row, &v);
                printf("(position:(%d,%d,0", column * CELL + 3 * layer, HEIGHT - row * CELL - 5 * layer);
                print_number(",", v.clip[3]);
                printf("),diffuse:(%d,%d,%d)", v.color[0], v.color[1], v.color[2]);
                print_number(",t0:(", v.st[0]);
                print_number(",", v.st[1]);
                printf(")),\n");
            }
    printf("        ]),\n        indices: [");
    for (int cell = 0; cell < CELLS; cell++) {
        int layer, column, row;
        cell_place(cell, &layer, &column, &row);
        int a = layer * (COLUMNS + 1) * (ROWS + 1) + row * (COLUMNS + 1) + column, b = a + COLUMNS + 1;
        printf("%s%d,%d,%d,%d,%d,%d,", cell % 8 ? "" : "\n", a, a + 1, b, b, a + 1, b + 1);
    }
    printf("\n        ],\n        textures: [\"normals\"],\n        program: Combiners(\n"
           "            stages: [(rgb: (a: ExpandNormal(Texture0), b: ExpandNormal(PrimaryColor), ab: Spare0, "
           "ab_dot_product: true))],\n            final_combiner: (d: Spare0),\n        ),\n    ),\n    ],\n)\n");
}

static void send_mesh(void)
{
    static MeshVertex vertices[CELLS * 4];
    static GLuint indices[CELLS * 6], buffers[2];
    for (int cell = 0; cell < CELLS; cell++) {
        int layer, column, row;
        cell_place(cell, &layer, &column, &row);
        for (int n = 0; n < 4; n++) mesh_vertex(layer, column + n % 2, row + n / 2, &vertices[4 * cell + n]);
        const GLuint corners[6] = { 0, 1, 2, 2, 1, 3 };
        for (int n = 0; n < 6; n++) indices[6 * cell + n] = 4 * cell + corners[n];
    }
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, sizeof vertices, vertices, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
    glVertexPointer(4, GL_FLOAT, sizeof(MeshVertex), (void *)0);
    glTexCoordPointer(2, GL_FLOAT, sizeof(MeshVertex), (void *)16);
    glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(MeshVertex), (void *)24);
}

/* ---- Textures ---- */

enum { NORMAL, COLOR, HALVES, CUBE = HALVES + 6, LEVELS, BLOCKS, NARROW };
static GLuint textures[TEXTURES];
static const char *const SIDES[6] = { "positive-x", "negative-x", "positive-y", "negative-y", "positive-z", "negative-z" };

static void load_as(const char *folder, const char *name, GLenum target, GLint format, int gray)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    png_image image = { .version = PNG_IMAGE_VERSION };
    if (!png_image_begin_read_from_file(&image, path)) fail(path);
    image.format = gray ? PNG_FORMAT_GRAY : PNG_FORMAT_RGBA;
    void *pixels = malloc(PNG_IMAGE_SIZE(image));
    if (!pixels || !png_image_finish_read(&image, NULL, pixels, 0, NULL)) fail(path);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(target, 0, format, image.width, image.height, 0,
                 gray ? GL_LUMINANCE : GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    free(pixels);
}

static void load(const char *folder, const char *name, GLenum target, int gray)
{
    load_as(folder, name, target, gray ? GL_LUMINANCE8 : GL_RGBA8, gray);
}

/* An image of DXT1 blocks after the 128 bytes of a DDS header. */
static void load_blocks(const char *folder, const char *name)
{
    enum { SIDE = 256, HEADER = 128, SIZE = SIDE * SIDE / 2 };
    static unsigned char bytes[HEADER + SIZE];
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.dds", folder, name);
    FILE *file = fopen(path, "rb");
    if (!file || fread(bytes, 1, sizeof bytes, file) != sizeof bytes) fail(path);
    fclose(file);
    glCompressedTexImage2D(GL_TEXTURE_2D, 0, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, SIDE, SIDE, 0, SIZE, bytes + HEADER);
}

static void parameters(GLenum target, GLint wrap, GLint filter)
{
    glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
}

static void load_textures(const char *folder)
{
    char name[64];
    glGenTextures(TEXTURES, textures);
    for (int n = 0; n < CUBE; n++) {
        glBindTexture(GL_TEXTURE_2D, textures[n]);
        if (n < HALVES) snprintf(name, sizeof name, n == NORMAL ? "normal" : "color");
        else snprintf(name, sizeof name, "half-%s", SIDES[n - HALVES]);
        load(folder, name, GL_TEXTURE_2D, n >= HALVES);
        parameters(GL_TEXTURE_2D, GL_REPEAT, GL_LINEAR);
    }
    glBindTexture(GL_TEXTURE_CUBE_MAP, textures[CUBE]);
    for (int face = 0; face < 6; face++) {
        snprintf(name, sizeof name, "direction-%s", SIDES[face]);
        load(folder, name, GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0);
    }
    parameters(GL_TEXTURE_CUBE_MAP, GL_CLAMP_TO_EDGE, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, textures[LEVELS]);
    load(folder, "color", GL_TEXTURE_2D, 0);
    glGenerateMipmap(GL_TEXTURE_2D);
    parameters(GL_TEXTURE_2D, GL_REPEAT, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glBindTexture(GL_TEXTURE_2D, textures[BLOCKS]);
    load_blocks(folder, "color");
    parameters(GL_TEXTURE_2D, GL_REPEAT, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, textures[NARROW]);
    load_as(folder, "color", GL_TEXTURE_2D, GL_RGB565, 0);
    parameters(GL_TEXTURE_2D, GL_REPEAT, GL_LINEAR);
}

/* ---- What fixed functions do not suffice for ---- */

static const char *const VERTEX =
    "#version 120\n"
    "varying vec4 a, b, c, d;\n"
    "varying float fog;\n"
    "void main() {\n"
    "    gl_Position = gl_Vertex;\n"
    "    gl_FrontColor = gl_Color;\n"
    "    a = gl_MultiTexCoord0; b = gl_MultiTexCoord1; c = gl_MultiTexCoord2; d = gl_MultiTexCoord3;\n"
    "    fog = gl_Vertex.w;\n"
    "}\n";

#define FRAGMENT "#version 120\nvarying vec4 a, b, c, d; varying float fog; uniform sampler2D t0, t1, t2, t3; uniform samplerCube c3;\n"

/* By workload, from W7 on. */
static const char *const FRAGMENTS[] = {
    /* The byte of a signed channel is a 128th of two's complement. */
    FRAGMENT "void main() {\n"
             "    vec3 n = texture2D(t0, a.xy).rgb;\n"
             "    vec2 moved = a.xy + 0.35 * vec2(n.b * 2.0 - 1.0, n.g * 2.0 - 1.0);\n"
             "    gl_FragColor = texture2D(t1, moved) * clamp(n.r * 1.1 + 0.05, 0.0, 1.0);\n"
             "}\n",
    FRAGMENT "void main() {\n"
             "    vec3 n = texture2D(t0, a.xy).rgb * 2.0 - 1.0, e = vec3(b.w, c.w, d.w);\n"
             "    vec3 m = vec3(dot(b.xyz, n), dot(c.xyz, n), dot(d.xyz, n));\n"
             "    gl_FragColor = textureCube(c3, 2.0 * dot(m, e) / dot(m, m) * m - e);\n"
             "}\n",
    FRAGMENT "void main() { gl_FragColor = texture2D(t0, a.xy) * gl_Color; }\n",
    FRAGMENT "void main() {\n"
             "    float l = clamp(dot(texture2D(t0, a.xy).rgb * 2.0 - 1.0, gl_Color.rgb * 2.0 - 1.0), 0.0, 1.0);\n"
             "    vec4 sum = clamp(texture2D(t2, a.xy) * l + texture2D(t1, a.xy), 0.0, 1.0);\n"
             "    gl_FragColor = sum * texture2D(t3, a.xy);\n"
             "}\n",
    FRAGMENT "void main() {\n"
             "    float l = clamp(dot(texture2D(t0, a.xy).rgb * 2.0 - 1.0, gl_Color.rgb * 2.0 - 1.0), 0.0, 1.0);\n"
             "    float x = 0.6 * fog, factor = clamp(exp(-x * x), 0.0, 1.0);\n"
             "    vec3 color = texture2D(t1, a.xy).rgb * l;\n"
             "    gl_FragColor = vec4(mix(vec3(0.588, 0.627, 0.706), color, factor), 1.0);\n"
             "}\n",
    FRAGMENT "void main() { gl_FragColor = vec4(texture2D(t0, a.xy).rgb * texture2D(t1, a.xy).rgb, 0.5); }\n",
};

static GLuint compiled(GLenum kind, const char *text)
{
    GLuint shader = glCreateShader(kind);
    GLint done;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (!done) fail(text);
    return shader;
}

static void use_program(const char *fragment)
{
    const char *const samplers[] = { "t0", "t1", "t2", "t3" };
    GLuint program = glCreateProgram();
    GLint done;
    glAttachShader(program, compiled(GL_VERTEX_SHADER, VERTEX));
    glAttachShader(program, compiled(GL_FRAGMENT_SHADER, fragment));
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &done);
    if (!done) fail("a program does not link");
    glUseProgram(program);
    for (int n = 0; n < 4; n++) glUniform1i(glGetUniformLocation(program, samplers[n]), n);
    glUniform1i(glGetUniformLocation(program, "c3"), 3);
}

/* A surface of its own, with depths. */
static void use_surface(GLenum format)
{
    GLuint frame, buffers[2];
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glGenRenderbuffers(2, buffers);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, format, WIDTH, HEIGHT);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, WIDTH, HEIGHT);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail("no surface");
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

/* ---- The quad: w = 1 along the lower edge, 2 along the upper, so that everything on it is in perspective. ---- */

enum { PLAIN = -2, LIGHT = -1 /* 0 to 5: half a component of the light */ };

static void quad(int color, int cube, double density)
{
    const double corners[6][2] = { { -1, -1 }, { 1, -1 }, { -1, 1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    glBegin(GL_TRIANGLES);
    for (int n = 0; n < 6; n++) {
        double x = corners[n][0], y = corners[n][1], w = y > 0 ? 2 : 1;
        Vector v = light_at(x * w, y * w);
        double m = length(v), component[3] = { v.x / m, v.y / m, v.z / m };
        if (color == PLAIN) glColor4ub(230, 204, 179, 255);
        else if (color == LIGHT) glColor4ub(biased(component[0]), biased(component[1]), biased(component[2]), 255);
        else {
            double half = fmax(0, color % 2 ? -component[color / 2] : component[color / 2]);
            glColor4d(half, half, half, 1);
        }
        double s = density * (x + 1) * w, t = density * 0.75 * (y + 1) * w;
        glMultiTexCoord2d(GL_TEXTURE0, s, t);
        if (cube) glMultiTexCoord3d(GL_TEXTURE1, v.x, v.y, v.z);
        else glMultiTexCoord2d(GL_TEXTURE1, s, t);
        glVertex4d(x * w, y * w, 0, w);
    }
    glEnd();
}

/* The same, with the rows of a matrix and an eye vector in sets 1 to 3. */
static void shaded_quad(double density)
{
    const double corners[6][2] = { { -1, -1 }, { 1, -1 }, { -1, 1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    glBegin(GL_TRIANGLES);
    for (int n = 0; n < 6; n++) {
        double x = corners[n][0], y = corners[n][1], w = y > 0 ? 2 : 1;
        Vector v = light_at(x * w, y * w);
        double m = length(v);
        glColor4ub(biased(v.x / m), biased(v.y / m), biased(v.z / m), 255);
        glMultiTexCoord2d(GL_TEXTURE0, density * (x + 1) * w, density * 0.75 * (y + 1) * w);
        glMultiTexCoord4d(GL_TEXTURE1, 1, 0, 0, x * w);
        glMultiTexCoord4d(GL_TEXTURE2, 0, 1, 0, y * w);
        glMultiTexCoord4d(GL_TEXTURE3, 0, 0, 1, 2);
        glVertex4d(x * w, y * w, 0.25 * y * w, w);
    }
    glEnd();
}

/* ---- State ---- */

static void unit(int n, GLenum target, GLuint texture, GLenum combine, GLenum with)
{
    glActiveTexture(GL_TEXTURE0 + n);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_TEXTURE_CUBE_MAP);
    if (!texture) return;
    glEnable(target);
    glBindTexture(target, texture);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_COMBINE);
    glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, combine);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC0_RGB, GL_TEXTURE);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC1_RGB, with);
    glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_ALPHA, GL_REPLACE);
    glTexEnvi(GL_TEXTURE_ENV, GL_SRC0_ALPHA, GL_PREVIOUS);
}

static void bind(int n, GLenum target, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + n);
    glBindTexture(target, texture);
}

/* Workloads whose fragments are programs. */
static void set_up_program(int workload)
{
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_TEXTURE_COORD_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    bind(0, GL_TEXTURE_2D, textures[workload == 9 ? LEVELS : workload == 12 ? BLOCKS : NORMAL]);
    if (workload != 9 && workload != 12) parameters(GL_TEXTURE_2D, GL_REPEAT, GL_LINEAR);
    bind(1, GL_TEXTURE_2D, textures[workload == 12 ? NARROW : COLOR]);
    parameters(GL_TEXTURE_2D, GL_REPEAT, GL_LINEAR);
    bind(2, GL_TEXTURE_2D, textures[HALVES]);
    bind(3, GL_TEXTURE_2D, textures[HALVES + 2]);
    bind(3, GL_TEXTURE_CUBE_MAP, textures[CUBE]);
    use_program(FRAGMENTS[workload - 7]);
    if (workload == 11) {
        use_surface(GL_RGBA8);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LEQUAL);
    }
    if (workload == 12) {
        use_surface(GL_RGB565);
        glDisable(GL_DEPTH_TEST);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
}

#include "grid.h"

static void set_up(int workload)
{
    GLuint normal = textures[NORMAL], color = textures[COLOR];
    if (workload >= 14) {
        set_up_grid(workload);
        return;
    }
    if (workload >= 7) {
        set_up_program(workload);
        return;
    }
    unit(1, 0, 0, 0, 0);
    glDisable(GL_BLEND);
    switch (workload) {
    case 1:
    case 6:
        unit(0, GL_TEXTURE_2D, normal, GL_DOT3_RGB, GL_PRIMARY_COLOR);
        break;
    case 2:
        unit(0, GL_TEXTURE_2D, normal, GL_DOT3_RGB, GL_PRIMARY_COLOR);
        unit(1, GL_TEXTURE_2D, color, GL_MODULATE, GL_PREVIOUS);
        break;
    case 3:
        unit(0, GL_TEXTURE_2D, normal, GL_REPLACE, GL_TEXTURE);
        unit(1, GL_TEXTURE_CUBE_MAP, textures[CUBE], GL_DOT3_RGB, GL_PREVIOUS);
        break;
    case 4:
        unit(0, GL_TEXTURE_2D, textures[HALVES], GL_MODULATE, GL_PRIMARY_COLOR);
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE);
        break;
    default:
        unit(0, GL_TEXTURE_2D, color, GL_MODULATE, GL_PRIMARY_COLOR);
        break;
    }
    glActiveTexture(GL_TEXTURE0);
    if (workload >= 5) {
        glBindTexture(GL_TEXTURE_2D, workload == 5 ? color : normal);
        parameters(GL_TEXTURE_2D, GL_REPEAT, workload == 5 ? GL_NEAREST : GL_LINEAR);
    }
    if (workload == 6) {
        send_mesh();
        glEnableClientState(GL_VERTEX_ARRAY);
        glEnableClientState(GL_TEXTURE_COORD_ARRAY);
        glEnableClientState(GL_COLOR_ARRAY);
    }
}

static void draw(int workload)
{
    switch (workload) {
    case 4:
        glClear(GL_COLOR_BUFFER_BIT);
        for (int pass = 0; pass < 12; pass++) {
            /* Equal signs add, unequal ones subtract. */
            glBlendEquation(pass < 6 ? GL_FUNC_ADD : GL_FUNC_REVERSE_SUBTRACT);
            glBindTexture(GL_TEXTURE_2D, textures[HALVES + pass % 6]);
            quad(pass < 6 ? pass : (pass % 6) ^ 1, 0, 1);
        }
        glBlendEquation(GL_FUNC_ADD);
        break;
    case 6:
        glDrawElements(GL_TRIANGLES, CELLS * 6, GL_UNSIGNED_INT, 0);
        break;
    case 7:
    case 8:
    case 9:
    case 10:
    case 11:
    case 12:
        shaded_quad(workload == 9 ? 4 : 1);
        break;
    case 14:
    case 15:
        glDrawArrays(GL_TRIANGLES, 0, grid_vertices);
        break;
    default:
        quad(workload == 3 || workload == 5 ? PLAIN : LIGHT, workload == 3, 1);
        break;
    }
    glFinish();
}

/* ---- Time ---- */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * t.tv_sec + t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void measure(int workload, int frames)
{
    GLuint query, shaded = 0;
    set_up(workload);
    draw(workload);
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    draw(workload);
    glEndQuery(GL_SAMPLES_PASSED);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &shaded);
    if (!shaded || glGetError()) fail("a workload draws nothing");
    double *times = malloc(frames * sizeof *times);
    if (!times) fail("no memory");
    for (int n = 0; n < frames; n++) {
        double start = now();
        draw(workload);
        times[n] = now() - start;
    }
    qsort(times, frames, sizeof *times, ascending);
    printf("w%d %u %.3f %.3f\n", workload, shaded, times[frames / 2] / shaded, times[0] / shaded);
    free(times);
}

/* The frame of a workload, which has been drawn, against a picture of it. */
static void compare(const char *path)
{
    static unsigned char drawn[WIDTH * HEIGHT * 4], wanted[WIDTH * HEIGHT * 4];
    png_image image = { .version = PNG_IMAGE_VERSION };
    if (!png_image_begin_read_from_file(&image, path)) fail(path);
    image.format = PNG_FORMAT_RGBA;
    if (image.width != WIDTH || image.height != HEIGHT) fail("the picture has another size");
    if (!png_image_finish_read(&image, NULL, wanted, 0, NULL)) fail(path);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, drawn);
    double squares = 0;
    int largest = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int n = 0; n < 3; n++) {
                /* Rows of OpenGL begin below. */
                int off = drawn[((HEIGHT - 1 - y) * WIDTH + x) * 4 + n] - wanted[(y * WIDTH + x) * 4 + n];
                squares += off * off;
                largest = abs(off) > largest ? abs(off) : largest;
            }
    printf("rms %.4f largest %d\n", sqrt(squares / (3.0 * WIDTH * HEIGHT)), largest);
}

int main(int count, char **arguments)
{
    if (count == 2 && !strcmp(arguments[1], "--mesh")) {
        print_mesh();
        return 0;
    }
    if (count < 2) fail("usage: llvmpipe FOLDER [FRAMES [WORKLOAD PICTURE.png]] | llvmpipe --mesh");
    int frames = count > 2 ? atoi(arguments[2]) : 60;
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (frames < 1 || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API)) fail("no OpenGL");
    const EGLint wanted[] = { EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                              EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_ALPHA_SIZE, 8,
                              EGL_DEPTH_SIZE, 0, EGL_NONE };
    const EGLint size[] = { EGL_WIDTH, WIDTH, EGL_HEIGHT, HEIGHT, EGL_NONE };
    EGLConfig config;
    EGLint found = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &found) || !found) fail("no frame of 32 bits");
    EGLSurface surface = eglCreatePbufferSurface(display, config, size);
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, NULL);
    if (!eglMakeCurrent(display, surface, surface, context)) fail("no context");
    printf("# %s, OpenGL %s\n", glGetString(GL_RENDERER), glGetString(GL_VERSION));
    glDisable(GL_DITHER);
    glViewport(0, 0, WIDTH, HEIGHT);
    load_textures(arguments[1]);
    int only = count > 4 ? atoi(arguments[3]) : 0;
    for (int workload = 1; workload <= WORKLOADS; workload++)
        if (workload != 13 && (!only || workload == only)) measure(workload, frames);
    if (only) compare(arguments[4]);
    return 0;
}
