// fork() and a pipe: a byte tells that all is done, the end of the pipe that the copy is no more. And one anonymous mapping.
#include "tools/serve/posix/forked_copies.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>

#include "tools/processes/posix/forked_snapshots.hpp"
#include "tools/serve/host_copies.hpp"

namespace ipos::tools::serve {
namespace {

constexpr int kGivesWay = 10;  // nice

class ForkedRun final : public SecondRun {
 public:
  // `body` never comes back here.
  explicit ForkedRun(const std::function<void()>& body);
  // After this the copy writes no more. Another process than the one that began it leaves it alone.
  ~ForkedRun() override;
  ForkedRun(const ForkedRun&) = delete;
  ForkedRun& operator=(const ForkedRun&) = delete;

  std::optional<bool> result() override;

 private:
  int pipe_ = -1;
  pid_t owner_ = -1;
  pid_t copy_ = -1;
  std::optional<bool> result_;
};

ForkedRun::ForkedRun(const std::function<void()>& body) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    result_ = false;
    return;
  }
  std::fflush(nullptr);
  owner_ = getpid();
  copy_ = fork();
  if (copy_ == 0) {
    close(ends[0]);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != owner_) _exit(1);
    if (nice(kGivesWay) == -1) errno = 0;
    try {
      body();
    } catch (...) {
      _exit(1);  // the same mistake was told by the process that it came from
    }
    const ssize_t told = write(ends[1], "d", 1);
    _exit(told == 1 ? 0 : 1);
  }
  close(ends[1]);
  pipe_ = ends[0];
  if (copy_ < 0) result_ = false;
}

ForkedRun::~ForkedRun() {
  if (copy_ > 0 && owner_ == getpid()) {
    kill(copy_, SIGKILL);
    char byte = 0;
    while (read(pipe_, &byte, 1) == 1 || errno == EINTR) errno = 0;
    waitpid(copy_, nullptr, 0);
  }
  if (pipe_ >= 0) close(pipe_);
}

std::optional<bool> ForkedRun::result() {
  pollfd waiting{pipe_, POLLIN, 0};
  if (result_ || poll(&waiting, 1, 0) <= 0) return result_;
  char byte = 0;
  const ssize_t count = read(pipe_, &byte, 1);
  if (count >= 0) result_ = count == 1;
  return result_;
}

}  // namespace

std::unique_ptr<debug::Snapshots> ForkedCopies::snapshots() {
  if (!snapshots_) return nullptr;
  return std::make_unique<ForkedSnapshots>();
}

Memory ForkedCopies::memory(size_t bytes) {
  void* const begin =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (begin == MAP_FAILED) return nullptr;
  return {static_cast<std::byte*>(begin), [bytes](std::byte* at) { munmap(at, bytes); }};
}

void ForkedCopies::give_way() { sched_yield(); }

std::unique_ptr<SecondRun> ForkedCopies::beside(const std::function<void()>& body) {
  return std::make_unique<ForkedRun>(body);
}

std::unique_ptr<Copies> host_copies(bool snapshots) { return std::make_unique<ForkedCopies>(snapshots); }

}  // namespace ipos::tools::serve
