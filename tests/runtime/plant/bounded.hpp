// Runs what may hang in a process of its own with a bound of work, so that a hang is a failed test and no hung suite. The
// bound is of the processor's time that it has used itself: a loaded machine changes nothing. Windows
// has no fork: there it runs here, and a hang is one for the limit of ctest.
#pragma once

#ifdef _WIN32

#include <string>

namespace ipos::tests {

template <class Attempt>
std::string bounded(const Attempt& attempt) {
  return attempt();
}

}  // namespace ipos::tests

#else

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>

namespace ipos::tests {

inline constexpr rlim_t kMostSeconds = 60;  // what is tried needs a hundredth of it

// What `attempt` returns, a complaint or nothing; a complaint of its own where it does not come to its end.
template <class Attempt>
std::string bounded(const Attempt& attempt) {
  int ends[2];
  if (pipe(ends) != 0) return "there is no pipe";
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return "there is no further process";
  if (child == 0) {
    const rlimit limit{kMostSeconds, kMostSeconds};
    setrlimit(RLIMIT_CPU, &limit);
    const std::string complaint = attempt();
    for (size_t at = 0; at < complaint.size();) {
      const ssize_t count = write(ends[1], complaint.data() + at, complaint.size() - at);
      if (count <= 0) break;
      at += static_cast<size_t>(count);
    }
    std::fflush(nullptr);
    _exit(0);
  }
  close(ends[1]);
  std::string complaint;
  char bytes[4096];
  for (ssize_t count = 0; (count = read(ends[0], bytes, sizeof bytes)) > 0;)
    complaint.append(bytes, static_cast<size_t>(count));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status))
    return WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGXCPU
               ? "it does not come to an end"
               : "it ends by signal " + std::to_string(WTERMSIG(status));
  if (WEXITSTATUS(status) != 0) return "it ends with " + std::to_string(WEXITSTATUS(status));
  return complaint;
}

}  // namespace ipos::tests

#endif
