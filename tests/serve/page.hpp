// A page without a browser: it posts messages to the host of a plant and keeps what the host sends.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tools/serve/plant_host.hpp"

namespace ipos::tests {

using tools::serve::Json;
using tools::serve::LetterKind;

class PagePost final : public tools::serve::Post {
 public:
  bool send(LetterKind kind, uint16_t client, std::string_view body) override {
    sent.push_back({kind, client, std::string(body)});
    return true;
  }
  std::optional<tools::serve::Letter> wait(int) override {
    if (waiting.empty()) return std::nullopt;
    tools::serve::Letter letter = std::move(waiting.front());
    waiting.pop_front();
    return letter;
  }
  bool open() const override { return true; }

  std::deque<tools::serve::Letter> waiting;
  std::vector<tools::serve::Letter> sent;
};

class Page {
 public:
  explicit Page(tools::debug::MakePlant make) : host(std::move(make), "plant.toml", "0", post, false) {
    come(1);
  }

  void come(uint16_t client) {
    post.waiting.push_back({LetterKind::Opened, client, {}});
    while (host.turn(0)) {
    }
  }

  // Posts it and gives the last reply to it; those before it are its parts.
  Json ask(Json message, uint16_t client = 1) {
    message["id"] = ++id_;
    post.sent.clear();
    post.waiting.push_back({LetterKind::Message, client, message.dump()});
    // What another process computes for it comes some time later.
    for (int n = 0; n < kPatience; ++n) {
      while (host.turn(0)) {
      }
      parts.clear();
      for (const auto& letter : post.sent)
        if (letter.kind == LetterKind::Reply && letter.client == client) parts.push_back(Json::parse(letter.body));
      if (!parts.empty() && !parts.back().contains("more")) return parts.back();
      if (message["do"] == "scope.view") return {};  // binary() is its answer
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
  }
  // The same as raw text.
  Json say(const std::string& text) {
    post.sent.clear();
    post.waiting.push_back({LetterKind::Message, 1, text});
    while (host.turn(0)) {
    }
    for (const auto& letter : post.sent)
      if (letter.kind == LetterKind::Reply) return Json::parse(letter.body);
    return {};
  }
  // The last event of a topic since the last ask().
  Json event(const std::string& name) const {
    for (size_t n = post.sent.size(); n-- > 0;) {
      if (post.sent[n].kind != LetterKind::Event) continue;
      Json event = Json::parse(post.sent[n].body);
      if (event["event"] == name) return event;
    }
    return {};
  }
  // The last binary frame since the last ask().
  std::string binary() const {
    for (size_t n = post.sent.size(); n-- > 0;)
      if (post.sent[n].kind == LetterKind::Binary) return post.sent[n].body;
    return {};
  }

  PagePost post;
  tools::serve::PlantHost host;
  std::vector<Json> parts;

 private:
  static constexpr int kPatience = 60'000;  // milliseconds
  int id_ = 0;
};

}  // namespace ipos::tests
