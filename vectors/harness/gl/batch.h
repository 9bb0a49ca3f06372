/* Reads UNIT.gpu.txt and UNIT.gpu.raw. */
#ifndef BATCH_H
#define BATCH_H

#include <stddef.h>

#define BATCH_WORDS 32
#define BATCH_SOURCES 8
#define BATCH_NEEDS 16
#define BATCH_COLUMNS 16
#define BATCH_WIDTH 256
#define BATCH_ROWS 65536L

/* What every row of a batch brings. */
typedef struct batch_source {
    char name[32];
    /* Bytes of a row. */
    long size;
    /* Of all rows. */
    const unsigned char *bytes;
} batch_source;

typedef struct batch {
    long rows;
    char path[16];
    int needs_count;
    char needs[BATCH_NEEDS][128];
    /* Six bytes a row. */
    const unsigned char *ids;
    int source_count;
    batch_source sources[BATCH_SOURCES];
    /* Places in the text: the state that all draws share, the first draw, and what comes after. */
    size_t state, draws, end;
    long line;
} batch;

/* The two files of a unit. */
typedef struct batch_file {
    char *text;
    size_t length;
    unsigned char *raw;
    size_t raw_length;
    size_t place;
    long line;
    char unit[64], profile[16], level[8], seed[24], behaviour[16];
    int column_count;
    char columns[BATCH_COLUMNS][64];
    /* Empty while nothing is wrong. */
    char error[200];
} batch_file;

/* Reads both files and the lines before the batches. 1, or 0 with `error` set. `batch_close` in either case. */
int batch_open(batch_file *file, const char *text_path, const char *raw_path);

/* Reads the next batch. 1; 0 at the end, or with `error` set. */
int batch_next(batch_file *file, batch *into);

/* Cuts the line at a place of the text into words; returns their number and moves the place behind the line. `line` is 512 characters. */
int batch_words(const batch_file *file, size_t *place, char *line, char **words);

/* A source of a batch by its name, NULL if there is none. */
const batch_source *batch_find(const batch *from, const char *name);

/* The number of a column, -1 if there is none. */
int batch_column(const batch_file *file, const char *name);

void batch_close(batch_file *file);

/* A whole file, with a zero behind it; NULL if it cannot be read. */
char *read_file(const char *path, size_t *length);

#endif
