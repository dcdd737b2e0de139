// const.h: constants and system variables of all units with IPOS.
// Values marked with a page are printed there. All others are ours: the manuals print some of the names,
// but no values. The same values stand in vm/isa/keywords.def.
#ifndef CONST_H
#define CONST_H

// _MoviLink, IPOSplus p. 309 (bus type, format and service also 1053 1610 p. 47)
// BusType
#define ML_BT_S0       1          // RS-485 no. 1
#define ML_BT_S1       2          // RS-485 no. 2
#define ML_BT_SBUS     5          // SBus, SBus 1 of MOVIDRIVE B
// Format: parameter channel and number of process data words, cyclic
#define ML_FT_PAR1     0
#define ML_FT_1        1
#define ML_FT_PAR2     2
#define ML_FT_2        3
#define ML_FT_PAR3     4
#define ML_FT_3        5
#define ML_FT_PAR      6
// the same, acyclic
#define ML_CFT_PAR1    128
#define ML_CFT_1       129
#define ML_CFT_PAR2    130
#define ML_CFT_2       131
#define ML_CFT_PAR3    132
#define ML_CFT_3       133
#define ML_CFT_PAR     134
// Service
#define ML_S_RD        1          // read
#define ML_S_WR        2          // write, non-volatile
#define ML_S_WRV       3          // write, volatile

// _SBusCommDef: kind of telegram (values ours)
#define SCD_TRCYCL     1          // transmit cyclic
#define SCD_TRACYCL    2          // transmit acyclic
#define SCD_REC        3          // receive

// _SBusCommState (values ours)
#define SCS_STOPALL    0          // stop
#define SCS_STARTALL   1          // start

// _SetTask, _SetTask2 (values ours)
#define T2_STOP        0          // stop
#define T2_START       1          // start

// _SetInterrupt (values ours)
#define SI_DISABLE     0          // disable
#define SI_ERROR       1          // error
#define SI_TIMER0      2          // timer0
#define SI_TOUCHP1     3          // touchp1

// _InputCall (values ours)
#define IC_LOW         0          // low
#define IC_HIGH        1          // high

// _SystemCall (values ours)
#define SC_UC          0          // always
#define SC_N           1          // standstill
#define SC_NPOS        2          // not in position
#define SC_NREF        3          // not referenced
#define SC_TP1         4          // touchp1
#define SC_NTP1        5          // not touchp1

// _GoAbs, _GoRel (values ours)
#define GO_NOWAIT      0          // nowait
#define GO_WAIT        1          // wait

// _Go0: U unconditional, C if not referenced; W wait, NW not; ZP zero pulse, CAM cam (values ours)
#define GO0_U_W_ZP     0          // u,w,zp
#define GO0_U_NW_ZP    1          // u,nw,zp
#define GO0_U_W_CAM    2          // u,w,cam
#define GO0_U_NW_CAM   3          // u,nw,cam
#define GO0_C_W_ZP     4          // c,w,zp
#define GO0_C_NW_ZP    5          // c,nw,zp
#define GO0_C_W_CAM    6          // c,w,cam
#define GO0_C_NW_CAM   7          // c,nw,cam
#define GO0_RESET      8          // reset

// _AxisStop (values ours)
#define AS_RSTOP       0          // rapid stop
#define AS_HCTRL       1          // hold control
#define AS_PSTOP       2          // position stop
#define AS_ENABLE      3          // enable

// _TouchProbe: RE rising edge, FE falling edge (values ours)
#define TP_DIS1        0          // disable 1
#define TP_EN1         1          // enable 1
#define TP_EN1_RE      2          // enable 1 rising
#define TP_EN1_FE      3          // enable 1 falling
#define TP_DIS2        4          // disable 2
#define TP_EN2         5          // enable 2
#define TP_EN2_RE      6          // enable 2 rising
#define TP_EN2_FE      7          // enable 2 falling

