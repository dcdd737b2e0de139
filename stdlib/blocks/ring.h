// blocks/ring.h: values that wait in a row, first in, first out.
// Names: RING_BLOCK the structure (Ring), RING_PUT and RING_GET the functions (PutRing, GetRing). docs/reference/blocks.md says how names are given.
//
//   in     in   PUT: the value to store
//   out    out  GET: the oldest value; it stays when there is none
//   got    out  GET: 1 if there was one, else 0
//   first  in   number of the first variable of the room
//   size   in   how many variables it has   1 and more; less: each value is lost
//   count  out  how many values wait
//   lost   out  how many found no room
//   put    own  place of the next value, from 0
//   get    own  place of the oldest one
//
// One task or interrupt routine may put while another one gets: count changes in one command, after the value is there.
#ifndef BLOCKS_RING_H
#define BLOCKS_RING_H
typedef struct { long in; long out; long got; long first; long size; long count; long lost; long put; long get; } RingBlock;
#endif
#ifndef RING_BLOCK
#define RING_BLOCK Ring
#endif
#ifndef RING_PUT
#define RING_PUT PutRing
#endif
#ifndef RING_GET
#define RING_GET GetRing
#endif

RingBlock RING_BLOCK;

RING_PUT()
{
    if (RING_BLOCK.count >= RING_BLOCK.size)
    {
        RING_BLOCK.lost++;
        return;
    }
    *(RING_BLOCK.first + RING_BLOCK.put) = RING_BLOCK.in;
    RING_BLOCK.put++;
    if (RING_BLOCK.put >= RING_BLOCK.size)
        RING_BLOCK.put = 0;
    RING_BLOCK.count++;
}

RING_GET()
{
    if (RING_BLOCK.count < 1)
    {
        RING_BLOCK.got = 0;
        return;
    }
    RING_BLOCK.out = *(RING_BLOCK.first + RING_BLOCK.get);
    RING_BLOCK.get++;
    if (RING_BLOCK.get >= RING_BLOCK.size)
        RING_BLOCK.get = 0;
    RING_BLOCK.count--;
    RING_BLOCK.got = 1;
}

#undef RING_BLOCK
#undef RING_PUT
#undef RING_GET
