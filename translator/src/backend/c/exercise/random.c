/* Random bits by Marsaglia's xorshift: the same on each machine. */
static uint64_t asl2c_random = ASL2C_SEED;

static uint64_t any_bits(void)
{
    asl2c_random ^= asl2c_random << 13;
    asl2c_random ^= asl2c_random >> 7;
    asl2c_random ^= asl2c_random << 17;
    return asl2c_random;
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
        value = (uint64_t)asl2c_own_integers[any_below(INTEGERS_COUNT)] + (any_below(3U) - 1U);
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
static uint64_t asl2c_happening = UINT64_MAX;
static uint64_t asl2c_answers;

static bool asl2c_happens(uint64_t call)
{
    return ((asl2c_happening >> (call & 63U)) & 1U) != 0U;
}

static bool any_answer(uint64_t function)
{
    return ((asl2c_answers >> (function & 63U)) & 1U) != ((any_below(16U) == 0U) ? 1U : 0U);
}

static void asl2c_change_situation(void)
{
    if (any_below(16U) == 0U) {
        asl2c_happening = any_bits();
    }
    asl2c_answers ^= (any_below(4U) == 0U) ? ((uint64_t)1 << any_below(64U)) : 0U;
    if (any_below(32U) == 0U) {
        asl2c_answers = any_bits();
    }
}

/* A number: mostly close to one of the agent's own, or a multiple of an eighth; sometimes infinity, NaN or any
   bits. */
static double any_double(void)
{
    union { uint64_t bits; double value; } number;
    number.value = ((double)(int64_t)any_below(100000U) / 8.0) - 4.0;
    if (any_bool()) {
        number.value = asl2c_own_numbers[any_below(NUMBERS_COUNT)];
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
        number.value = (float)asl2c_own_numbers[any_below(NUMBERS_COUNT)];
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
