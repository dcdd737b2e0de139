// blocks/alarms.h: up to 32 alarms: which are there, which wait for an acknowledgement, which came first, and a list of the last ones.
// Names: ALARMS_BLOCK the structure (Alarms), ALARMS_STEP the function (StepAlarms). docs/reference/blocks.md says how names are given.
//
//   active    in   a bit for each alarm: 1 while its cause is there. Bit 0 is alarm 1, bit 31 alarm 32
//   ack       in   not 0: what is not active any more leaves standing. The block writes 0
//   list      in   number of the first variable of the list
//   size      in   how many variables it has, 0: no list
//   standing  out  bits: active, or not acknowledged since
//   fresh     out  bits that are new in this call
//   first     out  number of the alarm that came first since nothing stood, 0: nothing stands. Of several in one call the lowest
//   count     out  alarms that have come since the start
//   place     out  place of the list that is written next, from 0: the newest alarm is the one before it
//   bit       own
#ifndef BLOCKS_ALARMS_H
#define BLOCKS_ALARMS_H
typedef struct {
    long active; long ack; long list; long size;
    long standing; long fresh; long first; long count; long place; long bit;
} AlarmsBlock;
#endif
#ifndef ALARMS_BLOCK
#define ALARMS_BLOCK Alarms
#endif
#ifndef ALARMS_STEP
#define ALARMS_STEP StepAlarms
#endif

AlarmsBlock ALARMS_BLOCK;

ALARMS_STEP()
{
    ALARMS_BLOCK.fresh = ALARMS_BLOCK.active & ~ALARMS_BLOCK.standing;
    if (ALARMS_BLOCK.ack)
    {
        ALARMS_BLOCK.ack = 0;
        ALARMS_BLOCK.standing &= ALARMS_BLOCK.active;
        if (ALARMS_BLOCK.standing == 0)
            ALARMS_BLOCK.first = 0;
    }
    if (ALARMS_BLOCK.fresh == 0)
        return;
    ALARMS_BLOCK.standing |= ALARMS_BLOCK.fresh;
    for (ALARMS_BLOCK.bit = 0; ALARMS_BLOCK.bit < 32; ALARMS_BLOCK.bit++)
    {
        if ((ALARMS_BLOCK.fresh >> ALARMS_BLOCK.bit & 1) == 0)
            continue;
        ALARMS_BLOCK.count++;
        if (ALARMS_BLOCK.first == 0)
            ALARMS_BLOCK.first = ALARMS_BLOCK.bit + 1;
        if (ALARMS_BLOCK.size < 1)
            continue;
        *(ALARMS_BLOCK.list + ALARMS_BLOCK.place) = ALARMS_BLOCK.bit + 1;
        ALARMS_BLOCK.place++;
        if (ALARMS_BLOCK.place >= ALARMS_BLOCK.size)
            ALARMS_BLOCK.place = 0;
    }
}

#undef ALARMS_BLOCK
#undef ALARMS_STEP
