/* Writes a part of the trace; the platform defines it. */
void trace_text(const char *text);

/* Random bits by Marsaglia's xorshift: the same on each machine. */
static uint64_t random_state = ASL2C_SEED;

static uint64_t any_bits(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return random_state;
}

/* Below a limit that is not zero. */
static uint64_t any_below(uint64_t limit)
{
    return (any_bits() >> 11) % limit;
}

/* An integer: mostly one of the agent's own or in the range of usual limits, sometimes the end of a range, or
   anything. */
static uint64_t any_integer(void)
{
    static const uint64_t ends[8] = {
        0U, UINT64_MAX, 0x7fffU, 0x8000U, 0x7fffffffU, 0x80000000U, INT64_MAX, 0x8000000000000000U
    };
    static const uint64_t ranges[5] = { 3U, 41U, 100U, 4000U, 100000U };
    const uint64_t kind = any_below(16U);
    uint64_t value = any_below(ranges[any_below(5U)]);
    if (kind == 0U) {
        value = any_bits();
    } else if (kind == 1U) {
        value = ends[any_below(8U)] + (any_below(3U) - 1U);
    } else if (kind < 4U) {
        value = (uint64_t)0 - value;
    } else if (kind < 10U) {
        value = (uint64_t)own_integers[any_below(INTEGERS_COUNT)] + (any_below(3U) - 1U);
    } else {
        /* A usual one. */
    }
    return value;
}

static bool any_bool(void)
{
    return any_below(2U) != 0U;
}

/* Calls that the environment makes at present, and answers that functions usually give: a bit each. Without some of the
   calls, such as those that report a danger, others have effects that they would hide; and much happens only if an answer
   stays the same for some steps. */
static uint64_t happening = UINT64_MAX;
static uint64_t answers;

static bool happens(uint64_t call)
{
    return ((happening >> (call & 63U)) & 1U) != 0U;
}

static bool any_answer(uint64_t function)
{
    return ((answers >> (function & 63U)) & 1U) != ((any_below(16U) == 0U) ? 1U : 0U);
}

static void change_situation(void)
{
    if (any_below(16U) == 0U) {
        happening = any_bits();
    }
    answers ^= (any_below(4U) == 0U) ? ((uint64_t)1 << any_below(64U)) : 0U;
    if (any_below(32U) == 0U) {
        answers = any_bits();
    }
}

/* A number: mostly close to one of the agent's own, or a multiple of an eighth; sometimes infinity, NaN or any
   bits. */
static double any_double(void)
{
    union { uint64_t bits; double value; } number;
    number.value = ((double)(int64_t)any_below(100000U) / 8.0) - 4.0;
    if (any_bool()) {
        number.value = own_numbers[any_below(NUMBERS_COUNT)];
        number.value += ((double)(int64_t)any_below(17U) - 8.0) / 8.0;
    } else if (any_bool()) {
        number.value = ((double)(int64_t)any_below(100U) / 8.0) - 4.0;
    } else {
        /* A large one. */
    }
    if (any_below(16U) == 0U) {
        number.bits = (any_bits() << 32) ^ any_bits();
    } else if (any_below(16U) == 0U) {
        number.bits = ((any_below(2U) << 11) | 0x7ffU) << 52;
        number.bits |= any_below(2U);
    } else {
        /* A usual one. */
    }
    return number.value;
}

static float any_float(void)
{
    union { uint32_t bits; float value; } number;
    number.value = ((float)(int32_t)any_below(4000U) / 8.0F) - 4.0F;
    if (any_bool()) {
        number.value = (float)own_numbers[any_below(NUMBERS_COUNT)];
    }
    if (any_below(8U) == 0U) {
        number.bits = (uint32_t)any_bits();
    }
    return number.value;
}

static const char *any_text(void)
{
    static const char *const texts[3] = { "", "a", "b, c" };
    return texts[any_below(3U)];
}

static void trace_digits(uint64_t value, uint64_t base)
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
    trace_text(&text[at]);
}

static void trace_unsigned(uint64_t value)
{
    trace_digits(value, 10U);
}

static void trace_signed(int64_t value)
{
    if (value < 0) {
        trace_text("-");
        trace_digits((uint64_t)0 - (uint64_t)value, 10U);
    } else {
        trace_digits((uint64_t)value, 10U);
    }
}

static void trace_bool(bool value)
{
    trace_text(value ? "true" : "false");
}

/* The bits of a number. Those of NaN are not fixed by C. */
static void trace_double(double value)
{
    union { uint64_t bits; double value; } number;
    number.value = value;
    if (value != value) {
        trace_text("nan");
    } else {
        trace_text("0x");
        trace_digits(number.bits, 16U);
    }
}

static void trace_float(float value)
{
    union { uint32_t bits; float value; } number;
    number.value = value;
    if (value != value) {
        trace_text("nan");
    } else {
        trace_text("0x");
        trace_digits(number.bits, 16U);
    }
}
