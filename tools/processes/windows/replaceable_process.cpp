// A thread.
#include "tools/processes/replaceable_process.hpp"

#include <system_error>
#include <thread>

namespace ipos::tools {

struct ReplaceableProcess::Running {
  int code = -1;
  std::thread thread;
};

const bool ReplaceableProcess::kHasCopies = false;

ReplaceableProcess::ReplaceableProcess(const std::function<int()>& body) : running_(std::make_unique<Running>()) {
  try {
    running_->thread = std::thread([running = running_.get(), body] { running->code = body(); });
  } catch (const std::system_error&) {
    running_.reset();
  }
}

ReplaceableProcess::~ReplaceableProcess() {
  if (running_) wait();
}

int ReplaceableProcess::wait() {
  if (running_->thread.joinable()) running_->thread.join();
  return running_->code;
}

int run_replaceable(const std::function<int()>& body) { return body(); }

std::unique_ptr<debug::Snapshots> snapshots_of_process() { return nullptr; }

}  // namespace ipos::tools
