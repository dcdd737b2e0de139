// ipos debug: the debugger on a terminal or a script, and ipos dap: the same for editors.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>

#include "compiler/diag/places.hpp"
#include "tools/cli/end_of_process.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/os_file.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/cli/whole_bytes.hpp"
#include "tools/cli/xml_text.hpp"
#include "tools/debug/console.hpp"
#include "tools/debug/dap.hpp"
#include "tools/debug/editor_port.hpp"
#include "tools/debug/heard_messages.hpp"
#include "tools/debug/line_input.hpp"
#include "tools/debug/onlookers.hpp"
#include "tools/input/folder_plant.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_objects.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"
#include "tools/lsp_base/transport.hpp"
#include "tools/processes/replaceable_process.hpp"
#include "tools/testing/debugged_test.hpp"

namespace ipos::tools {
namespace {

struct DebugFlags {
  std::string file;
  std::string test_case;
  std::string duration = "60s";
  std::string attach;  // a process, or "*": the only run
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
  if (kind_of_file(flags.file) == runtime::TomlKind::Test)
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

std::unique_ptr<debug::Snapshots> snapshots_of(const DebugFlags& flags) {
  return flags.snapshots ? snapshots_of_process() : nullptr;
}

// Of the option: a number, or nothing for the only one.
std::optional<int64_t> process_of(const std::string& text) {
  if (text == "*") return std::nullopt;
  int64_t process = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), process);
  if (status != std::errc() || end != text.data() + text.size())
    throw Failure(kUsage, fmt::format("--attach: '{}' is no number of a process", compiler::printable(text)));
  return process;
}

int look_at_run(const DebugFlags& flags) {
  if (!flags.file.empty()) throw Failure(kUsage, "--attach looks at a run, which knows its file");
  return debug::console_of_run(debug::chosen_run(process_of(flags.attach)));
}

int debug_console(const DebugFlags& flags) {
  debug::Debuggee what = debuggee_of(flags);
  debug::LineInput lines;
  debug::Console console([](const std::string& text) { fmt::print("{}", utf8(text)); });
  console.save_input = [&] { return debug::Json(lines.rest()); };
  console.load_input = [&](const debug::Json& state) { lines.set_rest(state.get<std::string>()); };
  console.not_interrupted = [] { return !interrupted(); };
  debug::Debugger debugger(std::move(what), console, snapshots_of(flags), runtime::parse_duration(flags.duration));
  tell_objects(debugger.plant());
  console.attach(debugger);
  catch_ctrl_c();
  lines.complete_with([&console](std::string_view line) { return console.complete(line); });
  while (const auto line = lines.next()) {
    forget_interrupt();
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
        if (!write_all(out, text.data(), text.size())) throw Failure(kIoError, "the editor does not listen any more");
      },
      snapshots_of(flags));
  bool open = true;
  const auto receive = [&](bool wait) {
    if (!open || (!wait && !readable(in, 0))) return;
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
  std::unique_ptr<debug::Peer> run;
  server.attach_to = [&run](const debug::DapAttach& wanted) {
    run = debug::attach_to(debug::chosen_run(wanted.process));
    if (!run) throw Failure(kIoError, "that run cannot be looked at any more");
  };
  while (!server.ended()) {
    if (server.handle_next()) {
      if (server.attached()) return debug::editor_of_run(*run, in, out, {server.for_the_run(), reader.rest()});
      continue;
    }
    if (!open) break;
    receive(true);
  }
  return kGood;
}

// One editor at a time and then the end: a session is a run of its own.
int serve_port(const DebugFlags& flags) {
  const runtime::Descriptor editor = debug::editor_at(
      *flags.port, [](uint16_t port) { fmt::print(stderr, "ipos: debug adapter at 127.0.0.1:{}\n", port); });
  return serve(flags, editor.get(), editor.get());
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
  add_plant_options(verb, flags.compile);
}

}  // namespace

void add_debug(cli::Verb& app) {
  auto flags = std::make_shared<DebugFlags>();
  cli::Verb& verb = app.verb("debug", "step through a program or a plant, forward and back");
  verb.option("FILE", flags->file,
              "source (.IPC), image (.ipx), plant (.toml), test (.test.toml) or folder; default: the only plant of this folder");
  verb.option("--case", flags->test_case, "of a test that has several");
  verb.option("--for", flags->duration, "virtual time to run at most; default 60s").check(check_time, "TIME");
  verb.flag("--attach", flags->attach, "*", "look at an 'ipos run --realtime' that goes on: the only one, or --attach=PROCESS");
  add_common(verb, *flags);
  verb.footer("Example, 'help' lists the words:\n  ipos debug examples/scom/scom.toml");
  verb.runs([flags] {
    if (!flags->attach.empty()) return look_at_run(*flags);
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
