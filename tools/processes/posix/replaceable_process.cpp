// The worker is a copy; what the last of its copies returns comes over a pipe.
#include "tools/processes/replaceable_process.hpp"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>

#include "tools/cli/whole_bytes.hpp"
#include "tools/processes/posix/forked_snapshots.hpp"

namespace ipos::tools {

struct ReplaceableProcess::Running {
  int pipe;  // what it returns comes here
};

const bool ReplaceableProcess::kHasCopies = true;

ReplaceableProcess::ReplaceableProcess(const std::function<int()>& body) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return;
  std::fflush(nullptr);
  // Ctrl-C is the worker's. It is ignored here before there is a worker whose prompt can be answered with one.
  const auto on_interrupt = std::signal(SIGINT, SIG_IGN);
  const pid_t worker = fork();
  if (worker <= 0) std::signal(SIGINT, on_interrupt);
  if (worker == 0) {
    close(ends[0]);
    std::signal(SIGCHLD, SIG_IGN);  // snapshots end without being waited for
    std::signal(SIGPIPE, SIG_IGN);
    const int32_t code = body();
    std::fflush(nullptr);
    write_all(ends[1], reinterpret_cast<const char*>(&code), sizeof code);
    _exit(0);
  }
  close(ends[1]);
  if (worker > 0)
    running_ = std::make_unique<Running>(Running{ends[0]});
  else
    close(ends[0]);
}

ReplaceableProcess::~ReplaceableProcess() {
  if (running_) close(running_->pipe);
}

int ReplaceableProcess::wait() {
  int32_t code = -1;
  return read_all(running_->pipe, reinterpret_cast<char*>(&code), sizeof code) ? code : -1;
}

int run_replaceable(const std::function<int()>& body) {
  ReplaceableProcess process(body);
  return process.started() ? process.wait() : body();
}

std::unique_ptr<debug::Snapshots> snapshots_of_process() { return std::make_unique<ForkedSnapshots>(); }

}  // namespace ipos::tools
