// The interface card beside its bus: which one it is, the switches that count from the last
// power-on, and the two LEDs (MOVITRAC 31 PROFIBUS, 2.5 to 2.8).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "runtime/bus/profibus/dp_slave.hpp"
#include "runtime/bus/profibus/timing.hpp"

namespace ipos::profibus {

enum class OptionKind : uint8_t {
#define PROFIBUS_OPTION(name, ...) name,
#include "runtime/bus/profibus/options.def"
};

struct OptionType {
  OptionKind kind;
  std::string_view word;  // in the plant file
  std::string_view unit;  // the type it fits
  uint16_t ident;
  bool fms;
  AcceptedWords accepts;
  std::string_view model;
  std::string_view gsd_file;
};

std::span<const OptionType> option_types();
const OptionType& option_type(OptionKind kind);
// The one for a unit, or the first where no unit is given. Else nullptr.
const OptionType* find_option_type(std::string_view word, std::string_view unit = {});

// --- switches

struct CardSwitches {
  uint8_t address = kNoAddressYet;
  bool fms = false;  // else DP: chooses the default of min Tsdr only
  bool terminated = false;
};

// Address and FMS/DP switch act from the next power-on without 24 V; the terminator acts at once.
class LatchedSwitches {
 public:
  explicit LatchedSwitches(CardSwitches switches) : set_(switches), active_(switches) {}

  void set(CardSwitches switches) { set_ = switches; }
  const CardSwitches& set() const { return set_; }  // as they stand, which may not act yet
  void power_on(bool supply_was_kept) {
    if (!supply_was_kept) active_ = set_;
  }
  uint8_t address() const { return active_.address; }  // P073
  bool fms() const { return active_.fms; }
  bool terminated() const { return set_.terminated; }

  // Of the card's slave at a line of this rate.
  SlaveSettings slave_settings(const OptionType& option, uint32_t baud) const;

 private:
  CardSwitches set_;
  CardSwitches active_;
};

// --- LEDs

enum class Light : uint8_t { Off, On, HalfHertz, OneHertz, ThreeHertz, Flicker };

std::string_view light_text(Light light);  // "flashes at 3 Hz"

struct LedPattern {
  Light green;  // RUN
  Light red;    // BUS FAULT
  friend bool operator==(const LedPattern&, const LedPattern&) = default;
};

enum class HardwareFault : uint8_t { None, GreenDark, BothFlash };  // the manual prints two patterns
enum class UsedAs : uint8_t { Dp, Fms, Both };  // Both: red where either is missing (ours)

struct CardState {
  HardwareFault hardware = HardwareFault::None;
  bool initialising = false;  // right after power-on; not on size 0
  bool address_valid = true;
  bool exchanging = false;  // DP
  bool fms_connected = false;
  bool accessing = false;  // parameters, over DP or FMS
  UsedAs used_as = UsedAs::Dp;
};

LedPattern leds(const CardState& state);

// Tenths of a Hz; 0: steady. That of the flicker is ours.
constexpr int light_rate(Light light) {
  switch (light) {
    case Light::HalfHertz: return 5;
    case Light::OneHertz: return 10;
    case Light::ThreeHertz: return 30;
    case Light::Flicker: return 100;
    case Light::Off:
    case Light::On: break;
  }
  return 0;
}

// Whether the light is on at a time. About 0.5, 1 and 3 Hz are printed; 10 Hz for the flicker is ours.
bool is_lit(Light light, Time now);

}  // namespace ipos::profibus
