/* Every function of OpenGL that is called, included several times with different macros.
 *
 * GL_CALLED(name, parameters, record, names): functions without a result. `record` are the arguments of the recording shim's `record`.
 * GL_ASKED(type, name, parameters, names): functions that tell something.
 * `names` are the names it may have, `|` between them; a leading `?` says that it may be missing.
 */
GL_CALLED(Clear, (GLbitfield mask), ("Clear %x", mask), "glClear")
GL_CALLED(ClearColor, (GLfloat r, GLfloat g, GLfloat b, GLfloat a), ("ClearColor %g %g %g %g", r, g, b, a), "glClearColor")
GL_CALLED(ClearDepth, (double depth), ("ClearDepth %.12g", depth), "glClearDepth")
GL_CALLED(ClearStencil, (GLint stencil), ("ClearStencil %d", stencil), "glClearStencil")
GL_CALLED(Enable, (GLenum what), ("Enable %x", what), "glEnable")
GL_CALLED(Disable, (GLenum what), ("Disable %x", what), "glDisable")
GL_CALLED(Finish, (void), ("Finish"), "glFinish")
GL_CALLED(Viewport, (GLint x, GLint y, GLsizei w, GLsizei h), ("Viewport %d %d %d %d", x, y, w, h), "glViewport")
GL_CALLED(PixelStorei, (GLenum name, GLint value), ("PixelStorei %x %d", name, value), "glPixelStorei")
GL_CALLED(Hint, (GLenum target, GLenum mode), ("Hint %x %x", target, mode), "glHint")
GL_CALLED(ShadeModel, (GLenum mode), ("ShadeModel %x", mode), "glShadeModel")
GL_CALLED(Begin, (GLenum mode), ("Begin %x", mode), "glBegin")
GL_CALLED(End, (void), ("End"), "glEnd")
GL_CALLED(Vertex2f, (GLfloat x, GLfloat y), ("Vertex2f %g %g", x, y), "glVertex2f")
GL_CALLED(Vertex4f, (GLfloat x, GLfloat y, GLfloat z, GLfloat w), ("Vertex4f %.9g %.9g %.9g %.9g", x, y, z, w), "glVertex4f")
GL_CALLED(Color4ub, (GLubyte r, GLubyte g, GLubyte b, GLubyte a), ("Color4ub %d %d %d %d", r, g, b, a), "glColor4ub")
GL_CALLED(Color4f, (GLfloat r, GLfloat g, GLfloat b, GLfloat a), ("Color4f %g %g %g %g", r, g, b, a), "glColor4f")
GL_CALLED(TexCoord3f, (GLfloat s, GLfloat t, GLfloat r), ("TexCoord3f %g %g %g", s, t, r), "glTexCoord3f")
GL_CALLED(TexCoord4f, (GLfloat s, GLfloat t, GLfloat r, GLfloat q), ("TexCoord4f %.9g %.9g %.9g %.9g", s, t, r, q), "glTexCoord4f")
GL_CALLED(StencilFunc, (GLenum function, GLint reference, GLuint mask), ("StencilFunc %x %d %x", function, reference, mask), "glStencilFunc")
GL_CALLED(StencilOp, (GLenum fail, GLenum zfail, GLenum zpass), ("StencilOp %x %x %x", fail, zfail, zpass), "glStencilOp")
GL_CALLED(StencilMask, (GLuint mask), ("StencilMask %x", mask), "glStencilMask")
GL_CALLED(DepthFunc, (GLenum function), ("DepthFunc %x", function), "glDepthFunc")
GL_CALLED(DepthMask, (GLboolean flag), ("DepthMask %d", flag), "glDepthMask")
GL_CALLED(PolygonOffset, (GLfloat factor, GLfloat units), ("PolygonOffset %.9g %.9g", factor, units), "glPolygonOffset")
GL_CALLED(AlphaFunc, (GLenum function, GLfloat reference), ("AlphaFunc %x %g", function, reference), "glAlphaFunc")
GL_CALLED(Scissor, (GLint x, GLint y, GLsizei w, GLsizei h), ("Scissor %d %d %d %d", x, y, w, h), "glScissor")
GL_CALLED(ColorMask, (GLboolean r, GLboolean g, GLboolean b, GLboolean a), ("ColorMask %d %d %d %d", r, g, b, a), "glColorMask")
GL_CALLED(BlendFunc, (GLenum source, GLenum destination), ("BlendFunc %x %x", source, destination), "glBlendFunc")
GL_CALLED(Fogfv, (GLenum name, const GLfloat *v), ("Fogfv %x %.9g %.9g %.9g %.9g", name, v[0], v[1], v[2], v[3]), "glFogfv")
GL_CALLED(GenTextures, (GLsizei n, GLuint *names), ("GenTextures %d", n); names[0] = ++texture_count, "glGenTextures")
GL_CALLED(DeleteTextures, (GLsizei n, const GLuint *names), ("DeleteTextures %d %u", n, names[0]), "glDeleteTextures")
GL_CALLED(BindTexture, (GLenum target, GLuint name), ("BindTexture %x %u", target, name), "glBindTexture")
GL_CALLED(TexParameteri, (GLenum target, GLenum name, GLint value), ("TexParameteri %x %x %x", target, name, value), "glTexParameteri")
GL_CALLED(TexEnvi, (GLenum target, GLenum name, GLint value), ("TexEnvi %x %x %x", target, name, value), "glTexEnvi")
GL_CALLED(TexEnvfv, (GLenum target, GLenum name, const GLfloat *v), ("TexEnvfv %x %x %.9g %.9g %.9g %.9g", target, name, v[0], v[1], v[2], v[3]), "glTexEnvfv")
GL_CALLED(TexEnviv, (GLenum target, GLenum name, const GLint *v), ("TexEnviv %x %x %x %x %x %x", target, name, v[0], v[1], v[2], v[3]), "glTexEnviv")
GL_CALLED(TexImage2D, (GLenum target, GLint level, GLint internal, GLsizei w, GLsizei h, GLint border, GLenum format, GLenum type, const void *texels),
    ("TexImage2D %x %d %x %d %d %d %x %x %d", target, level, internal, w, h, border, format, type, texels != 0), "glTexImage2D")
