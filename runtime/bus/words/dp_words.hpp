// The process data of a PROFIBUS-DP line in words: what Data_Exchange carries, taken apart by the configuration of the slave,
// the parameter channel and the words of its drive, or of each drive behind a gateway. The line is listened to from its
// beginning: the configuration is the one that its master sent last (Chk_Cfg), before that the one that is planned.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/bus/profibus/fdl_receiver.hpp"

namespace ipos::runtime {

struct DpSlaveNames {
  uint8_t address = 0;
  std::string name;
  profibus::AcceptedWords accepts;                         // of its card
  const profibus::Configuration* configuration = nullptr;  // that is planned; null: nobody knows
  bool own_numbers = false;                                // a MOVITRAC 31: values of parameters travel as BCD
  std::vector<UnitNames> drives;  // its own one; of a gateway those behind it, by rising SBus addresses
  bool gateway = false;
};

struct DpNames {
  std::map<std::string, std::vector<DpSlaveNames>> lines;  // by name; a log that names none has the only one
};

class DpLineWords {
 public:
  explicit DpLineWords(std::vector<DpSlaveNames> slaves = {}) : slaves_(std::move(slaves)) {}

  // Others from now on; what was heard stays.
  void use(std::vector<DpSlaveNames> slaves) { slaves_ = std::move(slaves); }

  // Of the next frame on the line.
  std::string describe(const profibus::Reception& reception);
  // Whether its words depend on what went before.
  bool is_known_exchange(const profibus::FdlFrame& frame) const;

 private:
  const DpSlaveNames* slave(uint8_t address) const;
  void listen(const profibus::FdlFrame& frame);
  const profibus::Configuration* configuration_of(const DpSlaveNames& slave) const;
  std::string data_text(const profibus::FdlFrame& frame) const;

  std::vector<DpSlaveNames> slaves_;
  std::map<uint8_t, const profibus::Configuration*> heard_;
};

}  // namespace ipos::runtime
