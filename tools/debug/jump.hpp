// Sets the next statement of a task: it goes on there, and what stands between is neither done nor undone.
#pragma once

#include <string>
#include <vector>

#include "tools/debugger/debugger.hpp"

namespace ipos::tools::debug {

// The first commands of the statements that begin at a line of a file: one in each copy of the function. Empty: none begins there.
std::vector<uint32_t> statements_at(const Debugger& debugger, uint32_t station, const std::string& file, uint32_t line);

// Throws ValueError with the reason where the task does not stand at a statement that could be left, or cannot go on there:
// another function, the middle of a statement, a place that needs what the code before it has computed.
void jump(Debugger& debugger, TaskRef task, uint32_t address);

}  // namespace ipos::tools::debug
