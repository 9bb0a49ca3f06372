#ifndef STUB_H
#define STUB_H
/* The parts of nxdk's headers that programs of `ninebit export` use, for a compiler that knows no console. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#define PAGE_READWRITE 4
#define PAGE_WRITECOMBINE 0x400
#define REFRESH_DEFAULT 0
void *MmAllocateContiguousMemoryEx(unsigned long, uintptr_t, uintptr_t, unsigned long, unsigned long);
typedef struct {
    unsigned short Major, Minor, Build, Qfe;
} XBOX_KRNL_VERSION;
extern XBOX_KRNL_VERSION XboxKrnlVersion;
extern volatile unsigned int stub_register;
#define VIDEOREG(x) (*(&stub_register + (x)))
int XVideoSetMode(int width, int height, int bpp, int refresh);
void debugPrint(const char *format, ...);
void Sleep(unsigned long);
bool nxIsDriveMounted(char);
bool nxMountDrive(char, const char *);
int pb_init(void);
void pb_kill(void);
void pb_reset(void);
int pb_busy(void);
void pb_show_debug_screen(void);
unsigned long pb_wait_for_vbl(void);
uint32_t *pb_begin(void);
uint32_t *pb_push1(uint32_t *, unsigned long, unsigned long);
void pb_end(uint32_t *);
#endif
