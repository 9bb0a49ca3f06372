/* EGL: a pbuffer on Mesa's surfaceless platform where there is one, else on the default display. */
#include "surface.h"

#include <EGL/egl.h>
#include <stdio.h>
#include <string.h>

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif

typedef EGLDisplay (*platform_display)(EGLenum platform, void *display, const EGLint *attributes);

static EGLDisplay display = EGL_NO_DISPLAY;

static EGLDisplay find_display(void)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (extensions && strstr(extensions, "EGL_MESA_platform_surfaceless")) {
        platform_display get = (platform_display)eglGetProcAddress("eglGetPlatformDisplayEXT");
        if (get) return get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    }
    return eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

int surface_open(int width, int height)
{
    static const EGLint wanted[] = { EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8,
                                     EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_ALPHA_SIZE, 8, EGL_DEPTH_SIZE, 24, EGL_STENCIL_SIZE, 8, EGL_SAMPLES, 0, EGL_NONE };
    EGLint size[5];
    EGLint count = 0;
    EGLConfig config;
    EGLSurface surface;
    EGLContext context;
    size[0] = EGL_WIDTH;
    size[1] = width;
    size[2] = EGL_HEIGHT;
    size[3] = height;
    size[4] = EGL_NONE;
    display = find_display();
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API)) {
        fprintf(stderr, "EGL: there is no display with OpenGL (0x%x)\n", (unsigned)eglGetError());
        return 0;
    }
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) {
        fprintf(stderr, "EGL: there is no pbuffer of 8 bits a channel (0x%x)\n", (unsigned)eglGetError());
        return 0;
    }
    surface = eglCreatePbufferSurface(display, config, size);
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, NULL);
    if (surface == EGL_NO_SURFACE || context == EGL_NO_CONTEXT || !eglMakeCurrent(display, surface, surface, context)) {
        fprintf(stderr, "EGL: there is no context (0x%x)\n", (unsigned)eglGetError());
        return 0;
    }
    return 1;
}

surface_function surface_lookup(const char *name)
{
    return (surface_function)eglGetProcAddress(name);
}

const char *surface_name(void)
{
    return "EGL pbuffer";
}

void surface_close(void)
{
    if (display != EGL_NO_DISPLAY) eglTerminate(display);
}
