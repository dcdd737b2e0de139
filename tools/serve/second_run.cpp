// fork() and a pipe: a byte tells that all is done, the end of the pipe that the copy is no more.
#include "tools/serve/second_run.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>

namespace ipos::tools::serve {
namespace {

constexpr int kGivesWay = 10;  // nice

}  // namespace

SecondRun::SecondRun(const std::function<void()>& body) {
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

SecondRun::~SecondRun() {
  if (copy_ > 0 && owner_ == getpid()) {
    kill(copy_, SIGKILL);
    char byte = 0;
    while (read(pipe_, &byte, 1) == 1 || errno == EINTR) errno = 0;
    waitpid(copy_, nullptr, 0);
  }
  if (pipe_ >= 0) close(pipe_);
}

std::optional<bool> SecondRun::result() {
  pollfd waiting{pipe_, POLLIN, 0};
  if (result_ || poll(&waiting, 1, 0) <= 0) return result_;
  char byte = 0;
  const ssize_t count = read(pipe_, &byte, 1);
  if (count >= 0) result_ = count == 1;
  return result_;
}

}  // namespace ipos::tools::serve
