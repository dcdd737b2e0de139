// The clients of a host: who has subscribed to what, which commands there are, and what each client has been sent
// already. The tabs (plant_tab.cpp and so on) add their commands and topics; docs/reference/serve.md is their list.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/serve/host/arguments.hpp"
#include "tools/serve/host/message.hpp"

namespace ipos::tools::serve {

// Of a topic whose values are questions to a unit that takes its time, asked at once.
inline constexpr size_t kReadsAtOnce = 8;

struct Subscription {
  std::string topic;
  double rate = 20;
  Json options;  // the message that subscribed
  WallClock::time_point due{};
  bool fresh = true;                        // nothing was sent yet: everything is news
  std::map<std::string, std::string> sent;  // by what it is about
  uint64_t mark = 0;                        // how far a topic that goes on has been sent

  // Whether this differs from what the client has; then it has it now.
  bool is_news(const std::string& about, const Json& value);
};

struct Client {
  uint16_t number = 0;
  std::map<std::string, Subscription> subscriptions;
  std::vector<std::string> watched;
  bool armed = false;  // has confirmed that it writes to a real drive
  size_t unsent = 0;   // bytes of events that are still on their way to it
};

class Router {
 public:
  Router(Outbox& outbox, const Clock& clock);
  Router(const Router&) = delete;
  Router& operator=(const Router&) = delete;

  // A command that is carried out later keeps client and id, and calls reply().
  struct Call {
    Router& router;
    Client& client;
    const Json& id;
    Arguments arguments;
    void part(Json fields) const { router.reply(client.number, id, std::move(fields), true); }
  };
  // The members of the reply; null: it comes later. A Mistake is the reply, too.
  using Handler = std::function<Json(const Call&)>;
  // Sends what is news. Asked as often as the client wants.
  using Publisher = std::function<void(Client&, Subscription&)>;

  void add_command(std::string name, Handler handler) { commands_[std::move(name)] = std::move(handler); }
  void add_topic(std::string name, Publisher publisher) { topics_[std::move(name)] = std::move(publisher); }
  // What every client hears first.
  std::function<Json()> hello = [] { return Json::object(); };
  std::function<void(const Client&)> on_closed = [](const Client&) {};
  // A setting of all clients that outlives this process (tools/serve/kept.hpp).
  std::function<void(const std::string& name, const Json& value)> keep = [](const std::string&, const Json&) {};

  void take(const Message& message);
  void reply(uint16_t client, const Json& id, Json fields, bool more = false);
  void fail(uint16_t client, const Json& id, const std::string& text, bool refused = false);
  void send(Client& client, const Json& event);
  void send_binary(Client& client, const std::string& bytes, bool is_reply = false);
  void send_all(const Json& event);

  // Sends the topics that are due. While the plant is busy they take a tenth of the time at most: they come later then.
  void publish(WallClock::time_point now, bool busy);
  WallClock::time_point next_due() const;
  // Everything is news again.
  void refresh();

  std::map<uint16_t, Client>& clients() { return clients_; }
  const Clock& clock() const { return clock_; }

  // What a copy of the host that goes on must know.
  Json save() const;
  void load(const Json& state);

 private:
  void carry_out(Client& client, std::string_view text);
  Json subscribe(const Call& call);

  Outbox& outbox_;
  const Clock& clock_;
  WallClock::time_point rest_until_{};  // for a busy plant
  std::map<uint16_t, Client> clients_;
  std::map<std::string, Handler> commands_;
  std::map<std::string, Publisher> topics_;
};

}  // namespace ipos::tools::serve
