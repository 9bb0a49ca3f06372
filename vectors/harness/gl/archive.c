#include "archive.h"

#include <string.h>

unsigned long crc_bytes(unsigned long crc, const unsigned char *bytes, size_t count)
{
    while (count--) {
        int bit;
        crc ^= *bytes++;
        for (bit = 0; bit < 8; bit++) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320UL : 0);
    }
    return crc;
}

/* Numbers of a zip, the lowest byte first. */
static void little(FILE *file, unsigned long value, int bytes)
{
    for (; bytes--; value >>= 8) putc((int)(value & 255), file);
}

/* What both headers of an entry share, from the version on. */
static void put_entry(FILE *file, const archive_entry *entry)
{
    little(file, 10, 2);
    little(file, 0, 2);
    little(file, 0, 2);
    /* The first day that a zip can name. */
    little(file, 0, 2);
    little(file, 1 << 5 | 1, 2);
    little(file, entry->crc, 4);
    little(file, entry->size, 4);
    little(file, entry->size, 4);
    little(file, (unsigned long)strlen(entry->name), 2);
    little(file, 0, 2);
}

int archive_open(archive *a, const char *path)
{
    a->count = 0;
    a->file = fopen(path, "wb");
    return a->file != NULL;
}

int archive_add(archive *a, const char *name, const unsigned char *bytes, size_t count)
{
    archive_entry *entry = &a->entries[a->count];
    if (a->count == ARCHIVE_ENTRIES || strlen(name) >= ARCHIVE_NAME) return 0;
    strcpy(entry->name, name);
    entry->crc = (crc_bytes(0xffffffffUL, bytes, count) ^ 0xffffffffUL) & 0xffffffffUL;
    entry->size = (unsigned long)count;
    entry->place = (unsigned long)ftell(a->file);
    little(a->file, 0x04034b50UL, 4);
    put_entry(a->file, entry);
    fputs(name, a->file);
    fwrite(bytes, 1, count, a->file);
    a->count++;
    return fflush(a->file) == 0 && !ferror(a->file);
}

int archive_close(archive *a)
{
    unsigned long directory = (unsigned long)ftell(a->file), end;
    int n, ok;
    for (n = 0; n < a->count; n++) {
        little(a->file, 0x02014b50UL, 4);
        little(a->file, 10, 2);
        put_entry(a->file, &a->entries[n]);
        little(a->file, 0, 2);
        little(a->file, 0, 2);
        little(a->file, 0, 2);
        little(a->file, 0, 4);
        little(a->file, a->entries[n].place, 4);
        fputs(a->entries[n].name, a->file);
    }
    end = (unsigned long)ftell(a->file);
    little(a->file, 0x06054b50UL, 4);
    little(a->file, 0, 2);
    little(a->file, 0, 2);
    little(a->file, (unsigned long)a->count, 2);
    little(a->file, (unsigned long)a->count, 2);
    little(a->file, end - directory, 4);
    little(a->file, directory, 4);
    little(a->file, 0, 2);
    ok = !ferror(a->file);
    return fclose(a->file) == 0 && ok;
}
