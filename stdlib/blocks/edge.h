// blocks/edge.h: tells in which call a value has become 1 or 0.
// Names: EDGE_BLOCK the structure (Edge), EDGE_STEP the function (StepEdge). docs/reference/blocks.md says how names are given.
//
//   in    in   0, or any other value for 1
//   rise  out  1 in the call in which in has become 1, else 0
//   fall  out  1 in the call in which in has become 0, else 0
//   last  own  in of the last call, 0 or 1: 0 at the start, so an input that is 1 then rises in the first call
#ifndef BLOCKS_EDGE_H
#define BLOCKS_EDGE_H
typedef struct { long in; long rise; long fall; long last; } EdgeBlock;
#endif
#ifndef EDGE_BLOCK
#define EDGE_BLOCK Edge
#endif
#ifndef EDGE_STEP
#define EDGE_STEP StepEdge
#endif

EdgeBlock EDGE_BLOCK;

EDGE_STEP()
{
    if (EDGE_BLOCK.in)
    {
        EDGE_BLOCK.rise = !EDGE_BLOCK.last;
        EDGE_BLOCK.fall = 0;
        EDGE_BLOCK.last = 1;
    }
    else
    {
        EDGE_BLOCK.fall = EDGE_BLOCK.last;
        EDGE_BLOCK.rise = 0;
        EDGE_BLOCK.last = 0;
    }
}

#undef EDGE_BLOCK
#undef EDGE_STEP
