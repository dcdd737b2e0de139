// blocks/state.h: what every state machine needs: the state, whether it has just begun, and how long it lasts.
// Names: STATE_BLOCK the structure (State), STATE_STEP the function (StepState). docs/reference/blocks.md says how names are given.
//
//   next     in   the state that is wanted   1 and more; 0 is the state before the first one
//   limit    in   calls that a state may last, 0: any number
//   now      out  the state: next of the last call
//   entered  out  1 in the first call of a state, else 0
//   calls    out  calls in this state before this one, up to 2147483647
//   late     out  1 when calls has reached limit, else 0
//
// Call it, then switch (State.now) with a case for each state: what is done when it begins stands behind if (State.entered), and
// State.next = ... leaves it. The state does not change within a turn.
#ifndef BLOCKS_STATE_H
#define BLOCKS_STATE_H
typedef struct { long next; long limit; long now; long entered; long calls; long late; } StateBlock;
#endif
#ifndef STATE_BLOCK
#define STATE_BLOCK State
#endif
#ifndef STATE_STEP
#define STATE_STEP StepState
#endif

StateBlock STATE_BLOCK;

STATE_STEP()
{
    if (STATE_BLOCK.now != STATE_BLOCK.next)
    {
        STATE_BLOCK.now = STATE_BLOCK.next;
        STATE_BLOCK.calls = 0;
        STATE_BLOCK.late = 0;
        STATE_BLOCK.entered = 1;
        return;
    }
    STATE_BLOCK.entered = 0;
    if (STATE_BLOCK.calls < 2147483647)
        STATE_BLOCK.calls++;
    STATE_BLOCK.late = STATE_BLOCK.limit > 0 && STATE_BLOCK.calls >= STATE_BLOCK.limit;
}

#undef STATE_BLOCK
#undef STATE_STEP
