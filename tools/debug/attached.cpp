// The side of who looks: lines and messages there and back. Nothing of the run is known here.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "compiler/diag/places.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/os_file.hpp"
#include "tools/cli/whole_bytes.hpp"
#include "tools/cli/xml_text.hpp"
#include "tools/debug/line_input.hpp"
#include "tools/debug/onlookers.hpp"
#include "tools/lsp_base/transport.hpp"

namespace ipos::tools::debug {
namespace {

constexpr char kEndOfAnswer = '\4';
constexpr std::chrono::seconds kLastAnswers{1};  // behind the end of what the editor sends
constexpr int kPause = 2;  // ms between two looks at what has come

std::unique_ptr<Peer> reached(const AttachableRun& run) {
  auto peer = attach_to(run);
  if (!peer) throw Failure(kIoError, fmt::format("process {} cannot be looked at any more", run.process));
  return peer;
}

// All of it. False: the run has gone.
bool send_all(Peer& peer, std::string bytes) {
  while (peer.send(bytes)) {
    if (bytes.empty()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(kPause));
  }
  return false;
}

// The next answer is printed. False: the run has gone, or Ctrl-C.
bool print_answer(Peer& peer, std::string& come) {
  for (bool there = true;;) {
    if (const size_t end = come.find(kEndOfAnswer); end != std::string::npos) {
      fmt::print("{}", utf8(come.substr(0, end)));
      std::fflush(stdout);
      come.erase(0, end + 1);
      return true;
    }
    if (!there || interrupted()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(kPause));
    there = peer.receive(come);
  }
}

void write_out(int out, const Json& message) {
  const std::string text = lsp::framed(message.dump(-1, ' ', false, Json::error_handler_t::replace));
  if (!write_all(out, text.data(), text.size())) throw Failure(kIoError, "the editor does not listen any more");
}

}  // namespace

AttachableRun chosen_run(std::optional<int64_t> process) {
  std::vector<AttachableRun> all = attachable_runs();
  if (!process && all.size() == 1) return all.front();
  std::string known;
  for (const AttachableRun& run : all) {
    if (process == run.process) return run;
    known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", run.process, run.name);
  }
  if (all.empty()) throw Failure(kBadInput, "no 'ipos run --realtime' of this user goes on");
  throw Failure(process ? kBadInput : kUsage,
                process ? fmt::format("process {} is no 'ipos run --realtime' of this user; there are {}", *process, known)
                        : fmt::format("several runs go on: {}; choose one of them (--attach=PROCESS)", known));
}

int console_of_run(const AttachableRun& run) {
  const auto peer = reached(run);
  std::string come;
  LineInput lines;
  catch_ctrl_c();
  bool there = send_all(*peer, "console\n") && print_answer(*peer, come);
  while (there) {
    forget_interrupt();
    const auto line = lines.next();
    if (!line) return kGood;
    if (!lines.is_terminal()) fmt::print("(ipos) {}\n", compiler::printable(*line));
    there = send_all(*peer, *line + "\n") && print_answer(*peer, come);
    const std::string word = line->substr(0, line->find_last_not_of(" \t\r") + 1);
    if (word == "q" || word == "quit") return kGood;
  }
  fmt::print("{}\n", interrupted() ? "Interrupted" : "the run has ended");
  return kGood;
}

int editor_of_run(Peer& run, int in, int out, EditorBefore before) {
  const int64_t first = before.told.front().value("seq", int64_t{0});
  std::string to_run = "dap\n", come;
  for (const Json& message : before.told) to_run += lsp::framed(message.dump());
  to_run += before.rest;
  lsp::MessageReader reader;
  int64_t seq = 0;
  bool disconnects = false;
  std::chrono::steady_clock::time_point end{};
  for (bool there = true, open = true;;) {
    if (!run.send(to_run)) there = false;
    if (there) there = run.receive(come);
    reader.feed(come);
    come.clear();
    while (const auto body = reader.next()) {
      const Json message = lsp::parsed(*body);
      if (!message.is_object()) continue;
      seq = message.value("seq", seq);
      const bool answers = message.value("type", "") == "response";
      // The editor has heard this of its own adapter.
      if ((answers && message.value("request_seq", int64_t{-1}) == first) || message.value("event", "") == "initialized") continue;
      disconnects = disconnects || (answers && message.value("command", "") == "disconnect");
      write_out(out, message);
    }
    if (disconnects || (!open && std::chrono::steady_clock::now() > end)) return kGood;
    if (!there) {
      write_out(out, {{"type", "event"}, {"seq", seq + 1}, {"event", "output"}, {"body", {{"category", "console"}, {"output", "the run has ended\n"}}}});
      write_out(out, {{"type", "event"}, {"seq", seq + 2}, {"event", "terminated"}, {"body", Json::object()}});
      return kGood;
    }
    if (!open) std::this_thread::sleep_for(std::chrono::milliseconds(kPause));
    if (!open || !readable(in, kPause)) continue;
    char buffer[65536];
    const auto count = read(in, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    open = count > 0;
    end = std::chrono::steady_clock::now() + kLastAnswers;
    if (open) to_run.append(buffer, static_cast<size_t>(count));
  }
}

}  // namespace ipos::tools::debug
