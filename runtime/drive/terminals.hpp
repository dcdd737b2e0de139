// The binary inputs as functions: which function P600..P617 gives an input, and its level.
#pragma once

#include <array>
#include <cstdint>

namespace ipos::runtime {

// Settings of P600..P617 (1053 1610 p. 78; 26 and 32 MOVITRAC 07 chapter 10.3). A slash is a low-active
// function: it acts at level 0.
enum class InputFunction : uint8_t {
  None = 0,
  Enable = 1,       // MOVIDRIVE: ENABLE/RAPID STOP, MOVITRAC 07: ENABLE/STOP
  Cw = 2,           // CW/STOP
  Ccw = 3,          // CCW/STOP
  FixedLow = 4,     // n11/n21
  FixedHigh = 5,    // n12/n22
  FixedSwitch = 6,  // fixed setpoint switchover
  ParameterSwitch = 7,
  RampSwitch = 8,
  PotUp = 9,
  PotDown = 10,
  ExternalFault = 11,  // slash
  Reset = 12,
  HoldControl = 13,  // slash
  LimitCw = 14,      // slash
  LimitCcw = 15,     // slash
  IposInput = 16,
  ReferenceCam = 17,
  ReferenceStart = 18,
  SlaveFreeRun = 19,
  SetpointHold = 20,
  MainsOn = 21,
  DrsZeroPoint = 22,  // of the DRS card, as the next three
  DrsSlaveStart = 23,
  DrsTeachIn = 24,
  DrsMasterStopped = 25,
  TemperatureSensor = 26,
  ControllerInhibit = 32,  // slash; DI00 of MOVIDRIVE has it without a parameter
};

class Terminals {
 public:
  Terminals() = default;
  // `levels` and `functions` by bit of InputLevel H483.
  Terminals(uint16_t levels, const std::array<uint8_t, 16>& functions);

  bool assigned(InputFunction f) const { return ((on_ | off_) >> static_cast<unsigned>(f) & 1) != 0; }
  // Some input with this function is 1, or is 0.
  bool on(InputFunction f) const { return (on_ >> static_cast<unsigned>(f) & 1) != 0; }
  bool off(InputFunction f) const { return (off_ >> static_cast<unsigned>(f) & 1) != 0; }

  bool operator==(const Terminals&) const = default;

 private:
  uint64_t on_ = 0;  // a bit a function
  uint64_t off_ = 0;
};

}  // namespace ipos::runtime
