// Any lines as messages of a page to the host of a plant (docs/reference/serve.md): each is answered, by one
// reply or its parts, and the plant goes on.
//
// Making a plant takes longer than a hundred messages, so with IPOS_FUZZ_KEEP=N in the environment N inputs go to one
// host. Its messages so far are then in the file serve-history, which outlives a finding: without its zeros it is one
// input that does the same.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <string>

#include "tests/fuzz/fuzz.hpp"
#include "tools/serve/plant_host.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

namespace {

using tools::serve::Json;
using tools::serve::LetterKind;

constexpr const char* kPlant = R"(
[[bus]]
name = "sbus"
kind = "can"
[[bus]]
name = "line"
kind = "rs485"
[[station]]
name = "saw"
unit = "md60a"
sbus = "sbus"
rs485 = "line"
[[station]]
name = "lift"
unit = "mc07"
sbus = "sbus"
[station.parameters]
P813 = 2
[[wire]]
from = "saw.DO01"
to = "lift.DI03"
)";
constexpr int64_t kMostStep = 20;  // ms: more tell nothing new
constexpr size_t kLongReply = 4096;  // is not read: that would take longer than to make it
// Commands that take as long as a hundred others. Of many inputs for one host only each so many-th is carried out.
constexpr std::string_view kSlow[] = {"parameters", "parameters.compare", "parameters.save", "plant", "back", "restart"};
constexpr int kOfSlow = 64;

// A page that pauses what it has started.
class PausingPost final : public tools::serve::Post {
 public:
  bool send(LetterKind kind, uint16_t, std::string_view body) override {
    if (kind == LetterKind::Reply && body.size() < kLongReply) {
      const Json reply = Json::parse(body, nullptr, false);
      require(reply.is_object() && reply.contains("re"), "a reply is an object and says to what");
      require(reply.contains("ok") != reply.contains("error"), "it is good or it is not");
    }
    answered = answered || kind == LetterKind::Reply || kind == LetterKind::Binary;
    return true;
  }
  std::optional<tools::serve::Letter> wait(int) override {
    if (waiting.empty() && !runs) return std::nullopt;
    runs = !waiting.empty();
    if (waiting.empty()) return tools::serve::Letter{LetterKind::Message, 1, R"({"do": "pause"})"};
    tools::serve::Letter letter = std::move(waiting.front());
    waiting.pop_front();
    return letter;
  }
  bool open() const override { return true; }

  std::deque<tools::serve::Letter> waiting;
  bool answered = false;
  bool runs = false;
};

tools::debug::MakePlant make() {
  return [] {
    std::vector<runtime::PlantError> errors;
    runtime::PlantFile file = runtime::read_plant_file(kPlant).plant;
    std::vector<std::optional<vm::Image>> programs(file.stations.size());
    return std::make_unique<runtime::Plant>(std::move(file), std::move(programs), std::nullopt, errors);
  };
}

// Long ways of the plant are cut short.
std::string shortened(std::string_view line) {
  const bool plain = line.find('\\') == std::string_view::npos;
  if (plain && line.find("step") == std::string_view::npos) return std::string(line);
  Json message = Json::parse(line, nullptr, false);
  if (!message.is_object()) return std::string(line);
  if (message.contains("ms") && message["ms"].is_number_integer() && message.value("do", Json()) == "step")
    message["ms"] = message["ms"].is_number_unsigned()
                        ? static_cast<int64_t>(message["ms"].get<uint64_t>() % kMostStep)
                        : -1;
  if (message.value("do", Json()) == "step") message.erase("telegram");
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The messages that a host has had, in a file.
class History {
 public:
  History() {
    const int file = open("serve-history", O_RDWR | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || ftruncate(file, kSize) != 0) broken("serve-history can be written");
    text_ = static_cast<char*>(mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    if (text_ == MAP_FAILED) broken("serve-history can be written");
    close(file);
  }
  bool has_room(size_t size) const { return used_ + size < kSize; }
  void add(std::string_view text) {
    std::memcpy(text_ + used_, text.data(), text.size());
    used_ += text.size();
    text_[used_++] = '\n';
  }
  void clear() {
    std::memset(text_, 0, used_);
    used_ = 0;
  }

 private:
  static constexpr size_t kSize = 1 << 20;
  char* text_ = nullptr;
  size_t used_ = 0;
};

bool is_slow(std::string_view message) {
  return std::ranges::any_of(kSlow, [&](std::string_view word) {
    const size_t at = message.find(word);
    return at != std::string_view::npos && at > 0 && message.substr(at - 1).starts_with('"') &&
           message.substr(at + word.size()).starts_with('"');
  });
}

struct Session {
  PausingPost post;
  tools::serve::PlantHost host{make(), "plant", "0", post, false};

  explicit Session(int of_slow) : left_out(of_slow) { post.waiting.push_back({LetterKind::Opened, 1, {}}); }

  void take(std::string_view text) {
    while (!text.empty()) {
      const size_t end = text.find('\n');
      std::string message = shortened(text.substr(0, end));
      text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
      if (is_slow(message) && slow++ % left_out != 0) continue;
      post.waiting.push_back({LetterKind::Message, 1, std::move(message)});
      post.runs = true;
      post.answered = false;
      while (host.turn(0)) {
      }
      require(post.answered, "a message is answered");
    }
    require(host.plant().now() >= 0, "the plant is there");
  }

  int left_out;
  int slow = 0;
};

// Takes an input with the host as the one before has left it.
void go_on(std::string_view text, int inputs) {
  static History history;
  static std::unique_ptr<Session> session;
  static int taken = 0;
  if (taken == inputs || !history.has_room(text.size())) session.reset();
  if (!session) {
    history.clear();
    session = std::make_unique<Session>(kOfSlow);
    taken = 0;
  }
  history.add(text);
  session->take(text);
  ++taken;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text = text_of(data, size);
  static const char* const keep = std::getenv("IPOS_FUZZ_KEEP");
  if (keep != nullptr)
    go_on(text, std::max(1, std::atoi(keep)));
  else
    Session(1).take(text);
  return 0;
}
