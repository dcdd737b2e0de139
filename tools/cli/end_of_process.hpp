// What every process of ipos ends with: its exit code, also when a verb threw or its output went nowhere.
#pragma once

#include <functional>

namespace ipos::tools {

// Runs `body` and returns its exit code; after a Failure the code of that, after anything else kInternal. Text
// that could not be written to standard output or as messages makes it kIoError, whatever the verb found.
int end_of_process(const std::function<int()>& body);

}  // namespace ipos::tools
