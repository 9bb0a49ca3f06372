/* Draws the GPU batches and the scenes of a pack and writes what it read back.
 *
 *     ninebit-gl PACK RESULTS [UNIT|SCENE...]
 *
 * RESULTS is a folder that exists; RESULTS/answers.zip holds all that was written. See README.md.
 */
#include "archive.h"
#include "batch.h"
#include "draw.h"
#include "gl.h"
#include "scene.h"
#include "surface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PATH_LENGTH 1024
#define FILES 200

/* The names of the files that were written, for the archive. */
static char files[FILES][ARCHIVE_NAME];
static int file_count;

static void note(const char *name, const char *extension)
{
    if (file_count < FILES) sprintf(files[file_count++], "%.60s%.8s", name, extension);
}

/* A file whose checksum, of everything before its last line, is counted along. */
typedef struct output {
    FILE *file;
    unsigned long crc;
} output;

static void put(output *out, const char *text)
{
    out->crc = crc_bytes(out->crc, (const unsigned char *)text, strlen(text));
    fputs(text, out->file);
}

static void put_header(output *out, const char *key, const char *value)
{
    put(out, "# ");
    put(out, key);
    put(out, " ");
    put(out, value);
    put(out, "\n");
}

/* A string of a JSON file. */
static void put_json(FILE *file, const char *name, const char *value, const char *end)
{
    fprintf(file, "  \"%s\": \"", name);
    for (; value && *value; value++) {
        if (*value == '"' || *value == '\\') fputc('\\', file);
        if ((unsigned char)*value >= ' ') fputc(*value, file);
    }
    fprintf(file, "\"%s\n", end);
}

/* The root digest out of a pack's manifest: the last string named "root". */
static int find_root(const char *pack, char *root)
{
    char path[PATH_LENGTH];
    char *text, *at, *found = NULL;
    size_t length;
    sprintf(path, "%.900s/MANIFEST.json", pack);
    text = read_file(path, &length);
    for (at = text; at && (at = strstr(at, "\"root\": \"")) != NULL; at++) found = at;
    root[0] = '\0';
    if (found && strcspn(found + 9, "\"") == 64) {
        memcpy(root, found + 9, 64);
        root[64] = '\0';
    }
    free(text);
    if (!root[0]) fprintf(stderr, "%s: not the manifest of a pack\n", path);
    return root[0] != '\0';
}

static int integer(GLenum name)
{
    GLint value = 0;
    gl.GetIntegerv(name, &value);
    return value;
}

/* What was asked: written first, so that results without it are known to be broken off. */
static int write_device(const char *folder, const char *root)
{
    char path[PATH_LENGTH], format[64];
    FILE *file;
    int ok;
    sprintf(path, "%.900s/device.json", folder);
    file = fopen(path, "wb");
    if (!file) {
        fprintf(stderr, "%s cannot be written; make the folder first\n", path);
        return 0;
    }
    sprintf(format, "R%d G%d B%d A%d, %d sample buffers", integer(GL_RED_BITS), integer(GL_GREEN_BITS), integer(GL_BLUE_BITS),
            integer(GL_ALPHA_BITS), gl_has("GL_ARB_multisample") ? integer(GL_SAMPLE_BUFFERS) : 0);
    fprintf(file, "{\n");
    put_json(file, "format", "ninebit-device-1", ",");
    put_json(file, "pack", root, ",");
    put_json(file, "vendor", (const char *)gl.GetString(GL_VENDOR), ",");
    put_json(file, "renderer", (const char *)gl.GetString(GL_RENDERER), ",");
    put_json(file, "version", (const char *)gl.GetString(GL_VERSION), ",");
    put_json(file, "surface", surface_name(), ",");
    put_json(file, "surface_format", format, ",");
    put_json(file, "extensions", (const char *)gl.GetString(GL_EXTENSIONS), "");
    fprintf(file, "}\n");
    ok = !ferror(file);
    return fclose(file) == 0 && ok;
}

/* Writes the rows of a batch. */
static void write_rows(output *out, const batch_file *file, const batch *from, const long *results, enum draw_status status)
{
    char text[64];
    long row;
    int n;
    for (row = 0; row < from->rows; row++) {
        for (n = 0; n < 6; n++) {
            sprintf(text, "%02x", from->ids[6 * row + n]);
            put(out, text);
        }
        for (n = 0; n < file->column_count; n++) {
            sprintf(text, "\t%ld", results[row * file->column_count + n]);
            put(out, status == DRAW_OK ? text : "\t-");
        }
        put(out, status == DRAW_OK ? "\tok\n" : "\terror\n");
    }
}

