// blocks/sbus_master.h: three process data words with a unit on the SBus, and what to do when it does not answer.
// Names: SBUS_MASTER_BLOCK the structure (SbusMaster), SBUS_MASTER_STEP the function (StepSbusMaster). docs/reference/blocks.md says how names are given.
//
//   link    in   a MOVLNK: write link.Address before the first call; the block writes the rest. link.Result is that of the last exchange
//   data    in   a MLDATA: PO1 to PO3 are sent; PI1 to PI3 come back, and are 0 while the unit is not there
//   limit   in   so many exchanges in a row have to fail until the unit is not there any more   1 and more, less counts as 1
//   pause   in   while it is not there, so many calls without an exchange before the next one   0 and more
//   online  out  1 while it is there
//   failed  out  exchanges in a row that have failed, up to limit
//   errors  out  exchanges that have failed since the start
//   wait    own  calls until the next exchange
//
// An exchange is one _MoviLink: the task waits in it, 50 ms for an answer that does not come. One master at a time in a network.
#include <const.h>
#ifndef BLOCKS_SBUS_MASTER_H
#define BLOCKS_SBUS_MASTER_H
typedef struct { MOVLNK link; MLDATA data; long limit; long pause; long online; long failed; long errors; long wait; } SbusMasterBlock;
#endif
#ifndef SBUS_MASTER_BLOCK
#define SBUS_MASTER_BLOCK SbusMaster
#endif
#ifndef SBUS_MASTER_STEP
#define SBUS_MASTER_STEP StepSbusMaster
#endif

SbusMasterBlock SBUS_MASTER_BLOCK;

SBUS_MASTER_STEP()
{
    if (SBUS_MASTER_BLOCK.wait > 0)
    {
        SBUS_MASTER_BLOCK.wait--;
        return;
    }
    SBUS_MASTER_BLOCK.link.BusType = ML_BT_SBUS;
    SBUS_MASTER_BLOCK.link.Format = ML_FT_3;
    SBUS_MASTER_BLOCK.link.Service = ML_S_RD;
    SBUS_MASTER_BLOCK.link.DPointer = numof(SBUS_MASTER_BLOCK.data);
    _MoviLink(SBUS_MASTER_BLOCK.link);
    if (SBUS_MASTER_BLOCK.link.Result == 0)
    {
        SBUS_MASTER_BLOCK.failed = 0;
        SBUS_MASTER_BLOCK.online = 1;
        return;
    }
    SBUS_MASTER_BLOCK.errors++;
    if (SBUS_MASTER_BLOCK.failed < SBUS_MASTER_BLOCK.limit)
        SBUS_MASTER_BLOCK.failed++;
    if (SBUS_MASTER_BLOCK.failed < SBUS_MASTER_BLOCK.limit)
        return;
    SBUS_MASTER_BLOCK.online = 0;
    SBUS_MASTER_BLOCK.data.PI1 = 0;
    SBUS_MASTER_BLOCK.data.PI2 = 0;
    SBUS_MASTER_BLOCK.data.PI3 = 0;
    SBUS_MASTER_BLOCK.wait = SBUS_MASTER_BLOCK.pause;
}

#undef SBUS_MASTER_BLOCK
#undef SBUS_MASTER_STEP
