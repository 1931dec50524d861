/* Writes a part of the trace; the platform defines it. */
void asl2c_trace_text(const char *text);

static void asl2c_trace_digits(uint64_t value, uint64_t base)
{
    static const char digits[] = "0123456789abcdef";
    char text[24];
    uint32_t at = 23U;
    uint64_t left = value;
    text[at] = '\0';
    do {
        at--;
        text[at] = digits[left % base];
        left /= base;
    } while (left > 0U);
    asl2c_trace_text(&text[at]);
}

static void asl2c_trace_unsigned(uint64_t value)
{
    asl2c_trace_digits(value, 10U);
}

static void asl2c_trace_signed(int64_t value)
{
    if (value < 0) {
        asl2c_trace_text("-");
        asl2c_trace_digits((uint64_t)0 - (uint64_t)value, 10U);
    } else {
        asl2c_trace_digits((uint64_t)value, 10U);
    }
}

static void asl2c_trace_bool(bool value)
{
    asl2c_trace_text(value ? "true" : "false");
}

/* The bits of a number. Those of NaN are not fixed by C. */
static void asl2c_trace_double(double value)
{
    union { uint64_t bits; double value; } number;
    number.value = value;
    if (value != value) {
        asl2c_trace_text("nan");
    } else {
        asl2c_trace_text("0x");
        asl2c_trace_digits(number.bits, 16U);
    }
}

static void asl2c_trace_float(float value)
{
    union { uint32_t bits; float value; } number;
    number.value = value;
    if (value != value) {
        asl2c_trace_text("nan");
    } else {
        asl2c_trace_text("0x");
        asl2c_trace_digits(number.bits, 16U);
    }
}
