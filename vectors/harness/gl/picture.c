#include "picture.h"
#include "archive.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void big(unsigned char *to, unsigned long value)
{
    int n;
    for (n = 0; n < 4; n++) to[n] = (unsigned char)(value >> (24 - 8 * n) & 255);
}

/* A chunk of a PNG. */
static void chunk(FILE *file, const char *kind, const unsigned char *bytes, size_t count)
{
    unsigned char word[4];
    unsigned long crc = crc_bytes(0xffffffffUL, (const unsigned char *)kind, 4);
    crc = crc_bytes(crc, bytes, count) ^ 0xffffffffUL;
    big(word, (unsigned long)count);
    fwrite(word, 1, 4, file);
    fwrite(kind, 1, 4, file);
    fwrite(bytes, 1, count, file);
    big(word, crc & 0xffffffffUL);
    fwrite(word, 1, 4, file);
}

int picture_write(const char *path, const unsigned char *pixels, int width, int height)
{
    static const unsigned char signature[8] = { 137, 'P', 'N', 'G', '\r', '\n', 26, '\n' };
    size_t row = 3 * (size_t)width + 1, all = row * (size_t)height, x;
    /* A block without compression has at most 65,535 bytes, and five before it. */
    size_t blocks = (all + 65534) / 65535, at = 2, place = 0;
    unsigned char head[13], *raw = (unsigned char *)malloc(all), *stream = (unsigned char *)malloc(all + 5 * blocks + 6);
    unsigned long a = 1, b = 0;
    FILE *file;
    int y, ok;
    if (!raw || !stream) {
        free(raw);
        free(stream);
        return 0;
    }
    for (y = 0; y < height; y++) {
        const unsigned char *from = pixels + 4 * (size_t)width * (size_t)(height - 1 - y);
        unsigned char *to = raw + row * (size_t)y;
        *to++ = 0;
        for (x = 0; x < (size_t)width; x++, from += 4, to += 3) memcpy(to, from, 3);
    }
    for (x = 0; x < all; x++) {
        a = (a + raw[x]) % 65521;
        b = (b + a) % 65521;
    }
    stream[0] = 0x78;
    stream[1] = 0x01;
    while (place < all) {
        size_t count = all - place < 65535 ? all - place : 65535;
        stream[at] = place + count == all;
        stream[at + 1] = (unsigned char)(count & 255);
        stream[at + 2] = (unsigned char)(count >> 8);
        stream[at + 3] = (unsigned char)(~count & 255);
        stream[at + 4] = (unsigned char)(~count >> 8 & 255);
        memcpy(stream + at + 5, raw + place, count);
        at += 5 + count;
        place += count;
    }
    big(stream + at, b << 16 | a);
    memset(head, 0, sizeof head);
    big(head, (unsigned long)width);
    big(head + 4, (unsigned long)height);
    head[8] = 8;
    head[9] = 2;
    file = fopen(path, "wb");
    ok = file != NULL;
    if (ok) {
        fwrite(signature, 1, 8, file);
        chunk(file, "IHDR", head, 13);
        chunk(file, "IDAT", stream, at + 4);
        chunk(file, "IEND", head, 0);
        ok = !ferror(file);
        ok &= fclose(file) == 0;
    }
    free(raw);
    free(stream);
    return ok;
}
