// Messages to commands, commands to replies, topics to those who want them.
#include "tools/serve/host/router.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "tools/cli/notices.hpp"

namespace ipos::tools::serve {
namespace {

// A client that has so many bytes of events to come gets no new ones: later ones have the newer state.
constexpr size_t kMostUnsent = 256 * 1024;

// Of the time, in parts of what the topics take.
constexpr int kPlantShare = 9;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

WallClock::duration period_of(double rate) {
  return std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(1 / rate));
}

}  // namespace

bool Subscription::is_news(const std::string& about, const Json& value) {
  std::string text = text_of(value);
  std::string& known = sent[about];
  if (known == text) return false;
  known = std::move(text);
  return true;
}

// The page has to show what it and its host contain, whatever host that is.
Router::Router(Outbox& outbox, const Clock& clock) : outbox_(outbox), clock_(clock) {
  add_command("licences", [](const Call&) { return Json{{"text", notices_text()}}; });
}

void Router::take(const Message& message) {
  if (message.kind == MessageKind::Opened) {
    Client& client = clients_[message.client];
    client.number = message.client;
    Json event = hello();
    event["event"] = "hello";
    return send(client, event);
  }
  const auto found = clients_.find(message.client);
  if (found == clients_.end()) return;
  Client& client = found->second;
  if (message.kind == MessageKind::Text) {
    carry_out(client, message.body);
    outbox_.send(MessageKind::Taken, message.client, {});
  } else if (message.kind == MessageKind::Drained) {
    size_t bytes = 0;
    std::from_chars(message.body.data(), message.body.data() + message.body.size(), bytes);
    client.unsent -= std::min(bytes, client.unsent);
  } else if (message.kind == MessageKind::Closed) {
    on_closed(client);
    clients_.erase(found);
  }
}

void Router::carry_out(Client& client, std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  Json id = nullptr;
  if (!message.is_object()) return fail(client.number, id, "a message is one JSON object");
  if (message.contains("id") && message["id"].is_number_integer()) id = message["id"];
  try {
    const Call call{*this, client, id, Arguments(message)};
    const std::string name = call.arguments.text("do");
    if (name == "subscribe") return reply(client.number, id, subscribe(call));
    if (name == "unsubscribe") {
      client.subscriptions.erase(call.arguments.text("topic"));
      return reply(client.number, id, Json::object());
    }
    const auto command = commands_.find(name);
    if (command == commands_.end()) throw Mistake(fmt::format("there is no command '{}' here", name));
    Json fields = command->second(call);
    if (!fields.is_null()) reply(client.number, id, std::move(fields));
  } catch (const Refusal& refusal) {
    fail(client.number, id, refusal.what(), true);
  } catch (const std::runtime_error& mistake) {  // Mistake, and the Failures of the other tools
    fail(client.number, id, mistake.what());
  }
}

Json Router::subscribe(const Call& call) {
  const std::string topic = call.arguments.text("topic");
  if (topics_.count(topic) == 0) throw Mistake(fmt::format("there is no topic '{}' here", topic));
  Subscription subscription;
  subscription.topic = topic;
  subscription.rate = call.arguments.number("rate", 0.1, 60, 20);
  subscription.options = call.arguments.json();
  call.client.subscriptions[topic] = std::move(subscription);
  return Json::object();
}

void Router::reply(uint16_t client, const Json& id, Json fields, bool more) {
  fields["re"] = id;
  fields["ok"] = true;
  if (more) fields["more"] = true;
  outbox_.send(MessageKind::Reply, client, text_of(fields));
}

void Router::fail(uint16_t client, const Json& id, const std::string& text, bool refused) {
  Json answer{{"re", id}, {"error", text.empty() ? "it failed; see the messages of ipos serve" : text}};
  if (refused) answer["refused"] = true;
  outbox_.send(MessageKind::Reply, client, text_of(answer));
}

void Router::send(Client& client, const Json& event) {
  const std::string text = text_of(event);
  client.unsent += text.size();
  outbox_.send(MessageKind::Event, client.number, text);
}

// A view that was asked for comes whatever waits; it is no reply for the server either, but counted.
void Router::send_binary(Client& client, const std::string& bytes, bool is_reply) {
  if (!is_reply && client.unsent > kMostUnsent) return;
  client.unsent += bytes.size();
  outbox_.send(MessageKind::Binary, client.number, bytes);
}

void Router::send_all(const Json& event) {
  for (auto& [number, client] : clients_)
    if (client.unsent <= kMostUnsent) send(client, event);
}

void Router::publish(WallClock::time_point now, bool busy) {
  const bool rests = busy && now < rest_until_;
  bool sent = false;
  for (auto& [number, client] : clients_)
    for (auto& [topic, subscription] : client.subscriptions) {
      if (subscription.due > now || client.unsent > kMostUnsent || (rests && !subscription.fresh)) continue;
      topics_.at(topic)(client, subscription);
      subscription.fresh = false;
      subscription.due = now + period_of(subscription.rate);
      sent = true;
    }
  if (!sent) return;
  const auto end = clock_.now();
  rest_until_ = end + kPlantShare * (end - now);
}

WallClock::time_point Router::next_due() const {
  auto due = WallClock::time_point::max();
  for (const auto& [number, client] : clients_)
    if (client.unsent <= kMostUnsent)
      for (const auto& [topic, subscription] : client.subscriptions) due = std::min(due, subscription.due);
  return due;
}

void Router::refresh() {
  for (auto& [number, client] : clients_)
    for (auto& [topic, subscription] : client.subscriptions) {
      subscription.fresh = true;
      subscription.sent.clear();
      subscription.mark = 0;
      subscription.due = {};
    }
}

Json Router::save() const {
  Json clients = Json::array();
  for (const auto& [number, client] : clients_) {
    Json subscriptions = Json::array();
    for (const auto& [topic, subscription] : client.subscriptions)
      subscriptions.push_back(subscription.options);
    clients.push_back({{"number", number},
                       {"watched", client.watched},
                       {"armed", client.armed},
                       {"unsent", client.unsent},
                       {"subscriptions", std::move(subscriptions)}});
  }
  return clients;
}

void Router::load(const Json& state) {
  clients_.clear();
  for (const Json& saved : state) {
    Client& client = clients_[saved["number"].get<uint16_t>()];
    client.number = saved["number"];
    client.watched = saved["watched"].get<std::vector<std::string>>();
    client.armed = saved["armed"];
    client.unsent = saved["unsent"];
    for (const Json& options : saved["subscriptions"]) {
      static const Json kNone = nullptr;
      subscribe({*this, client, kNone, Arguments(options)});
    }
  }
}

}  // namespace ipos::tools::serve
