// The positioning commands of a program: GOA, GOR, GO0, ASTOP, TOUCHP, and of GETSYS and SETSYS what belongs
// to positioning. Waiting commands block the context that runs them, nothing else.
#pragma once

#include <array>

#include "runtime/services/positioning_service.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

class PositioningCommands {
 public:
  explicit PositioningCommands(PositioningService& service) : service_(service) {}

  bool touched() const { return service_.positioner().touch_probes().probe(0).touched; }

  // Whether this value of GETSYS or SETSYS belongs to positioning.
  static bool has_value(vm::Opcode opcode, int32_t keyword);
  // One of the commands above.
  vm::HostReply execute(vm::Machine& machine, int context, const vm::Instruction& command);

  // Once a millisecond, after the service has shown what there is: contexts whose wait is over go on.
  void tick(vm::Machine& machine) {
    if (may_wait_ && service_.positioner().in_position()) resume(machine);
  }

  // The context does not wait any more.
  void cancel(int context) { waiting_[slot(context)] = false; }
  void cancel_all() { waiting_ = {}; }

 private:
  static size_t slot(int context) { return static_cast<size_t>(context - 1); }

  void resume(vm::Machine& machine);
  vm::HostReply wait(int context);
  vm::HostReply travel(vm::Machine& machine, int context, const vm::Instruction& command);
  vm::HostReply set_system_value(std::span<const int32_t> h, int32_t keyword, size_t variable,
                                 uint32_t address);
  vm::HostReply run_cam(std::span<int32_t> h, uint32_t structure);

  PositioningService& service_;
  std::array<bool, vm::kContexts> waiting_{};  // for the axis to be in position
  bool may_wait_ = false;                      // one of them does, or did before it was stopped
};

}  // namespace ipos::runtime
