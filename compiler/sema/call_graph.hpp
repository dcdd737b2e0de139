// Which function calls, starts or installs which. Main, tasks and interrupt routines are the roots: what one
// root reaches can be interrupted by what another one reaches.
#pragma once

#include <vector>

#include "compiler/diag/diag.hpp"
#include "compiler/sema/checked.hpp"

namespace ipos::compiler {

struct Context;

enum class ReferenceKind : uint8_t {
  Call,   // runs as part of the caller: CALL, INPCALL, SYSCALL
  Start,  // begins a life of its own: task or interrupt routine
  Stop,   // only named, to be stopped or switched off
};

struct Reference {
  ReferenceKind kind = ReferenceKind::Call;
  size_t function = 0;  // the one referred to
  vm::Opcode opcode = vm::Opcode::Call;
  int32_t keyword = 0;  // which interrupt
  Span span;
};

// What a function call or system call refers to, if anything.
std::optional<Reference> reference_of(const checked::Expr& expr);

// References of each function, in source order.
using CallGraph = std::vector<std::vector<Reference>>;
CallGraph call_graph(const checked::Program& program);

// Functions that main reaches in any way.
std::vector<bool> reachable(const CallGraph& graph, size_t main);

// Warnings: recursion with its chain, functions nobody uses.
void check_calls(Context& context);

}  // namespace ipos::compiler
