/* @NAME@ as words of the 3D class, drawn on a console by its owner.

   Built with nxdk (https://github.com/XboxDev/nxdk), which is not part of this file. Beside default.xbe stands memory.bin; the surface that was drawn
   goes to E:\@NAME@.bin: width, height, bytes from row to row and bytes of a pixel, as words, then the rows.. */

#include <hal/debug.h>
#include <pbkit/pbkit.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <windows.h>
#include <xboxkrnl/xboxkrnl.h>

/* Methods with their words, one by one. */
static const uint32_t writes[][2] = {
@WRITES@};

/* Methods whose words are addresses in memory.bin. */
static int is_address(uint32_t method)
{
    uint32_t of_unit = method & ~0xc0u;
    return method == 0x210 || method == 0x214 || of_unit == 0x1b00 || of_unit == 0x1b20;
}

#define MEMORY_BYTES @MEMORY@u
static const uint32_t surface[4] = { @WIDTH@u, @HEIGHT@u, @PITCH@u, @BYTES@u };
static const uint32_t surface_place = @PLACE@u;

int main(void)
{
    uint8_t *memory = MmAllocateContiguousMemoryEx(MEMORY_BYTES, 0, 0x03ffafff, 0x1000, PAGE_READWRITE | PAGE_WRITECOMBINE);
    FILE *file = fopen("D:\\memory.bin", "rb");
    uint32_t base, *p;
    size_t n;

    if (!memory || !file || fread(memory, 1, MEMORY_BYTES, file) != MEMORY_BYTES || pb_init()) {
        debugPrint("memory.bin was not read, or the chip does not start\n");
        Sleep(10000);
        return 1;
    }
    fclose(file);
    base = (uint32_t)(uintptr_t)memory & 0x03ffffff;
    pb_wait_for_vbl();
    pb_reset();
    /* All contexts are the one that covers the whole memory, pbkit's third. */
    p = pb_begin();
    p = pb_push1(p, 0x184, 3);
    p = pb_push1(p, 0x188, 3);
    p = pb_push1(p, 0x194, 3);
    p = pb_push1(p, 0x198, 3);
    pb_end(p);
    for (n = 0; n < sizeof(writes) / sizeof(writes[0]); n++) {
        p = pb_begin();
        p = pb_push1(p, writes[n][0], writes[n][1] + (is_address(writes[n][0]) ? base : 0));
        pb_end(p);
        if (n % 256 == 255) {
            while (pb_busy()) {
            }
            pb_reset();
        }
    }
    while (pb_busy()) {
    }
    file = fopen("E:\\@NAME@.bin", "wb");
    if (file) {
        fwrite(surface, 1, sizeof(surface), file);
        fwrite(memory + surface_place, surface[2], surface[1], file);
        fclose(file);
        debugPrint("E:\\@NAME@.bin is written\n");
    } else {
        debugPrint("E:\\@NAME@.bin cannot be written\n");
    }
    pb_kill();
    Sleep(10000);
    return 0;
}
