/* Start of a Cortex-M4 without any library; the trace is printed by semihosting. */
#include <stddef.h>
#include <stdint.h>

/* Operations of Arm's semihosting (its specification, "Semihosting operations"). */
#define SYS_OPEN 1U
#define SYS_WRITE 5U
#define SYS_EXIT 24U
#define APPLICATION_EXIT 0x20026U
#define RUN_TIME_ERROR 0x20023U
/* Coprocessor access control, and full access to the floating-point unit. */
#define CPACR (*(volatile uint32_t *)0xE000ED88U)
#define FLOATING_POINT (0xFU << 20)

extern uint32_t stack_top;
void asl2c_exercise(void);
void asl2c_trace_text(const char *text);
void reset(void);
void *memcpy(void *to, const void *from, size_t count);
void *memset(void *to, int value, size_t count);

static char buffer[1024];
static uint32_t used;
static uint32_t output;

static uint32_t semihosting(uint32_t operation, uint32_t argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register uint32_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void fault(void)
{
    (void)semihosting(SYS_EXIT, RUN_TIME_ERROR);
    for (;;) {
    }
}

static void flush(void)
{
    const uint32_t written[3] = { output, (uint32_t)buffer, used };
    /* The number of bytes that are not written. */
    if (semihosting(SYS_WRITE, (uint32_t)written) != 0U) {
        fault();
    }
    used = 0U;
}

void asl2c_trace_text(const char *text)
{
    for (const char *at = text; *at != '\0'; at++) {
        if (used == sizeof buffer) {
            flush();
        }
        buffer[used] = *at;
        used++;
    }
}

void reset(void)
{
    static const char console[] = ":tt";
    const uint32_t opened[3] = { (uint32_t)console, 4U, sizeof console - 1U };
    CPACR |= FLOATING_POINT;
    __asm__ volatile("dsb\n isb");
    output = semihosting(SYS_OPEN, (uint32_t)opened);
    asl2c_exercise();
    flush();
    (void)semihosting(SYS_EXIT, APPLICATION_EXIT);
    for (;;) {
    }
}

/* The compiler may call these. */
void *memcpy(void *to, const void *from, size_t count)
{
    for (size_t at = 0U; at < count; at++) {
        ((volatile char *)to)[at] = ((const char *)from)[at];
    }
    return to;
}

void *memset(void *to, int value, size_t count)
{
    for (size_t at = 0U; at < count; at++) {
        ((volatile char *)to)[at] = (char)value;
    }
    return to;
}

/* Initial stack, reset, and the exceptions of the core, none of which is expected. */
__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    &stack_top, (const void *)reset, (const void *)fault, (const void *)fault,
    (const void *)fault, (const void *)fault, (const void *)fault, (const void *)fault,
    (const void *)fault, (const void *)fault, (const void *)fault, (const void *)fault,
    (const void *)fault, (const void *)fault, (const void *)fault, (const void *)fault
};
