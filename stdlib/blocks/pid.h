// blocks/pid.h: a PID controller with limits. At a limit the integral part stands (anti-windup).
// Names: PID_BLOCK the structure (Pid), PID_STEP the function (StepPid). docs/reference/blocks.md says how names are given.
//
//   on        in   1: controls. 0: out stays as it is, or as the program writes it; with 1 the integral part begins there
//   setpoint  in   any value
//   actual    in   any value
//   kp        in   gain in 1/1000                            0 to 20000
//   ki        in   gain of the sum, in 1/1000 a call         0 to 20000
//   kd        in   gain of the change, in 1/1000 of a call   0 to 20000
//   low       in   least value of out                        -1000000 to 1000000
//   high      in   largest value of out                      low to 1000000
//   out       out  low to high
//   error     out  setpoint - actual, limited to -20000 to 20000
//   sum       own  integral part in 1/1000
//   last      own  actual of the last call
//   change    own  part of kd, then the new integral part
//   total     own  what out would be without limits, in 1/1000
//
// Called every T ms: ki = kp * T / Tn, kd = kp * Tv / T. The part of kd looks at actual only, so a new setpoint makes no jump of it.
#ifndef BLOCKS_PID_H
#define BLOCKS_PID_H
typedef struct {
    long on; long setpoint; long actual; long kp; long ki; long kd; long low; long high;
    long out; long error; long sum; long last; long change; long total;
} PidBlock;
#endif
#ifndef PID_BLOCK
#define PID_BLOCK Pid
#endif
#ifndef PID_STEP
#define PID_STEP StepPid
#endif

PidBlock PID_BLOCK;

// A difference of two values may need 33 bits: when its sign is not that of their order, it is longer than every limit.
// 20000 * 20000 three times and 1000 * 1000000 are less than 2147483647.
PID_STEP()
{
    PID_BLOCK.error = PID_BLOCK.setpoint - PID_BLOCK.actual;
    if (PID_BLOCK.setpoint < PID_BLOCK.actual)
    {
        if (PID_BLOCK.error < -20000 || PID_BLOCK.error > 0)
            PID_BLOCK.error = -20000;
    }
    else if (PID_BLOCK.error > 20000 || PID_BLOCK.error < 0)
        PID_BLOCK.error = 20000;
    PID_BLOCK.change = PID_BLOCK.last - PID_BLOCK.actual;
    if (PID_BLOCK.last < PID_BLOCK.actual)
    {
        if (PID_BLOCK.change < -20000 || PID_BLOCK.change > 0)
            PID_BLOCK.change = -20000;
    }
    else if (PID_BLOCK.change > 20000 || PID_BLOCK.change < 0)
        PID_BLOCK.change = 20000;
    PID_BLOCK.last = PID_BLOCK.actual;
    if (!PID_BLOCK.on)
    {
        if (PID_BLOCK.out > PID_BLOCK.high)
            PID_BLOCK.out = PID_BLOCK.high;
        if (PID_BLOCK.out < PID_BLOCK.low)
            PID_BLOCK.out = PID_BLOCK.low;
        PID_BLOCK.sum = PID_BLOCK.out * 1000;
        return;
    }
    PID_BLOCK.total = PID_BLOCK.kp * PID_BLOCK.error + PID_BLOCK.kd * PID_BLOCK.change;
    PID_BLOCK.change = PID_BLOCK.sum + PID_BLOCK.ki * PID_BLOCK.error;
    if (PID_BLOCK.change > PID_BLOCK.high * 1000)
        PID_BLOCK.change = PID_BLOCK.high * 1000;
    if (PID_BLOCK.change < PID_BLOCK.low * 1000)
        PID_BLOCK.change = PID_BLOCK.low * 1000;
    PID_BLOCK.total += PID_BLOCK.change;
    if (PID_BLOCK.total > PID_BLOCK.high * 1000)
    {
        PID_BLOCK.out = PID_BLOCK.high;
        if (PID_BLOCK.error < 0)
            PID_BLOCK.sum = PID_BLOCK.change;
    }
    else if (PID_BLOCK.total < PID_BLOCK.low * 1000)
    {
        PID_BLOCK.out = PID_BLOCK.low;
        if (PID_BLOCK.error > 0)
            PID_BLOCK.sum = PID_BLOCK.change;
    }
    else
    {
        PID_BLOCK.out = PID_BLOCK.total / 1000;
        PID_BLOCK.sum = PID_BLOCK.change;
    }
}

#undef PID_BLOCK
#undef PID_STEP
