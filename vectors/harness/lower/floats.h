/* The printed combiners behind floats, in the shape in which executors of push buffers call theirs: arrays of register words, and colours from
 * 0 to 1.
 *
 *     ninebit lower --generic --to c99 -o vendor
 *     cc -I vendor -c floats.c vendor/ninebit_combiners.c
 */
#ifndef NINEBIT_FLOATS_H
#define NINEBIT_FLOATS_H

#include "ninebit_combiners.h"

#ifdef __cplusplus
extern "C" {
#endif

/* R, G, B, A of one pixel as they leave the final combiner, 0 to 1: exactly the chip's bytes over 255. The other colours are rounded to bytes
 * first, as the chip has them; a texture of a signed channel may be negative. */
void ninebit_combine(const struct nb_state *state, const float primary[4], const float secondary[4], const float fog[4],
                     const float texture[4][4], float out[4]);

#ifdef __cplusplus
}
#endif

#endif
