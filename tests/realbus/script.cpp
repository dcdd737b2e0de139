// Scripts as child processes.
#include "tests/realbus/script.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <sstream>

namespace ipos::tests {

ScriptResult run_script(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {-1, "no pipe"};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], 1);
    dup2(ends[1], 2);
    close(ends[0]);
    close(ends[1]);
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  close(ends[1]);
  ScriptResult result{-1, {}};
  std::array<char, 4096> buffer{};
  ssize_t size = 0;
  while ((size = read(ends[0], buffer.data(), buffer.size())) > 0)
    result.output.append(buffer.data(), static_cast<size_t>(size));
  close(ends[0]);
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status))
    result.exit_code = WEXITSTATUS(status);
  return result;
}

void expect_all_ok(const std::string& output, size_t checks) {
  size_t ok = 0;
  bool ended = false;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    ok += line.starts_with("ok ") ? 1 : 0;
    ended |= line == "end";
    if (line.starts_with("FAIL ")) ADD_FAILURE() << line;
  }
  EXPECT_TRUE(ended) << output;
  EXPECT_GE(ok, checks) << output;
}

}  // namespace ipos::tests
