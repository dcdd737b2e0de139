// A CAN line of the plant whose `port` is "fmi": a terminal of FMI-LS-BUS. What stations send on the line goes out as operations at
// the end of the step; frames that come in are sent on the line by a node of the library.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/library/session.hpp"
#include "runtime/plant_file/outer_port.hpp"

namespace ipos::fmi {

// Of the variables of a terminal, in the order of their value references.
enum class TerminalMember : uint8_t { RxData, TxData, RxClock, TxClock };
inline constexpr size_t kTerminalMembers = 4;

// What goes out and what has come in, as it is kept with a state.
struct TerminalBuffers {
  std::string out, in;
  bool rx_active = false;
  std::map<uint32_t, std::string> sent;  // the last operation of each identifier, for a bus simulation that lost it

  bool operator==(const TerminalBuffers&) const = default;
};

class BusTerminal {
 public:
  // `line` counts the CAN lines of the plant.
  BusTerminal(std::string name, uint32_t line, uint32_t baud) : name_(std::move(name)), line_(line), baud_(baud) {}
  const std::string& name() const { return name_; }

  // At power-on: the line is joined, and the configuration goes out.
  void begin(library::Session& session);
  // After a step; true: there is something to be fetched.
  bool collect(library::Session& session);
  // What has come is sent on the line; texts are of what could not be.
  std::vector<std::string> take_in(library::Session& session);
  // After another state was gone back to: what the line has carried before is known outside already.
  void forget_heard(library::Session& session) const;

  TerminalBuffers buffers;
  bool fetched = false;  // the clock of what goes out was seen

 private:
  std::string name_;
  uint32_t line_;
  uint32_t baud_;
};

std::vector<BusTerminal> terminals_of(const runtime::PlantFile& file);

}  // namespace ipos::fmi
