// A run answers one request of each onlooker at a time, between two of its milliseconds.
#include "tools/debug/onlookers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <vector>

#include "tools/debug/console.hpp"
#include "tools/debug/onlooker_share.hpp"
#include "tools/lsp_base/transport.hpp"
#include "tools/running/onlooker.hpp"

namespace ipos::tools::debug {
namespace {

constexpr size_t kMostOnlookers = 8;
constexpr size_t kLongestLine = size_t{1} << 20;     // of what an onlooker asks
constexpr size_t kMostUnread = size_t{16} << 20;     // answers that it does not fetch
constexpr std::chrono::seconds kShownAgain{1};       // in an editor

// What one of them has asked for, in the order of its requests.
class Talk {
 public:
  virtual ~Talk() = default;
  // Takes what has come; false: it is none of this kind.
  virtual bool take(std::string& bytes) = 0;
  virtual void answer_one() = 0;
  virtual void show_again() {}
  virtual bool over() const = 0;
};

class ConsoleTalk final : public Talk {
 public:
  ConsoleTalk(runtime::Plant& plant, const std::string& file, std::string& out)
      : console_([&out](const std::string& text) { out += text; }), debugger_(plant, console_), out_(out) {
    console_.attach(debugger_);
    console_.begin_to_look(file);
    out_ += kEndOfAnswer;
  }

  bool take(std::string& bytes) override {
    for (size_t end; (end = bytes.find('\n')) != std::string::npos; bytes.erase(0, end + 1)) lines_.push_back(bytes.substr(0, end));
    return bytes.size() < kLongestLine;
  }
  void answer_one() override {
    if (lines_.empty() || over_) return;
    debugger_.look();
    over_ = !console_.execute(lines_.front());
    lines_.pop_front();
    out_ += kEndOfAnswer;
  }
  bool over() const override { return over_; }

  static constexpr char kEndOfAnswer = '\4';

 private:
  Console console_;
  Debugger debugger_;
  std::string& out_;
  std::deque<std::string> lines_;
  bool over_ = false;
};

class EditorTalk final : public Talk {
 public:
  EditorTalk(runtime::Plant& plant, const std::string& file, std::string& out)
      : server_(plant, file, [&out](const Json& message) {
          out += lsp::framed(message.dump(-1, ' ', false, Json::error_handler_t::replace));
        }) {}

  bool take(std::string& bytes) override {
    reader_.feed(bytes);
    bytes.clear();
    while (const auto body = reader_.next()) server_.receive(*body);
    return !reader_.broken() && reader_.rest().size() < kLongestLine;
  }
  void answer_one() override { server_.handle_next(); }
  void show_again() override { server_.show_again(); }
  bool over() const override { return server_.ended(); }

 private:
  DapServer server_;
  lsp::MessageReader reader_;
};

class RunPort final : public Onlooker {
 public:
  RunPort(runtime::Plant& plant, std::string file, std::unique_ptr<AttachPort> port)
      : plant_(plant), file_(std::move(file)), port_(std::move(port)) {}

  void look() override {
    const auto now = Clock::now();
    if (!share_.is_due(now)) return;
    if (auto peer = port_->accept(); peer && clients_.size() < kMostOnlookers) {
      clients_.push_back(std::make_unique<Client>());
      clients_.back()->peer = std::move(peer);
    }
    const bool again = now - shown_ >= kShownAgain;
    if (again) shown_ = now;
    std::erase_if(clients_, [&](const auto& client) { return !serve(*client, again); });
    share_.looked(now, Clock::now());
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Client {
    std::unique_ptr<Peer> peer;
    std::string in, out;
    bool known = false;  // it has said the word
    std::unique_ptr<Talk> talk;
  };

  // False: it has gone, or is no onlooker.
  bool serve(Client& client, bool again) {
    const bool there = client.peer->receive(client.in);
    if (!there && client.in.empty()) return false;
    if (!client.talk && !begin(client)) return false;
    if (client.talk) {
      if (!client.talk->take(client.in)) return false;
      client.talk->answer_one();
      if (again) client.talk->show_again();
    }
    if (!client.peer->send(client.out) || client.out.size() > kMostUnread) return false;
    return there && !(client.talk && client.talk->over() && client.out.empty());
  }

  // The word, where there is one, and what it wants: a line each.
  bool begin(Client& client) {
    for (size_t end; !client.talk && (end = client.in.find('\n')) != std::string::npos;) {
      const std::string line = client.in.substr(0, end);
      client.in.erase(0, end + 1);
      if (!client.known && !port_->word().empty()) {
        if (line != port_->word()) return false;
        client.known = true;
      } else if (line == "console") {
        client.talk = std::make_unique<ConsoleTalk>(plant_, file_, client.out);
      } else if (line == "dap") {
        client.talk = std::make_unique<EditorTalk>(plant_, file_, client.out);
      } else {
        return false;
      }
    }
    return client.talk || client.in.size() < 256;
  }

  runtime::Plant& plant_;
  std::string file_;
  std::unique_ptr<AttachPort> port_;
  std::vector<std::unique_ptr<Client>> clients_;
  OnlookerShare share_;
  Clock::time_point shown_{};
};

}  // namespace

void offer_onlookers() {
  use_onlookers([](runtime::Plant& plant, const std::string& file) -> std::unique_ptr<Onlooker> {
    auto port = open_attach_port(std::filesystem::path(file).stem().string());
    return port ? std::make_unique<RunPort>(plant, file, std::move(port)) : nullptr;
  });
}

}  // namespace ipos::tools::debug
