// Any lines as messages of a page to the host of a plant (docs/reference/serve.md): each is answered, by one reply or
// its parts, and the plant goes on.
//
// Making a plant takes longer than a hundred messages, so with IPOS_FUZZ_KEEP=N in the environment N inputs go to one
// host, which leaves out most messages that take long and does not read long replies. The messages that it has
// carried out are then in the file serve-history, which outlives a finding: without its zeros it is one input that
// does the same.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include "tests/fuzz/fuzz.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/host/plant_host.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

namespace {

using tools::serve::Json;
using tools::serve::MessageKind;
using tools::serve::SteadyClock;

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
constexpr size_t kLongReply =
    4096;  // is not read by a host of many inputs: that would take longer than to make it
// Commands that take as long as a hundred others. Of many inputs for one host only each so many-th is carried out.
constexpr std::string_view kSlow[] = {"parameters", "parameters.compare", "parameters.save", "plant", "back",
                                      "restart"};
constexpr int kOfSlow = 64;

// A page that pauses what it has started.
class CheckedOutbox final : public tools::serve::Outbox {
 public:
  // Replies of `longest` bytes and more are not read.
  explicit CheckedOutbox(size_t longest) : longest_(longest) {}
  bool send(MessageKind kind, uint16_t, std::string_view body) override {
    if (kind == MessageKind::Reply && body.size() < longest_) {
      const Json reply = Json::parse(body, nullptr, false);
      require(reply.is_object() && reply.contains("re"), "a reply is an object and says to what");
      require(reply.contains("ok") != reply.contains("error"), "it is good or it is not");
    }
    answered = answered || kind == MessageKind::Reply || kind == MessageKind::Binary;
    return true;
  }

  bool answered = false;

 private:
  size_t longest_;
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

// The messages that a host has carried out, in a file.
class History {
 public:
  // A message is written shortened: written again as JSON it may be longer, at worst \u00xx for a byte.
  static constexpr size_t kGrows = 6;

  History() {
    const int file = open("serve-history", O_RDWR | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || ftruncate(file, kSize) != 0) broken("serve-history can be written");
    text_ = static_cast<char*>(mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    if (text_ == MAP_FAILED) broken("serve-history can be written");
    close(file);
  }
  bool has_room(size_t size) const { return used_ + size < kSize; }
  void add(std::string_view text) {
    assert(has_room(text.size()));
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
  History* kept;  // null for a host of one input
  CheckedOutbox post;
  SteadyClock clock;
  tools::serve::Copies copies;
  tools::serve::Ports ports;
  tools::serve::Files files;
  tools::serve::Language language;
  tools::serve::PlantHost host{make(), "plant", "0", {post, clock, copies, ports, files, language}};
  int slow = 0;

  explicit Session(History* history)
      : kept(history), post(history == nullptr ? std::numeric_limits<size_t>::max() : kLongReply) {
    host.take({MessageKind::Opened, 1, {}});
  }

  void take(std::string_view text) {
    while (!text.empty()) {
      const size_t end = text.find('\n');
      std::string message = shortened(text.substr(0, end));
      text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
      if (kept != nullptr) {
        if (is_slow(message) && slow++ % kOfSlow != 0) continue;
        kept->add(message);
      }
      post.answered = false;
      host.take({MessageKind::Text, 1, std::move(message)});
      for (host.turn(); host.busy(); host.turn()) host.take({MessageKind::Text, 1, R"({"do": "pause"})"});
      require(post.answered, "a message is answered");
    }
    require(host.plant().now() >= 0, "the plant is there");
  }
};

// Takes an input with the host as the one before has left it.
void go_on(std::string_view text, int inputs) {
  static History history;
  static std::unique_ptr<Session> session;
  static int taken = 0;
  if (taken == inputs || !history.has_room(History::kGrows * text.size())) session.reset();
  if (!session) {
    history.clear();
    session = std::make_unique<Session>(&history);
    taken = 0;
  }
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
    Session(nullptr).take(text);
  return 0;
}
