/* The machine that translates: prints the trace. */
#include <stdio.h>

void exercise(void);
void trace_text(const char *text);

void trace_text(const char *text)
{
    (void)fputs(text, stdout);
}

int main(void)
{
    exercise();
    return (fflush(stdout) == 0) ? 0 : 1;
}
