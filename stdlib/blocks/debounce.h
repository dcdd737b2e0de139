// blocks/debounce.h: an input that counts only when it has stayed the same for some calls.
// Names: DEBOUNCE_BLOCK the structure (Debounce), DEBOUNCE_STEP the function (StepDebounce). docs/reference/blocks.md says how names are given.
//
//   in     in   0, or any other value for 1
//   calls  in   so many calls in a row in has to differ from out   1 to 2147483647, less counts as 1
//   out    out  0 or 1
//   count  own  calls in a row in which they have differed
#ifndef BLOCKS_DEBOUNCE_H
#define BLOCKS_DEBOUNCE_H
typedef struct { long in; long calls; long out; long count; } DebounceBlock;
#endif
#ifndef DEBOUNCE_BLOCK
#define DEBOUNCE_BLOCK Debounce
#endif
#ifndef DEBOUNCE_STEP
#define DEBOUNCE_STEP StepDebounce
#endif

DebounceBlock DEBOUNCE_BLOCK;

DEBOUNCE_STEP()
{
    if ((DEBOUNCE_BLOCK.in && DEBOUNCE_BLOCK.out) || (!DEBOUNCE_BLOCK.in && !DEBOUNCE_BLOCK.out))
    {
        DEBOUNCE_BLOCK.count = 0;
        return;
    }
    DEBOUNCE_BLOCK.count++;
    if (DEBOUNCE_BLOCK.count < DEBOUNCE_BLOCK.calls)
        return;
    DEBOUNCE_BLOCK.count = 0;
    DEBOUNCE_BLOCK.out ^= 1;
}

#undef DEBOUNCE_BLOCK
#undef DEBOUNCE_STEP
