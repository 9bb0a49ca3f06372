/* A window-system shim: a context of OpenGL with an RGBA surface of 8 bits a channel, without multisampling. One of surface_*.c is linked. */
#ifndef SURFACE_H
#define SURFACE_H

typedef void (*surface_function)(void);

/* Opens a surface of so many pixels and makes its context current. 0 and a message on stderr if there is none. */
int surface_open(int width, int height);

/* A function of OpenGL by its whole name, core or extension; NULL if there is none. */
surface_function surface_lookup(const char *name);

/* What the surface is, for the device file. */
const char *surface_name(void);

void surface_close(void);

#endif
