// ipos debug: the debugger on a terminal or a script, and ipos dap: the same for editors.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#ifdef IPOS_EDITLINE
#include <editline/readline.h>
#endif

#include "compiler/diag/places.hpp"
#include "tools/cli/end_of_process.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/cli/xml_text.hpp"
#include "tools/debug/console.hpp"
#include "tools/debug/dap.hpp"
#include "tools/debug/heard_messages.hpp"
#include "tools/input/folder_plant.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"
#include "tools/lsp_base/transport.hpp"
#include "tools/processes/forked_snapshots.hpp"
#include "tools/processes/replaceable_process.hpp"
#include "tools/test_file/read_tests.hpp"
#include "tools/testing/debugged_test.hpp"

namespace ipos::tools {
namespace {

volatile std::sig_atomic_t stop_asked = 0;
void on_stop(int) { stop_asked = 1; }

// Calls of the system that a command makes go on after Ctrl-C.
void catch_stop() {
  struct sigaction action {};
  action.sa_handler = on_stop;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
}

struct DebugFlags {
  std::string file;
  std::string test_case;
  std::string duration = "60s";
  uint32_t speed = 0;
  bool snapshots = true;
  std::optional<uint16_t> port;
  CompileFlags compile;
};

std::optional<vm::Rates> rates_of(uint32_t speed) {
  return speed == 0 ? std::nullopt : std::optional(vm::Rates{{speed, speed, speed}});
}

// A debugged unit works on a copy of its memory, which is gone at the end: what is stepped over twice must
// not be stored twice.
debug::MakePlant plant_maker(PlantInput input, std::optional<vm::Rates> rates) {
  return [input = std::move(input), rates] { return make_plant(input, runtime::FileUse::Look, rates); };
}

debug::Debuggee debuggee_of(const DebugFlags& flags) {
  if (testing::is_test_file(flags.file))
    return testing::debugged_test(testing::chosen_test(flags.file, flags.test_case), flags.compile, {.speed = flags.speed});
  if (!flags.test_case.empty())
    throw Failure(kUsage, fmt::format("{}: only a test (.test.toml) has cases", compiler::printable(flags.file)));
  return plant_maker(read_plant_input(flags.file, flags.compile), rates_of(flags.speed));
}

// Why it cannot be debugged is said in the Failure, with all that was printed before it.
debug::Debuggee debuggee_or_why(const DebugFlags& flags) {
  const debug::HeardMessages heard;
  try {
    return debuggee_of(flags);
  } catch (const Failure& failure) {
    std::string text = heard.text() + failure.what();
    while (text.ends_with('\n')) text.pop_back();
    throw Failure(failure.exit_code(), text);
  }
}

// Lines of standard input. Ctrl-C on a terminal gives a new prompt; what stood on the line is gone. A script is
// read without a buffer of the library's: what was read ahead must go with the session to the process that goes
// on. Ctrl-C comes through only while keys are waited for: one that comes between the prompt and the first key,
// or between two keys, waits in the kernel and is not lost.
class LineInput {
 public:
  LineInput() : terminal_(isatty(STDIN_FILENO) != 0) {}
  bool is_terminal() const { return terminal_; }

  std::optional<std::string> next() {
    if (!terminal_) return next_of(nullptr);
    sigset_t open;
    sigset_t interrupt;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    sigprocmask(SIG_BLOCK, &interrupt, &open);
    stop_asked = 0;
#ifdef IPOS_EDITLINE
    std::optional<std::string> line = next_edited(open);
#else
    prompt();
    std::optional<std::string> line = next_of(&open);
#endif
    sigprocmask(SIG_SETMASK, &open, nullptr);
    return line;
  }
  debug::Json save() const { return rest_; }
  void load(const debug::Json& state) { rest_ = state.get<std::string>(); }

 private:
  // False: Ctrl-C. `open` is the mask of signals under which Ctrl-C comes through.
  static bool wait_for_keys(const sigset_t& open) {
    for (;;) {
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (ppoll(&input, 1, nullptr, &open) >= 0) return true;
      if (std::exchange(stop_asked, 0) != 0) return false;
    }
  }

