/* State: the lines of batches as calls. */
#include "drawing.h"

#include <stdio.h>
#include <string.h>

int drawing_fail(drawing *d, const char *message, const char *detail)
{
    sprintf(d->message, "%.100s%.60s", message, detail);
    return 0;
}

int drawing_max(GLenum name)
{
    GLint value = 0;
    gl.GetIntegerv(name, &value);
    return value;
}

void drawing_activate(int unit)
{
    if (gl.ActiveTexture) gl.ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
}

int drawing_combiners(void)
{
    return gl_has("GL_NV_register_combiners") && gl.CombinerParameteriNV && gl.CombinerParameterfvNV && gl.CombinerInputNV
        && gl.CombinerOutputNV && gl.FinalCombinerInputNV;
}

void drawing_color(const long *bytes, GLfloat *color)
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

void drawing_fog(GLenum mode)
{
    GLfloat values[4] = { 0, 0, 0, 0 };
    gl.Enable(GL_FOG);
    values[0] = (GLfloat)mode;
    gl.Fogfv(GL_FOG_MODE, values);
    values[0] = (GLfloat)GL_FOG_COORDINATE;
    gl.Fogfv(GL_FOG_COORDINATE_SOURCE, values);
}

/* Black fog of density 1. */
static void set_fog(GLenum mode)
{
    static const GLfloat black[4] = { 0, 0, 0, 0 }, one[4] = { 1, 0, 0, 0 };
    drawing_fog(mode);
    gl.Fogfv(GL_FOG_COLOR, black);
    gl.Fogfv(GL_FOG_DENSITY, one);
}

