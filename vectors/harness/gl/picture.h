/* Pictures of results. */
#ifndef PICTURE_H
#define PICTURE_H

/* Writes R, G, B, A from the bottom row on as a PNG of three channels, not compressed. 1, or 0 if it cannot be written. */
int picture_write(const char *path, const unsigned char *pixels, int width, int height);

#endif
