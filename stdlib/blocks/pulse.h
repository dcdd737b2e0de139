// blocks/pulse.h: a pulse of fixed length when a value becomes 1.
// Names: PULSE_BLOCK the structure (Pulse), PULSE_STEP the function (StepPulse). docs/reference/blocks.md says how names are given.
//
//   in     in   0, or any other value for 1; a change to 1 begins a pulse if none runs
//   calls  in   length in calls                     1 to 2147483647, less: no pulse
//   out    out  1 from the call that begins the pulse on, for so many calls; 0 else
//   rest   out  calls until the pulse ends, 0 if none runs
//   last   own  in of the last call
#ifndef BLOCKS_PULSE_H
#define BLOCKS_PULSE_H
typedef struct { long in; long calls; long out; long rest; long last; } PulseBlock;
#endif
#ifndef PULSE_BLOCK
#define PULSE_BLOCK Pulse
#endif
#ifndef PULSE_STEP
#define PULSE_STEP StepPulse
#endif

PulseBlock PULSE_BLOCK;

PULSE_STEP()
{
    if (PULSE_BLOCK.rest > 0)
    {
        PULSE_BLOCK.rest--;
        if (PULSE_BLOCK.rest == 0)
            PULSE_BLOCK.out = 0;
    }
    else if (PULSE_BLOCK.in && !PULSE_BLOCK.last && PULSE_BLOCK.calls > 0)
    {
        PULSE_BLOCK.rest = PULSE_BLOCK.calls;
        PULSE_BLOCK.out = 1;
    }
    PULSE_BLOCK.last = PULSE_BLOCK.in;
}

#undef PULSE_BLOCK
#undef PULSE_STEP
