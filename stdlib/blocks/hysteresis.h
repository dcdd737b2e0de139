// blocks/hysteresis.h: a switch with two limits.
// Names: HYSTERESIS_BLOCK the structure (Hysteresis), HYSTERESIS_STEP the function (StepHysteresis). docs/reference/blocks.md says how names are given.
//
//   in    in   any value
//   high  in   out becomes 1 when in has this value or more   above low
//   low   in   out becomes 0 when in has this value or less
//   out   out  0 or 1; between the limits it stays
//
// The unit is the program's.
#ifndef BLOCKS_HYSTERESIS_H
#define BLOCKS_HYSTERESIS_H
typedef struct { long in; long high; long low; long out; } HysteresisBlock;
#endif
#ifndef HYSTERESIS_BLOCK
#define HYSTERESIS_BLOCK Hysteresis
#endif
#ifndef HYSTERESIS_STEP
#define HYSTERESIS_STEP StepHysteresis
#endif

HysteresisBlock HYSTERESIS_BLOCK;

HYSTERESIS_STEP()
{
    if (HYSTERESIS_BLOCK.in >= HYSTERESIS_BLOCK.high)
        HYSTERESIS_BLOCK.out = 1;
    else if (HYSTERESIS_BLOCK.in <= HYSTERESIS_BLOCK.low)
        HYSTERESIS_BLOCK.out = 0;
}

#undef HYSTERESIS_BLOCK
#undef HYSTERESIS_STEP
