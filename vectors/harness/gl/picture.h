/* Files of results: pictures, and the archive of all. */
#ifndef PICTURE_H
#define PICTURE_H

#include <stddef.h>

/* CRC-32 as in PNG and zip, from 0xffffffff on and not inverted at the end. */
unsigned long crc_bytes(unsigned long crc, const unsigned char *bytes, size_t count);

/* Writes R, G, B, A from the bottom row on as a PNG of three channels, not compressed. 1, or 0 if it cannot be written. */
int picture_write(const char *path, const unsigned char *pixels, int width, int height);

/* Writes files of a folder into one archive, FOLDER/NAME: a zip without compression. `names` are `count` names, of which those that do not exist
 * are left out. 1, or 0 if it cannot be written. */
int archive_write(const char *folder, const char *name, char (*names)[80], int count);

#endif