int set_state(drawing *d, char **words, int count)
{
    GLint v[BATCH_WORDS];
    long bytes[4];
    GLfloat color[4];
    int known = 1, n;
    const char *what = words[0];
    for (n = 1; n < count; n++) v[n] = gl_value(words[n], &known);
    for (n = 0; n < 4; n++) bytes[n] = 255;
    if (!known) return drawing_fail(d, "unknown words in the state: ", what);
    if (strcmp(what, "env") == 0 && count == 4) {
        drawing_activate(v[1]);
        gl.TexEnvi(GL_TEXTURE_ENV, (GLenum)v[2], v[3]);
    } else if (strcmp(what, "parameter") == 0 && count == 4) {
        drawing_activate(v[1]);
        gl.TexParameteri(d->enabled[v[1] & 3], (GLenum)v[2], v[3]);
    } else if (strcmp(what, "ramp") == 0 && count == 3 && v[2] > 0) {
        if (v[2] > drawing_max(GL_MAX_TEXTURE_SIZE)) return drawing_fail(d, "the texture is too large", "");
        return upload_ramp(d, v[2]);
    } else if (strcmp(what, "layers") == 0 && count == 3 && v[2] > 0 && v[2] <= 512) {
        return upload_layers(d, v[2]);
    } else if (strcmp(what, "cube") == 0 && count == 3 && v[2] > 0 && v[2] <= 256) {
        return upload_cube(d, v[2]);
    } else if (strcmp(what, "texels") == 0 && count == 5) {
        const batch_source *source = batch_find(d->from, "texture0"), *quads = batch_find(d->from, "quads0");
        if (quads) return upload_quads(d, quads, v[2], (GLenum)v[3], (GLenum)v[4]);
        if (!source) return drawing_fail(d, "there are no texels", "");
        return upload(d, 0, source, v[2], (GLenum)v[3], (GLenum)v[4]);
    } else if (strcmp(what, "compressed") == 0 && count == 3) {
        return upload_blocks(d, v[2]);
    } else if (strcmp(what, "alpha_test") == 0 && count == 3) {
        gl.Enable(GL_ALPHA_TEST);
        gl.AlphaFunc((GLenum)v[1], (GLfloat)v[2] / 255.0f);
    } else if (strcmp(what, "stencil") == 0 && count == 5) {
        d->stencil = (GLenum)v[1];
        gl.StencilOp((GLenum)v[2], (GLenum)v[3], (GLenum)v[4]);
    } else if (strcmp(what, "depth_test") == 0 && count == 2) {
        d->depth = v[1];
    } else if (strcmp(what, "fog") == 0 && count == 2) {
        set_fog((GLenum)v[1]);
    } else if (strcmp(what, "blend") == 0 && count == 4) {
        if (gl.BlendEquation) gl.BlendEquation((GLenum)v[1]);
        else if (v[1] != GL_FUNC_ADD) return drawing_fail(d, "there is no glBlendEquation", "");
        gl.BlendFunc((GLenum)v[2], (GLenum)v[3]);
    } else if (strcmp(what, "fog_color") == 0 && count == 4) {
        for (n = 0; n < 3; n++) bytes[n] = v[n + 1];
        drawing_color(bytes, color);
        gl.Fogfv(GL_FOG_COLOR, color);
    } else if (strcmp(what, "combiners") == 0 && count == 2) {
        if (v[1] > drawing_max(GL_MAX_GENERAL_COMBINERS_NV)) return drawing_fail(d, "there are too few general combiners", "");
        gl.CombinerParameteriNV(GL_NUM_GENERAL_COMBINERS_NV, v[1]);
    } else if (strcmp(what, "portion") == 0 && count == 23) {
        return set_portion(v);
    } else if (strcmp(what, "constant") == 0 && count == 6) {
        for (n = 0; n < 4; n++) bytes[n] = v[n + 2];
        drawing_color(bytes, color);
        gl.CombinerParameterfvNV(GL_CONSTANT_COLOR0_NV + (GLenum)v[1], color);
    } else if (strcmp(what, "stage_constant") == 0 && count == 7) {
        if (!gl.CombinerStageParameterfvNV) return drawing_fail(d, "there are no constants of single stages", "");
        for (n = 0; n < 4; n++) bytes[n] = v[n + 3];
        drawing_color(bytes, color);
        gl.CombinerStageParameterfvNV(GL_COMBINER0_NV + (GLenum)v[1], GL_CONSTANT_COLOR0_NV + (GLenum)v[2], color);
    } else if (strcmp(what, "final") == 0 && count == 5) {
        gl.FinalCombinerInputNV((GLenum)v[1], (GLenum)v[2], (GLenum)v[3], (GLenum)v[4]);
    } else if (strcmp(what, "color_sum_clamp") == 0 && count == 2) {
        gl.CombinerParameteriNV(GL_COLOR_SUM_CLAMP_NV, v[1]);
    } else {
        return drawing_fail(d, "not a line of state: ", what);
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

/* No input, no output, anywhere; no constant and no fog color, which the final combiner reads. */
static void reset_combiners(int stage_constants)
{
    static const GLfloat black[4] = { 0, 0, 0, 0 };
    int stages = drawing_max(GL_MAX_GENERAL_COMBINERS_NV), stage, n;
    gl.Fogfv(GL_FOG_COLOR, black);
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

void reset_final(void)
{
    GLenum n;
    for (n = GL_VARIABLE_A_NV; n <= GL_VARIABLE_G_NV; n++) {
        gl.FinalCombinerInputNV(n, GL_ZERO, GL_UNSIGNED_IDENTITY_NV, n == GL_VARIABLE_G_NV ? GL_ALPHA : GL_RGB);
    }
}

void begin_combiners(const batch *from)
{
    int stage_constants = has_stage_constants(from);
    gl.Enable(GL_REGISTER_COMBINERS_NV);
    if (stage_constants) gl.Enable(GL_PER_STAGE_CONSTANTS_NV);
    reset_combiners(stage_constants);
}

void end_combiners(const batch *from)
{
    if (has_stage_constants(from)) gl.Disable(GL_PER_STAGE_CONSTANTS_NV);
    gl.Disable(GL_REGISTER_COMBINERS_NV);
}
