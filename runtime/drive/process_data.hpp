// Process output data as the drive understands it: which bus counts, and what the three words mean (unit
// profile; 1053 1610 p. 41, MOVITRAC 07 chapter 6).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/drive/settings.hpp"
#include "stdlib/control_sources.hpp"

namespace ipos::runtime {

inline constexpr size_t kProcessWords = 3;
using DriveWords = std::array<uint16_t, kProcessWords>;
// PO4 to PO10 and PI4 to PI10, which a fieldbus card and CANopen carry. No parameter describes them: they are for the
// program alone (ours; the manuals print the number of words, and no use of them).
inline constexpr size_t kFurtherWords = 7;
using FurtherWords = std::array<uint16_t, kFurtherWords>;

// Settings of P870..P872 and P873..P875 (1053 1610 p. 82; 13 of PO and 10 of PI: MOVITRAC 07 chapter 10.3).
enum class PoAssignment : uint8_t {
  None = 0,
  Speed = 1,
  Current = 2,
  PositionLow = 3,
  PositionHigh = 4,
  MaximumSpeed = 5,
  MaximumCurrent = 6,
  Slip = 7,
  Ramp = 8,
  ControlWord1 = 9,
  ControlWord2 = 10,
  RelativeSpeed = 11,
  IposData = 12,
  PiSetpoint = 13,
};
enum class PiAssignment : uint8_t {
  None = 0,
  Speed = 1,
  OutputCurrent = 2,
  ActiveCurrent = 3,
  PositionLow = 4,
  PositionHigh = 5,
  StatusWord1 = 6,
  StatusWord2 = 7,
  RelativeSpeed = 8,
  IposData = 9,
  PiActual = 10,
  StatusWord3 = 11,
};

// Bits of the basic control block and of control word 1 (MOVITRAC 07 chapter 6.2; bits 3..5 not on all units).
namespace control_bits {
inline constexpr uint16_t kInhibit = 1 << 0;    // 1: controller inhibit
inline constexpr uint16_t kRapidStop = 1 << 1;  // 0: rapid stop
inline constexpr uint16_t kStop = 1 << 2;       // 0: stop
inline constexpr uint16_t kHold = 1 << 3;       // 1: hold control
inline constexpr uint16_t kRampSet = 1 << 4;    // 1: integrator 2
inline constexpr uint16_t kParameterSet = 1 << 5;
inline constexpr uint16_t kReset = 1 << 6;  // 0 -> 1
inline constexpr uint16_t kPotCcw = 1 << 8;
inline constexpr uint16_t kPotUp = 1 << 9;
inline constexpr uint16_t kPotDown = 1 << 10;
inline constexpr unsigned kFixedShift = 11;  // bits 11, 12: n11, n12, n13
inline constexpr uint16_t kFixedSwitch = 1 << 13;
inline constexpr uint16_t kEnable = kRapidStop | kStop;
inline constexpr uint16_t kReserved = 1 << 7;                  // in every control word
inline constexpr uint16_t kReservedWord1 = 1 << 14 | 1 << 15;  // in control word 1
}  // namespace control_bits

// One digit of a speed word is 0.2 rpm, of a relative word 100 % / 4000h, of a current word 0.1 % of IN.
int32_t speed_of_word(uint16_t word);                        // 1/1000 rpm
int32_t speed_of_relative(uint16_t word, int32_t maximum);   // 1/1000 rpm
uint16_t word_of_speed(int32_t speed);                       // saturates (M07-PD-01)
uint16_t relative_of_speed(int32_t speed, int32_t maximum);  // saturates
uint16_t word_of_current(int32_t current);                   // from 1/1000 %, saturates

// What the PO words order. The same assignment on several words: the first one counts, and SPEED and
// SPEED [%] are the same in this.
struct BusOrder {
  std::optional<uint16_t> control_word;
  bool is_control_word_1 = false;
  std::optional<int32_t> speed;            // 1/1000 rpm
  std::optional<int32_t> current;          // 1/1000 % of IN, the setpoint of a torque control
  std::optional<int32_t> ramp;             // ms
  std::optional<int32_t> maximum_speed;    // 1/1000 rpm
  std::optional<int32_t> maximum_current;  // 1/1000 %
  std::optional<int32_t> slip;             // 1/1000 rpm
  std::optional<int32_t> pi_setpoint;      // 1/1000 %
  std::optional<int32_t> position;         // increments; only with both halves
};
BusOrder decode_order(const DriveWords& words, const std::array<uint8_t, kProcessWords>& assignments,
                      int32_t maximum_speed);

// How P100 and P101 name a bus.
struct BusSource {
  PoSource bus;
  stdlib::SetpointSource setpoint;
  stdlib::ControlSource control;
  std::optional<stdlib::SetpointSource> master;  // the same bus with master/slave telegrams
};
const BusSource& bus_source(PoSource bus);  // of SBus 2: that of the SBus stands for it

// The bus that P100, or P101, names; nothing for terminals.
std::optional<PoSource> setpoint_bus(const Settings& settings);
std::optional<PoSource> control_bus(const Settings& settings);
bool is_master_slave(const Settings& settings);  // P100 = MASTER-SBus or MASTER-RS-485

}  // namespace ipos::runtime
