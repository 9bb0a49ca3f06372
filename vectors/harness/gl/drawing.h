/* What the files of drawing share. */
#ifndef DRAWING_H
#define DRAWING_H

#include "batch.h"
#include "gl.h"

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
    /* The function of the stencil test, and whether rows say what the depth test says. */
    GLenum stencil;
    int depth;
    char *message;
} drawing;

/* Keeps a message; 0, for returning it at once. */
int drawing_fail(drawing *d, const char *message, const char *detail);

/* A limit of the implementation. */
int drawing_max(GLenum name);

/* Whether there are register combiners, with their functions. */
int drawing_combiners(void);

/* Fog by a coordinate of each vertex. */
void drawing_fog(GLenum mode);

/* Makes a texture unit the one that calls are about. */
void drawing_activate(int unit);

/* Four bytes as a color of floats. */
void drawing_color(const long *bytes, GLfloat *color);

/* texture.c: uploads. All return 0 with a message if they fail. */

/* What the rows bring, a texel a row, in a format of OpenGL. */
int upload(drawing *d, int unit, const batch_source *source, GLint internal, GLenum format, GLenum type);

/* Four texels a row in a format of OpenGL, which its coordinates lie between. */
int upload_quads(drawing *d, const batch_source *source, GLint internal, GLenum format, GLenum type);

/* A compressed block a row. */
int upload_blocks(drawing *d, GLint internal);

/* A line of texels that say where they are: red and green the number of the column, blue 1. */
int upload_ramp(drawing *d, int size);

/* Layers of one texel that say where they are, as the columns of the line do. */
int upload_layers(drawing *d, int layers);

/* Six faces of texels that say where they are: red the column, green the row, blue the face. */
int upload_cube(drawing *d, int size);

/* state.c: state. */

/* Does what a line of state says; 0 with a message if it cannot. */
int set_state(drawing *d, char **words, int count);

/* Turns the combiners on, with no input and no output anywhere, and off. */
void begin_combiners(const batch *from);
void end_combiners(const batch *from);

/* No input of the final combiner. */
void reset_final(void);

#endif
