/* The machine that translates: prints the trace. */
#include <stdio.h>

void asl2c_exercise(void);
void asl2c_trace_text(const char *text);

void asl2c_trace_text(const char *text)
{
    (void)fputs(text, stdout);
}

int main(void)
{
    asl2c_exercise();
    return (fflush(stdout) == 0) ? 0 : 1;
}
