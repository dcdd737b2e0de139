// blocks/ramp.h: a value that follows another one by steps of limited size.
// Names: RAMP_BLOCK the structure (Ramp), RAMP_STEP the function (StepRamp). docs/reference/blocks.md says how names are given.
//
//   target  in   where to go                      any value
//   up      in   largest step upwards a call      0 to 2147483647, 0: never upwards
//   down    in   largest step downwards a call    0 to 2147483647, 0: never downwards
//   out     out  where it is; may be written to begin elsewhere than at 0
//
// The unit of target and out is the program's, up and down are that unit a call.
#ifndef BLOCKS_RAMP_H
#define BLOCKS_RAMP_H
typedef struct { long target; long up; long down; long out; } RampBlock;
#endif
#ifndef RAMP_BLOCK
#define RAMP_BLOCK Ramp
#endif
#ifndef RAMP_STEP
#define RAMP_STEP StepRamp
#endif

RampBlock RAMP_BLOCK;

// The way to go has up to 32 bits without a sign: a negative one is longer than every step.
RAMP_STEP()
{
    if (RAMP_BLOCK.out < RAMP_BLOCK.target)
    {
        if (RAMP_BLOCK.target - RAMP_BLOCK.out < 0 || RAMP_BLOCK.target - RAMP_BLOCK.out > RAMP_BLOCK.up)
            RAMP_BLOCK.out += RAMP_BLOCK.up;
        else
            RAMP_BLOCK.out = RAMP_BLOCK.target;
    }
    else if (RAMP_BLOCK.out > RAMP_BLOCK.target)
    {
        if (RAMP_BLOCK.out - RAMP_BLOCK.target < 0 || RAMP_BLOCK.out - RAMP_BLOCK.target > RAMP_BLOCK.down)
            RAMP_BLOCK.out -= RAMP_BLOCK.down;
        else
            RAMP_BLOCK.out = RAMP_BLOCK.target;
    }
}

#undef RAMP_BLOCK
#undef RAMP_STEP
