/* A zip without compression, entry by entry: what programs that ask a chip leave. */
#ifndef ARCHIVE_H
#define ARCHIVE_H

#include <stddef.h>
#include <stdio.h>

#define ARCHIVE_ENTRIES 1000
/* Of a name, with the zero behind it. */
#define ARCHIVE_NAME 80

typedef struct archive_entry {
    char name[ARCHIVE_NAME];
    unsigned long crc, size, place;
} archive_entry;

typedef struct archive {
    FILE *file;
    int count;
    archive_entry entries[ARCHIVE_ENTRIES];
} archive;

/* CRC-32 as in PNG and zip, from 0xffffffff on and not inverted at the end. */
unsigned long crc_bytes(unsigned long crc, const unsigned char *bytes, size_t count);

/* Begins an archive. 1, or 0 if it cannot be written. `archive_close` only in the first case. */
int archive_open(archive *a, const char *path);

/* Adds a file. 1, or 0 if it has no room or cannot be written. */
int archive_add(archive *a, const char *name, const unsigned char *bytes, size_t count);

/* Writes the list of entries, without which a zip has none. 1, or 0 if it cannot be written. */
int archive_close(archive *a);

#endif
