// A page without a browser: it posts messages to the host of a plant and keeps what the host sends.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tools/serve/host/plant_host.hpp"

namespace ipos::tests {

using tools::serve::Json;
using tools::serve::MessageKind;

class PagePost final : public tools::serve::Outbox {
 public:
  bool send(MessageKind kind, uint16_t client, std::string_view body) override {
    sent.push_back({kind, client, std::string(body)});
    return true;
  }

  std::deque<tools::serve::Message> waiting;
  std::vector<tools::serve::Message> sent;
};

class Page {
 public:
  Page(tools::debug::Debuggee make, const tools::serve::Clock& clock, tools::serve::Copies& copies,
       tools::serve::Files& files)
      : host(std::move(make), "plant.toml", "0", {post, clock, copies, ports, files, language}) {
    come(1);
  }

  void come(uint16_t client) {
    post.waiting.push_back({MessageKind::Opened, client, {}});
    settle();
  }

  // Until there is nothing more to do.
  void settle() {
    do {
      if (!post.waiting.empty()) {
        host.take(post.waiting.front());
        post.waiting.pop_front();
      }
      host.turn();
    } while (!post.waiting.empty() || host.busy());
  }

  // Posts it and gives the last reply to it; those before it are its parts.
  Json ask(Json message, uint16_t client = 1) {
    message["id"] = ++id_;
    post.sent.clear();
    post.waiting.push_back({MessageKind::Text, client, message.dump()});
    // What another process computes for it comes some time later.
    for (int n = 0; n < kPatience; ++n) {
      settle();
      parts.clear();
      for (const auto& sent : post.sent)
        if (sent.kind == MessageKind::Reply && sent.client == client) parts.push_back(Json::parse(sent.body));
      if (!parts.empty() && !parts.back().contains("more")) return parts.back();
      if (message["do"] == "scope.view") return {};  // binary() is its answer
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
  }
  // The same as raw text.
  Json say(const std::string& text) {
    post.sent.clear();
    post.waiting.push_back({MessageKind::Text, 1, text});
    settle();
    for (const auto& message : post.sent)
      if (message.kind == MessageKind::Reply) return Json::parse(message.body);
    return {};
  }
  // The last event of a topic since the last ask().
  Json event(const std::string& name) const {
    for (size_t n = post.sent.size(); n-- > 0;) {
      if (post.sent[n].kind != MessageKind::Event) continue;
      Json event = Json::parse(post.sent[n].body);
      if (event["event"] == name) return event;
    }
    return {};
  }
  // The last binary frame since the last ask().
  std::string binary() const {
    for (size_t n = post.sent.size(); n-- > 0;)
      if (post.sent[n].kind == MessageKind::Binary) return post.sent[n].body;
    return {};
  }

  PagePost post;
  tools::serve::Ports ports;  // none
  tools::serve::Language language;  // none
  tools::serve::PlantHost host;
  std::vector<Json> parts;

 private:
  static constexpr int kPatience = 60'000;  // milliseconds
  int id_ = 0;
};

}  // namespace ipos::tests