// _GetSys (values ours)
#define GS_ACTCUR      0          // act.current
#define GS_ACTSPEED    1          // act.speed
#define GS_SPSPEED     2          // speed setpoint
#define GS_ERROR       3          // fault
#define GS_SEN         4          // unit state
#define GS_PODATA      5          // po-data
#define GS_DCVOLT      6          // dc-link voltage
#define GS_ANINP       7          // analog inputs
#define GS_CAM         8          // cam
#define GS_PODATA10    9          // po-data 10

// _SetSys (values ours)
#define SS_N11         0          // fixed setpoint 11
#define SS_N12         1          // fixed setpoint 12
#define SS_N13         2          // fixed setpoint 13
#define SS_N21         3          // fixed setpoint 21
#define SS_N22         4          // fixed setpoint 22
#define SS_N23         5          // fixed setpoint 23
#define SS_PIDATA      6          // pi-data
#define SS_OPMODE      7          // operating mode
#define SS_IMAX        8          // max.current
#define SS_POSRAMP     9          // pos.ramp
#define SS_POSSPEED    10         // pos.speed
#define SS_OVERRIDE    11         // override on
#define SS_BRAKE       12         // brake function
#define SS_RAMPTYPE    13         // ramp type
#define SS_RESET       14         // reset
#define SS_PIDATA10    15         // pi-data 10

// _FaultReaction (values of P830, 1053 1610 p. 81; names ours)
#define FR_NORESP      0          // no response
#define FR_DISP        1          // display fault
#define FR_SWOFFFLT    2          // immediate stop/fault
#define FR_ESTOPFLT    3          // emergency stop/fault
#define FR_RSTOPFLT    4          // rapid stop/fault
#define FR_SWOFFWARN   5          // immediate stop/warning
#define FR_ESTOPWARN   6          // emergency stop/warning
#define FR_RSTOPWARN   7          // rapid stop/warning

// _Memorize (values ours)
#define MEM_NOP        0          // nothing
#define MEM_STALL      1          // store all
#define MEM_LDALL      2          // load all
#define MEM_STPRG      3          // store program
#define MEM_STDATA     4          // store data

// System variables; "common" is common knowledge, on no page read
#define ModuloCtrl     H453       // IPOSplus p. 29
#define ModTagPos      H454       // IPOSplus p. 29, 76
#define ModActPos      H455       // common; IPOSplus p. 86 has the number
#define ModCount       H456       // common
#define StatusWord     H473       // common; IPOSplus p. 34, 91 has number and bits 19, 20
#define Scope474       H474       // common; IPOSplus p. 44 has the number
#define Scope475       H475       // common; IPOSplus p. 44 has the number
#define AnaOutIPOS     H478       // common
#define AnaOutIPOS2    H479       // common
#define OptOutpIPOS    H480       // common
#define StdOutpIPOS    H481       // common; IPOSplus p. 86 has the number
#define OutputLevel    H482       // common
#define InputLevel     H483       // common
#define ControlWord    H484       // common; MOVITRAC 07 figure 19 has the number
#define T0_Reload      H485       // common
#define Timer_2        H487       // common
#define Timer_1        H488       // common
#define Timer_0        H489       // common
#define WdogTimer      H490       // IPOSplus p. 34
#define SetpointPos    H491       // IPOSplus p. 34
#define TargetPos      H492       // IPOSplus p. 34
#define PosWindow      H493       // IPOSplus p. 34
#define LagWindow      H494       // common
#define LagDistance    H495       // common
#define SLS_right      H496       // common
#define SLS_left       H497       // common
#define RefOffset      H498       // common
#define SetpointPosBus H499       // common
#define TpPos2_Abs     H502       // common
#define TpPos1_Abs     H503       // common
#define TpPos2_Ext     H504       // common
#define TpPos2_Mot     H505       // common
#define TpPos1_Ext     H506       // common
#define TpPos1_Mot     H507       // common
#define ActPos_Abs     H509       // common; IPOSplus p. 86, 91 has the number
#define ActPos_Ext     H510       // common; IPOSplus p. 86, 91 has the number
#define ActPos_Mot     H511       // common; IPOSplus p. 86, 91 has the number

#endif
