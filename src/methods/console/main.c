/* Draws scenes by words of the 3D class on a console, and keeps the surfaces that the chip has stored.

   Built with nxdk (https://github.com/XboxDev/nxdk), which is not part of these files: make NXDK_DIR=... */

#include "archive.h"
#include "program.h"

#include <hal/debug.h>
#include <hal/video.h>
#include <nxdk/mount.h>
#include <pbkit/pbkit.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>
#include <xboxkrnl/xboxkrnl.h>

#define RESULTS "E:\\ninebit.zip"
#define WAIT_FOR_IDLE 0x110

/* Methods whose words are addresses in a scene's memory. */
static int is_address(uint32_t method)
{
    uint32_t of_unit = method & ~0xc0u;
    return method == 0x210 || method == 0x214 || of_unit == 0x1b00 || of_unit == 0x1b20;
}

static void wait_for_chip(void)
{
    while (pb_busy()) {
    }
    pb_reset();
}

static void push(uint32_t method, uint32_t word)
{
    uint32_t *p = pb_begin();
    p = pb_push1(p, method, word);
    pb_end(p);
}

/* Reads the image of a scene's memory. */
static int load(int number, uint8_t *memory)
{
    char path[32];
    FILE *file;
    int is_whole;
    sprintf(path, "D:\\memory-%d.bin", number);
    file = fopen(path, "rb");
    if (!file) return 0;
    is_whole = fread(memory, 1, scenes[number].memory, file) == scenes[number].memory;
    fclose(file);
    return is_whole;
}

static void draw(const scene *s, uint8_t *memory)
{
    uint32_t base = ((uint32_t)(uintptr_t)memory & 0x03ffffff) - first_place, n;
    /* All contexts are the one that covers the whole memory, pbkit's third. */
    static const uint32_t contexts[] = { 0x184, 0x188, 0x194, 0x198 };
    for (n = 0; n < sizeof contexts / sizeof contexts[0]; n++) push(contexts[n], 3);
    for (n = 0; n < s->word_count; n++) {
        push(s->words[n][0], s->words[n][1] + (is_address(s->words[n][0]) ? base : 0));
        if (n % 256 == 255) wait_for_chip();
    }
    push(WAIT_FOR_IDLE, 0);
    wait_for_chip();
}

/* Adds the surface that was drawn to the archive. */
static int keep(archive *results, const scene *s, const uint8_t *memory)
{
    char name[ARCHIVE_NAME];
    size_t head = strlen(s->head);
    unsigned char *bytes = malloc(head + s->bytes);
    int is_kept;
    if (!bytes) return 0;
    memcpy(bytes, s->head, head);
    memcpy(bytes + head, memory + s->place, s->bytes);
    sprintf(name, "%.60s.surface", s->name);
    is_kept = archive_add(results, name, bytes, head + s->bytes);
    free(bytes);
    return is_kept;
}

/* Adds what the console is. */
static int describe(archive *results)
{
    char text[640];
    sprintf(text,
            "{\n  \"format\": \"ninebit-device-1\",\n  \"pack\": \"%.64s\",\n  \"vendor\": \"NVIDIA\",\n  \"renderer\": \"NV2A %08x\",\n"
            "  \"version\": \"kernel %u.%u.%u.%u\",\n  \"surface\": \"memory\",\n  \"surface_format\": \"that of each scene\",\n  \"extensions\": \"\"\n}\n",
            root, (unsigned)VIDEOREG(0), (unsigned)XboxKrnlVersion.Major, (unsigned)XboxKrnlVersion.Minor, (unsigned)XboxKrnlVersion.Build,
            (unsigned)XboxKrnlVersion.Qfe);
    return archive_add(results, "device.json", (const unsigned char *)text, strlen(text));
}

static int stop(const char *message)
{
    debugPrint("%s\n", message);
    Sleep(10000);
    return 1;
}

int main(void)
{
    static archive results;
    uint8_t *memory;
    int n, kept = 0;

    XVideoSetMode(640, 480, 32, REFRESH_DEFAULT);
    memory = MmAllocateContiguousMemoryEx(largest_memory, 0, 0x03ffafff, 0x1000, PAGE_READWRITE | PAGE_WRITECOMBINE);
    if (!memory) return stop("there is no memory for these scenes");
    if (!nxIsDriveMounted('E')) nxMountDrive('E', "\\Device\\Harddisk0\\Partition1\\");
    if (!archive_open(&results, RESULTS)) return stop(RESULTS " cannot be written");
    if (pb_init()) return stop("the chip does not start");
    pb_show_debug_screen();
    pb_wait_for_vbl();
    pb_reset();
    if (!describe(&results)) debugPrint("the disk is full\n");
    for (n = 0; n < scene_count; n++) {
        debugPrint("%d of %d %s\n", n + 1, scene_count, scenes[n].name);
        if (!load(n, memory)) {
            debugPrint("  D:\\memory-%d.bin was not read\n", n);
            continue;
        }
        draw(&scenes[n], memory);
        if (keep(&results, &scenes[n], memory)) kept++;
        else debugPrint("  the surface was not kept: the disk or the archive is full\n");
    }
    pb_kill();
    if (!archive_close(&results)) return stop(RESULTS " is not whole");
    debugPrint("%d of %d scenes are in %s\n", kept, scene_count, RESULTS);
    Sleep(10000);
    return kept < scene_count;
}
