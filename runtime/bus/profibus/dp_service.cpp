// Octets of Set_Prm and Slave_Diag.
#include "runtime/bus/profibus/dp_service.hpp"

#include <algorithm>

namespace ipos::profibus {
namespace {

constexpr uint8_t kLock = 0x80, kUnlock = 0x40, kSync = 0x20, kFreeze = 0x10, kWatchdog = 0x08,
                  kReserved = 0x07;
constexpr uint8_t kUnitDiagSize = 2;  // of octets 7 and 8 of Slave_Diag, told in octet 7

uint8_t high(uint16_t word) { return static_cast<uint8_t>(word >> 8); }
uint8_t low(uint16_t word) { return static_cast<uint8_t>(word); }
uint16_t word(uint8_t high_octet, uint8_t low_octet) {
  return static_cast<uint16_t>(high_octet << 8 | low_octet);
}

struct ServiceRow {
  DpService service;
  std::string_view text;
};
constexpr ServiceRow kServices[] = {
#define DP_SERVICE(name, access_point, text) {DpService::name, text},
#include "runtime/bus/profibus/dp_services.def"
};

}  // namespace

std::optional<DpService> dp_service(uint8_t access_point) {
  for (const ServiceRow& row : kServices)
    if (static_cast<uint8_t>(row.service) == access_point) return row.service;
  return std::nullopt;
}

std::string_view dp_service_text(DpService service) {
  for (const ServiceRow& row : kServices)
    if (row.service == service) return row.text;
  return {};
}

Octets encode(const PrmData& prm) {
  unsigned station = prm.reserved & kReserved;
  if (prm.lock) station |= kLock;
  if (prm.unlock) station |= kUnlock;
  if (prm.sync) station |= kSync;
  if (prm.freeze) station |= kFreeze;
  if (prm.watchdog) station |= kWatchdog;
  Octets octets(kPrmSize + prm.user.size());
  octets[0] = static_cast<uint8_t>(station);
  octets[1] = prm.watchdog_factor_1;
  octets[2] = prm.watchdog_factor_2;
  octets[3] = prm.min_tsdr;
  octets[4] = high(prm.ident);
  octets[5] = low(prm.ident);
  octets[6] = prm.groups;
  std::copy(prm.user.begin(), prm.user.end(), octets.begin() + kPrmSize);
  return octets;
}

std::optional<PrmData> decode_prm(std::span<const uint8_t> octets) {
  if (octets.size() < kPrmSize) return std::nullopt;
  PrmData prm;
  prm.lock = (octets[0] & kLock) != 0;
  prm.unlock = (octets[0] & kUnlock) != 0;
  prm.sync = (octets[0] & kSync) != 0;
  prm.freeze = (octets[0] & kFreeze) != 0;
  prm.watchdog = (octets[0] & kWatchdog) != 0;
  prm.reserved = octets[0] & kReserved;
  prm.watchdog_factor_1 = octets[1];
  prm.watchdog_factor_2 = octets[2];
  prm.min_tsdr = octets[3];
  prm.ident = word(octets[4], octets[5]);
  prm.groups = octets[6];
  prm.user.assign(octets.begin() + kPrmSize, octets.end());
  return prm;
}

Octets encode(const Diagnosis& diagnosis) {
  Octets octets(diagnosis.status.begin(), diagnosis.status.end());
  octets.insert(octets.end(), {diagnosis.master, high(diagnosis.ident), low(diagnosis.ident)});
  if (diagnosis.fault) octets.insert(octets.end(), {kUnitDiagSize, *diagnosis.fault});
  return octets;
}

std::optional<Diagnosis> decode_diagnosis(std::span<const uint8_t> octets) {
  if (octets.size() < kStandardDiagSize) return std::nullopt;
  Diagnosis diagnosis;
  diagnosis.status = {octets[0], octets[1], octets[2]};
  diagnosis.master = octets[3];
  diagnosis.ident = word(octets[4], octets[5]);
  if (octets.size() == kStandardDiagSize + kUnitDiagSize && octets[6] == kUnitDiagSize)
    diagnosis.fault = octets[7];
  return diagnosis;
}

}  // namespace ipos::profibus