  // `open` is null for a script, which no Ctrl-C restarts.
  std::optional<std::string> next_of(const sigset_t* open) {
    for (;;) {
      if (const size_t end = rest_.find('\n'); end != std::string::npos) {
        std::string line = rest_.substr(0, end);
        if (line.ends_with('\r')) line.pop_back();
        rest_.erase(0, end + 1);
        return line;
      }
      if (open != nullptr && !wait_for_keys(*open)) {
        rest_.clear();
        fmt::print("\n");
        prompt();
        continue;
      }
      char buffer[4096];
      const ssize_t count = read(STDIN_FILENO, buffer, sizeof buffer);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return rest_.empty() ? std::nullopt : std::optional(std::exchange(rest_, {}));
      rest_.append(buffer, static_cast<size_t>(count));
    }
  }

#ifdef IPOS_EDITLINE
  std::optional<std::string> next_edited(const sigset_t& open) {
    bool done = false;
    edited_ = [this, &done](char* text) {
      done = true;
      line_ = text == nullptr ? std::nullopt : std::optional<std::string>(text);
      std::free(text);
    };
    const auto take = [](char* text) { edited_(text); };
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
    if (line_ && !line_->empty()) add_history(line_->c_str());
    return std::exchange(line_, std::nullopt);
  }

  static inline std::function<void(char*)> edited_;  // the library's callback has no argument of ours
  std::optional<std::string> line_;
#endif

  static constexpr const char* kPrompt = "(ipos) ";
  static void prompt() {
    fmt::print("{}", kPrompt);
    std::fflush(stdout);
  }