GL_CALLED(ReadPixels, (GLint x, GLint y, GLsizei w, GLsizei h, GLenum format, GLenum type, void *pixels),
    ("ReadPixels %d %d %d %d %x %x", x, y, w, h, format, type); memset(pixels, 0, (size_t)w * (size_t)h * 4), "glReadPixels")
GL_CALLED(ActiveTexture, (GLenum unit), ("ActiveTexture %x", unit), "?glActiveTexture|glActiveTextureARB")
GL_CALLED(MultiTexCoord2f, (GLenum unit, GLfloat s, GLfloat t), ("MultiTexCoord2f %x %g %g", unit, s, t), "?glMultiTexCoord2f|glMultiTexCoord2fARB")
GL_CALLED(MultiTexCoord4f, (GLenum unit, GLfloat s, GLfloat t, GLfloat r, GLfloat q), ("MultiTexCoord4f %x %.9g %.9g %.9g %.9g", unit, s, t, r, q),
    "?glMultiTexCoord4f|glMultiTexCoord4fARB")
GL_CALLED(SecondaryColor3ub, (GLubyte r, GLubyte g, GLubyte b), ("SecondaryColor3ub %d %d %d", r, g, b), "?glSecondaryColor3ub|glSecondaryColor3ubEXT")
GL_CALLED(FogCoordf, (GLfloat d), ("FogCoordf %.9g", d), "?glFogCoordf|glFogCoordfEXT")
GL_CALLED(TexImage3D, (GLenum target, GLint level, GLint internal, GLsizei w, GLsizei h, GLsizei depth, GLint border, GLenum format, GLenum type, const void *texels),
    ("TexImage3D %x %d %x %d %d %d %d %x %x %d", target, level, internal, w, h, depth, border, format, type, texels != 0), "?glTexImage3D|glTexImage3DEXT")
GL_CALLED(BlendColor, (GLfloat r, GLfloat g, GLfloat b, GLfloat a), ("BlendColor %g %g %g %g", r, g, b, a), "?glBlendColor|glBlendColorEXT")
GL_CALLED(BlendEquation, (GLenum mode), ("BlendEquation %x", mode), "?glBlendEquation|glBlendEquationEXT")
GL_CALLED(CompressedTexImage2D, (GLenum target, GLint level, GLenum internal, GLsizei w, GLsizei h, GLint border, GLsizei size, const void *blocks),
    ("CompressedTexImage2D %x %d %x %d %d %d %d %d", target, level, internal, w, h, border, size, blocks != 0),
    "?glCompressedTexImage2D|glCompressedTexImage2DARB")
GL_CALLED(CombinerParameteriNV, (GLenum name, GLint value), ("CombinerParameteri %x %d", name, value), "?glCombinerParameteriNV")
GL_CALLED(CombinerParameterfvNV, (GLenum name, const GLfloat *v), ("CombinerParameterfv %x %g %g %g %g", name, v[0] * 255, v[1] * 255, v[2] * 255, v[3] * 255),
    "?glCombinerParameterfvNV")
GL_CALLED(CombinerStageParameterfvNV, (GLenum stage, GLenum name, const GLfloat *v),
    ("CombinerStageParameterfv %x %x %g %g %g %g", stage, name, v[0] * 255, v[1] * 255, v[2] * 255, v[3] * 255), "?glCombinerStageParameterfvNV")
GL_CALLED(CombinerInputNV, (GLenum stage, GLenum portion, GLenum variable, GLenum input, GLenum mapping, GLenum component),
    ("CombinerInput %x %x %x %x %x %x", stage, portion, variable, input, mapping, component), "?glCombinerInputNV")
GL_CALLED(CombinerOutputNV, (GLenum stage, GLenum portion, GLenum ab, GLenum cd, GLenum sum, GLenum scale, GLenum bias, GLboolean ab_dot, GLboolean cd_dot, GLboolean mux),
    ("CombinerOutput %x %x %x %x %x %x %x %d %d %d", stage, portion, ab, cd, sum, scale, bias, ab_dot, cd_dot, mux), "?glCombinerOutputNV")
GL_CALLED(FinalCombinerInputNV, (GLenum variable, GLenum input, GLenum mapping, GLenum component),
    ("FinalCombinerInput %x %x %x %x", variable, input, mapping, component), "?glFinalCombinerInputNV")
GL_ASKED(const GLubyte *, GetString, (GLenum name), "glGetString")
GL_ASKED(GLenum, GetError, (void), "glGetError")
GL_ASKED(void, GetIntegerv, (GLenum name, GLint *values), "glGetIntegerv")