/* Whether some batch that asks the register combiners can be drawn: then those for the texture environment are left out. */
static int combines(batch_file *file)
{
    size_t place = file->place;
    long line = file->line;
    const char *missing;
    batch b;
    int found = 0;
    while (!found && batch_next(file, &b)) found = strcmp(b.path, "combiners") == 0 && draw_supports(file, &b, &missing);
    if (!file->error[0]) {
        file->place = place;
        file->line = line;
    }
    return found;
}

/* Draws all batches of a unit into a file beside which the finished one will stand. */
static int write_unit(batch_file *file, output *out, const char *unit)
{
    long rows = 0, failed = 0, left_out = 0;
    int combining = combines(file), n;
    long *results = (long *)malloc((size_t)BATCH_ROWS * (size_t)(file->column_count + 1) * sizeof *results);
    char text[256], message[200], first[200];
    batch b;
    if (!results) {
        fprintf(stderr, "not enough memory\n");
        return 0;
    }
    put(out, "# ninebit-results 1\n");
    put_header(out, "unit", file->unit);
    put_header(out, "profile", file->profile);
    put_header(out, "level", file->level);
    put_header(out, "seed", file->seed);
    put_header(out, "behaviour", file->behaviour);
    put(out, "id\t");
    for (n = 0; n < file->column_count; n++) {
        put(out, file->columns[n]);
        put(out, "\t");
    }
    put(out, "status\n");
    first[0] = '\0';
    while (batch_next(file, &b)) {
        const char *missing = "the path";
        enum draw_status status;
        if (strcmp(b.path, "environment") == 0 && combining) continue;
        if (!draw_supports(file, &b, &missing)) {
            left_out += b.rows;
            if (!first[0]) sprintf(first, "%.100s", missing);
            continue;
        }
        message[0] = '\0';
        status = draw_batch(file, &b, results, message);
        if (status != DRAW_OK) {
            failed += b.rows;
            fprintf(stderr, "%s, line %ld: %s\n", unit, b.line, message);
        }
        write_rows(out, file, &b, results, status);
        rows += b.rows;
    }
    free(results);
    if (file->error[0]) {
        fprintf(stderr, "%s.gpu.txt, %s\n", unit, file->error);
        return 0;
    }
    sprintf(text, "%ld", left_out);
    put_header(out, "unsupported", text);
    fprintf(out->file, "# end %ld %08lx\n", rows, (out->crc ^ 0xffffffffUL) & 0xffffffffUL);
    printf("%-24s%8ld rows", unit, rows);
    if (failed) printf(", %ld with errors", failed);
    if (left_out) printf(", %ld left out for want of %s", left_out, first);
    printf("\n");
    fflush(stdout);
    return 1;
}

/* Draws a unit. A unit without batches is none that a card can be asked. */
static int run_unit(const char *pack, const char *folder, const char *unit)
{
    char text_path[PATH_LENGTH], raw_path[PATH_LENGTH], part[PATH_LENGTH], path[PATH_LENGTH];
    batch_file file;
    output out;
    int ok;
    sprintf(text_path, "%.900s/units/%.60s.gpu.txt", pack, unit);
    sprintf(raw_path, "%.900s/units/%.60s.gpu.raw", pack, unit);
    sprintf(part, "%.900s/%.60s.part", folder, unit);
    sprintf(path, "%.900s/%.60s.tsv", folder, unit);
    if (!batch_open(&file, text_path, raw_path)) {
        fprintf(stderr, "%s, %s\n", text_path, file.error);
        batch_close(&file);
        return 0;
    }
    out.crc = 0xffffffffUL;
    out.file = fopen(part, "wb");
    if (!out.file) {
        fprintf(stderr, "%s cannot be written\n", part);
        batch_close(&file);
        return 0;
    }
    gl.Viewport(0, 0, BATCH_WIDTH, BATCH_WIDTH);
    ok = write_unit(&file, &out, unit);
    batch_close(&file);
    ok &= !ferror(out.file);
    ok &= fclose(out.file) == 0;
    remove(path);
    if (!ok || rename(part, path) != 0) {
        fprintf(stderr, "%s was not written\n", path);
        remove(part);
        return 0;
    }
    note(unit, ".tsv");
    return 1;
}

/* Names in a text that stand between two words, each at most 60 characters. */
static int names_between(const char *text, const char *before, const char *after, char (*names)[64], int most)
{
    const char *at = text;
    int count = 0;
    while (at && (at = strstr(at, before)) != NULL && count < most) {
        size_t length;
        at += strlen(before);
        length = strcspn(at, ".\"\n");
        if (length >= 60 || strncmp(at + length, after, strlen(after)) != 0) continue;
        memcpy(names[count], at, length);
        names[count++][length] = '\0';
    }
    return count;
}

