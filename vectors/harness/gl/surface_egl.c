/* EGL: a pbuffer on the first display that has one: Mesa's surfaceless platform, the default display, or a card without any. */
#include "surface.h"

#include <EGL/egl.h>
#include <stdio.h>
#include <string.h>

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif
#ifndef EGL_PLATFORM_DEVICE_EXT
#define EGL_PLATFORM_DEVICE_EXT 0x313F
#endif

#define MOST_DISPLAYS 18

typedef EGLDisplay (*platform_display)(EGLenum platform, void *display, const EGLint *attributes);
typedef EGLBoolean (*query_devices)(EGLint most, void **devices, EGLint *count);

static EGLDisplay display = EGL_NO_DISPLAY;

/* The displays that may have a surface, best first. */
static int find_displays(EGLDisplay *found)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    platform_display get = (platform_display)eglGetProcAddress("eglGetPlatformDisplayEXT");
    query_devices query = (query_devices)eglGetProcAddress("eglQueryDevicesEXT");
    void *devices[MOST_DISPLAYS - 2];
    EGLint device, count = 0;
    int displays = 0;
    if (!extensions) extensions = "";
    if (get && strstr(extensions, "EGL_MESA_platform_surfaceless"))
        found[displays++] = get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    found[displays++] = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (get && query && strstr(extensions, "EGL_EXT_platform_device") && query(MOST_DISPLAYS - 2, devices, &count))
        for (device = 0; device < count; device++) found[displays++] = get(EGL_PLATFORM_DEVICE_EXT, devices[device], NULL);
    return displays;
}

int surface_open(int width, int height)
{
    static const EGLint wanted[] = { EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8,
                                     EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_ALPHA_SIZE, 8, EGL_DEPTH_SIZE, 24, EGL_STENCIL_SIZE, 8, EGL_SAMPLES, 0, EGL_NONE };
    EGLDisplay displays[MOST_DISPLAYS];
    EGLint size[5], count = 0;
    EGLConfig config;
    EGLSurface surface;
    EGLContext context;
    const char *missing = "display with OpenGL";
    int number = find_displays(displays), n;
    size[0] = EGL_WIDTH;
    size[1] = width;
    size[2] = EGL_HEIGHT;
    size[3] = height;
    size[4] = EGL_NONE;
    for (n = 0; n < number && count < 1; n++) {
        display = displays[n];
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API)) continue;
        missing = "pbuffer of 8 bits a channel";
        if (!eglChooseConfig(display, wanted, &config, 1, &count)) count = 0;
    }
    if (count < 1) {
        fprintf(stderr, "EGL: there is no %s (0x%x)\n", missing, (unsigned)eglGetError());
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
