/* OpenGL without its headers, which differ from system to system: types, the few constants that the program itself names, and functions that
 * are looked up at run time. Constants that batches name are in gl.c. */
#ifndef GL_H
#define GL_H

typedef unsigned int GLenum;
typedef unsigned int GLbitfield;
typedef unsigned int GLuint;
typedef int GLint;
typedef int GLsizei;
typedef float GLfloat;
typedef unsigned char GLubyte;
typedef unsigned char GLboolean;

#ifdef _WIN32
#define GL_CALL __stdcall
#else
#define GL_CALL
#endif

#define GL_NONE 0
#define GL_ZERO 0
#define GL_ONE 1
#define GL_TRIANGLES 0x0004
#define GL_QUADS 0x0007
#define GL_DEPTH_BUFFER_BIT 0x0100
#define GL_STENCIL_BUFFER_BIT 0x0400
#define GL_COLOR_BUFFER_BIT 0x4000
#define GL_ALWAYS 0x0207
#define GL_NEVER 0x0200
#define GL_FOG 0x0B60
#define GL_FOG_DENSITY 0x0B62
#define GL_FOG_START 0x0B63
#define GL_FOG_END 0x0B64
#define GL_FOG_MODE 0x0B65
#define GL_DEPTH_TEST 0x0B71
#define GL_STENCIL_TEST 0x0B90
#define GL_DEPTH_BITS 0x0D56
#define GL_STENCIL_BITS 0x0D57
#define GL_STENCIL_INDEX 0x1901
#define GL_TEXTURE_3D 0x806F
#define GL_FOG_COORDINATE_SOURCE 0x8450
#define GL_FOG_COORDINATE 0x8451
#define GL_ALPHA_TEST 0x0BC0
#define GL_DITHER 0x0BD0
#define GL_SCISSOR_TEST 0x0C11
#define GL_BLEND 0x0BE2
#define GL_UNPACK_SWAP_BYTES 0x0CF0
#define GL_UNPACK_ALIGNMENT 0x0CF5
#define GL_PACK_ALIGNMENT 0x0D05
#define GL_MAX_TEXTURE_SIZE 0x0D33
#define GL_RED_BITS 0x0D52
#define GL_GREEN_BITS 0x0D53
#define GL_BLUE_BITS 0x0D54
#define GL_ALPHA_BITS 0x0D55
#define GL_TEXTURE_2D 0x0DE1
#define GL_UNSIGNED_BYTE 0x1401
#define GL_UNSIGNED_SHORT 0x1403
#define GL_UNSIGNED_INT 0x1405
#define GL_DEPTH_COMPONENT 0x1902
#define GL_RGBA 0x1908
#define GL_SMOOTH 0x1D01
#define GL_REPLACE 0x1E01
#define GL_VENDOR 0x1F00
#define GL_RENDERER 0x1F01
#define GL_VERSION 0x1F02
#define GL_EXTENSIONS 0x1F03
#define GL_MODULATE 0x2100
#define GL_TEXTURE_ENV_MODE 0x2200
#define GL_TEXTURE_ENV_COLOR 0x2201
#define GL_TEXTURE_ENV 0x2300
#define GL_NEAREST 0x2600
#define GL_LINEAR 0x2601
#define GL_TEXTURE_MAG_FILTER 0x2800
#define GL_TEXTURE_MIN_FILTER 0x2801
#define GL_TEXTURE_WRAP_S 0x2802
#define GL_TEXTURE_WRAP_T 0x2803
#define GL_FUNC_ADD 0x8006
#define GL_RGBA8 0x8058
#define GL_POLYGON_OFFSET_FILL 0x8037
#define GL_CLAMP_TO_EDGE 0x812F
#define GL_DEPTH_COMPONENT16 0x81A5
#define GL_DEPTH_COMPONENT24 0x81A6
#define GL_TEXTURE_MAX_ANISOTROPY_EXT 0x84FE
#define GL_DEPTH_CLAMP 0x864F
#define GL_TEXTURE_SHADER_NV 0x86DE
#define GL_TEXTURE_COMPARE_MODE 0x884C
#define GL_TEXTURE_COMPARE_FUNC 0x884D
#define GL_COMPARE_R_TO_TEXTURE 0x884E
#define GL_FOG_COLOR 0x0B66
#define GL_COLOR_SUM 0x8458
#define GL_TEXTURE0 0x84C0
#define GL_MAX_TEXTURE_UNITS 0x84E2
#define GL_TEXTURE_CUBE_MAP 0x8513
#define GL_TEXTURE_CUBE_MAP_POSITIVE_X 0x8515
#define GL_REGISTER_COMBINERS_NV 0x8522
#define GL_VARIABLE_A_NV 0x8523
#define GL_VARIABLE_G_NV 0x8529
#define GL_CONSTANT_COLOR0_NV 0x852A
#define GL_DISCARD_NV 0x8530
#define GL_PER_STAGE_CONSTANTS_NV 0x8535
#define GL_UNSIGNED_IDENTITY_NV 0x8536
#define GL_MAX_GENERAL_COMBINERS_NV 0x854D
#define GL_NUM_GENERAL_COMBINERS_NV 0x854E
#define GL_COLOR_SUM_CLAMP_NV 0x854F
#define GL_COMBINER0_NV 0x8550
#define GL_SAMPLE_BUFFERS 0x80A8
#define GL_MULTISAMPLE 0x809D
#define GL_RGB 0x1907
#define GL_ALPHA 0x1906

/* The functions: gl.Clear and so on. */
typedef struct gl_functions {
#define GL_CALLED(name, parameters, record, names) void (GL_CALL *name) parameters;
#define GL_ASKED(type, name, parameters, names) type (GL_CALL *name) parameters;
#include "gl_functions.h"
#undef GL_CALLED
#undef GL_ASKED
    int end;
} gl_functions;

extern gl_functions gl;

/* Looks the functions up. 0 and a message on stderr if one that has to be there is missing. */
int gl_load(void);

/* Whether all of a list of extensions are there: `A|B` is either. */
int gl_has(const char *needs);

/* A constant by its name without GL_, or a decimal number. 0 in *found if there is none. */
GLint gl_value(const char *name, int *found);

#endif
