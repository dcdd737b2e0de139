// Those who look at a real-time run of another process: the side of the run, and that of `ipos debug` and `ipos dap`.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "tools/debug/attach_port.hpp"
#include "tools/debug/dap.hpp"

namespace ipos::tools::debug {

// Real-time runs of this program can be looked at from now on.
void offer_onlookers();

// The run of this process number, or the only one there is. A Failure says what there is instead.
AttachableRun chosen_run(std::optional<int64_t> process);

// Lines of standard input to the run, answers back, until either ends.
int console_of_run(const AttachableRun& run);

// An editor on two files and the run. `told` are the messages that have come from the editor and are for the run,
// "initialize" first, whose answer the editor has; `rest` is the beginning of the next.
struct EditorBefore {
  std::deque<Json> told;
  std::string rest;
};
int editor_of_run(Peer& run, int in, int out, EditorBefore before);

}  // namespace ipos::tools::debug
