// What the VM asks of the unit it runs in: system functions, through one plain structure of function
// pointers. The VM knows neither buses nor parameters; the host knows no opcodes' coding.
#pragma once

#include <cstdint>

#include "vm/isa/isa.hpp"

namespace ipos::vm {

class Machine;

enum class Answer : uint8_t {
  Done,   // go on with the next command
  Taken,  // Flow::SystemCall only: the event has occurred, call the label
  Wait,   // the task waits until the host calls Machine::resume
  Fault,  // the command cannot be carried out: fault number in HostReply::fault
};

struct HostReply {
  Answer answer = Answer::Done;
  uint8_t fault = 0;             // drive fault number when answer is Fault, for example 10
  const char* reason = nullptr;  // static text for the user when answer is Fault
};

struct Host {
  void* self = nullptr;
  // Carries out one system command. `context` says who executes it (vm/context/context.hpp), 1..3 are the tasks;
  // with Answer::Wait it is what to give to Machine::resume. Must not throw and not block.
  HostReply (*execute)(void* self, Machine& machine, int context,
                       const Instruction& command) noexcept = nullptr;
  // A context that was waiting for the host has been stopped: it must not be resumed for that command. May be
  // left out by a host that never answers Wait.
  void (*cancel)(void* self, Machine& machine, int context) noexcept = nullptr;
};

}  // namespace ipos::vm
