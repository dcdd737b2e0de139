// One connection as a master has it: opens it before the first service, asks until the answer is there, keeps a watched one alive,
// and opens it anew after it has ended. Octets out and in; frames and their order are the caller's.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/bus/profibus/fms/messages.hpp"

namespace ipos::profibus::fms {

// What is to be done. Initiate opens the connection without a service, also an open one; Abort ends it.
struct Done {
  Request request;
  Response response;
};

class ClientLink {
 public:
  static constexpr Time kPatience = 5 * runtime::kSecond;  // for one service (ours)

  ClientLink(const Connection& connection, MasterEntry entry) : connection_(connection), entry_(entry) {}

  const Connection& connection() const { return connection_; }
  bool is_open() const { return open_; }
  bool is_busy() const { return !wanted_.empty(); }
  void ask(Request request) { wanted_.push_back(std::move(request)); }

  // The data of the next frame; nothing: there is nothing to say. Empty: asks for an answer.
  std::optional<Octets> next(Time now);
  // What came for it, nothing with a short acknowledgement.
  std::optional<Done> answered(Time now, std::span<const uint8_t> data);
  // Nobody answers, or RS.
  std::optional<Done> unanswered() { return finish(Response::aborted(Reason::NoAnswer)); }

 private:
  enum class Sent : uint8_t { Nothing, Associate, Request, Abort, Idle };

  std::optional<Done> finish(Response response);
  Octets associate() const;
  Octets service();

  const Connection& connection_;
  MasterEntry entry_;
  std::vector<Request> wanted_;  // the first one is next
  bool open_ = false;
  Sent sent_ = Sent::Nothing;  // and its answer is awaited
  Time sent_at_ = 0;
  uint8_t invoke_ = 0;
};

}  // namespace ipos::profibus::fms
