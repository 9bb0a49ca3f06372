/* The scenes that main.c draws. */
#ifndef PROGRAM_H
#define PROGRAM_H

#include <stdint.h>

typedef struct scene {
    const char *name;
    /* Methods with their words, one by one. */
    const uint32_t (*words)[2];
    uint32_t word_count;
    /* Bytes of the image of its memory, and the surface in it that is kept. */
    uint32_t memory, place, bytes;
    /* The line before the surface's bytes. */
    const char *head;
} scene;

extern const scene scenes[];
extern const int scene_count;
/* Bytes of the largest image. */
extern const uint32_t largest_memory;
/* The place that the words call the image's first byte. */
extern const uint32_t first_place;
/* A digest of all words and images. */
extern const char root[];

#endif
