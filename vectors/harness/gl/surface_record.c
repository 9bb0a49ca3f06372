/* No OpenGL at all: an implementation that writes every call to the file that NINEBIT_RECORD names, and says that it has whatever scenes
 * and combiners need. With it a test compares what is called with what the batches say. */
#include "gl.h"
#include "surface.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static FILE *out;
static GLuint texture_count;

static void record(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(out, format, arguments);
    va_end(arguments);
    fputc('\n', out);
}

#define GL_CALLED(name, parameters, recorded, names) \
    static void GL_CALL recorded_##name parameters \
    { \
        record recorded; \
    }
#define GL_ASKED(type, name, parameters, names)
#include "gl_functions.h"
#undef GL_CALLED
#undef GL_ASKED

static const GLubyte *GL_CALL recorded_GetString(GLenum name)
{
    switch (name) {
    case GL_EXTENSIONS:
        return (const GLubyte *)"GL_ARB_depth_clamp GL_ARB_depth_texture GL_ARB_multitexture GL_ARB_shadow GL_ARB_texture_cube_map GL_ARB_texture_mirrored_repeat "
                                "GL_EXT_fog_coord GL_EXT_secondary_color GL_EXT_shadow_funcs GL_EXT_stencil_wrap GL_EXT_texture_filter_anisotropic "
                                "GL_NV_register_combiners GL_NV_register_combiners2 GL_NV_texture_shader";
    case GL_VERSION:
        return (const GLubyte *)"1.2";
    default:
        return (const GLubyte *)"ninebit recorder";
    }
}

static GLenum GL_CALL recorded_GetError(void)
{
    return 0;
}

static void GL_CALL recorded_GetIntegerv(GLenum name, GLint *values)
{
    *values = name == GL_MAX_GENERAL_COMBINERS_NV ? 8 : name == GL_MAX_TEXTURE_UNITS ? 4 : name == GL_MAX_TEXTURE_SIZE ? 2048 : name == GL_SAMPLE_BUFFERS ? 0 : name == GL_DEPTH_BITS ? 24 : 8;
}

int surface_open(int width, int height)
{
    const char *path = getenv("NINEBIT_RECORD");
    out = path ? fopen(path, "w") : NULL;
    if (!out) fprintf(stderr, "NINEBIT_RECORD does not name a file that can be written\n");
    (void)width;
    (void)height;
    return out != NULL;
}

surface_function surface_lookup(const char *name)
{
    /* Whole names, the first of those that a function may have. */
#define GL_CALLED(function, parameters, recorded, names) \
    if (strncmp(names + (*names == '?'), name, strlen(name)) == 0 && strchr("|", (names + (*names == '?'))[strlen(name)])) \
        return (surface_function)recorded_##function;
#define GL_ASKED(type, function, parameters, names) GL_CALLED(function, parameters, (0), names)
#include "gl_functions.h"
#undef GL_CALLED
#undef GL_ASKED
    return NULL;
}

const char *surface_name(void)
{
    return "recorder";
}

void surface_close(void)
{
    if (out) fclose(out);
}
