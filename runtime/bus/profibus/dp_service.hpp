// What the data of the DP services mean: Set_Prm, Global_Control and Slave_Diag, as fields and as octets (EN
// 50170 volume 2, DP; MOVITRAC 31 PROFIBUS, 3.3 to 3.5).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

using runtime::Time;

enum class DpService : uint8_t {
#define DP_SERVICE(name, access_point, text) name = access_point,
#include "runtime/bus/profibus/dp_services.def"
};
inline constexpr uint8_t kMasterAccessPoint = 62;

std::optional<DpService> dp_service(uint8_t access_point);
std::string_view dp_service_text(DpService service);

// --- Set_Prm

inline constexpr size_t kPrmSize = 7;         // without user parameters
inline constexpr uint8_t kLeastMinTsdr = 11;  // bit times; 0 keeps the old value

struct PrmData {
  bool lock = false;
  bool unlock = false;
  bool sync = false;
  bool freeze = false;
  bool watchdog = false;
  uint8_t reserved = 0;  // bits 0..2 of octet 1
  uint8_t watchdog_factor_1 = 0;
  uint8_t watchdog_factor_2 = 0;
  uint8_t min_tsdr = 0;
  uint16_t ident = 0;
  uint8_t groups = 0;
  Octets user;

  // 10 ms x factor 1 x factor 2.
  Time watchdog_time() const { return 10 * runtime::kMillisecond * watchdog_factor_1 * watchdog_factor_2; }
  friend bool operator==(const PrmData&, const PrmData&) = default;
};

Octets encode(const PrmData& prm);
std::optional<PrmData> decode_prm(std::span<const uint8_t> octets);  // at least 7

// --- Global_Control

namespace global_control {
inline constexpr uint8_t kClear = 0x02;
inline constexpr uint8_t kUnfreeze = 0x04;
inline constexpr uint8_t kFreeze = 0x08;
inline constexpr uint8_t kUnsync = 0x10;
inline constexpr uint8_t kSync = 0x20;
}  // namespace global_control

// Of Sync and Unsync, Freeze and Unfreeze together the one that ends the mode counts.
struct GlobalCommand {
  uint8_t command = 0;  // 0: "Operate", which some masters send all the time
  uint8_t groups = 0;   // 0: all

  bool clears() const { return (command & global_control::kClear) != 0; }
  bool unsyncs() const { return (command & global_control::kUnsync) != 0; }
  bool syncs() const { return (command & global_control::kSync) != 0 && !unsyncs(); }
  bool unfreezes() const { return (command & global_control::kUnfreeze) != 0; }
  bool freezes() const { return (command & global_control::kFreeze) != 0 && !unfreezes(); }
  bool addresses(uint8_t group_mask) const { return groups == 0 || (groups & group_mask) != 0; }
};

// --- Slave_Diag

struct DiagBit {
  uint8_t octet;  // 0..2
  uint8_t mask;
};
namespace diag {
#define DIAG_BIT(name, octet, mask, by, text) inline constexpr DiagBit k##name{octet - 1, mask};
#include "runtime/bus/profibus/diag_bits.def"
}  // namespace diag

inline constexpr uint8_t kNoMaster = 0xFF;
inline constexpr size_t kStandardDiagSize = 6;

struct Diagnosis {
  std::array<uint8_t, 3> status{0, diag::kAlwaysOne.mask, 0};
  uint8_t master = kNoMaster;
  uint16_t ident = 0;
  std::optional<uint8_t> fault;  // of the unit; then two octets more

  bool has(DiagBit bit) const { return (status[bit.octet] & bit.mask) != 0; }
  void set(DiagBit bit, bool on) {
    status[bit.octet] =
        static_cast<uint8_t>(on ? status[bit.octet] | bit.mask : status[bit.octet] & ~bit.mask);
  }
  friend bool operator==(const Diagnosis&, const Diagnosis&) = default;
};

Octets encode(const Diagnosis& diagnosis);
// Of unit diagnosis in the form of this unit, 02 and the fault code, the code is kept.
std::optional<Diagnosis> decode_diagnosis(std::span<const uint8_t> octets);

}  // namespace ipos::profibus
