#include "batch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE 512

char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0, capacity = 0;
    if (!file) return NULL;
    for (;;) {
        char *larger;
        size_t got;
        if (capacity - size < 65536) {
            capacity = 2 * capacity + 65536;
            larger = (char *)realloc(text, capacity + 1);
            if (!larger) {
                free(text);
                fclose(file);
                return NULL;
            }
            text = larger;
        }
        got = fread(text + size, 1, capacity - size, file);
        size += got;
        if (got == 0) break;
    }
    if (ferror(file)) {
        free(text);
        text = NULL;
    } else {
        text[size] = '\0';
        *length = size;
    }
    fclose(file);
    return text;
}

static int fail(batch_file *file, const char *message, const char *detail)
{
    sprintf(file->error, "line %ld: %.100s%.60s", file->line, message, detail);
    return 0;
}

int batch_words(const batch_file *file, size_t *place, char *line, char **words)
{
    const char *start = file->text + *place;
    size_t length = strcspn(start, "\n");
    int count = 0;
    char *at = line;
    *place += length + (start[length] == '\n');
    if (length >= LINE) return -1;
    memcpy(line, start, length);
    line[length] = '\0';
    while (*at && count < BATCH_WORDS) {
        words[count++] = at;
        at += strcspn(at, " ");
        if (*at) *at++ = '\0';
    }
    return *at ? -1 : count;
}

/* The next line of the file in words. */
static int next(batch_file *file, char *line, char **words)
{
    file->line++;
    return batch_words(file, &file->place, line, words);
}

/* Copies a word that has to fit. */
static int copy(char *into, size_t size, const char *word)
{
    if (strlen(word) >= size) return 0;
    strcpy(into, word);
    return 1;
}

/* A header line of one value. */
static int header(batch_file *file, const char *key, char *into, size_t size)
{
    char line[LINE], *words[BATCH_WORDS];
    int count = next(file, line, words);
    if (count != 2 || strcmp(words[0], key) != 0 || !copy(into, size, words[1])) return fail(file, "expected: ", key);
    return 1;
}

int batch_open(batch_file *file, const char *text_path, const char *raw_path)
{
    char line[LINE], *words[BATCH_WORDS];
    char version[8];
    int count, n;
    memset(file, 0, sizeof *file);
    file->text = read_file(text_path, &file->length);
    if (!file->text) return fail(file, "the file cannot be read: ", text_path);
    file->raw = (unsigned char *)read_file(raw_path, &file->raw_length);
    if (!file->raw) return fail(file, "the file cannot be read: ", raw_path);
    if (!header(file, "ninebit-gpu", version, sizeof version)) return 0;
    if (strcmp(version, "1") != 0) return fail(file, "another version: ", version);
    if (!header(file, "unit", file->unit, sizeof file->unit) || !header(file, "profile", file->profile, sizeof file->profile)
        || !header(file, "level", file->level, sizeof file->level) || !header(file, "seed", file->seed, sizeof file->seed)
        || !header(file, "behaviour", file->behaviour, sizeof file->behaviour)) {
        return 0;
    }
    count = next(file, line, words);
    if (count < 1 || strcmp(words[0], "columns") != 0 || count - 1 > BATCH_COLUMNS) return fail(file, "expected: ", "columns");
    for (n = 1; n < count; n++) {
        if (!copy(file->columns[n - 1], sizeof file->columns[0], words[n])) return fail(file, "a column's name is too long", "");
    }
    file->column_count = count - 1;
    return 1;
}

/* The bytes of a source, inside the raw file. */
static const unsigned char *bytes_at(const batch_file *file, const char *place, long size, long rows)
{
    unsigned long at = strtoul(place, NULL, 10);
    if (size < 1 || size > 64 || at > file->raw_length || (unsigned long)(size * rows) > file->raw_length - at) return NULL;
    return file->raw + at;
}

/* A line before the state of a batch. */
static int batch_line(batch_file *file, batch *into, char **words, int count)
{
    if (strcmp(words[0], "needs") == 0) {
        if (count != 2 || into->needs_count == BATCH_NEEDS || !copy(into->needs[into->needs_count++], sizeof into->needs[0], words[1])) {
            return fail(file, "this needs too much", "");
        }
    } else if (strcmp(words[0], "ids") == 0) {
        into->ids = count == 2 ? bytes_at(file, words[1], 6, into->rows) : NULL;
        if (!into->ids) return fail(file, "ids are outside the raw file", "");
    } else {
        batch_source *source = &into->sources[into->source_count];
        if (count != 4 || into->source_count == BATCH_SOURCES || !copy(source->name, sizeof source->name, words[1])) {
            return fail(file, "not a source", "");
        }
        source->size = strtol(words[2], NULL, 10);
        source->bytes = bytes_at(file, words[3], source->size, into->rows);
        if (!source->bytes) return fail(file, "a source is outside the raw file: ", source->name);
        into->source_count++;
    }
    return 1;
}

int batch_next(batch_file *file, batch *into)
{
    char line[LINE], *words[BATCH_WORDS];
    int count;
    size_t before;
    memset(into, 0, sizeof *into);
    if (file->error[0] || file->place >= file->length) return 0;
    count = next(file, line, words);
    if (count != 3 || strcmp(words[0], "batch") != 0 || !copy(into->path, sizeof into->path, words[2])) return fail(file, "expected: ", "batch");
    into->rows = strtol(words[1], NULL, 10);
    if (into->rows < 1 || into->rows > BATCH_ROWS) return fail(file, "a batch has 1 to 65536 rows", "");
    for (;;) {
        before = file->place;
        if (before >= file->length) return fail(file, "the file is cut off", "");
        count = next(file, line, words);
        if (count < 1) return fail(file, "an empty or too long line", "");
        if (strcmp(words[0], "needs") != 0 && strcmp(words[0], "ids") != 0 && strcmp(words[0], "source") != 0) break;
        if (!batch_line(file, into, words, count)) return 0;
    }
    if (!into->ids) return fail(file, "expected: ", "ids");
    into->state = before;
    into->line = file->line;
    while (strcmp(words[0], "end") != 0) {
        if (strcmp(words[0], "draw") == 0 && !into->draws) into->draws = before;
        before = file->place;
        if (before >= file->length) return fail(file, "the file is cut off", "");
        count = next(file, line, words);
        if (count < 1) return fail(file, "an empty or too long line", "");
    }
    if (!into->draws) return fail(file, "a batch without a draw", "");
    into->end = before;
    return 1;
}

const batch_source *batch_find(const batch *from, const char *name)
{
    int n;
    for (n = 0; n < from->source_count; n++) {
        if (strcmp(from->sources[n].name, name) == 0) return &from->sources[n];
    }
    return NULL;
}

int batch_column(const batch_file *file, const char *name)
{
    int n;
    for (n = 0; n < file->column_count; n++) {
        if (strcmp(file->columns[n], name) == 0) return n;
    }
    return -1;
}

void batch_close(batch_file *file)
{
    free(file->text);
    free(file->raw);
}
