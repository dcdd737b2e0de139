// Lists of clients, and the values of them that differ from what each has been sent.
#include "tools/serve/host/watch_tab.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace ipos::tools::serve {
namespace {

using signals::Signal;

}  // namespace

WatchTab::WatchTab(Router& router, WatchSource& source) : router_(router), source_(source) {
  router.add_command("watch", [this](const Router::Call& call) { return watch(call); });
  router.add_command("set", [this](const Router::Call& call) { return source_.set(call); });
  router.add_topic("watch",
                   [this](Client& client, Subscription& subscription) { publish(client, subscription); });
  router.on_closed = [this](const Client& client) { watched_.erase(client.number); };
}

Json WatchTab::watch(const Router::Call& call) {
  std::vector<Signal> found;
  for (const std::string& name : call.arguments.texts("names", source_.most()))
    std::ranges::move(source_.find(name), std::back_inserter(found));
  if (found.size() > source_.most())
    throw Mistake(fmt::format("these are {} values, at most {} are watched", found.size(), source_.most()));
  call.client.watched.clear();
  Json names = Json::array();
  for (const Signal& signal : found) {
    call.client.watched.push_back(signal.name);
    names.push_back(source_.row(signal));
  }
  watched_[call.client.number] = std::move(found);
  if (const auto topic = call.client.subscriptions.find("watch"); topic != call.client.subscriptions.end())
    topic->second.sent.clear();
  return {{"names", std::move(names)}};
}

const std::vector<Signal>& WatchTab::watched(const Client& client) {
  const auto found = watched_.find(client.number);
  if (found != watched_.end()) return found->second;
  std::vector<Signal>& all = watched_[client.number];
  for (const std::string& name : client.watched) {
    try {
      std::ranges::move(source_.find(name), std::back_inserter(all));
    } catch (const Mistake&) {  // the plant was built anew and has it no more
    }
  }
  return all;
}

void WatchTab::publish(Client& client, Subscription& subscription) {
  const std::vector<Signal>& all = watched(client);
  if (all.empty() && !client.watched.empty()) return;
  const size_t at_once = source_.answers_at_once() ? all.size() : std::min(kReadsAtOnce, all.size());
  Json values = Json::object();
  for (size_t n = 0; n < at_once && !source_.others_wait(); ++n) {
    const Signal& signal = all[subscription.mark++ % all.size()];
    Json now = source_.value(signal);
    if (subscription.is_news(signal.name, now)) values[signal.name] = std::move(now);
  }
  if (values.empty() && !(subscription.fresh && source_.answers_at_once())) return;
  router_.send(client, {{"event", "watch"}, {"us", source_.us()}, {"values", std::move(values)}});
}

}  // namespace ipos::tools::serve
