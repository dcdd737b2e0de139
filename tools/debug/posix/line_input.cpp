// A terminal. Ctrl-C comes through only while keys are waited for: one that comes between the prompt and the first key, or
// between two keys, waits in the kernel and is not lost. With libedit lines can be edited and completed.
#include "tools/debug/line_input.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>
#ifdef IPOS_EDITLINE
#include <editline/readline.h>
#endif

#include "tools/cli/interrupt.hpp"

namespace ipos::tools::debug {
namespace {

constexpr const char* kPrompt = "(ipos) ";

// False: Ctrl-C. `open` is the mask of signals under which Ctrl-C comes through.
bool wait_for_keys(const sigset_t& open) {
  for (;;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (ppoll(&input, 1, nullptr, &open) >= 0) return true;
    if (!interrupted()) continue;
    forget_interrupt();
    return false;
  }
}

#ifdef IPOS_EDITLINE
// The library's callbacks have no argument of ours.
std::function<void(char*)> edited;
LineInput::Words completing;

std::optional<std::string> next_edited(const sigset_t& open) {
  bool done = false;
  std::optional<std::string> line;
  edited = [&](char* text) {
    done = true;
    if (text != nullptr) line = text;
    std::free(text);
  };
  const auto take = [](char* text) { edited(text); };
  rl_callback_handler_install(kPrompt, take);
  while (!done) {
    if (wait_for_keys(open)) {
      rl_callback_read_char();
      continue;
    }
    rl_callback_handler_remove();
    fmt::print("\n");
    std::fflush(stdout);
    rl_callback_handler_install(kPrompt, take);
  }
  rl_callback_handler_remove();
  if (line && !line->empty()) add_history(line->c_str());
  return line;
}

char* offer(const char* /*part*/, int n) {
  static std::vector<std::string> words;
  if (n == 0) words = completing(std::string_view(rl_line_buffer, static_cast<size_t>(rl_point)));
  return static_cast<size_t>(n) < words.size() ? strdup(words[static_cast<size_t>(n)].c_str()) : nullptr;
}
char** offers(const char* part, int, int) {
  rl_attempted_completion_over = 1;
  return rl_completion_matches(part, offer);
}
#else
void prompt() {
  fmt::print("{}", kPrompt);
  std::fflush(stdout);
}
#endif

}  // namespace

std::optional<std::string> LineInput::next_typed() {
  sigset_t open;
  sigset_t interrupt;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  sigprocmask(SIG_BLOCK, &interrupt, &open);
  forget_interrupt();
#ifdef IPOS_EDITLINE
  std::optional<std::string> line = next_edited(open);
#else
  prompt();
  std::optional<std::string> line = line_of_rest();
  for (bool more = true; !line && more; line = line_of_rest()) {
    if (wait_for_keys(open)) {
      more = read_more();
      continue;
    }
    rest_.clear();
    fmt::print("\n");
    prompt();
  }
  if (!line && !rest_.empty()) line = std::exchange(rest_, {});
#endif
  sigprocmask(SIG_SETMASK, &open, nullptr);
  return line;
}

void LineInput::complete_with([[maybe_unused]] Words words) {
#ifdef IPOS_EDITLINE
  completing = std::move(words);
  rl_attempted_completion_function = offers;
#endif
}

}  // namespace ipos::tools::debug
