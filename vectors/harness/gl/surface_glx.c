/* X11 and GLX: a window of RGBA with 8 bits a channel. It is mapped, so that every pixel of it belongs to it; nothing may cover it. */
#include "surface.h"

#include <GL/glx.h>
#include <X11/Xlib.h>
#include <stdio.h>

static Display *display;

int surface_open(int width, int height)
{
    static int wanted[] = { GLX_RGBA, GLX_RED_SIZE, 8, GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE, 8, GLX_ALPHA_SIZE, 8, GLX_DEPTH_SIZE, 24, GLX_STENCIL_SIZE, 8, None };
    XVisualInfo *visual;
    XSetWindowAttributes attributes;
    XEvent event;
    GLXContext context;
    Window window;
    display = XOpenDisplay(NULL);
    visual = display ? glXChooseVisual(display, DefaultScreen(display), wanted) : NULL;
    if (!visual) {
        fprintf(stderr, "GLX: there is no display, or no visual of 8 bits a channel with alpha\n");
        return 0;
    }
    attributes.colormap = XCreateColormap(display, RootWindow(display, visual->screen), visual->visual, AllocNone);
    attributes.border_pixel = 0;
    attributes.event_mask = ExposureMask;
    attributes.override_redirect = True;
    window = XCreateWindow(display, RootWindow(display, visual->screen), 0, 0, (unsigned)width, (unsigned)height, 0, visual->depth,
                           InputOutput, visual->visual, CWColormap | CWBorderPixel | CWEventMask | CWOverrideRedirect, &attributes);
    XMapRaised(display, window);
    do {
        XNextEvent(display, &event);
    } while (event.type != Expose);
    context = glXCreateContext(display, visual, NULL, True);
    if (!context || !glXMakeCurrent(display, window, context)) {
        fprintf(stderr, "GLX: there is no context\n");
        return 0;
    }
    return 1;
}

surface_function surface_lookup(const char *name)
{
    return (surface_function)glXGetProcAddressARB((const GLubyte *)name);
}

const char *surface_name(void)
{
    return "GLX window";
}

void surface_close(void)
{
    if (display) XCloseDisplay(display);
}
