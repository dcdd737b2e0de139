// Which telegrams concern a station: those of its address and group, and the variable telegrams it sends or
// receives. Who calls another station does not stand in a telegram, so a master's calls are not among its
// own.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/movilink/serial_telegram.hpp"

namespace ipos::runtime {

// The address that a text is; nothing for a name.
std::optional<uint8_t> station_number(std::string_view text);

class StationFilter {
 public:
  // Adds a station by its name, or by its address, which need not be known. False: there is no such name.
  bool add(const TelegramNames& names, std::string_view station);

  // Frames with this identifier, of a station that is no unit of MOVILINK.
  void add(uint32_t identifier);

  // From now on only what is added passes, also if that is nothing.
  void close() { all_ = false; }

  // Without any station everything passes.
  bool passes(const Frame& frame) const;
  bool passes(const SerialTelegram& telegram) const;

 private:
  void add(const TelegramNames& names, const UnitNames& unit);
  bool is_addressed(uint8_t address, bool group) const;

  bool all_ = true;
  std::vector<uint8_t> addresses_;
  std::vector<uint8_t> groups_;
  std::vector<uint32_t> identifiers_;  // of variable telegrams and sync telegrams
};

}  // namespace ipos::runtime
