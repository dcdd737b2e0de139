// iob.h: binary inputs and outputs of MOVIDRIVE B. A program that includes it is built for mdxb.
// Bit positions and all names but the inputs are ours. An input or output is read as 0 or 1; an output of
// function "IPOS output" is set by a statement (SET_DO01;) or by _BitSet with the bit number.
#ifndef IOB_H
#define IOB_H

// Inputs: levels, InputLevel H483
#define DI00           ((H483 >> 0) & 1)
#define DI01           ((H483 >> 1) & 1)
#define DI02           ((H483 >> 2) & 1)
#define DI03           ((H483 >> 3) & 1)
#define DI04           ((H483 >> 4) & 1)
#define DI05           ((H483 >> 5) & 1)
#define DI06           ((H483 >> 6) & 1)
#define DI07           ((H483 >> 7) & 1)
#define DI10           ((H483 >> 8) & 1)
#define DI11           ((H483 >> 9) & 1)
#define DI12           ((H483 >> 10) & 1)
#define DI13           ((H483 >> 11) & 1)
#define DI14           ((H483 >> 12) & 1)
#define DI15           ((H483 >> 13) & 1)
#define DI16           ((H483 >> 14) & 1)
#define DI17           ((H483 >> 15) & 1)

// Bit numbers of the inputs in H483
#define BIT_DI00       0
#define BIT_DI01       1
#define BIT_DI02       2
#define BIT_DI03       3
#define BIT_DI04       4
#define BIT_DI05       5
#define BIT_DI06       6
#define BIT_DI07       7
#define BIT_DI10       8
#define BIT_DI11       9
#define BIT_DI12       10
#define BIT_DI13       11
#define BIT_DI14       12
#define BIT_DI15       13
#define BIT_DI16       14
#define BIT_DI17       15

// Outputs: what the program has set, StdOutpIPOS H481 and OptOutpIPOS H480
#define DB00           ((H481 >> 0) & 1)
#define DO01           ((H481 >> 1) & 1)
#define DO02           ((H481 >> 2) & 1)
#define DO03           ((H481 >> 3) & 1)
#define DO04           ((H481 >> 4) & 1)
#define DO05           ((H481 >> 5) & 1)
#define DO10           ((H480 >> 0) & 1)
#define DO11           ((H480 >> 1) & 1)
#define DO12           ((H480 >> 2) & 1)
#define DO13           ((H480 >> 3) & 1)
#define DO14           ((H480 >> 4) & 1)
#define DO15           ((H480 >> 5) & 1)
#define DO16           ((H480 >> 6) & 1)
#define DO17           ((H480 >> 7) & 1)

// Bit numbers of the outputs
#define BIT_DB00       0
#define BIT_DO01       1
#define BIT_DO02       2
#define BIT_DO03       3
#define BIT_DO04       4
#define BIT_DO05       5
#define BIT_DO10       0
#define BIT_DO11       1
#define BIT_DO12       2
#define BIT_DO13       3
#define BIT_DO14       4
#define BIT_DO15       5
#define BIT_DO16       6
#define BIT_DO17       7

// Statements
#define SET_DB00       _BitSet(H481, 0)
#define CLEAR_DB00     _BitClear(H481, 0)
#define SET_DO01       _BitSet(H481, 1)
#define CLEAR_DO01     _BitClear(H481, 1)
#define SET_DO02       _BitSet(H481, 2)
#define CLEAR_DO02     _BitClear(H481, 2)
#define SET_DO03       _BitSet(H481, 3)
#define CLEAR_DO03     _BitClear(H481, 3)
#define SET_DO04       _BitSet(H481, 4)
#define CLEAR_DO04     _BitClear(H481, 4)
#define SET_DO05       _BitSet(H481, 5)
#define CLEAR_DO05     _BitClear(H481, 5)
#define SET_DO10       _BitSet(H480, 0)
#define CLEAR_DO10     _BitClear(H480, 0)
#define SET_DO11       _BitSet(H480, 1)
#define CLEAR_DO11     _BitClear(H480, 1)
#define SET_DO12       _BitSet(H480, 2)
#define CLEAR_DO12     _BitClear(H480, 2)
#define SET_DO13       _BitSet(H480, 3)
#define CLEAR_DO13     _BitClear(H480, 3)
#define SET_DO14       _BitSet(H480, 4)
#define CLEAR_DO14     _BitClear(H480, 4)
#define SET_DO15       _BitSet(H480, 5)
#define CLEAR_DO15     _BitClear(H480, 5)
#define SET_DO16       _BitSet(H480, 6)
#define CLEAR_DO16     _BitClear(H480, 6)
#define SET_DO17       _BitSet(H480, 7)
#define CLEAR_DO17     _BitClear(H480, 7)

#endif
