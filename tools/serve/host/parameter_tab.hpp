// The tab Parameters: the list of a unit in its groups, and what is read and written over its parameter channel, as `ipos
// param` does it. It knows neither plant nor drive: a source has the units.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tools/parameters/parameter_access.hpp"
#include "tools/serve/host/router.hpp"

namespace ipos::tools::serve {

class ParameterSource {
 public:
  // The unit that this member of the arguments names. A Mistake says which there are.
  virtual std::shared_ptr<ParameterAccess> unit(const Arguments& arguments, const char* key) = 0;
  virtual std::string station(const Arguments& arguments) const { return arguments.text("station"); }
  // False: each question takes its time, so only what must be is asked, and little at once.
  virtual bool answers_at_once() const = 0;
  // Somebody waits for his turn.
  virtual bool others_wait() const { return false; }
  // A Mistake: all of a unit cannot be read now, or this client may not write.
  virtual void check_reading() const {}
  virtual void check_writing(const Router::Call& /*call*/) const {}
  virtual void write(const Json& order) = 0;       // `station`, `index`, `value`, `volatile`
  virtual Json write_file(const Json& order) = 0;  // `station`, `text`
  virtual int64_t us() const = 0;

 protected:
  ~ParameterSource() = default;
};

class ParameterTab final {
 public:
  // Adds its commands and its topic.
  ParameterTab(Router& router, ParameterSource& source);

 private:
  Json list(const Router::Call& call);
  Json set(const Router::Call& call);
  Json compare(const Router::Call& call);
  Json save(const Router::Call& call);
  Json toml(const Router::Call& call);
  Json load(const Router::Call& call);
  void publish(Client& client, Subscription& subscription);

  Router& router_;
  ParameterSource& source_;
};

}  // namespace ipos::tools::serve
