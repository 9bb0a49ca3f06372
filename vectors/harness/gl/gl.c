#include "gl.h"
#include "surface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

gl_functions gl;

/* Finds a function under any of its names. */
static int load(surface_function *into, const char *names)
{
    char name[64];
    int optional = *names == '?';
    names += optional;
    *into = NULL;
    while (*names && !*into) {
        size_t length = strcspn(names, "|");
        if (length >= sizeof name) return 0;
        memcpy(name, names, length);
        name[length] = '\0';
        *into = surface_lookup(name);
        names += length + (names[length] == '|');
    }
    if (!*into && !optional) fprintf(stderr, "OpenGL has no %s\n", name);
    return *into || optional;
}

int gl_load(void)
{
    union {
        surface_function any;
#define GL_CALLED(name, parameters, record, names) void (GL_CALL *name) parameters;
#define GL_ASKED(type, name, parameters, names) type (GL_CALL *name) parameters;
#include "gl_functions.h"
#undef GL_CALLED
#undef GL_ASKED
    } function;
    int whole = 1;
#define GL_CALLED(name, parameters, record, names) \
    whole &= load(&function.any, names); \
    gl.name = function.name;
#define GL_ASKED(type, name, parameters, names) GL_CALLED(name, parameters, (0), names)
#include "gl_functions.h"
#undef GL_CALLED
#undef GL_ASKED
    return whole;
}

/* Whether a word stands in a list of words. */
static int listed(const char *list, const char *word, size_t length)
{
    const char *at = list;
    while (at && (at = strstr(at, word)) != NULL) {
        size_t found = strcspn(at, " ");
        if ((at == list || at[-1] == ' ') && found == length) return 1;
        at += found;
    }
    return 0;
}

int gl_has(const char *needs)
{
    const char *extensions = (const char *)gl.GetString(GL_EXTENSIONS);
    char name[128];
    while (*needs) {
        size_t length = strcspn(needs, "|");
        if (length < sizeof name) {
            memcpy(name, needs, length);
            name[length] = '\0';
            if (listed(extensions, name, length)) return 1;
        }
        needs += length + (needs[length] == '|');
    }
    return 0;
}

