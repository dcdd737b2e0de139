// blocks/filter.h: a filter of first order (PT1). It reaches a constant input exactly.
// Names: FILTER_BLOCK the structure (Filter), FILTER_STEP the function (StepFilter). docs/reference/blocks.md says how names are given.
//
//   in     in   what is filtered                 limited to -1000000000 to 1000000000
//   calls  in   time constant in calls           1 to 100000000, less counts as 1: no filter
//   out    out  filtered value; may be written to begin elsewhere than at 0, within the limits of in
//   rest   own  what a division has left over    write 0 where out is written
//
// Called every T ms the time constant is calls * T ms: after a jump of the input out has 63 % of it then.
#ifndef BLOCKS_FILTER_H
#define BLOCKS_FILTER_H
typedef struct { long in; long calls; long out; long rest; } FilterBlock;
#endif
#ifndef FILTER_BLOCK
#define FILTER_BLOCK Filter
#endif
#ifndef FILTER_STEP
#define FILTER_STEP StepFilter
#endif

FilterBlock FILTER_BLOCK;

// 1000000000 twice and the rest of the division are less than 2147483647.
FILTER_STEP()
{
    if (FILTER_BLOCK.calls < 1)
        FILTER_BLOCK.calls = 1;
    if (FILTER_BLOCK.in > 1000000000)
        FILTER_BLOCK.rest += 1000000000 - FILTER_BLOCK.out;
    else if (FILTER_BLOCK.in < -1000000000)
        FILTER_BLOCK.rest += -1000000000 - FILTER_BLOCK.out;
    else
        FILTER_BLOCK.rest += FILTER_BLOCK.in - FILTER_BLOCK.out;
    FILTER_BLOCK.out += FILTER_BLOCK.rest / FILTER_BLOCK.calls;
    FILTER_BLOCK.rest %= FILTER_BLOCK.calls;
}

#undef FILTER_BLOCK
#undef FILTER_STEP
