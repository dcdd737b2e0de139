// The tab Watch: a list of names of each client, and what of their values is news. It knows neither plant nor drive: a source
// has the values.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/signals/signal.hpp"
#include "tools/serve/host/router.hpp"

namespace ipos::tools::serve {

class WatchSource {
 public:
  // What a name or pattern stands for. A Mistake says what there is.
  virtual std::vector<signals::Signal> find(const std::string& name) = 0;
  virtual Json row(const signals::Signal& signal) const = 0;  // `name`, `group`, `unit`, `text`, `writable`
  // `value`, `text`, `hex`, `forced`; null: there is no value now.
  virtual Json value(const signals::Signal& signal) = 0;
  // The command `set`; its reply.
  virtual Json set(const Router::Call& call) = 0;
  virtual size_t most() const = 0;  // values of a client
  // False: each value is a question that takes its time, so few are asked at once.
  virtual bool answers_at_once() const = 0;
  virtual bool others_wait() const { return false; }
  virtual int64_t us() const = 0;

 protected:
  ~WatchSource() = default;
};

class WatchTab final {
 public:
  // Adds its commands `watch` and `set` and its topic.
  WatchTab(Router& router, WatchSource& source);
  // The values are others; the names of the clients stay.
  void forget() { watched_.clear(); }

 private:
  Json watch(const Router::Call& call);
  const std::vector<signals::Signal>& watched(const Client& client);
  void publish(Client& client, Subscription& subscription);

  Router& router_;
  WatchSource& source_;
  std::map<uint16_t, std::vector<signals::Signal>> watched_;  // by client
};

}  // namespace ipos::tools::serve