  bool terminal_;
  std::string rest_;
};

#ifdef IPOS_EDITLINE
const debug::Console* completing = nullptr;  // the library's callback has no argument of ours

char* offer(const char* part, int n) {
  static std::vector<std::string> words;
  if (n == 0) words = completing->complete(std::string_view(rl_line_buffer, static_cast<size_t>(rl_point)));
  (void)part;
  return static_cast<size_t>(n) < words.size() ? strdup(words[static_cast<size_t>(n)].c_str()) : nullptr;
}
char** offers(const char* part, int, int) {
  rl_attempted_completion_over = 1;
  return rl_completion_matches(part, offer);
}
#endif

std::unique_ptr<debug::Snapshots> snapshots_of(const DebugFlags& flags) {
  if (!flags.snapshots) return nullptr;
  return std::make_unique<ForkedSnapshots>();
}

int debug_console(const DebugFlags& flags) {
  debug::Debuggee what = debuggee_of(flags);
  LineInput lines;
  debug::Console console([](const std::string& text) { fmt::print("{}", utf8(text)); });
  console.save_input = [&] { return lines.save(); };
  console.load_input = [&](const debug::Json& state) { lines.load(state); };
  console.not_interrupted = [] { return stop_asked == 0; };
  debug::Debugger debugger(std::move(what), console, snapshots_of(flags), runtime::parse_duration(flags.duration));
  console.attach(debugger);
  catch_stop();
#ifdef IPOS_EDITLINE
  completing = &console;
  rl_attempted_completion_function = offers;
#endif
  while (const auto line = lines.next()) {
    stop_asked = 0;
    if (!lines.is_terminal()) fmt::print("(ipos) {}\n", compiler::printable(*line));
    if (!console.execute(*line)) break;
    std::fflush(stdout);
  }
  return kGood;
}

// Messages of an editor on two file descriptors.
int serve(const DebugFlags& flags, int in, int out) {
  lsp::MessageReader reader;
  debug::DapServer server(
      [&flags](const debug::DapLaunch& launch) {
        DebugFlags own = flags;
        if (!launch.unit.empty()) own.compile.unit = launch.unit;
        own.file = launch.file;
        own.test_case = launch.test_case;
        return debuggee_or_why(own);
      },
      [out](const debug::Json& message) {
        const std::string text =
            lsp::framed(message.dump(-1, ' ', false, debug::Json::error_handler_t::replace));
        for (size_t done = 0; done < text.size();) {
          const ssize_t count = write(out, text.data() + done, text.size() - done);
          if (count < 0 && errno != EINTR) throw Failure(kIoError, "the editor does not listen any more");
          if (count > 0) done += static_cast<size_t>(count);
        }
      },
      snapshots_of(flags));
  bool open = true;
  const auto receive = [&](bool wait) {
    pollfd input{in, POLLIN, 0};
    if (!open || (!wait && poll(&input, 1, 0) <= 0)) return;
    char buffer[65536];
    const ssize_t count = read(in, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) return;
    open = count > 0;
    if (!open) server.close();
    if (open) reader.feed({buffer, static_cast<size_t>(count)});
    while (const auto body = reader.next()) server.receive(*body);
    if (reader.broken()) throw Failure(kBadInput, "the input is no debug adapter protocol");
  };
  server.poll = [&] { receive(false); };
  server.save_input = [&] {
    debug::Json state = debug::Json::object();
    state["rest"] = reader.rest();
    return state;
  };
  server.load_input = [&](const debug::Json& state) {
    reader = {};
    reader.feed(state["rest"].get<std::string>());
  };
  while (!server.ended()) {
    if (server.handle_next()) continue;
    if (!open) break;
    receive(true);
  }
  return kGood;
}

// One editor at a time and then the end: a session is a run of its own.
int serve_port(const DebugFlags& flags) {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(*flags.port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (listener < 0 || bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener, 1) != 0)
    throw Failure(kIoError, fmt::format("port {} cannot be listened at", *flags.port));
  socklen_t size = sizeof address;
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  fmt::print(stderr, "ipos: debug adapter at 127.0.0.1:{}\n", ntohs(address.sin_port));
  const int editor = accept(listener, nullptr, nullptr);
  close(listener);
  if (editor < 0) throw Failure(kIoError, "no editor came");
  return serve(flags, editor, editor);
}

// In a process of its own, which another one may take the place of.
int replaceable(const std::function<int()>& body) {
  const int code = run_replaceable([&body] { return end_of_process(body); });
  return code < 0 ? kInternal : code;
}

void add_common(cli::Verb& verb, DebugFlags& flags) {
  verb.option("--speed", flags.speed, "commands per ms of every task, instead of P938 and P939")
      .between(1U, 1'000'000U);
  verb.off("--no-snapshots", flags.snapshots, "step back by running again from the beginning");
  add_compile_options(verb, flags.compile);
}

}  // namespace

void add_debug(cli::Verb& app) {
  auto flags = std::make_shared<DebugFlags>();
  cli::Verb& verb = app.verb("debug", "step through a program or a plant, forward and back");
  verb.option("FILE", flags->file,
              "source (.IPC), image (.ipx), plant (.toml), test (.test.toml) or folder; default: the only plant of this folder");
  verb.option("--case", flags->test_case, "of a test that has several");
  verb.option("--for", flags->duration, "virtual time to run at most; default 60s").check(check_time, "TIME");
  add_common(verb, *flags);
  verb.footer("Example, 'help' lists the words:\n  ipos debug examples/scom/scom.toml");
  verb.runs([flags] {
    flags->file = plant_or_program(flags->file);
    return replaceable([&] { return debug_console(*flags); });
  });
}

void add_dap(cli::Verb& app) {
  auto flags = std::make_shared<DebugFlags>();
  cli::Verb& verb = app.verb("dap", "debug adapter for editors, on standard input and output");
  verb.option("--port", flags->port, "listen at this port of the loopback instead; 0: any free one");
  add_common(verb, *flags);
  verb.footer("Example, in an editor's settings:\n  command: ipos dap");
  verb.runs([flags] {
    return replaceable(
        [&] { return flags->port ? serve_port(*flags) : serve(*flags, STDIN_FILENO, STDOUT_FILENO); });
  });
}

}  // namespace ipos::tools
