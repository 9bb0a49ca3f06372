/* Windows and WGL: a window of RGBA with 8 bits a channel. Compiled, but not run yet: see README.md. */
#include "surface.h"

#include <stdio.h>
#include <string.h>
#include <windows.h>

static HWND window;
static HDC device;
static HGLRC context;
static HMODULE library;

int surface_open(int width, int height)
{
    PIXELFORMATDESCRIPTOR wanted;
    int format;
    window = CreateWindowA("STATIC", "ninebit", WS_POPUP | WS_VISIBLE, 0, 0, width, height, NULL, NULL, GetModuleHandleA(NULL), NULL);
    device = window ? GetDC(window) : NULL;
    if (!device) {
        fprintf(stderr, "WGL: there is no window\n");
        return 0;
    }
    memset(&wanted, 0, sizeof wanted);
    wanted.nSize = sizeof wanted;
    wanted.nVersion = 1;
    wanted.dwFlags = PFD_DRAW_TO_WINDOW | PFD_SUPPORT_OPENGL;
    wanted.iPixelType = PFD_TYPE_RGBA;
    wanted.cColorBits = 32;
    wanted.cAlphaBits = 8;
    wanted.cDepthBits = 24;
    wanted.cStencilBits = 8;
    format = ChoosePixelFormat(device, &wanted);
    if (!format || !SetPixelFormat(device, format, &wanted)) {
        fprintf(stderr, "WGL: there is no pixel format of 8 bits a channel; set the desktop to 32 bits\n");
        return 0;
    }
    context = wglCreateContext(device);
    if (!context || !wglMakeCurrent(device, context)) {
        fprintf(stderr, "WGL: there is no context\n");
        return 0;
    }
    library = LoadLibraryA("opengl32.dll");
    return library != NULL;
}

/* The functions of OpenGL 1.1 come from the library, all others from the driver. */
surface_function surface_lookup(const char *name)
{
    union {
        PROC found;
        FARPROC core;
        surface_function function;
    } address;
    address.found = wglGetProcAddress(name);
    if (!address.found) address.core = GetProcAddress(library, name);
    return address.function;
}

const char *surface_name(void)
{
    return "WGL window";
}

void surface_close(void)
{
    wglMakeCurrent(NULL, NULL);
    if (context) wglDeleteContext(context);
    if (window) DestroyWindow(window);
}
