/* Draws batches. */
#ifndef DRAW_H
#define DRAW_H

#include "batch.h"

enum draw_status { DRAW_OK, DRAW_UNSUPPORTED, DRAW_ERROR };

/* Whether the implementation has what a batch needs; the first thing that it lacks is told. */
int draw_supports(const batch_file *file, const batch *from, const char **missing);

/* Draws a batch. `results` takes a number a row and column, row by row. A message tells why it is not DRAW_OK. */
enum draw_status draw_batch(const batch_file *file, const batch *from, long *results, char *message);

#endif