/* Names that batches use, with their values in the registry of OpenGL. */
static const struct {
    const char *name;
    GLint value;
} constants[] = {
    { "ZERO", 0 }, { "NONE", 0 }, { "ONE", 1 },
    { "NEVER", 0x0200 }, { "LESS", 0x0201 }, { "EQUAL", 0x0202 }, { "LEQUAL", 0x0203 }, { "GREATER", 0x0204 }, { "NOTEQUAL", 0x0205 },
    { "GEQUAL", 0x0206 }, { "ALWAYS", 0x0207 },
    { "SRC_COLOR", 0x0300 }, { "ONE_MINUS_SRC_COLOR", 0x0301 }, { "SRC_ALPHA", 0x0302 }, { "ONE_MINUS_SRC_ALPHA", 0x0303 },
    { "DST_ALPHA", 0x0304 }, { "ONE_MINUS_DST_ALPHA", 0x0305 }, { "DST_COLOR", 0x0306 }, { "ONE_MINUS_DST_COLOR", 0x0307 },
    { "SRC_ALPHA_SATURATE", 0x0308 },
    { "CONSTANT_COLOR", 0x8001 }, { "ONE_MINUS_CONSTANT_COLOR", 0x8002 }, { "CONSTANT_ALPHA", 0x8003 }, { "ONE_MINUS_CONSTANT_ALPHA", 0x8004 },
    { "FUNC_ADD", 0x8006 }, { "MIN", 0x8007 }, { "MAX", 0x8008 }, { "FUNC_SUBTRACT", 0x800A }, { "FUNC_REVERSE_SUBTRACT", 0x800B },
    { "UNSIGNED_BYTE", 0x1401 }, { "UNSIGNED_SHORT_5_6_5", 0x8363 }, { "UNSIGNED_SHORT_4_4_4_4_REV", 0x8365 },
    { "UNSIGNED_SHORT_1_5_5_5_REV", 0x8366 }, { "UNSIGNED_INT_8_8_8_8_REV", 0x8367 },
    { "ALPHA", 0x1906 }, { "RGB", 0x1907 }, { "RGBA", 0x1908 }, { "LUMINANCE", 0x1909 }, { "LUMINANCE_ALPHA", 0x190A }, { "BGRA", 0x80E1 },
    { "BLUE", 0x1905 }, { "ALPHA8", 0x803C }, { "LUMINANCE8", 0x8040 }, { "LUMINANCE8_ALPHA8", 0x8045 }, { "INTENSITY8", 0x804B },
    { "RGB5", 0x8050 }, { "RGB8", 0x8051 }, { "RGBA4", 0x8056 }, { "RGB5_A1", 0x8057 }, { "RGBA8", 0x8058 },
    { "COMPRESSED_RGBA_S3TC_DXT1_EXT", 0x83F1 }, { "COMPRESSED_RGBA_S3TC_DXT3_EXT", 0x83F2 }, { "COMPRESSED_RGBA_S3TC_DXT5_EXT", 0x83F3 },
    { "TEXTURE", 0x1702 }, { "REPLACE", 0x1E01 }, { "MODULATE", 0x2100 }, { "DECAL", 0x2101 }, { "BLEND", 0x0BE2 }, { "ALPHA_SCALE", 0x0D1C }, { "ADD", 0x0104 }, { "TEXTURE_ENV_MODE", 0x2200 },
    { "COMBINE", 0x8570 }, { "COMBINE_RGB", 0x8571 }, { "COMBINE_ALPHA", 0x8572 }, { "RGB_SCALE", 0x8573 }, { "ADD_SIGNED", 0x8574 },
    { "INTERPOLATE", 0x8575 }, { "CONSTANT", 0x8576 }, { "PRIMARY_COLOR", 0x8577 }, { "PREVIOUS", 0x8578 }, { "SUBTRACT", 0x84E7 },
    { "COMBINE4_NV", 0x8503 }, { "SOURCE0_RGB", 0x8580 }, { "SOURCE1_RGB", 0x8581 }, { "SOURCE2_RGB", 0x8582 },
    { "SOURCE3_RGB_NV", 0x8583 }, { "SOURCE0_ALPHA", 0x8588 }, { "SOURCE1_ALPHA", 0x8589 }, { "SOURCE2_ALPHA", 0x858A },
    { "SOURCE3_ALPHA_NV", 0x858B }, { "OPERAND0_RGB", 0x8590 }, { "OPERAND1_RGB", 0x8591 }, { "OPERAND2_RGB", 0x8592 },
    { "OPERAND3_RGB_NV", 0x8593 }, { "OPERAND0_ALPHA", 0x8598 }, { "OPERAND1_ALPHA", 0x8599 }, { "OPERAND2_ALPHA", 0x859A },
    { "OPERAND3_ALPHA_NV", 0x859B }, { "DOT3_RGB", 0x86AE }, { "DOT3_RGBA", 0x86AF }, { "DOT3_RGB_EXT", 0x8740 },
    { "DOT3_RGBA_EXT", 0x8741 },
    { "TEXTURE_WRAP_S", 0x2802 }, { "CLAMP", 0x2900 }, { "REPEAT", 0x2901 }, { "CLAMP_TO_BORDER", 0x812D }, { "CLAMP_TO_EDGE", 0x812F },
    { "MIRRORED_REPEAT", 0x8370 }, { "NEAREST", 0x2600 }, { "LINEAR", 0x2601 }, { "TEXTURE_WRAP_R", 0x8072 },
    { "KEEP", 0x1E00 }, { "INVERT", 0x150A }, { "INCR", 0x1E02 }, { "DECR", 0x1E03 }, { "INCR_WRAP", 0x8507 }, { "DECR_WRAP", 0x8508 },
    { "EXP", 0x0800 }, { "EXP2", 0x0801 },
    { "DEPTH_COMPONENT", 0x1902 }, { "DEPTH_COMPONENT16", 0x81A5 }, { "DEPTH_COMPONENT24", 0x81A6 }, { "UNSIGNED_SHORT", 0x1403 },
    { "UNSIGNED_INT", 0x1405 }, { "TEXTURE_COMPARE_MODE", 0x884C }, { "TEXTURE_COMPARE_FUNC", 0x884D }, { "COMPARE_R_TO_TEXTURE", 0x884E },
    { "TEXTURE_2D", 0x0DE1 }, { "TEXTURE_CUBE_MAP", 0x8513 }, { "RGBA_UNSIGNED_DOT_PRODUCT_MAPPING_NV", 0x86D9 }, { "SHADER_OPERATION_NV", 0x86DF },
    { "CULL_MODES_NV", 0x86E0 }, { "PREVIOUS_TEXTURE_INPUT_NV", 0x86E4 }, { "CONST_EYE_NV", 0x86E5 }, { "PASS_THROUGH_NV", 0x86E6 },
    { "CULL_FRAGMENT_NV", 0x86E7 }, { "DEPENDENT_AR_TEXTURE_2D_NV", 0x86E9 }, { "DEPENDENT_GB_TEXTURE_2D_NV", 0x86EA }, { "DOT_PRODUCT_NV", 0x86EC },
    { "DOT_PRODUCT_TEXTURE_2D_NV", 0x86EE }, { "DOT_PRODUCT_TEXTURE_CUBE_MAP_NV", 0x86F0 }, { "DOT_PRODUCT_DIFFUSE_CUBE_MAP_NV", 0x86F1 },
    { "DOT_PRODUCT_REFLECT_CUBE_MAP_NV", 0x86F2 }, { "DOT_PRODUCT_CONST_EYE_REFLECT_CUBE_MAP_NV", 0x86F3 },
    { "FOG", 0x0B60 }, { "TEXTURE0_ARB", 0x84C0 }, { "TEXTURE1_ARB", 0x84C1 }, { "TEXTURE2_ARB", 0x84C2 }, { "TEXTURE3_ARB", 0x84C3 },
    { "VARIABLE_A_NV", 0x8523 }, { "VARIABLE_B_NV", 0x8524 }, { "VARIABLE_C_NV", 0x8525 }, { "VARIABLE_D_NV", 0x8526 },
    { "VARIABLE_E_NV", 0x8527 }, { "VARIABLE_F_NV", 0x8528 }, { "VARIABLE_G_NV", 0x8529 },
    { "CONSTANT_COLOR0_NV", 0x852A }, { "CONSTANT_COLOR1_NV", 0x852B }, { "PRIMARY_COLOR_NV", 0x852C }, { "SECONDARY_COLOR_NV", 0x852D },
    { "SPARE0_NV", 0x852E }, { "SPARE1_NV", 0x852F }, { "DISCARD_NV", 0x8530 }, { "E_TIMES_F_NV", 0x8531 },
    { "SPARE0_PLUS_SECONDARY_COLOR_NV", 0x8532 },
    { "UNSIGNED_IDENTITY_NV", 0x8536 }, { "UNSIGNED_INVERT_NV", 0x8537 }, { "EXPAND_NORMAL_NV", 0x8538 }, { "EXPAND_NEGATE_NV", 0x8539 },
    { "HALF_BIAS_NORMAL_NV", 0x853A }, { "HALF_BIAS_NEGATE_NV", 0x853B }, { "SIGNED_IDENTITY_NV", 0x853C }, { "SIGNED_NEGATE_NV", 0x853D },
    { "SCALE_BY_TWO_NV", 0x853E }, { "SCALE_BY_FOUR_NV", 0x853F }, { "SCALE_BY_ONE_HALF_NV", 0x8540 }, { "BIAS_BY_NEGATIVE_ONE_HALF_NV", 0x8541 }
};

GLint gl_value(const char *name, int *found)
{
    size_t n;
    char *end;
    long number = strtol(name, &end, 10);
    if (*name && !*end) return (GLint)number;
    for (n = 0; n < sizeof constants / sizeof constants[0]; n++) {
        if (strcmp(constants[n].name, name) == 0) return constants[n].value;
    }
    *found = 0;
    return 0;
}
