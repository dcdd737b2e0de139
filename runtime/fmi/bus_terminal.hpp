// Terminals of FMI-LS-BUS: what goes out and comes in as operations. A CAN line of the plant whose `port` is "fmi" is one: what
// stations send goes out at the end of the step, frames that come in are sent on the line by a node of the library. The terminals of
// a line alone are in line_terminal.hpp.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/fmi/variables.hpp"
#include "runtime/library/session.hpp"
#include "runtime/plant_file/outer_port.hpp"

namespace ipos::fmi {

struct ReadOperation;

// Of variables of a terminal, in the order of their value references.
enum class TerminalMember : uint8_t { RxData, TxData, RxClock, TxClock, BusNotifications };
inline constexpr size_t kTerminalMembers = 5;

// What goes out and what has come in, as it is kept with a state.
struct TerminalBuffers {
  std::string out, in;
  bool rx_active = false;
  bool notified = false;  // Confirm, Arbitration Lost and Bus Error count
  std::map<uint32_t, std::string> sent;  // the last operation of each identifier, for a bus simulation that lost it

  bool operator==(const TerminalBuffers&) const = default;
};

class BusTerminal {
 public:
  explicit BusTerminal(std::string name) : name_(std::move(name)) {}
  BusTerminal(const BusTerminal&) = delete;
  BusTerminal& operator=(const BusTerminal&) = delete;
  virtual ~BusTerminal() = default;
  const std::string& name() const { return name_; }

  // It stands for the line, and the FMU is a bus simulation: its clock is a countdown, where a node has a triggered one.
  virtual bool is_of_the_line() const = 0;
  // At power-on.
  virtual void begin(library::Session& session) = 0;
  // After a step; true: there is something to be fetched.
  virtual bool collect(library::Session& session) = 0;
  // What has come acts.
  struct Taken {
    std::vector<std::string> wrong;  // texts of what could not
    bool wakes = false;              // the other terminals
  };
  Taken take_in(library::Session& session);
  // When there is something to be fetched, unless something else comes in before; kNever: nobody knows.
  virtual runtime::Time next_time(library::Session& session) const = 0;
  // After another state was gone back to: what the line has carried before is known outside already.
  virtual void forget_heard(library::Session& session) const = 0;

  TerminalBuffers buffers;
  bool fetched = false;  // the clock of what goes out was seen, or set
  struct Announced {
    runtime::Time at, length;
  };
  std::optional<Announced> announced;  // of a countdown

 protected:
  virtual void act(const ReadOperation& operation, library::Session& session, Taken& taken) = 0;
  void put_out(const std::string& operation);

 private:
  std::string name_;
};

using Terminals = std::vector<std::unique_ptr<BusTerminal>>;
Terminals terminals_of(const runtime::PlantFile& file, const Choice& choice);

}  // namespace ipos::fmi
