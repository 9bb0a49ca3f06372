#ifndef STUB_H
#define STUB_H
/* The parts of nxdk's headers that programs of `ninebit export` use, for a compiler that knows no console. */
#include <stddef.h>
#include <stdint.h>
#define PAGE_READWRITE 4
#define PAGE_WRITECOMBINE 0x400
void *MmAllocateContiguousMemoryEx(size_t, uintptr_t, uintptr_t, uintptr_t, unsigned long);
void debugPrint(const char *format, ...);
void Sleep(unsigned long);
int pb_init(void);
void pb_kill(void);
void pb_reset(void);
int pb_busy(void);
unsigned long pb_wait_for_vbl(void);
uint32_t *pb_begin(void);
uint32_t *pb_push1(uint32_t *, unsigned long, unsigned long);
void pb_end(uint32_t *);
#endif