/* Names in the lines `scene NAME` of a list. */
static int names_of_scenes(const char *text, char (*names)[64], int most)
{
    int count = 0;
    while (text && *text && count < most) {
        size_t length = strcspn(text, "\n");
        if (strncmp(text, "scene ", 6) == 0 && length > 6 && length < 66) {
            memcpy(names[count], text + 6, length - 6);
            names[count++][length - 6] = '\0';
        }
        text += length + (text[length] == '\n');
    }
    return count;
}

static int draw_scene(const char *pack, const char *folder, const char *name)
{
    char message[256];
    enum scene_status status;
    message[0] = '\0';
    status = scene_draw(pack, folder, name, message);
    if (status == SCENE_DRAWN) {
        note(name, ".png");
        printf("%s drawn\n", name);
    } else if (status == SCENE_UNSUPPORTED) {
        printf("%s left out for want of %s\n", name, message);
    } else {
        printf("%s failed\n", name);
        fprintf(stderr, "%s.scene.txt: %s\n", name, message);
    }
    fflush(stdout);
    return status != SCENE_FAILED;
}

/* Whether the pack has a scene of this name. */
static int is_scene(const char *pack, const char *name)
{
    char path[PATH_LENGTH];
    FILE *file;
    sprintf(path, "%.900s/scenes/%.60s.scene.txt", pack, name);
    file = fopen(path, "rb");
    return file && fclose(file) == 0;
}

/* Every unit of the manifest that has batches, and every scene that is listed beside it. */
static int run_all(const char *pack, const char *folder)
{
    static char units[FILES / 2][64], scenes[FILES / 2][64];
    char path[PATH_LENGTH];
    char *manifest, *list;
    size_t length;
    int ok = 1, unit_count, scene_count, n;
    sprintf(path, "%.900s/MANIFEST.json", pack);
    manifest = read_file(path, &length);
    sprintf(path, "%.900s/scenes/scenes.txt", pack);
    list = read_file(path, &length);
    unit_count = names_between(manifest, "\"units/", ".gpu.txt\"", units, FILES / 2);
    scene_count = names_of_scenes(list, scenes, FILES / 2);
    free(manifest);
    free(list);
    for (n = 0; n < scene_count; n++) {
        printf("[%d/%d] ", n + 1, scene_count + unit_count);
        ok &= draw_scene(pack, folder, scenes[n]);
    }
    for (n = 0; n < unit_count; n++) {
        printf("[%d/%d] ", scene_count + n + 1, scene_count + unit_count);
        fflush(stdout);
        ok &= run_unit(pack, folder, units[n]);
    }
    if (unit_count + scene_count == 0) fprintf(stderr, "%s: the pack has no batches; export it with --gpu-batches\n", pack);
    return ok && unit_count + scene_count > 0;
}

/* Writes all that was written into one file. */
static void write_archive(const char *folder)
{
    static archive all;
    char path[PATH_LENGTH];
    int n, ok;
    sprintf(path, "%.900s/answers.zip", folder);
    ok = archive_open(&all, path);
    for (n = 0; ok && n < file_count; n++) {
        char *bytes;
        size_t length;
        sprintf(path, "%.900s/%.79s", folder, files[n]);
        bytes = read_file(path, &length);
        ok = bytes && archive_add(&all, files[n], (const unsigned char *)bytes, length);
        free(bytes);
    }
    if (all.file) ok &= archive_close(&all);
    if (ok) printf("%s/answers.zip holds all %d files\n", folder, file_count);
    else fprintf(stderr, "%s/answers.zip was not written\n", folder);
}

int main(int count, char **arguments)
{
    char root[65];
    int ok, n;
    if (count < 3) {
        fprintf(stderr, "usage: ninebit-gl PACK RESULTS [UNIT|SCENE...]\n");
        return 2;
    }
    if (!find_root(arguments[1], root)) return 4;
    if (!surface_open(SURFACE_WIDTH, SURFACE_HEIGHT) || !gl_load()) return 6;
    if (integer(GL_RED_BITS) != 8 || integer(GL_GREEN_BITS) != 8 || integer(GL_BLUE_BITS) != 8 || integer(GL_ALPHA_BITS) != 8) {
        fprintf(stderr, "the surface has not 8 bits a channel: its bytes would tell nothing\n");
        return 6;
    }
    ok = write_device(arguments[2], root);
    note("device", ".json");
    if (ok && count == 3) ok = run_all(arguments[1], arguments[2]);
    for (n = 3; ok && n < count; n++) {
        if (is_scene(arguments[1], arguments[n])) ok = draw_scene(arguments[1], arguments[2], arguments[n]);
        else ok = run_unit(arguments[1], arguments[2], arguments[n]);
    }
    if (file_count > 1) write_archive(arguments[2]);
    surface_close();
    return ok ? 0 : 7;
}
