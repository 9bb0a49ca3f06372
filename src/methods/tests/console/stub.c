/* A console without a chip. Words that are to be done go to the file `words`, memory to the file `memory`; whoever reads `play BASE` on the other side
   does them, writes the memory as it is then, and answers with a line. */
#include "stub.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CONSOLE_MEMORY 0x4000000u
#define BASE 0x3000u
#define WAIT_FOR_IDLE 0x110u

volatile unsigned int stub_register = 0x02a000a3;
XBOX_KRNL_VERSION XboxKrnlVersion = { 1, 0, 5838, 1 };

static unsigned char *memory;
static unsigned long memory_size;
static FILE *words;
static uint32_t entry[2];
static int is_mounted, is_waiting;

static void fail(const char *what)
{
    fprintf(stderr, "%s\n", what);
    exit(9);
}

void *MmAllocateContiguousMemoryEx(unsigned long size, uintptr_t lowest, uintptr_t highest, unsigned long alignment, unsigned long protection)
{
    /* The lowest 26 bits of an address are those of the console's. */
    unsigned char *all = malloc(2 * (size_t)CONSOLE_MEMORY);
    if (!all || size > highest - BASE || BASE % alignment || lowest || !(protection & PAGE_READWRITE)) fail("no such memory");
    memory = all + (CONSOLE_MEMORY - (uintptr_t)all % CONSOLE_MEMORY) + BASE;
    memory_size = size;
    return memory;
}

int XVideoSetMode(int width, int height, int bpp, int refresh)
{
    return width == 640 && height == 480 && bpp == 32 && refresh == REFRESH_DEFAULT;
}

void debugPrint(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
}

void Sleep(unsigned long milliseconds)
{
    if (milliseconds > 60000) fail("too long");
}

bool nxIsDriveMounted(char letter)
{
    return letter == 'D' || is_mounted;
}

bool nxMountDrive(char letter, const char *path)
{
    is_mounted = letter == 'E' && strcmp(path, "\\Device\\Harddisk0\\Partition1\\") == 0;
    return is_mounted;
}

int pb_init(void)
{
    words = fopen("words", "wb");
    return words == NULL;
}

void pb_kill(void)
{
    fclose(words);
}

void pb_reset(void)
{
    if (is_waiting) fail("words are forgotten");
}

void pb_show_debug_screen(void)
{
}

unsigned long pb_wait_for_vbl(void)
{
    return 0;
}

uint32_t *pb_begin(void)
{
    return entry;
}

uint32_t *pb_push1(uint32_t *p, unsigned long method, unsigned long word)
{
    p[0] = (uint32_t)method;
    p[1] = (uint32_t)word;
    return p + 2;
}

void pb_end(uint32_t *p)
{
    if (p != entry + 2 || is_waiting) fail("not one word");
    if (entry[0] == WAIT_FOR_IDLE) is_waiting = 1;
    else fwrite(entry, sizeof entry, 1, words);
}

int pb_busy(void)
{
    char line[16];
    FILE *file;
    if (!is_waiting) return 0;
    is_waiting = 0;
    fclose(words);
    file = fopen("memory", "wb");
    if (!file || fwrite(memory, 1, memory_size, file) != memory_size || fclose(file)) fail("memory is not written");
    printf("play %u\n", BASE);
    fflush(stdout);
    if (!fgets(line, sizeof line, stdin)) fail("nobody plays");
    file = fopen("memory", "rb");
    if (!file || fread(memory, 1, memory_size, file) != memory_size || fclose(file)) fail("memory is not read");
    words = fopen("words", "wb");
    return words == NULL;
}
