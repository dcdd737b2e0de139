// constb.h: constants and system variables of MOVIDRIVE B. A program that includes it is built for mdxb.
#ifndef CONSTB_H
#define CONSTB_H

#include <const.h>

// _MoviLink, IPOSplus p. 309
#define ML_BT_SBUS1    5
#define ML_BT_SBUS2    8

// Bus of a variable telegram, to be added to ObjectNo (bit 24, IPOSplus p. 232, 320)
#define SCD_SBUS1      0x0000000
#define SCD_SBUS2      0x1000000

// _SetVarInterrupt: Mode of VARINT (names and values ours)
#define VI_NEVER       0          // only a request in VarIntReq
#define VI_CHANGED     1          // a bit of the mask CompareVar has changed
#define VI_RISING      2          // a bit of the mask 0 -> 1
#define VI_FALLING     3          // a bit of the mask 1 -> 0
#define VI_EQ          4          // equal to CompareVar
#define VI_NE          5          // not equal
#define VI_GE          6          // CompareVar or more
#define VI_LE          7          // CompareVar or less
#define VI_ANY         8          // a bit of the mask is 1
#define VI_NONE        9          // no bit of the mask is 1

// System variables
#define RecStatS1      H522       // name ours; IPOSplus p. 232 has the number
#define RecStatS2      H523       // name ours; IPOSplus p. 232 has the number
#define IPOS_Setp      H524       // IPOSplus p. 38
#define VarIntReq      H530       // IPOSplus p. 38
#define PID_Mode       H540       // IPOSplus p. 38
#define PID_K_p        H541       // IPOSplus p. 38
#define PID_Outp_P     H542       // IPOSplus p. 38
#define PID_Outp_I     H543       // IPOSplus p. 38
#define PID_Outp_D     H544       // IPOSplus p. 38
#define PID_Feedf      H545       // IPOSplus p. 38
#define PID_Command    H546       // IPOSplus p. 38
#define PID_SetpMin    H557       // IPOSplus p. 39
#define PID_SetpMax    H558       // IPOSplus p. 39
#define PID_Status     H559       // IPOSplus p. 39
#define SyncSource     H560       // ISYNC; numbers and names ours
#define SyncControl    H561
#define SyncState      H562
#define SyncGearMaster H563
#define SyncGearSlave  H564

#endif
